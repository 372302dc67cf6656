//! The moduli of the layer, from the contacts of the surfaces.

use std::f64::consts::PI;

use crate::ContactError;
use crate::Pair;
use crate::growth::Growth;
use crate::number::{HARDNESS, positive};
use crate::surface::Roughness;

/// Greatest |ln a_c|, ln of the critical area in m², with which its powers are ordinary numbers.
const LARGEST_LOG_AREA: f64 = 300.0;
/// Greatest ln(a_L/a_c), for the same reason.
const LARGEST_GROWTH: f64 = 300.0;

/// The contact of two rough surfaces as the source of a layer's moduli.
///
/// Both moduli are sums over the elastic contacts, (D/2) a_L^(D/2) a^(−(D+2)/2) of them for each da: G_x of (16/π) (1 − β/f)^(1/3) G' each, and E of
/// [2/(3π²)] E' G^(1−D) a^((D−1)/2) each, which is dσ/dε of a Hertzian contact with the stress σ on its area πRδ and the strain ε = δ/R.
/// They are not divided by an area, so that they depend on the whole load, not on the pressure.
#[derive(Debug, Clone, Copy)]
pub struct LayerContact {
    fractal_dimension: f64,
    critical_area_m2: f64,
    critical_load_n: f64,
    growth: Growth,
    /// What multiplies e^(Dx/2) (1 − e^(−x/2)) in E, and e^(Dx/2) − 1 in G_x, in Pa.
    factors: [f64; 2],
}

/// How much of the surfaces is in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Loading {
    /// Normal load P of the whole interface, in N.
    Force(f64),
    /// Real area of contact A_t, in m².
    RealArea(f64),
}

impl Loading {
    pub(super) fn value(self) -> f64 {
        match self {
            Self::Force(value) | Self::RealArea(value) => value,
        }
    }

    fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Force(_) => ("normal load", "N"),
            Self::RealArea(_) => ("real contact area", "m²"),
        }
    }
}

/// Moduli of the layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moduli {
    /// Young's modulus E across the layer, in Pa.
    pub youngs_modulus_pa: f64,
    /// Shear modulus G_x, in Pa.
    pub shear_modulus_pa: f64,
}

impl Moduli {
    /// Poisson's ratio of an isotropic material with these moduli; there is none if it is not inside (−1, 0.5).
    #[must_use]
    pub fn poissons_ratio(&self) -> f64 {
        // (2), (8)–(10): ν = (1 + μ') E*/G_x* − 1 with 1 + μ' = E'/(2G'), which is E/(2 G_x) − 1
        self.youngs_modulus_pa / (2.0 * self.shear_modulus_pa) - 1.0
    }
}

impl LayerContact {
    /// The contact of a pair of materials, of the hardness Kσ_y (Pa) of the softer one, under a tangential load β/f times the friction force.
    ///
    /// # Errors
    /// The hardness is not positive, β/f not inside [0, 1), or the critical area no ordinary number.
    pub fn new(
        pair: &Pair,
        roughness: Roughness,
        hardness_pa: f64,
        friction_ratio: f64,
    ) -> Result<Self, ContactError> {
        positive("the hardness", hardness_pa, " Pa", HARDNESS)?;
        if !(0.0..1.0).contains(&friction_ratio) {
            return Err(ContactError::LayerSlips(friction_ratio));
        }
        let d = roughness.fractal_dimension();
        let modulus = pair.equivalent_youngs_modulus_pa();
        let log_critical = log_critical_area(d, roughness.roughness_m(), hardness_pa / modulus);
        if log_critical.abs() > LARGEST_LOG_AREA {
            return Err(ContactError::CriticalArea {
                exponent: log_critical,
                fractal_dimension: d,
                hardness_to_modulus: hardness_pa / modulus,
            });
        }
        let critical_area_m2 = log_critical.exp();
        Ok(Self {
            fractal_dimension: d,
            critical_area_m2,
            // (13) with a_L = a_c: P = [D/(2−D)] K σ_y a_c
            critical_load_n: d / (2.0 - d) * hardness_pa * critical_area_m2,
            growth: growth(d),
            factors: [
                // (1): E = [2D/(3π²)] E' G^(1−D) a_L^(D/2) (a_c^(−1/2) − a_L^(−1/2)), where (6) makes
                // (√a_c/G)^(D−1) = 2E'/(Kσ_y)
                4.0 * d / (3.0 * PI * PI) * modulus * (modulus / hardness_pa),
                // (12): G_x = (16/π) (1 − β/f)^(1/3) G' [(a_L/a_c)^(D/2) − 1]
                16.0 / PI * (1.0 - friction_ratio).cbrt() * pair.equivalent_shear_modulus_pa(),
            ],
        })
    }

