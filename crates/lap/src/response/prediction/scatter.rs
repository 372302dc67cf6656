//! How resonances of runs scatter about the model, told by those that were fitted, and why it may not be told.
//!
//! Runs differ from the model by more than the noise of their lines, and each as a whole: the error of a run is taken as one
//! number in frequency and one in amplitude. With the gradients G of the fitted runs, in deviations s of these errors, a new run
//! has the variance s² (1 + g (GᵀG)⁻¹ gᵀ), and s² = Σe²/(n − p) where p, the part of the errors that the unknowns take up, is the
//! trace of G (GᵀG)⁻¹ Gᵀ over them.

use std::fmt;

use bolted_joint_statistics::student_975;
use nalgebra::DMatrix;
use serde::{Serialize, Serializer};

use super::{ACCURACY, Gradients, ITERATIONS, Prediction};

/// Fewest runs beyond what the unknowns take up that tell how runs scatter about the model.
const FEWEST_FREE: f64 = 1.5;
/// Part of a run by which what the unknowns take up may still change.
const SETTLED: f64 = 1e-3;

/// Why it is not told where a run is expected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoInterval {
    /// The model has no resonance at the force that was measured.
    NoResonance,
    /// The model's resonance vanishes within the errors of the unknowns.
    Vanishes,
    /// So many fitted runs have a resonance, and the unknowns take up so many of them.
    TooFewRuns {
        /// Fitted runs.
        fitted: usize,
        /// Of these, in frequency or amplitude, whichever is more.
        taken_up: f64,
    },
    /// The equations for the scatter have no solution.
    Undetermined,
}

impl fmt::Display for NoInterval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoResonance => {
                f.write_str("the model has no resonance at the force that was measured")
            }
            Self::Vanishes => {
                f.write_str("the model's resonance vanishes within the errors of the unknowns")
            }
            Self::TooFewRuns { fitted, .. } if *fitted < 2 => write!(
                f,
                "{} fitted run has a resonance, so that nothing tells how runs scatter about the model; fit at least two",
                if *fitted == 0 { "no" } else { "one" }
            ),
            Self::TooFewRuns { fitted, taken_up } => write!(
                f,
                "how runs scatter about the model is not told: the unknowns take up {taken_up:.1} of the {fitted} fitted run(s) with \
                 a resonance, and at least {FEWEST_FREE} must be left; fit more runs, or fewer terms"
            ),
            Self::Undetermined => f.write_str(
                "how runs scatter about the model is not told: its equations have no solution",
            ),
        }
    }
}

impl Serialize for NoInterval {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// The scatter of runs, in frequency (Hz) and in the logarithm of the displacement's amplitude.
pub(super) struct Scatter {
    variances: [f64; 2],
    quantiles: [f64; 2],
    /// (GᵀG)⁻¹
    inverse: DMatrix<f64>,
}

impl Scatter {
    /// Of the runs that were fitted, about resonances of one motion.
    pub(super) fn of<'p>(all: impl Iterator<Item = &'p Prediction>) -> Result<Self, NoInterval> {
        let fitted = all.filter(|row| !row.left_out);
        let fitted = fitted.filter_map(|row| {
            let relative = row.predicted?.displacement_m / row.measured.displacement_m;
            Some((
                [row.frequency_error_hz()?, relative.ln()],
                row.gradients.as_ref()?,
            ))
        });
        let fitted: Vec<([f64; 2], &Gradients)> = fitted.collect();
        let too_few = |taken_up: [f64; 2]| NoInterval::TooFewRuns {
            fitted: fitted.len(),
            taken_up: taken_up[0].max(taken_up[1]),
        };
        let Some((_, first)) = fitted.first() else {
            return Err(too_few([0.0; 2]));
        };
        let (count, unknowns) = (fitted.len() as f64, first.by_unknown[0].len());
        let squares = [0, 1].map(|kind| {
            let each = fitted.iter().map(|(errors, _)| errors[kind].powi(2));
            each.sum::<f64>()
        });
        let mut taken_up = [0.0; 2];
        let mut inverse = DMatrix::zeros(unknowns, unknowns);
        let mut variances = [0.0; 2];
        for _ in 0..ITERATIONS {
            let free = taken_up.map(|taken_up| count - taken_up);
            if free.iter().any(|&free| free < FEWEST_FREE) {
                return Err(too_few(taken_up));
            }
            variances = [0, 1].map(|kind| squares[kind] / free[kind]);
            let mut normal = DMatrix::zeros(unknowns, unknowns);
            for (_, gradients) in &fitted {
                for (by, variance) in gradients.by_unknown.iter().zip(variances) {
                    normal.ger(1.0 / variance, by, by, 1.0);
                }
            }
            let found = bolted_joint_singular::pseudo_inverse(normal, ACCURACY);
            inverse = found.ok_or(NoInterval::Undetermined)?;
            let before = taken_up;
            taken_up = [0, 1].map(|kind| {
                let each = fitted.iter().map(|(_, gradients)| {
                    let by = &gradients.by_unknown[kind];
                    by.dot(&(&inverse * by)) / variances[kind]
                });
                each.sum()
            });
            let moves = (0..2).map(|kind| (taken_up[kind] - before[kind]).abs());
            if moves.fold(0.0, f64::max) < SETTLED {
                break;
            }
        }
        Ok(Self {
            variances,
            quantiles: taken_up.map(|taken_up| student_975((count - taken_up).round() as usize)),
            inverse,
        })
    }

    /// Halves of the intervals of 95 % of a run with these gradients.
    pub(super) fn halves(&self, own: &Gradients) -> [f64; 2] {
        [0, 1].map(|kind| {
            let by = &own.by_unknown[kind];
            let variance = self.variances[kind] + by.dot(&(&self.inverse * by));
            self.quantiles[kind] * variance.sqrt()
        })
    }
}
