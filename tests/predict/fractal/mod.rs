//! Contact of rough surfaces: Zhao's equations.

mod field;
mod limits;
mod precision;
mod published;
mod quadrature;
mod refusals;

use bolted_joint::predict::ContactError;
use bolted_joint::predict::fractal::{FractalContact, Friction};
use bolted_joint::predict::surface::Roughness;
use bolted_joint::predict::{Material, Pair};

/// A contact by its numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Numbers {
    pub(crate) dimension: f64,
    pub(crate) roughness_m: f64,
    pub(crate) modulus_pa: [f64; 2],
    pub(crate) poisson: [f64; 2],
    pub(crate) hardness_pa: f64,
    pub(crate) friction: f64,
    pub(crate) shear_pa: f64,
    pub(crate) area_m2: f64,
}

/// Table 1 and Section 2 of the paper; friction as it is not given there.
pub(crate) const ZHAO: Numbers = Numbers {
    dimension: 1.42,
    roughness_m: 1.21e-8,
    modulus_pa: [1.5e11; 2],
    poisson: [0.28; 2],
    hardness_pa: 1.96e9,
    friction: 0.15,
    shear_pa: 0.0,
    area_m2: 0.06,
};

impl Numbers {
    pub(crate) fn pair(&self) -> Pair {
        let part = |side: usize| Material::new(self.modulus_pa[side], self.poisson[side]).unwrap();
        Pair {
            a: part(0),
            b: part(1),
        }
    }

    pub(crate) fn try_contact(&self) -> Result<FractalContact, ContactError> {
        let friction = Friction {
            coefficient: self.friction,
            shear_strength_pa: self.shear_pa,
        };
        let roughness = Roughness::new(self.dimension, self.roughness_m).unwrap();
        FractalContact::new(
            &self.pair(),
            roughness,
            self.hardness_pa,
            friction,
            self.area_m2,
        )
    }

    pub(crate) fn contact(&self) -> FractalContact {
        self.try_contact().unwrap()
    }
}

/// Relative difference, of 0 to 0 as none.
pub(crate) fn relative(found: f64, expected: f64) -> f64 {
    if found == expected {
        0.0
    } else {
        (found / expected - 1.0).abs()
    }
}
