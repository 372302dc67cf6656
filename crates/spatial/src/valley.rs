//! Minima beside the one that was found, along what the functions hardly tell.
//!
//! Few functions leave a long valley with several bottoms, and a search ends in the first of them. So others begin in front of the
//! lowest one and behind it, where the squares would be what chance makes likely if the valley were straight.

use nalgebra::DMatrix;

use crate::error::SpatialError;
use crate::fit::{Fit, covariance};
use crate::parallel::over_each;
use crate::problem::Unknowns;

/// How far away they begin, in standard deviations, and along how many directions: of those that are told least.
const ALONG: f64 = 3.0;
const DIRECTIONS: usize = 3;

/// χ² by which one of them is lower if it is another bottom, and how often such a one is begun beside again.
pub(crate) const LOWER: f64 = 1.0;
const ROUNDS: usize = 3;

/// What searches from beside this one, and from beside those that are lower, come to.
pub(crate) fn beside(
    lowest: &Fit,
    information: impl Fn(&Unknowns) -> Result<DMatrix<f64>, SpatialError>,
    follow: impl Fn(&Unknowns) -> Result<Fit, SpatialError> + Sync,
) -> Result<Vec<Fit>, SpatialError> {
    let mut all: Vec<Fit> = Vec::new();
    let mut lowest = lowest.clone();
    for _ in 0..ROUNDS {
        let starts = starts(&lowest.unknowns, &information(&lowest.unknowns)?);
        let ended = over_each(&starts, &follow);
        all.extend(ended.into_iter().flatten());
        let least = all
            .iter()
            .min_by(|one, other| one.cost.total_cmp(&other.cost));
        match least {
            Some(fit) if fit.cost < lowest.cost - LOWER => lowest = fit.clone(),
            _ => break,
        }
    }
    Ok(all)
}

/// At both sides along each of the directions; none where the functions do not determine all.
fn starts(at: &Unknowns, information: &DMatrix<f64>) -> Vec<Unknowns> {
    let Some(covariance) = covariance(information) else {
        return Vec::new();
    };
    let deviations = covariance.diagonal().map(f64::sqrt);
    let between = |i: usize, j: usize| covariance[(i, j)] / (deviations[i] * deviations[j]);
    let correlation = DMatrix::from_fn(deviations.len(), deviations.len(), between);
    let axes = correlation.symmetric_eigen();
    let mut order: Vec<usize> = (0..deviations.len()).collect();
    order.sort_by(|&one, &other| axes.eigenvalues[other].total_cmp(&axes.eigenvalues[one]));
    let steps = order.into_iter().take(DIRECTIONS).map(|n| {
        let axis = axes.eigenvectors.column(n).component_mul(&deviations);
        ALONG * axes.eigenvalues[n].max(0.0).sqrt() * axis
    });
    steps
        .flat_map(|step| [&at.0 - &step, &at.0 + &step])
        .map(Unknowns)
        .collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::*;

    /// Of two bottoms of x² (x − 10)² / 400 − x / 4 + 1000 (y − x / 10)², that at 10 is lower: a search from 0 does not see it.
    #[test]
    fn a_lower_bottom_along_the_valley_is_found() {
        let squares = |at: &DVector<f64>| {
            let (x, y) = (at[0], at[1]);
            (x * (x - 10.0)).powi(2) / 400.0 - 0.25 * x + 1000.0 * (y - 0.1 * x).powi(2)
        };
        let down = |start: &Unknowns| {
            let mut at = start.0.clone();
            for _ in 0..200_000 {
                let (x, y) = (at[0], at[1]);
                let across = 2000.0 * (y - 0.1 * x);
                let along = x * (x - 10.0) * (2.0 * x - 10.0) / 200.0 - 0.25 - 0.1 * across;
                at -= 4e-4 * DVector::from_vec(vec![along, across]);
            }
            Fit {
                cost: squares(&at),
                unknowns: Unknowns(at),
                has_converged: true,
            }
        };
        let first = down(&Unknowns(DVector::from_vec(vec![0.0, 0.0])));
        assert!(first.unknowns.0[0] < 2.0);
        // half of the second derivatives at x = 0
        let information = DMatrix::from_row_slice(2, 2, &[10.25, -100.0, -100.0, 1000.0]);
        let all = beside(&first, |_| Ok(information.clone()), |start| Ok(down(start))).unwrap();
        let lowest = all.iter().map(|fit| fit.cost).fold(f64::INFINITY, f64::min);
        assert!(lowest < -2.5, "{lowest}");
    }
}
