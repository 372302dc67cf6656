//! Whether a joint of all numbers would explain the functions better than that of the model: where the errors of the set-up make up
//! for what a model leaves out, residuals do not show it.
//!
//! By the score of the numbers that the model does not have, at the estimate: χ² falls by about gᵀ F⁻¹ g with F and g of all
//! numbers (Rao 1948).

use bolted_joint_space::{JointModel, Motions};
use bolted_joint_statistics::chi_squared_tail;
use nalgebra::DVector;

use crate::error::SpatialError;
use crate::fit::covariance;
use crate::links::Numbers;
use crate::normal::Normal;
use crate::problem::{Problem, Unknowns};

/// Probability below which noise does not make further numbers explain so much.
const UNLIKELY: f64 = 1e-6;

/// That a joint of all numbers explains more than noise would, in a sentence; `normal` are the equations of such a problem, at its
/// unknowns.
pub(crate) fn warning(
    problem: &Problem,
    unknowns: &Unknowns,
    normal: impl FnOnce(&Problem, &Unknowns) -> Result<Normal, SpatialError>,
) -> Result<Option<String>, SpatialError> {
    let Some((all, at)) = with_all_numbers(problem, unknowns)? else {
        return Ok(None);
    };
    let more = all.joint_count() - problem.joint_count();
    let normal = normal(&all, &at)?;
    // further numbers that the functions do not tell explain nothing
    let Some(covariance) = covariance(&normal.information) else {
        return Ok(None);
    };
    let gain = normal.descent.dot(&(covariance * &normal.descent));
    Ok((chi_squared_tail(gain, more) < UNLIKELY).then(|| {
        format!(
            "a joint of all numbers would fit better: χ² falls by about {gain:.0} with {more} further ones, of which noise explains \
             {more}; the joint is not what its model says, and its deviations are too small; take model = \"full\""
        )
    }))
}

/// The same with a joint of all numbers, which are those of the model at first; `None` where the model has them all, and in a plane.
fn with_all_numbers(
    problem: &Problem,
    unknowns: &Unknowns,
) -> Result<Option<(Problem, Unknowns)>, SpatialError> {
    let sought = problem.only()?;
    let full = JointModel::Full.parametrisation()?;
    if sought.link.motions != Motions::ALL || sought.model.count() == full.count() {
        return Ok(None);
    }
    let values = unknowns.0.as_slice();
    let mut own = Vec::new();
    for matrix in sought.matrices(values)? {
        own.extend(full.nearest(&matrix, sought.link.length_m)?.unknowns);
    }
    own.extend(&values[problem.joint_count()..]);
    let number = sought.number;
    let mut all = problem.clone();
    all.links.0[number].numbers = Numbers::Unknown(full);
    Ok(Some((all, Unknowns(DVector::from_vec(own)))))
}
