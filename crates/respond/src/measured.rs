//! The set of functions that a test would bring home.

use std::fmt::Write as _;

use bolted_joint_frf::{Direction, Frf, FrfError, FrfSet};

use super::pollution::{Generator, Pollution};

/// `set` with noise on each function; the same seed gives the same noise.
///
/// # Errors
/// [`FrfError`] if a value is no longer finite.
pub fn with_noise(set: &FrfSet, noise: &Pollution, seed: u64) -> Result<FrfSet, FrfError> {
    let mut generator = Generator::new(seed);
    let functions = set.functions().map(|(response, reference, receptance)| {
        let values = noise.applied(receptance, &mut generator);
        Frf::new(response, reference, set.frequency_hz().to_vec(), values)
    });
    FrfSet::new(functions.collect::<Result<_, _>>()?)
}

/// `set` as a table: frequency, then real and imaginary part of each receptance.
#[must_use]
pub fn to_csv(set: &FrfSet) -> String {
    let functions: Vec<_> = set.functions().collect();
    let mut text = "frequency [Hz]".to_owned();
    for (response, reference, _) in &functions {
        let motion = unit(response.direction(), ["m", "rad", "1"]);
        let load = unit(reference.direction(), ["N", "(N*m)", "1"]);
        for part in ["real", "imaginary"] {
            let _ = write!(
                text,
                ",{response}/{reference} receptance {part} [{motion}/{load}]"
            );
        }
    }
    text.push('\n');
    for (line, hz) in set.frequency_hz().iter().enumerate() {
        let _ = write!(text, "{hz}");
        for (_, _, values) in &functions {
            let value = values[line];
            let _ = write!(text, ",{:e},{:e}", value.re, value.im);
        }
        text.push('\n');
    }
    text
}

/// The unit of a translation, a rotation or neither.
fn unit(direction: Direction, units: [&'static str; 3]) -> &'static str {
    let [translation, rotation, none] = units;
    if direction.is_translation() {
        translation
    } else if direction.is_rotation() {
        rotation
    } else {
        none
    }
}
