//! A pressure field as elements of area, wherever it comes from.

use super::PressureError;
use crate::number::{check, not_negative, positive};

/// A piece of the interface over which the pressure is taken as constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Element {
    /// Coordinate of its centre along the first in-plane axis, in m.
    pub x_m: f64,
    /// Coordinate of its centre along the second in-plane axis, in m.
    pub y_m: f64,
    /// Nominal area, in m²; positive.
    pub area_m2: f64,
    /// Pressure, in Pa; zero where the parts do not touch.
    pub pressure_pa: f64,
}

/// The pressure over an interface.
#[derive(Debug, Clone, PartialEq)]
pub struct PressureField {
    elements: Vec<Element>,
}

impl PressureField {
    /// A field of elements.
    ///
    /// # Errors
    /// There is none, or one has a coordinate that is not finite, an area that is not positive, or a pressure that is negative.
    pub fn new(elements: Vec<Element>) -> Result<Self, PressureError> {
        if elements.is_empty() {
            return Err(PressureError::NoElements);
        }
        for (number, element) in (1..).zip(&elements) {
            let of = |quantity| format!("element {number} of the pressure field: {quantity}");
            let [x_m, y_m] = [element.x_m, element.y_m];
            let (area_m2, pressure_pa) = (element.area_m2, element.pressure_pa);
            let expected = "a finite length in m";
            check(x_m.is_finite(), of("x"), x_m, "", expected)?;
            check(y_m.is_finite(), of("y"), y_m, "", expected)?;
            positive(of("area"), area_m2, "", "a positive area in m²")?;
            not_negative(
                of("pressure"),
                pressure_pa,
                "",
                "a pressure of 0 Pa or more",
            )?;
        }
        Ok(Self { elements })
    }

    /// Its elements, in the order given.
    #[must_use]
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// Nominal area of all elements, touching or not, in m².
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        self.elements.iter().map(|element| element.area_m2).sum()
    }

    /// Normal force that the field carries, in N.
    #[must_use]
    pub fn force_n(&self) -> f64 {
        // N = Σ p ΔA
        self.elements
            .iter()
            .map(|element| element.pressure_pa * element.area_m2)
            .sum()
    }

    /// Moments of the normal force about the x and the y axis, `[Σ p y ΔA, −Σ p x ΔA]`, in N·m.
    #[must_use]
    pub fn moments_n_m(&self) -> [f64; 2] {
        self.elements
            .iter()
            .fold([0.0; 2], |[about_x, about_y], element| {
                let force_n = element.pressure_pa * element.area_m2;
                [
                    about_x + force_n * element.y_m,
                    about_y - force_n * element.x_m,
                ]
            })
    }

    /// The same field with every pressure times a factor.
    ///
    /// # Errors
    /// As [`PressureField::new`], when the factor is negative or not finite.
    pub fn scaled(&self, factor: f64) -> Result<Self, PressureError> {
        Self::new(
            self.elements
                .iter()
                .map(|element| Element {
                    pressure_pa: element.pressure_pa * factor,
                    ..*element
                })
                .collect(),
        )
    }
}
