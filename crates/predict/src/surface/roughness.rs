//! The two numbers that a fractal surface is described by.

use thiserror::Error;

/// Fractal dimension and roughness parameter of a surface profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roughness {
    fractal_dimension: f64,
    roughness_m: f64,
}

/// Numbers that describe no fractal profile.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum RoughnessError {
    /// The fractal dimension is not between 1 and 2.
    #[error(
        "the fractal dimension D is {0}; expected more than 1 and less than 2, as a profile has (a surface's dimension is one more: subtract 1)"
    )]
    FractalDimension(f64),
    /// The roughness parameter is not a positive length.
    #[error(
        "the fractal roughness G is {0} m; expected a positive length, about 1e-13 m to 1e-7 m for machined metal"
    )]
    RoughnessLength(f64),
}

impl Roughness {
    /// A surface of fractal dimension D, 1 < D < 2, and roughness parameter G > 0 (m) of its profile.
    ///
    /// # Errors
    /// D is not inside (1, 2), or G is not a positive finite length.
    pub fn new(fractal_dimension: f64, roughness_m: f64) -> Result<Self, RoughnessError> {
        if !(fractal_dimension > 1.0 && fractal_dimension < 2.0) {
            return Err(RoughnessError::FractalDimension(fractal_dimension));
        }
        if !(roughness_m.is_finite() && roughness_m > 0.0) {
            return Err(RoughnessError::RoughnessLength(roughness_m));
        }
        Ok(Self {
            fractal_dimension,
            roughness_m,
        })
    }

    /// Fractal dimension D of the profile, between 1 and 2.
    #[must_use]
    pub fn fractal_dimension(&self) -> f64 {
        self.fractal_dimension
    }

    /// Fractal roughness parameter G, in m.
    #[must_use]
    pub fn roughness_m(&self) -> f64 {
        self.roughness_m
    }
}
