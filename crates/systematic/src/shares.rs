//! What each group of causes contributes to the variance of each unknown: it says what to calibrate.

use nalgebra::DMatrix;

use super::cause::Group;
use super::line::Task;

/// Parts of each unknown's variance; together with the noise they add up to one.
#[derive(Clone, Debug, PartialEq)]
pub struct Shares {
    /// Part of the noise in each unknown's variance.
    pub noise: Vec<f64>,
    /// Part of each group of causes that takes part.
    pub groups: Vec<(Group, Vec<f64>)>,
}

impl Shares {
    /// With V = (N + P)⁻¹ the error is V (noise − P ν), so that V = V N V + Σ_g V P_g V.
    pub(crate) fn of(task: &Task<'_>, whole: &DMatrix<f64>, information: &DMatrix<f64>) -> Self {
        let size = task.unknowns();
        let noise = whole * information * whole;
        let part = |of: f64, unknown: usize| of / whole[(unknown, unknown)];
        let of_group = |group: Group| {
            let own: Vec<usize> = (0..task.priors.len())
                .filter(|&n| task.priors[n].cause.group() == group)
                .collect();
            let variance = |unknown: usize| -> f64 {
                let one = |&n: &usize| {
                    (whole[(unknown, size + n)] / task.priors[n].standard_deviation).powi(2)
                };
                own.iter().map(one).sum()
            };
            let shares: Vec<f64> = (0..size)
                .map(|unknown| part(variance(unknown), unknown))
                .collect();
            (!own.is_empty()).then_some((group, shares))
        };
        Self {
            noise: (0..size)
                .map(|unknown| part(noise[(unknown, unknown)], unknown))
                .collect(),
            groups: Group::ALL.into_iter().filter_map(of_group).collect(),
        }
    }
}
