//! A pressure field as elements of area, wherever it comes from.

use thiserror::Error;

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

/// An element that cannot be part of a pressure field.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FieldError {
    /// No element at all.
    #[error("the pressure field has no elements; at least one is needed")]
    Empty,
    /// A number that is not finite, an area that is not positive or a pressure below zero.
    #[error("element {number} of the pressure field: {quantity} is {found}; expected {expected}")]
    Element {
        /// Its place in the field, counted from 1.
        number: usize,
        /// What is wrong: "x", "y", "area" or "pressure".
        quantity: &'static str,
        /// The number found.
        found: f64,
        /// What it has to be.
        expected: &'static str,
    },
}

impl PressureField {
    /// A field of elements.
    ///
    /// # Errors
    /// There is none, or one has a coordinate that is not finite, an area that is not positive, or a pressure that is negative.
    pub fn new(elements: Vec<Element>) -> Result<Self, FieldError> {
        if elements.is_empty() {
            return Err(FieldError::Empty);
        }
        for (index, element) in elements.iter().enumerate() {
            let checks = [
                (
                    "x",
                    element.x_m,
                    element.x_m.is_finite(),
                    "a finite length in m",
                ),
                (
                    "y",
                    element.y_m,
                    element.y_m.is_finite(),
                    "a finite length in m",
                ),
                (
                    "area",
                    element.area_m2,
                    element.area_m2.is_finite() && element.area_m2 > 0.0,
                    "a positive area in m²",
                ),
                (
                    "pressure",
                    element.pressure_pa,
                    element.pressure_pa.is_finite() && element.pressure_pa >= 0.0,
                    "a pressure of 0 Pa or more",
                ),
            ];
            for (quantity, found, valid, expected) in checks {
                if !valid {
                    return Err(FieldError::Element {
                        number: index + 1,
                        quantity,
                        found,
                        expected,
                    });
                }
            }
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
    pub fn scaled(&self, factor: f64) -> Result<Self, FieldError> {
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