    /// Area a_c between plastic contacts and the larger, elastic ones, in m².
    #[must_use]
    pub fn critical_area_m2(&self) -> f64 {
        self.critical_area_m2
    }

    /// Real area A_rc of contact above which contacts are elastic, in m².
    #[must_use]
    pub fn critical_real_area_m2(&self) -> f64 {
        // (7): A_rc = D a_c/(2 − D)
        self.areas_of_largest() * self.critical_area_m2
    }

    /// Normal load above which contacts are elastic, in N.
    #[must_use]
    pub fn critical_load_n(&self) -> f64 {
        self.critical_load_n
    }

    /// Real area of contact A_t, in m².
    ///
    /// # Errors
    /// The load or area is not more than the critical one.
    pub fn real_area_m2(&self, loading: Loading) -> Result<f64, ContactError> {
        let growth = self.log_growth(loading)?;
        // (5): a_L = (2 − D) A_t/D
        Ok(self.critical_real_area_m2() * growth.exp())
    }

    /// Normal load P, in N.
    ///
    /// # Errors
    /// The load or area is not more than the critical one.
    pub fn load_n(&self, loading: Loading) -> Result<f64, ContactError> {
        let growth = self.log_growth(loading)?;
        // (13), both branches
        Ok(self.critical_load_n * self.growth.log_load(growth).exp())
    }

    /// Moduli of the layer.
    ///
    /// # Errors
    /// The load or area is not more than the critical one: then no contact is elastic.
    pub fn moduli(&self, loading: Loading) -> Result<Moduli, ContactError> {
        let [young, shear] = shapes(self.fractal_dimension, self.log_growth(loading)?);
        Ok(Moduli {
            youngs_modulus_pa: self.factors[0] * young,
            shear_modulus_pa: self.factors[1] * shear,
        })
    }

    /// A_t over the largest contact.
    fn areas_of_largest(&self) -> f64 {
        self.fractal_dimension / (2.0 - self.fractal_dimension)
    }

    /// x = ln(a_L/a_c) > 0
    fn log_growth(&self, loading: Loading) -> Result<f64, ContactError> {
        let (quantity, unit) = loading.names();
        let found = loading.value();
        let expected = "a positive number";
        match loading {
            Loading::Force(_) => positive("the normal load", found, " N", expected),
            Loading::RealArea(_) => positive("the real contact area", found, " m²", expected),
        }?;
        let critical = match loading {
            Loading::Force(_) => self.critical_load_n,
            Loading::RealArea(_) => self.critical_real_area_m2(),
        };
        if found <= critical {
            return Err(ContactError::NoElasticContact {
                quantity,
                found,
                critical,
                unit,
            });
        }
        let ratio = (found / critical).ln();
        let x = match loading {
            Loading::Force(_) => self.growth.solve(ratio),
            Loading::RealArea(_) => ratio,
        };
        if x > LARGEST_GROWTH {
            return Err(ContactError::Overflow(x));
        }
        Ok(x)
    }
}

/// e^(Dx/2) (1 − e^(−x/2)), which E goes with, and e^(Dx/2) − 1, which G_x goes with; x = ln(a_L/a_c).
fn shapes(d: f64, x: f64) -> [f64; 2] {
    let half = 0.5 * d * x;
    [half.exp() * -(-0.5 * x).exp_m1(), half.exp_m1()]
}

/// How the load (13) grows with a_L/a_c.
///
/// With (6), the elastic part of (13) is [(2−D)√π/3] φ(3/2 − D, ln(a_L/a_c)) times the plastic one, D = 1.5 included.
fn growth(d: f64) -> Growth {
    Growth::new(d, (2.0 - d) * PI.sqrt() / 3.0)
}

/// ln a_c
fn log_critical_area(d: f64, roughness_m: f64, hardness_to_modulus: f64) -> f64 {
    // (6): a_c = G²/(Kφ/2)^(2/(D−1)), Kφ = Kσ_y/E'
    2.0 * roughness_m.ln() - 2.0 / (d - 1.0) * (0.5 * hardness_to_modulus).ln()
}
