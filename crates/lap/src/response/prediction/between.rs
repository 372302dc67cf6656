//! What backbones and free decays of one joint differ by as a whole: a bolt that was tightened anew, another hanging, another
//! day. It is a random effect of each run, and a run that was left out has one of its own.
//!
//! It is told by the differences between runs at the same amplitudes. What the law misses at an amplitude it misses in all runs
//! alike, so that a trend over the amplitude which they share takes it out: whether the law is right does not matter.

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// Highest power of the logarithm of the amplitude in the trend that all runs share, of few points and of many …
const TREND: [usize; 2] = [3, 7];
/// … which have so many points for each.
const POINTS_A_POWER: usize = 8;
/// Smallest singular value, as a part of the largest, that tells a number.
const SINGULAR: f64 = 1e-10;

/// The error of one number of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PointError {
    /// Which run it is of.
    pub(super) run: usize,
    /// Logarithm of the amplitude.
    pub(super) log_amplitude: f64,
    /// Relative to the model.
    pub(super) error: f64,
    /// Variance that its noise is taken to have.
    pub(super) variance: f64,
}

/// How runs scatter, in the logarithm of the frequency or relative to the damping ratio.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RunScatter {
    /// One standard deviation of what runs differ by as a whole, relative.
    pub standard_deviation: f64,
    /// Mean square of what is left within runs, in the variances that were taken.
    pub within: f64,
}

/// The scatter of runs about each other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BetweenRuns {
    /// Number of runs that tell it.
    pub runs: usize,
    /// Of frequencies.
    pub frequency: RunScatter,
    /// Of damping ratios, where they were measured.
    pub damping: Option<RunScatter>,
}

impl BetweenRuns {
    /// What it is, for people.
    #[must_use]
    pub fn words(&self) -> String {
        let percent = |own: f64| format!("{:.2} %", 100.0 * own);
        let of_damping = self.damping.map_or_else(String::new, |own| {
            format!(
                " and {} of the damping ratio",
                percent(own.standard_deviation)
            )
        });
        format!(
            "The {} fitted runs differ as a whole, one from the next, by {} of the frequency{of_damping} (one standard deviation). \
             Intervals of runs that were left out have that in them, by Student's quantile of {}.",
            self.runs,
            percent(self.frequency.standard_deviation),
            match self.runs {
                2 => "one degree of freedom".to_owned(),
                runs => format!("{} degrees of freedom", runs - 1),
            }
        )
    }

    /// Of frequencies or, where they were measured, of damping ratios.
    pub(super) fn of_kind(&self, kind: usize) -> Option<RunScatter> {
        match kind {
            0 => Some(self.frequency),
            _ => self.damping,
        }
    }

    /// Variance of a new run's own effect about the mean of those that were fitted: τ² (1 + 1/n).
    pub(super) fn variance(&self, kind: usize) -> f64 {
        let own = self.of_kind(kind);
        let deviation = own.map_or(0.0, |own| own.standard_deviation);
        deviation * deviation * (1.0 + (self.runs as f64).recip())
    }
}

