//! Whether all places of one side are off alike: measured from another point than those of the other side, or in turned axes.
//!
//! Each place by itself may be off by what the budget says; all of them in one direction are not. Half a plate that was forgotten moves
//! the joint of one side against that of the other, and no single place by much.

use bolted_joint_space::Dof;
use bolted_joint_virtual_point::Change;
use nalgebra::{DMatrix, DVector};

use crate::problem::{Problem, Unknowns};
use crate::side::Side;

/// Deviations of the budget beyond which a mean over all places is no chance.
const BEYOND: f64 = 4.0;

/// Part of the budget's variance that the data have to tell of a mean to say anything of it.
const TOLD: f64 = 0.05;

/// A mean error of the places of b less that of those of a.
struct Mean {
    /// Without what the budget draws back.
    value: f64,
    /// In deviations of what it is found to be where the budget holds.
    pull: f64,
}

/// Why the set-up is another one than the study says, if all places of a side are off alike.
///
/// `covariance` is that of all unknowns, with all data.
pub(crate) fn reason(
    problem: &Problem,
    unknowns: &Unknowns,
    covariance: &DMatrix<f64>,
) -> Option<String> {
    let means = |dofs: &[Dof]| -> Vec<Option<Mean>> {
        dofs.iter()
            .map(|&dof| mean(problem, unknowns, covariance, dof))
            .collect()
    };
    let largest = |means: &[Option<Mean>]| {
        let pulls = means.iter().flatten().map(|mean| mean.pull);
        pulls.fold(0.0, f64::max)
    };
    let (along, about) = Dof::ALL.split_at(3);
    let (along, about) = (means(along), means(about));
    let (of_shift, of_turn) = (largest(&along), largest(&about));
    let told = |means: &[Option<Mean>], scale: f64| -> String {
        let values = means
            .iter()
            .map(|mean| mean.as_ref().map_or(0.0, |mean| scale * mean.value));
        let values: Vec<String> = values.map(|value| format!("{value:.1}")).collect();
        values.join(", ")
    };
    if of_shift.max(of_turn) < BEYOND {
        return None;
    }
    Some(match of_shift >= of_turn {
        true => format!(
            "all places of b seem to lie ({}) mm from where the study has them, against those of a, {of_shift:.0} times what the budget lets their mean be: \
             state the positions of both from one point of the joint, half thicknesses of plates and adapters with them",
            told(&along, 1e3)
        ),
        false => format!(
            "all places of b seem to be turned by ({})° from how the study has them, against those of a, {of_turn:.0} times what the budget lets their mean be: \
             state positions and directions of both in the same axes",
            told(&about, 1f64.to_degrees())
        ),
    })
}

/// Of the errors of one kind; `None` where neither side has any, or where the data say nothing of their mean.
fn mean(
    problem: &Problem,
    unknowns: &Unknowns,
    covariance: &DMatrix<f64>,
    dof: Dof,
) -> Option<Mean> {
    let sides = problem.sides.each_ref().map(Side::parameters);
    let kinds = sides.iter().map(|all| {
        let own = all.iter().map(|(_, one)| one.change == Change::Pose(dof));
        own.collect::<Vec<_>>()
    });
    let count = |kinds: &[bool]| kinds.iter().filter(|is_one| **is_one).count().max(1) as f64;
    let weights = kinds.zip([-1.0, 1.0]).flat_map(|(kinds, sign)| {
        let own = sign / count(&kinds);
        kinds
            .into_iter()
            .map(move |is_one| if is_one { own } else { 0.0 })
    });
    let weights = DVector::from_vec(weights.collect());
    let (joint, errors) = (problem.joint_count(), weights.len());
    let found = unknowns.0.rows(joint, errors).dot(&weights);
    let of_budget = weights.iter().zip(problem.error_deviations());
    let before: f64 = of_budget.map(|(weight, by)| (weight * by).powi(2)).sum();
    let after = covariance.view((joint, joint), (errors, errors)) * &weights;
    // an estimate that the budget draws back varies by what the data take off its variance
    let told = before - weights.dot(&after);
    (told > TOLD * before).then(|| Mean {
        value: found * before / told,
        pull: found.abs() / told.sqrt(),
    })
}
