//! Other joints that explain the functions as well as the one that was found.
//!
//! Where the functions say less than all motions of the joints, searches end in several minima. Which of them is the joint is not
//! known then, and the deviations of each say nothing of the others.

use nalgebra::DMatrix;

use crate::error::SpatialError;
use crate::fit::{Fit, covariance};
use crate::problem::Problem;

/// Standard deviations of χ² up to which a minimum above the lowest explains the functions, too.
const AS_GOOD: f64 = 6.0;

/// Stiffnesses of other joints are elsewhere, in parts of themselves, and in their deviations.
const ELSEWHERE: f64 = 0.05;
const BEYOND: f64 = 2.0;

/// How far χ² of other joints is above that of one that noise clearly explains where they are out of the question: five deviations.
pub(crate) const DECISIVE: f64 = 25.0;

/// Squares of so many numbers up to which they are as good as the lowest, wherever that is: it need not be the joint's.
pub(crate) fn as_good(lowest: f64, numbers: f64) -> f64 {
    // χ² of ν numbers is ν ± √(2 ν)
    lowest * (1.0 + AS_GOOD * (2.0 / numbers).sqrt())
}

/// Whether a search came to another joint than another one, beside which stiffnesses are elsewhere.
pub(crate) fn is_elsewhere(problem: &Problem, one: &Fit, other: &Fit) -> bool {
    let mut places = problem.links.stiffnesses().into_iter();
    places.any(|place| is_away(one, other, place))
}

fn is_away(one: &Fit, other: &Fit, place: usize) -> bool {
    away(one, other, place) > ELSEWHERE * other.unknowns.0[place].abs()
}

fn away(one: &Fit, other: &Fit, place: usize) -> f64 {
    (one.unknowns.0[place] - other.unknowns.0[place]).abs()
}

/// How many searches came to joints with other stiffnesses than the lowest, with squares up to these; what is known of the lowest is
/// asked where there are others.
pub(crate) fn rivals(
    problem: &Problem,
    ended: &[Fit],
    most: f64,
    information: impl FnOnce(&Fit) -> Result<DMatrix<f64>, SpatialError>,
) -> Result<usize, SpatialError> {
    let Some(best) = (ended.iter()).min_by(|one, other| one.cost.total_cmp(&other.cost)) else {
        return Ok(0);
    };
    let others = ended.iter().filter(|fit| fit.cost <= most);
    let others: Vec<&Fit> = others
        .filter(|fit| is_elsewhere(problem, fit, best))
        .collect();
    if others.is_empty() {
        return Ok(0);
    }
    let covariance = covariance(&information(best)?);
    let is_beyond = |fit: &&Fit, place: usize| {
        let known = covariance
            .as_ref()
            .map(|known| known[(place, place)].sqrt());
        known.is_none_or(|deviation| away(fit, best, place) > BEYOND * deviation)
    };
    let rivals = others.into_iter().filter(|fit| {
        let mut places = problem.links.stiffnesses().into_iter();
        places.any(|place| is_away(fit, best, place) && is_beyond(fit, place))
    });
    Ok(rivals.count())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::Unknowns;
    use crate::samples::{chain, unknowns};

    /// One that is 3 % elsewhere is the same joint; one that is 20 % elsewhere is another one where that is beyond its deviations.
    #[test]
    fn others_have_other_stiffnesses_beyond_their_deviations() {
        let problem = chain();
        let at = unknowns(&problem).0;
        let place = problem.links.stiffnesses()[0];
        let fit = |part: f64, cost: f64| {
            let mut own = at.clone();
            own[place] *= part;
            Fit {
                unknowns: Unknowns(own),
                cost,
                has_converged: true,
            }
        };
        let ended = [
            fit(1.03, 101.0),
            fit(1.0, 100.0),
            fit(1.2, 101.0),
            fit(1.2, 150.0),
        ];
        let found = |deviation: f64, most: f64| {
            rivals(&problem, &ended, most, |best| {
                let own = best.unknowns.0.map(|own| match own {
                    0.0 => 1.0,
                    own => (deviation * own).powi(-2),
                });
                Ok(DMatrix::from_diagonal(&own))
            })
            .unwrap()
        };
        assert_eq!(found(0.05, 120.0), 1);
        assert_eq!(found(0.05, 200.0), 2);
        assert_eq!(found(0.15, 200.0), 0);
    }

    /// χ² of 200 numbers is 200 ± 20.
    #[test]
    fn as_good_is_six_deviations_above_the_lowest() {
        assert!((as_good(200.0, 200.0) - 320.0).abs() < 1e-9);
    }
}