impl RunScatter {
    /// From errors of at least two runs whose amplitudes meet; `None` where they do not.
    ///
    /// e = b_r + m(ln A) + ε by weighted least squares, τ² = Σ (b_r − b̄)²/(n−1) less what the noise of b_r makes of it.
    pub(super) fn of(runs: usize, errors: &[PointError]) -> Option<Self> {
        if runs < 2 || !do_meet(runs, errors) {
            return None;
        }
        let count = errors.len();
        let [least, most] = TREND;
        let columns = runs + (count.saturating_sub(runs) / POINTS_A_POWER).clamp(least, most);
        if count <= columns {
            return None;
        }
        let middle = errors.iter().map(|own| own.log_amplitude).sum::<f64>() / count as f64;
        let widest = errors.iter().fold(0.0_f64, |most, own| {
            most.max((own.log_amplitude - middle).abs())
        });
        if widest <= 0.0 {
            return None;
        }
        let root = |place: usize| errors[place].variance.sqrt().recip();
        let design = DMatrix::from_fn(count, columns, |row, column| {
            let own = &errors[row];
            let entry = match column.checked_sub(runs) {
                None => f64::from(u8::from(own.run == column)),
                Some(power) => ((own.log_amplitude - middle) / widest).powi(power as i32 + 1),
            };
            root(row) * entry
        });
        let found = DVector::from_fn(count, |row, _| root(row) * errors[row].error);
        let inverse =
            bolted_joint_singular::pseudo_inverse(design.clone(), SINGULAR * design.norm())?;
        let numbers = &inverse * &found;
        let left = (&found - &design * &numbers).norm_squared() / (count - columns) as f64;
        let covariance = left * &inverse * inverse.transpose();
        let (all, free) = (runs as f64, runs as f64 - 1.0);
        let own = numbers.rows(0, runs);
        let mean = own.sum() / all;
        let squares: f64 = own.iter().map(|effect| (effect - mean).powi(2)).sum();
        // the trace of the covariance without the mean's part
        let block = covariance.view((0, 0), (runs, runs));
        let of_noise = block.trace() - block.sum() / all;
        let variance = ((squares - of_noise) / free).max(0.0);
        // what the law misses at an amplitude stays in it, what runs differ by does not
        let within = errors.iter().map(|error| {
            let effect = own.get(error.run).map_or(0.0, |effect| effect - mean);
            (error.error - effect).powi(2) / error.variance
        });
        let within = within.sum::<f64>() / (count - runs) as f64;
        let standard_deviation = variance.sqrt();
        (standard_deviation.is_finite() && within.is_finite()).then_some(Self {
            standard_deviation,
            within,
        })
    }
}

/// Whether each run has amplitudes that lie among those of the others.
fn do_meet(runs: usize, errors: &[PointError]) -> bool {
    (0..runs).all(|run| {
        let ends = |of: &dyn Fn(&PointError) -> bool| {
            let own = errors.iter().filter(|error| of(error));
            own.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], error| {
                [low.min(error.log_amplitude), high.max(error.log_amplitude)]
            })
        };
        let [low, high] = ends(&|error| error.run == run);
        let [from, to] = ends(&|error| error.run != run);
        low <= to && from <= high
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(effects: &[f64], noise: f64) -> Vec<PointError> {
        let each = effects.iter().enumerate();
        each.flat_map(|(run, &effect)| {
            (0..40).map(move |place| {
                let log_amplitude = f64::from(place) / 10.0 + 0.3 * run as f64;
                // the law misses by a curve of its own; noise that only looks random
                let missed = 0.4 * log_amplitude - 0.05 * log_amplitude.powi(3);
                let chance =
                    noise * (f64::from(place * place + 7) * (run + 3) as f64).sin() * 2_f64.sqrt();
                PointError {
                    run,
                    log_amplitude,
                    error: effect + missed + chance,
                    variance: 1e-4,
                }
            })
        })
        .collect()
    }

    /// What the law misses has no part of what runs differ by, as long as the trend can follow it.
    #[test]
    fn a_wrong_law_is_no_scatter_of_runs() {
        let effects = [0.02, -0.05, 0.01, 0.06];
        let mean = effects.iter().sum::<f64>() / 4.0;
        let squares: f64 = effects.iter().map(|own| (own - mean).powi(2)).sum();
        let found = RunScatter::of(4, &errors(&effects, 0.0)).unwrap();
        assert!(
            (found.standard_deviation - (squares / 3.0).sqrt()).abs() < 1e-9,
            "{found:?}"
        );
        assert!(found.within > 100.0);
        let alike = RunScatter::of(4, &errors(&[0.3; 4], 0.01)).unwrap();
        assert!(alike.standard_deviation < 0.003, "{alike:?}");
    }

    #[test]
    fn runs_that_do_not_meet_tell_nothing_of_it() {
        let mut apart = errors(&[0.0, 0.1], 0.0);
        for error in &mut apart {
            error.log_amplitude += 10.0 * error.run as f64;
        }
        assert_eq!(RunScatter::of(2, &apart), None);
        assert_eq!(RunScatter::of(1, &errors(&[0.0], 0.0)), None);
    }
}
