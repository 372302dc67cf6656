//! Elastic constants of a part, and of a pair of parts in contact.

use thiserror::Error;

/// An isotropic elastic material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Young's modulus, in Pa.
    youngs_modulus_pa: f64,
    /// Poisson's ratio.
    poissons_ratio: f64,
}

/// Elastic constants that no stable isotropic material has.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum MaterialError {
    /// Young's modulus is not a positive number.
    #[error("Young's modulus is {0} Pa; expected a positive number")]
    YoungsModulus(f64),
    /// Poisson's ratio is not between −1 and 0.5.
    #[error(
        "Poisson's ratio is {0}; expected more than −1 and less than 0.5 (0.5 is incompressible: contact formulas divide by its compliance)"
    )]
    PoissonsRatio(f64),
}

impl Material {
    /// A material of Young's modulus (Pa) and Poisson's ratio.
    ///
    /// # Errors
    /// The modulus is not positive, or the ratio is not inside (−1, 0.5).
    pub fn new(youngs_modulus_pa: f64, poissons_ratio: f64) -> Result<Self, MaterialError> {
        if !(youngs_modulus_pa.is_finite() && youngs_modulus_pa > 0.0) {
            return Err(MaterialError::YoungsModulus(youngs_modulus_pa));
        }
        if !(poissons_ratio > -1.0 && poissons_ratio < 0.5) {
            return Err(MaterialError::PoissonsRatio(poissons_ratio));
        }
        Ok(Self {
            youngs_modulus_pa,
            poissons_ratio,
        })
    }

    /// Young's modulus, in Pa.
    #[must_use]
    pub fn youngs_modulus_pa(&self) -> f64 {
        self.youngs_modulus_pa
    }

    /// Poisson's ratio.
    #[must_use]
    pub fn poissons_ratio(&self) -> f64 {
        self.poissons_ratio
    }

    /// Shear modulus, in Pa.
    #[must_use]
    pub fn shear_modulus_pa(&self) -> f64 {
        // G = E/(2(1 + ν))
        self.youngs_modulus_pa / (2.0 * (1.0 + self.poissons_ratio))
    }
}

/// Two materials in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// The part on side a.
    pub a: Material,
    /// The part on side b.
    pub b: Material,
}

impl Pair {
    /// Equivalent Young's modulus E* of the contact, in Pa.
    #[must_use]
    pub fn equivalent_youngs_modulus_pa(&self) -> f64 {
        // 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂
        let compliance =
            |part: &Material| (1.0 - part.poissons_ratio.powi(2)) / part.youngs_modulus_pa;
        1.0 / (compliance(&self.a) + compliance(&self.b))
    }

    /// Equivalent shear modulus G′ of the contact, in Pa.
    #[must_use]
    pub fn equivalent_shear_modulus_pa(&self) -> f64 {
        // 1/G′ = (2 − ν₁)/G₁ + (2 − ν₂)/G₂
        let compliance = |part: &Material| (2.0 - part.poissons_ratio) / part.shear_modulus_pa();
        1.0 / (compliance(&self.a) + compliance(&self.b))
    }
}
