//! Points that are all shifted alike: then it is not each of their positions that is wrong but what they are counted from.

use bolted_joint_systematic::Cause;

use super::{Systematic, shown};

/// Shifts that differ by less than this part of their mean are alike.
const ALIKE: f64 = 0.2;
/// So many points are not shifted alike by chance.
const FEWEST: usize = 3;

/// What to look at where the positions of all points contradict the budget by nearly the same.
pub(super) fn warning(found: &Systematic) -> Option<String> {
    let positions = || {
        let causes = found.causes.iter().map(|(_, cause)| cause);
        causes.filter(|cause| matches!(cause.prior.cause, Cause::Position(_)))
    };
    let shifts: Vec<f64> = positions()
        .filter(|cause| cause.contradicted.is_some())
        .map(|cause| cause.value)
        .collect();
    let common_m = common(&shifts).filter(|_| shifts.len() == positions().count())?;
    let ([common, _], unit) = shown(Cause::Position(0), [common_m, 0.0]);
    Some(format!(
        "all points seem to be shifted alike, by {common:.2} {unit}: look at the length of the structure that they are on, and at the \
         end that their positions are counted from, before you move each of them"
    ))
}

/// The mean of shifts that are alike.
fn common(shifts: &[f64]) -> Option<f64> {
    let mean = shifts.iter().sum::<f64>() / shifts.len() as f64;
    let is_alike = |shift: &f64| (shift - mean).abs() < ALIKE * mean.abs();
    (shifts.len() >= FEWEST && shifts.iter().all(is_alike)).then_some(mean)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shifts_have_something_in_common_where_all_are_nearly_the_same() {
        let found = common(&[2.87e-3, 2.93e-3, 3.0e-3]).unwrap();
        assert!((found - 2.933e-3).abs() < 1e-6);
        for other in [
            &[2.9e-3, 3.0e-3][..],
            &[2.9e-3, -2.9e-3, 2.9e-3],
            &[1e-3, 3e-3, 3e-3],
        ] {
            assert_eq!(common(other), None);
        }
    }
}
