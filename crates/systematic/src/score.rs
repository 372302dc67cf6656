//! Score tests: by how much χ² would drop if a cause were let free, and which size it would have.

use super::budget::Prior;
use super::cause::Cause;
use super::estimate::Estimate;
use super::experiment::Experiment;
use super::line::{Point, Task};
use super::normal::{Scatter, Whitened};
use super::search::inverse;
use super::structures::Recomputations;

/// What speaks for a cause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// The cause.
    pub cause: Cause,
    /// Drop of χ², distributed as χ² of one degree of freedom where the cause does not act.
    pub drop: f64,
    /// Size that it would have, in its unit.
    pub value: f64,
    /// Standard deviation of that.
    pub standard_deviation: f64,
}

/// Tests `candidates` beside an estimate, the most telling first; unknowns and causes of the estimate are estimated anew in the
/// same step. The standard deviations of the candidates serve as their scale only.
#[must_use]
pub fn score_tests(
    experiment: &Experiment<'_>,
    estimate: &Estimate,
    candidates: &[Prior],
) -> Vec<Score> {
    let own = estimate.causes.iter().map(|cause| cause.prior);
    let base: Vec<Prior> = own.collect();
    let is_new = |prior: &&Prior| {
        !prior.cause.is_hidden() && base.iter().all(|own| own.cause != prior.cause)
    };
    let mut priors = base.clone();
    priors.extend(candidates.iter().filter(is_new));
    let task = Task::new(experiment, &priors);
    let mut causes = estimate.found.point.causes.clone();
    causes.resize(priors.len(), 0.0);
    let point = Point {
        unknowns: estimate.unknowns.clone(),
        causes,
    };
    tested(&task, &point, estimate, base.len()).unwrap_or_default()
}

fn tested(task: &Task<'_>, point: &Point, estimate: &Estimate, own: usize) -> Option<Vec<Score>> {
    let recomputed = Recomputations::of(task.experiment, task.priors, &point.causes)?;
    let size = task.unknowns() + task.priors.len();
    let mut information = nalgebra::DMatrix::zeros(size, size);
    let mut gradient = nalgebra::DVector::zeros(size);
    for &line in &estimate.found.lines {
        let terms = task.terms(line, point, &estimate.found.labelled[line], &recomputed)?;
        let share = Whitened::of(task, line, &terms, &Scatter::default())?.share();
        information += share.information;
        gradient += share.gradient;
    }
    let base = task.unknowns() + own;
    for number in 0..own {
        let precision = task.priors[number].standard_deviation.powi(-2);
        let index = task.unknowns() + number;
        information[(index, index)] += precision;
        gradient[index] -= point.causes[number] * precision;
    }
    let inner = inverse(&information.view((0, 0), (base, base)).into_owned())?;
    let rest = &inner * gradient.rows(0, base);
    let mut scores: Vec<Score> = (base..size)
        .filter_map(|index| {
            let coupling = information.view((0, index), (base, 1));
            // drop = (g_c − N_cq N_qq⁻¹ g_q)²/(N_cc − N_cq N_qq⁻¹ N_qc)
            let above = gradient[index] - coupling.dot(&rest);
            let below = information[(index, index)] - coupling.dot(&(&inner * coupling));
            (below > 1e-9 * information[(index, index)]).then(|| Score {
                cause: task.priors[index - task.unknowns()].cause,
                drop: above * above / below,
                value: above / below,
                standard_deviation: below.sqrt().recip(),
            })
        })
        .collect();
    scores.sort_by(|one, other| other.drop.total_cmp(&one.drop));
    Some(scores)
}
