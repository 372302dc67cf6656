//! The beam itself: layers, how they bend together, and how it is held.

use std::f64::consts::TAU;

use bolted_joint_frf::structure::{Beam, Boundary, Damping, Theory};

use super::error::{LayeredBeamError, positive, value};
use super::shape::ModeShape;

/// One layer of rectangular section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Thickness, m.
    pub thickness_m: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus_pa: f64,
    /// Density, kg/m³.
    pub density_kg_per_m3: f64,
}

/// A straight uniform beam of two or more layers, bent about its width.
#[derive(Clone, Debug, PartialEq)]
pub struct LayeredBeam {
    length_m: f64,
    width_m: f64,
    layers: Vec<Layer>,
    boundary: Boundary,
    stiffness_ratio: f64,
}

impl LayeredBeam {
    /// A beam of `layers` from one face to the other. `stiffness_ratio` is k/k′, the static bending stiffness of the jointed
    /// beam over that of the solid one: Kavi measures 0.90 to 0.95, 1 is a beam without joints.
    ///
    /// # Errors
    /// A dimension, modulus or density is not positive, there is no interface, or the ratio is not in (0, 1].
    pub fn new(
        length_m: f64,
        width_m: f64,
        layers: Vec<Layer>,
        boundary: Boundary,
        stiffness_ratio: f64,
    ) -> Result<Self, LayeredBeamError> {
        positive("beam.length", length_m, "m")?;
        positive("beam.width", width_m, "m")?;
        if layers.len() < 2 {
            let expected = "at least two: a solid beam has no interface that slips";
            return Err(value("beam.layer", layers.len(), expected));
        }
        for layer in &layers {
            positive("beam.layer.thickness", layer.thickness_m, "m")?;
            positive("beam.layer.youngs_modulus", layer.youngs_modulus_pa, "Pa")?;
            positive("beam.layer.density", layer.density_kg_per_m3, "kg/m³")?;
        }
        if !(stiffness_ratio > 0.0 && stiffness_ratio <= 1.0) {
            let expected = "more than 0 and at most 1: the stiffness of the jointed beam over that of the solid one";
            return Err(value("beam.stiffness_ratio", stiffness_ratio, expected));
        }
        let height_m: f64 = layers.iter().map(|layer| layer.thickness_m).sum();
        if height_m >= length_m {
            return Err(value(
                "beam.layer.thickness",
                format_args!("{height_m} m in all on a length of {length_m} m"),
                "a slender beam: shear and rotary inertia are left out",
            ));
        }
        Ok(Self {
            length_m,
            width_m,
            layers,
            boundary,
            stiffness_ratio,
        })
    }

    /// Length between the supports, m.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.length_m
    }

    /// Width, m.
    #[must_use]
    pub fn width_m(&self) -> f64 {
        self.width_m
    }

    /// The layers from one face to the other.
    #[must_use]
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// Thickness of all layers, m.
    #[must_use]
    pub fn height_m(&self) -> f64 {
        self.layers.iter().map(|layer| layer.thickness_m).sum()
    }

    /// EI of the jointed beam, N·m²: that of the solid section, bent about the neutral axis of all layers, times the stiffness
    /// ratio.
    #[must_use]
    pub fn bending_stiffness_n_m2(&self) -> f64 {
        // z̄ = Σ E t z/Σ E t;  EI = b Σ E (t³/12 + t (z − z̄)²), z the middle of each layer
        let mut face = 0.0;
        let middles = self.layers.iter().map(|layer| {
            face += layer.thickness_m;
            (layer, face - 0.5 * layer.thickness_m)
        });
        let middles: Vec<(&Layer, f64)> = middles.collect();
        let membrane = |layer: &Layer| layer.youngs_modulus_pa * layer.thickness_m;
        let first: f64 = middles.iter().map(|(layer, z)| membrane(layer) * z).sum();
        let neutral = first / self.layers.iter().map(membrane).sum::<f64>();
        let bending: f64 = middles
            .iter()
            .map(|(layer, z)| {
                membrane(layer) * (layer.thickness_m.powi(2) / 12.0 + (z - neutral).powi(2))
            })
            .sum();
        self.stiffness_ratio * self.width_m * bending
    }

    /// ρA, kg/m.
    #[must_use]
    pub fn mass_per_length_kg_per_m(&self) -> f64 {
        let of = |layer: &Layer| layer.density_kg_per_m3 * layer.thickness_m;
        self.width_m * self.layers.iter().map(of).sum::<f64>()
    }

    /// Shape of elastic mode `mode`, counted from one.
    #[must_use]
    pub fn shape(&self, mode: usize) -> ModeShape {
        ModeShape::new(self.boundary, mode)
    }

    /// Natural frequency of elastic mode `mode`, counted from one, Hz.
    #[must_use]
    pub fn natural_frequency_hz(&self, mode: usize) -> f64 {
        self.angular_frequency(mode) / TAU
    }

    /// ω of elastic mode `mode`, rad/s.
    pub(super) fn angular_frequency(&self, mode: usize) -> f64 {
        // ω = (λ/L)² √(EI/ρA)   (Kavi 3.1, 3.7)
        let wave_number = self.shape(mode).lambda() / self.length_m;
        let stiffness = self.bending_stiffness_n_m2();
        wave_number.powi(2) * (stiffness / self.mass_per_length_kg_per_m()).sqrt()
    }

    /// Static stiffness k at a point `x_m` from the first end, N/m: load over deflection there. `None` at a support, and for a
    /// beam that is held nowhere.
    #[must_use]
    pub fn static_stiffness_n_per_m(&self, x_m: f64) -> Option<f64> {
        let length = self.length_m;
        let (a, b) = (x_m, length - x_m);
        // compliance times EI
        let compliance = match self.boundary {
            Boundary::FixedFixed => (a * b / length).powi(3) / 3.0,
            Boundary::FixedPinned => {
                a.powi(3) * b * b * (3.0 * length + b) / (12.0 * length.powi(3))
            }
            Boundary::PinnedPinned => (a * b).powi(2) / (3.0 * length),
            Boundary::FixedFree => a.powi(3) / 3.0,
            Boundary::FreeFixed => b.powi(3) / 3.0,
            Boundary::FreeFree => return None,
        };
        (compliance > 0.0).then(|| self.bending_stiffness_n_m2() / compliance)
    }

    /// The uniform beam that bends as this one, for finite elements (Kavi 4.10, 4.11: without shear and rotary inertia).
    pub(super) fn equivalent(&self) -> Beam {
        let height = self.height_m();
        // E b h³/12 = EI,  ρ b h = ρA
        let second_moment = self.width_m * height.powi(3) / 12.0;
        Beam {
            length_m: self.length_m,
            width_m: self.width_m,
            height_m: height,
            youngs_modulus_pa: self.bending_stiffness_n_m2() / second_moment,
            density_kg_per_m3: self.mass_per_length_kg_per_m() / (self.width_m * height),
            theory: Theory::EulerBernoulli,
            boundary: self.boundary,
            damping: Damping::Ratios(vec![0.0]),
        }
    }
}
