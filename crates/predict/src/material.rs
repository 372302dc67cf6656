//! Elastic constants of a part, and of a pair of parts in contact.

use super::number::{NumberError, check, positive};

/// An isotropic elastic material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Young's modulus, in Pa.
    youngs_modulus_pa: f64,
    /// Poisson's ratio.
    poissons_ratio: f64,
}

impl Material {
    /// A material of Young's modulus (Pa) and Poisson's ratio.
    ///
    /// # Errors
    /// The modulus is not positive, or the ratio is not inside (−1, 0.5).
    pub fn new(youngs_modulus_pa: f64, poissons_ratio: f64) -> Result<Self, NumberError> {
        positive(
            "Young's modulus",
            youngs_modulus_pa,
            " Pa",
            "a positive number",
        )?;
        check(
            poissons_ratio > -1.0 && poissons_ratio < 0.5,
            "Poisson's ratio",
            poissons_ratio,
            "",
            "more than −1 and less than 0.5 (0.5 is incompressible: contact formulas divide by its compliance)",
        )?;
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
