//! Which lines take part: those at which first orders hold. Decided by data and variances alone, never by the residual, so that nothing
//! is selected by it.

use rayon::prelude::*;

use super::cause::{Cause, Side};
use super::estimate::Settings;
use super::experiment::Structure;
use super::line::{Point, Task, Terms};
use super::normal::as_measured;
use super::structures::Recomputations;

/// Part of what is predicted, and multiple of what noise does to it, by which smooth fits may predict something else.
const APART: f64 = 0.05;
const APART_IN_NOISE: f64 = 5.0;
/// How much less linear a line may be at the end than at the beginning: those at the limit stay.
const STAYS: f64 = 2.0;
/// Of two shifts of the frequency by two prior standard deviations at most this is looked at.
const LARGEST_SHIFT: f64 = 0.008;

/// Whether a line is linear in the receptances of the structures: their noise moves what is predicted by less than a part of it at
/// every entry, and smooth fits, at which derivatives by causes are taken, predict the same but for noise.
pub(crate) fn is_linear(terms: &Terms, most: f64) -> bool {
    let mut entries = terms.magnitude.iter().zip(&terms.apart).enumerate();
    entries.all(|(e, (magnitude, apart))| {
        let sources = terms.labelled_variance.iter().enumerate();
        let moved: f64 = sources
            .map(|(s, variance)| terms.by_labelled[(e, s)].norm_sqr() * variance)
            .sum();
        let moved = moved.sqrt();
        moved < most * magnitude && *apart <= (APART * magnitude).max(APART_IN_NOISE * moved)
    })
}

/// The lines that are linear at a point of the end, too: what is near a resonance there, where it was not at the beginning, can
/// explain anything. Looked at with the receptances as measured: those that follow the residual would leave out what they do not
/// explain.
pub(crate) fn still_linear(
    task: &Task<'_>,
    lines: &[usize],
    point: &Point,
    recomputed: &Recomputations,
    settings: &Settings,
) -> Vec<usize> {
    let most = STAYS * settings.most_nonlinear;
    let stays = |&line: &usize| {
        let measured = as_measured(task, line, point);
        let terms = task.terms(line, point, &measured, recomputed);
        let is_linear = terms.is_some_and(|terms| is_linear(&terms, most));
        is_linear.then_some(line)
    };
    lines.par_iter().filter_map(stays).collect()
}

/// Whether a line is not moved much by the frequency scales that the budget allows: there the first order in them fails.
pub(crate) fn keeps_its_frequency(task: &Task<'_>, line: usize, settings: &Settings) -> bool {
    [Side::A, Side::B].into_iter().all(|side| {
        let prior = task
            .priors
            .iter()
            .find(|prior| prior.cause == Cause::Frequency(side));
        let (Some(prior), Structure::Measured(measured)) = (prior, task.experiment.side(side))
        else {
            return true;
        };
        let shift = (2.0 * prior.standard_deviation).min(LARGEST_SHIFT);
        [shift, -shift].into_iter().all(|epsilon| {
            let ratios = task.ratios(side, line, epsilon);
            let entries = measured.functions.entries.iter().zip(ratios);
            let mut measured = entries.filter(|(entry, _)| !entry.measurements.is_empty());
            measured.all(|(_, ratio)| (ratio - 1.0).norm() < settings.most_shifted)
        })
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use num_complex::Complex64;

    use super::*;

    /// One function of one, and one receptance with 1 % of noise that moves it so many times as much.
    fn line(sensitivity: f64, apart: f64) -> Terms {
        Terms {
            residual: DVector::zeros(1),
            rows: DMatrix::zeros(1, 0),
            by_labelled: DMatrix::from_element(1, 1, Complex64::from(sensitivity)),
            measured: [Vec::new(), Vec::new()],
            labelled_variance: vec![1e-4],
            measured_by_cause: [Vec::new(), Vec::new()],
            magnitude: vec![1.0],
            apart: vec![apart],
        }
    }

    #[test]
    fn a_line_is_linear_where_neither_noise_nor_a_smooth_fit_moves_it_far() {
        let takes_part = |sensitivity, apart| is_linear(&line(sensitivity, apart), 0.3);
        assert!(takes_part(1.0, 0.0) && takes_part(29.0, 0.0));
        assert!(!takes_part(31.0, 0.0));
        // 5 % of it, and 5 times the noise
        assert!(takes_part(0.0, 0.049) && takes_part(4.0, 0.19));
        assert!(!takes_part(0.0, 0.051) && !takes_part(4.0, 0.21));
    }
}
