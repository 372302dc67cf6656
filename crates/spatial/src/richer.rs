//! Whether a joint of all numbers would explain the functions better than that of the model: where the errors of the set-up make up
//! for what a model leaves out, residuals do not show it.
//!
//! By the score of the numbers that the model does not have, at the estimate: χ² falls by about gᵀ F⁻¹ g with F and g of all
//! numbers (Rao 1948).

use bolted_joint_space::{Entry, JointModel, Part};
use bolted_joint_statistics::chi_squared_tail;
use nalgebra::{DVector, Matrix6};

use crate::error::SpatialError;
use crate::fit::covariance;
use crate::links::{Numbers, size};
use crate::normal::Normal;
use crate::numbers::deviations;
use crate::problem::{Problem, Unknowns};

/// Probability below which noise does not make further numbers explain so much.
const UNLIKELY: f64 = 1e-6;

/// Deviations, of the joint found and of one of all numbers, beyond which the one is not the other.
const FAR: f64 = 5.0;

/// Parts of what couples two motions at most below which it does not matter.
const FAR_IN_PARTS: f64 = 0.02;

/// That a joint of all numbers explains more than noise would.
#[derive(Clone, Debug)]
pub(crate) struct Richer {
    /// By how much χ² falls with it, about.
    gain: f64,
    /// Numbers that it has beyond those of the model.
    more: usize,
    /// By how much its K and C are others, to first order.
    shifts: [Matrix6<f64>; 2],
    /// Its deviations.
    deviations: [Matrix6<f64>; 2],
}

impl Richer {
    /// In a sentence.
    pub(crate) fn warning(&self) -> String {
        let Self { gain, more, .. } = self;
        format!(
            "a joint of all numbers would fit better: χ² falls by about {gain:.0} with {more} further ones, of which noise explains \
             {more}; the joint is not what its model says, or not where, and its deviations are too small; take model = \"full\", or state \
             in budget.joint how far it may be beside its point"
        )
    }

    /// Where the matrices that were found, with these deviations, are far from those of all numbers: the number that is farthest away.
    pub(crate) fn reason(
        &self,
        matrices: [&Matrix6<f64>; 2],
        found: &[Matrix6<f64>; 2],
    ) -> Option<String> {
        let mut farthest: Option<(f64, String)> = None;
        for (n, part) in [Part::Stiffness, Part::Damping].into_iter().enumerate() {
            for entry in Entry::ALL {
                let at = (entry.row.index(), entry.column.index());
                let shift = self.shifts[n][at].abs();
                let by = shift / found[n][at].max(self.deviations[n][at]);
                let matters = shift > FAR_IN_PARTS * size(matrices[n], &entry);
                if by > FAR && matters && farthest.as_ref().is_none_or(|(most, _)| by > *most) {
                    let value = matrices[n][at] + self.shifts[n][at];
                    let told = format!(
                        "the joint is not what its model says: with all numbers {} would be about {value:.3e} and not {:.3e}, {by:.0} \
                         standard deviations away; take model = \"full\", or one that has the numbers that differ, or state in budget.joint how \
                         far the joint may be beside its point",
                        entry.name(part),
                        matrices[n][at],
                    );
                    farthest = Some((by, told));
                }
            }
        }
        farthest.map(|(_, told)| told)
    }
}

/// Whether a joint of all numbers explains more than noise would; `normal` are the equations of such a problem, at its unknowns.
pub(crate) fn richer(
    problem: &Problem,
    unknowns: &Unknowns,
    normal: impl FnOnce(&Problem, &Unknowns) -> Result<Normal, SpatialError>,
) -> Result<Option<Richer>, SpatialError> {
    let Some((all, at)) = with_all_numbers(problem, unknowns)? else {
        return Ok(None);
    };
    let (own, count) = (problem.joint_count(), all.joint_count());
    let more = count - own;
    let normal = normal(&all, &at)?;
    // further numbers that the functions do not tell explain nothing
    let Some(covariance) = covariance(&normal.information) else {
        return Ok(None);
    };
    let step = &covariance * &normal.descent;
    let gain = normal.descent.dot(&step);
    if chi_squared_tail(gain, more) >= UNLIKELY {
        return Ok(None);
    }
    let full = all.only()?.model;
    let (stiffness, damping) = step.as_slice()[..count].split_at(full.count());
    let of_joint = covariance.view((0, 0), (count, count)).into_owned();
    Ok(Some(Richer {
        gain,
        more,
        shifts: [full.matrix(stiffness)?, full.matrix(damping)?],
        deviations: deviations(full, &of_joint),
    }))
}

/// The same with a joint of all numbers, which are those of the model at first; `None` where the model has them all.
fn with_all_numbers(
    problem: &Problem,
    unknowns: &Unknowns,
) -> Result<Option<(Problem, Unknowns)>, SpatialError> {
    let Some(all) = of_all_numbers(problem)? else {
        return Ok(None);
    };
    let values = unknowns.0.as_slice();
    let matrices = problem.only()?.matrices(values)?;
    let mut own = all.links.nearest(&[matrices])?.as_slice().to_vec();
    own.extend(&values[problem.joint_count()..]);
    Ok(Some((all, Unknowns(DVector::from_vec(own)))))
}

/// The same with a joint of all numbers; `None` where the model has them all.
pub(crate) fn of_all_numbers(problem: &Problem) -> Result<Option<Problem>, SpatialError> {
    let sought = problem.only()?;
    let full = JointModel::Full
        .parametrisation()?
        .within(sought.link.motions)?;
    if sought.model.count() == full.count() {
        return Ok(None);
    }
    let mut all = problem.clone();
    all.links.0[sought.number].numbers = Numbers::Unknown(full);
    Ok(Some(all))
}
