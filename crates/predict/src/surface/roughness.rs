//! The two numbers that a fractal surface is described by.

use crate::number::{NumberError, check, positive};

/// Fractal dimension and roughness parameter of a surface profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roughness {
    fractal_dimension: f64,
    roughness_m: f64,
}

impl Roughness {
    /// A surface of fractal dimension D, 1 < D < 2, and roughness parameter G > 0 (m) of its profile.
    ///
    /// # Errors
    /// D is not inside (1, 2), or G is not a positive finite length.
    pub fn new(fractal_dimension: f64, roughness_m: f64) -> Result<Self, NumberError> {
        check(
            fractal_dimension > 1.0 && fractal_dimension < 2.0,
            "the fractal dimension D",
            fractal_dimension,
            "",
            "more than 1 and less than 2, as a profile has (a surface's dimension is one more: subtract 1)",
        )?;
        let expected = "a positive length, about 1e-13 m to 1e-7 m for machined metal";
        positive("the fractal roughness G", roughness_m, " m", expected)?;
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
