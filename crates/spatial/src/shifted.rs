//! Whether all places of one side are off alike: measured from another point than those of the other side, or in turned axes.
//!
//! Each place by itself may be off by what the budget says; all of them in one direction are not. Half a plate that was forgotten moves
//! the joint of one side against that of the other, and no single place by much.

use bolted_joint_space::Dof;
use bolted_joint_virtual_point::Change;
use nalgebra::{DMatrix, DVector};

use crate::contradicted;
use crate::problem::{Problem, Unknowns};
use crate::side::{Side, Test};

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
            "all places of b seem to lie ({}) mm from where the study has them, against those of a, {of_shift:.0} times what the budget \
             lets their mean be: state the positions of both from one point of the joint, half thicknesses of plates and adapters with them, \
             or in budget.origin how well that point is known",
            told(&along, 1e3)
        ),
        false => format!(
            "all places of b seem to be turned by ({})° from how the study has them, against those of a, {of_turn:.0} times what the \
             budget lets their mean be: state positions and directions of both in the same axes, or in budget.origin how well these are known",
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
    let errors = problem.prior().alone(unknowns);
    let parameters = || sides.iter().flatten();
    let is_of_kind: Vec<bool> = parameters()
        .map(|one| one.test == Test::All && one.parameter.change == Change::Pose(dof))
        .collect();
    let kept = |left_out: Option<usize>| -> Vec<bool> {
        let places = is_of_kind.iter().enumerate();
        places
            .map(|(n, is_one)| *is_one && Some(n) != left_out)
            .collect()
    };
    let first_of_b = sides[0].len();
    let of = |kept: &[bool]| {
        let [a, b] = [&kept[..first_of_b], &kept[first_of_b..]]
            .map(|own| own.iter().filter(|is_one| **is_one).count().max(1) as f64);
        let weights = DVector::from_iterator(
            kept.len(),
            kept.iter().enumerate().map(|(n, is_one)| match *is_one {
                true if n < first_of_b => -1.0 / a,
                true => 1.0 / b,
                false => 0.0,
            }),
        );
        of_weights(problem, unknowns, covariance, &weights)
    };
    // one place that is off by itself makes a mean, too, and none without it
    let farthest = (0..errors.len())
        .filter(|&n| is_of_kind[n])
        .max_by(|&one, &other| errors[one].abs().total_cmp(&errors[other].abs()))?;
    let all = of(&kept(None))?;
    let deviation = problem.own_deviations()[farthest];
    let is_off_by_itself = errors[farthest].abs() > contradicted::BEYOND * deviation;
    let others = match is_off_by_itself {
        true => of(&kept(Some(farthest)))?.pull,
        false => all.pull,
    };
    Some(Mean {
        pull: all.pull.min(others),
        ..all
    })
}

/// A mean of the errors with these weights; `None` where the data say nothing of it.
fn of_weights(
    problem: &Problem,
    unknowns: &Unknowns,
    covariance: &DMatrix<f64>,
    weights: &DVector<f64>,
) -> Option<Mean> {
    let (joint, errors) = (problem.joint_count(), weights.len());
    let found = unknowns.0.rows(joint, errors).dot(weights);
    let before = problem.prior().variance(weights);
    let after = covariance.view((joint, joint), (errors, errors)) * weights;
    // an estimate that the budget draws back varies by what the data take off its variance
    let told = before - weights.dot(&after);
    (told > TOLD * before).then(|| Mean {
        value: found * before / told,
        pull: found.abs() / told.sqrt(),
    })
}
