//! Hits of the assembly that are not where those of the substructures' tests were, though the study does not say so.
//!
//! Nobody hits a place twice. Two tenths of a millimetre are many times the noise of a good test, and one error for each hit of both
//! tests cannot say them: what is left of the functions moves the interface as a rigid body ([`lack`]). So errors of the
//! assembly's own hits join, and stay where they explain that.

use bolted_joint_virtual_point::Change;
use nalgebra::DVector;

use crate::budget::HIT_ANEW;
use crate::error::SpatialError;
use crate::estimate::Found;
use crate::lack;
use crate::problem::{Problem, Unknowns};
use crate::side::Test;
use crate::study::SpatialStudy;

/// Squares that are left where hits anew explain what was left, in parts of these, at most.
const EXPLAINED: f64 = 0.5;

impl SpatialStudy {
    /// With hits of the assembly that may be elsewhere, if something is left out without them.
    pub(crate) fn hit_anew(&self, found: &Found) -> Result<Option<Self>, SpatialError> {
        let is_exact = self.noise == [0.0; 2] && found.best.has_converged;
        let may_be = self.problem.tolerances.is_some() && !self.problem.has_hits_anew();
        if !(is_exact && may_be) || lack::of(&found.shown, &found.joint.unknowns)? < lack::LACKING {
            return Ok(None);
        }
        let mut own = self.clone();
        own.problem = own.problem.with_hits(Some(HIT_ANEW));
        own.problem.wider.clear();
        Ok(Some(own))
    }
}

/// Whether errors of hits explain what was left without them.
pub(crate) fn explains(before: &Found, after: &Found) -> Result<bool, SpatialError> {
    let left = |found: &Found| -> Result<f64, SpatialError> {
        let rms = crate::level::relative_rms(&found.shown, &found.joint.unknowns)?;
        Ok(rms * rms)
    };
    Ok(after.joint.has_converged
        && left(after)? < EXPLAINED * left(before)?
        && lack::of(&after.shown, &after.joint.unknowns)? < lack::LACKING)
}

impl Problem {
    pub(crate) fn has_hits_anew(&self) -> bool {
        self.sides.iter().any(|side| side.hits_anew.is_some())
    }

    /// Unknowns of a problem without hits anew, for this one, which has them.
    pub(crate) fn from_repeated(&self, before: &Problem, unknowns: &Unknowns) -> Unknowns {
        let mut errors = before.errors(unknowns);
        for (errors, side) in errors.iter_mut().zip(&self.sides) {
            errors.resize(side.parameters().len(), 0.0);
        }
        let joint = unknowns.0.rows(0, before.joint_count()).into_owned();
        Unknowns(joint).beside(&errors)
    }

    /// What is said of hits that the study has not as such.
    pub(crate) fn told_anew(&self, unknowns: &Unknowns) -> String {
        let parameters = self.sides.iter().flat_map(|side| side.parameters());
        let errors = unknowns.0.iter().skip(self.joint_count());
        let (mut along, mut about) = (Vec::new(), Vec::new());
        for (one, error) in parameters.zip(errors) {
            match (one.test, one.parameter.change) {
                (Test::Assembly, Change::Pose(dof)) if dof.is_rotation() => about.push(*error),
                (Test::Assembly, _) => along.push(*error),
                (Test::All, _) => {}
            }
        }
        // a hit's own direction says nothing of where along it the hit is, nor of its turns about it
        let rms = |all: Vec<f64>| {
            let seen = 2.0 * all.len() as f64 / 3.0;
            (DVector::from_vec(all).norm_squared() / seen.max(1.0)).sqrt()
        };
        format!(
            "hits of the assembly are not where those of a and b were (by {:.2} mm and {:.1}° in each direction, r.m.s.), and the budget has no hits: \
             they were estimated with errors of their own; state hits in [budget]",
            1e3 * rms(along),
            rms(about).to_degrees()
        )
    }
}
