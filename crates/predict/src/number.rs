//! Numbers that no model can be computed with: one error and one check for all models.

use std::borrow::Cow;

use thiserror::Error;

/// A number that a model cannot be computed with.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{quantity} is {found}{unit}; expected {expected}")]
pub struct NumberError {
    /// What it is the number of.
    pub quantity: Cow<'static, str>,
    /// The number found.
    pub found: f64,
    /// Its unit with a space before it, or nothing.
    pub unit: &'static str,
    /// What it has to be.
    pub expected: &'static str,
}

/// What a hardness has to be.
pub(crate) const HARDNESS: &str =
    "a positive number, that of the softer part (about 2.8 times its yield strength)";

/// Refuses a number that is not `valid`.
pub(crate) fn check(
    valid: bool,
    quantity: impl Into<Cow<'static, str>>,
    found: f64,
    unit: &'static str,
    expected: &'static str,
) -> Result<(), NumberError> {
    match valid {
        true => Ok(()),
        false => Err(NumberError {
            quantity: quantity.into(),
            found,
            unit,
            expected,
        }),
    }
}

/// Refuses a number that is not finite and above zero.
pub(crate) fn positive(
    quantity: impl Into<Cow<'static, str>>,
    found: f64,
    unit: &'static str,
    expected: &'static str,
) -> Result<(), NumberError> {
    let valid = found.is_finite() && found > 0.0;
    check(valid, quantity, found, unit, expected)
}

/// Refuses a number that is not finite or below zero.
pub(crate) fn not_negative(
    quantity: impl Into<Cow<'static, str>>,
    found: f64,
    unit: &'static str,
    expected: &'static str,
) -> Result<(), NumberError> {
    let valid = found.is_finite() && found >= 0.0;
    check(valid, quantity, found, unit, expected)
}
