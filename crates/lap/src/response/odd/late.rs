//! A delay that all responses have: a filter, or a sensor of another amplifier. It turns phases by ωτ, which looks like damping.

use super::{Runs, Search, fitted_runs};
use crate::response::data::{SineLine, wrapped};
use crate::response::fit::Fit;

/// Angle by which phases are turned for a difference, rad.
const STEP: f64 = 1e-3;
/// How often the delay is found anew about where it was.
const ROUNDS: usize = 2;
/// Deviations that a delay has to be from none, and the part of what is more than noise that has to go with it.
const CERTAIN: f64 = 5.0;
const MOST: f64 = 0.5;

/// A delay of all responses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Late {
    /// s
    late_s: f64,
    /// χ² per degree of freedom as it is, and without the delay.
    reduced: [f64; 2],
}

impl Late {
    /// In a sentence.
    pub(super) fn told(&self) -> String {
        let [now, without] = self.reduced;
        format!(
            "all responses seem to be late by {:.3} ms: without that, χ² per degree of freedom would be {without:.3} in place of {now:.3}; if \
             it is a delay of the set-up, take it out of the phases",
            1e3 * self.late_s
        )
    }
}

/// The delay that explains most of what an estimate leaves of sines beyond the noise that is known; `None` if none does.
pub(super) fn of_all(search: &Search<'_>, estimate: &Fit) -> Option<Late> {
    let (sines, curves) = fitted_runs(search.study);
    let lines = || sines.iter().flat_map(|run| &run.lines);
    let count = lines().count();
    (count > 0 && search.study.noise.is_stated).then_some(())?;
    let mean_omega = lines().map(|line| line.omega).sum::<f64>() / count as f64;
    let without = |late_s: f64| {
        let undone = lines().map(|line| SineLine {
            phase_rad: wrapped(line.phase_rad + line.omega * late_s),
            ..*line
        });
        let runs = Runs {
            lines: undone.collect(),
            sines: Vec::new(),
            backbones: curves.clone(),
        };
        search.fitted(&runs, &estimate.values)
    };
    let step_s = STEP / mean_omega;
    let (mut late_s, mut best) = (0.0, estimate.clone());
    let mut deviation_s = f64::INFINITY;
    for _ in 0..ROUNDS {
        let [before, after] = [-step_s, step_s].map(|by| without(late_s + by));
        let [before, after] = [before?.chi_squared, after?.chi_squared];
        // half the second derivative of χ², the information of the delay
        let information = (before + after - 2.0 * best.chi_squared) / (2.0 * step_s * step_s);
        if information <= 0.0 {
            return None;
        }
        let change_s = (before - after) / (4.0 * step_s * information);
        let next = without(late_s + change_s)?;
        if next.chi_squared >= best.chi_squared {
            break;
        }
        late_s += change_s;
        best = next;
        deviation_s = (best.reduced_chi_squared().max(1.0) / information).sqrt();
    }
    let reduced = [estimate, &best].map(Fit::reduced_chi_squared);
    let is_most = reduced[0] - reduced[1] > MOST * (reduced[0] - 1.0);
    (is_most && late_s.abs() > CERTAIN * deviation_s).then_some(Late { late_s, reduced })
}
