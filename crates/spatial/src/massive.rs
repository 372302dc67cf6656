//! Whether a mass at the joint would explain the functions better: bolts, nuts and sensors that the assembly has, and neither structure
//! had in its own test.

use crate::further::{Further, Score};
use crate::identification::Unknown;

/// χ² by which a mass explains more than noise would.
const BEYOND: f64 = 36.0;

/// Deviations of a number of the joint beyond which the joint is another one with that mass.
const FAR: f64 = 4.0;

/// The mass that explains most, on which side, where one explains more than noise does.
fn mass(scores: &[(Further, Score)]) -> Option<(&'static str, &Score)> {
    let masses = scores.iter().filter_map(|(one, score)| match one {
        Further::Mass(side) => Some((["a", "b"][*side], score)),
        Further::LossFactor => None,
    });
    let likely = masses.filter(|(_, score)| score.gain > BEYOND);
    likely.max_by(|(_, one), (_, other)| one.gain.total_cmp(&other.gain))
}

/// What it would be, in a sentence.
pub(crate) fn warning(scores: &[(Further, Score)]) -> Option<String> {
    let (side, score) = mass(scores)?;
    Some(format!(
        "a mass of {} ± {:.1} g {} on {side} at the joint, in the assembly alone, would fit better: χ² falls by {:.0}; bolts, nuts and sensors \
         have to be the same in all tests, or in the functions of a or b",
        grams(score),
        1e3 * score.deviation,
        more_or_less(score),
        score.gain
    ))
}

/// Why the joint is not to be relied on, if it is another one with that mass.
pub(crate) fn reason(scores: &[(Further, Score)], unknowns: &[Unknown]) -> Option<String> {
    let (side, score) = mass(scores)?;
    let shifts = score.shifts.iter().zip(unknowns);
    let (by, name) = shifts
        .map(|(shift, unknown)| (shift.abs() / unknown.deviation, &unknown.name))
        .max_by(|(one, _), (other, _)| one.total_cmp(other))?;
    (by > FAR).then(|| {
        format!(
            "with a mass of {} g {} on {side} at the joint, as the functions ask for, {name} would be {by:.0} standard deviations away",
            grams(score),
            more_or_less(score)
        )
    })
}

fn grams(score: &Score) -> String {
    format!("{:.1}", 1e3 * score.value.abs())
}

fn more_or_less(score: &Score) -> &'static str {
    if score.value < 0.0 { "less" } else { "more" }
}
