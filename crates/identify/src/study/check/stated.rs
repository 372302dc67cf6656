//! Values that may come with a standard deviation, and those that may not.

use bolted_joint_study::{Stated, StudyError, StudyText};

/// The keys whose values the error budget has a cause for.
const WITH_CAUSES: &str = "a number alone: the error budget has no cause for it; a deviation may stand beside \
    `youngs_modulus`, `density` and `joint.x` of a beam, `section.youngs_modulus`, the positions in `points`, \
    `accelerometer_mass`, and `mass` and `inertia` in `joint`";

/// A value that the budget has no cause for.
pub(super) fn without_deviation(
    study: &StudyText,
    key: &str,
    stated: &Stated,
) -> Result<f64, StudyError> {
    let found = format!("{stated}");
    study.ensure(stated.deviation.is_none(), key, found, WITH_CAUSES)?;
    Ok(stated.value)
}

/// A mass or a moment of inertia that is known, in `unit`.
pub(super) fn not_negative(
    study: &StudyText,
    key: &str,
    stated: &Stated,
    unit: &str,
    most: f64,
) -> Result<(), StudyError> {
    let expected = format!("a number from 0 to {most} in {unit}");
    study.within(key, stated.value, 0.0..=most, expected)?;
    Ok(())
}
