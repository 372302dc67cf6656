//! What each group of causes contributes to the variance of each unknown: it says what to calibrate.

use nalgebra::DMatrix;

use super::cause::Group;
use super::line::Task;

/// What the variance of each unknown would fall by, as a part of it, if a group of causes were known exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct Shares {
    /// For each group of causes that takes part, a part of each unknown's variance. They need not add up to one.
    pub groups: Vec<(Group, Vec<f64>)>,
}

impl Shares {
    /// With the group exact, V_qq becomes V_qq − V_qg V_gg⁻¹ V_gq, V = (N + P)⁻¹.
    pub(crate) fn of(task: &Task<'_>, whole: &DMatrix<f64>) -> Self {
        let size = task.unknowns();
        let of_group = |group: Group| {
            let own: Vec<usize> = (0..task.priors.len())
                .filter(|&number| task.priors[number].cause.group() == group)
                .map(|number| size + number)
                .collect();
            if own.is_empty() {
                return None;
            }
            let across = whole.rows(0, size).select_columns(&own);
            let inner = whole.select_rows(&own).select_columns(&own);
            let solved = inner.cholesky()?.solve(&across.transpose());
            let falls =
                |unknown: usize| across.row(unknown).transpose().dot(&solved.column(unknown));
            let part = |unknown: usize| falls(unknown) / whole[(unknown, unknown)];
            Some((group, (0..size).map(part).collect()))
        };
        Self {
            groups: Group::ALL.into_iter().filter_map(of_group).collect(),
        }
    }
}
