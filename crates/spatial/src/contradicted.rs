//! Errors of the set-up that the budget does not allow for: they are estimated as unknown, and named.
//!
//! A hit that was 20 mm beside its place is found there by the functions, and not quite: what the budget says draws it back, and the
//! joint pays for it.

use bolted_joint_space::Dof;
use bolted_joint_virtual_point::Change;

use crate::identification::SetUpError;
use crate::problem::{Problem, Unknowns};

/// Deviations of the budget beyond which an error is one that it does not allow for: chance leaves none of hundreds there.
pub(crate) const BEYOND: f64 = 4.0;

/// Part of the largest of them from which on another one counts, too: one place that is off draws others with it.
const BESIDE: f64 = 0.5;

/// Deviation of such an error before anything is measured, in parts of what was found.
const UNKNOWN: f64 = 3.0;

/// Factors of the budget's deviations with which these errors are likely; `None` where all are.
pub(crate) fn wider(problem: &Problem, unknowns: &Unknowns) -> Option<Vec<f64>> {
    let deviations = problem.own_deviations();
    let errors = problem.prior().alone(unknowns);
    let pulls = errors
        .iter()
        .zip(&deviations)
        .map(|(own, by)| (own / by).abs());
    let largest = pulls.clone().fold(0.0, f64::max);
    (largest > BEYOND).then(|| {
        let is_beyond = |pull: f64| pull > BEYOND.max(BESIDE * largest);
        let factors = pulls.map(|pull| match is_beyond(pull) {
            true => UNKNOWN * pull,
            false => 1.0,
        });
        let before = problem.wider.iter().chain(std::iter::repeat(&1.0));
        factors
            .zip(before)
            .map(|(own, before)| own * before)
            .collect()
    })
}

/// What to know of errors that were estimated so: one sentence for each sensor or impact.
pub(crate) fn warnings(problem: &Problem, errors: &[SetUpError]) -> Vec<String> {
    let mut named: Vec<(&str, Vec<String>)> = Vec::new();
    let all = errors.iter().zip(&problem.wider);
    for (error, _) in all.filter(|(error, factor)| **factor > 1.0 && error.pull().abs() > BEYOND) {
        let found = found(error);
        match named.last_mut().filter(|(key, _)| *key == error.key) {
            Some((_, all)) => all.push(found),
            None => named.push((&error.key, vec![found])),
        }
    }
    let sentence = |(key, found): (&str, Vec<String>)| {
        format!(
            "{key} is not where and as it is said to be, by more than the budget allows for: found {}; it was estimated as unknown: \
             check it, and correct the study",
            found.join(", ")
        )
    };
    named.into_iter().map(sentence).collect()
}

/// An error with its deviation.
fn found(error: &SetUpError) -> String {
    let (what, unit, scale) = match error.change {
        Change::Pose(dof) if dof.is_rotation() => {
            (format!("turned {}", about(dof)), "°", 1f64.to_degrees())
        }
        Change::Pose(dof) => (format!("moved along {dof}"), "mm", 1e3),
        Change::Gain(channel) => (format!("gain of channel {}", channel + 1), "%", 1e2),
    };
    let [value, deviation] = [error.value, error.deviation].map(|own| own * scale);
    format!("{what} by {value:.1} ± {deviation:.1} {unit}")
}

fn about(dof: Dof) -> String {
    format!("about {}", dof.symbol().trim_start_matches('r'))
}
