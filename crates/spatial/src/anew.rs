//! Hits of the assembly that are not where those of the substructures' tests were, though the study does not say so.
//!
//! Nobody hits a place twice. Two tenths of a millimetre are many times the noise of a good test, and one error for each hit of both
//! tests cannot say them: what is left of the functions moves the interface as a rigid body ([`lack`]). So errors of the
//! assembly's own hits join, and stay where they explain that.

use std::borrow::Cow;

use bolted_joint_virtual_point::Change;
use nalgebra::DVector;

use crate::budget::HIT_ANEW;
use crate::error::SpatialError;
use crate::estimate::Found;
use crate::lack;
use crate::normal::Deviations;
use crate::problem::{Level, Problem, Unknowns};
use crate::search::Extent;
use crate::side::Test;
use crate::study::SpatialStudy;

/// Squares over numbers that noise of a stated level explains.
const EXPLAINED: f64 = 1.2;

impl SpatialStudy {
    /// What fits best; with hits of the assembly that are elsewhere, where that explains what nothing else does.
    ///
    /// Not all starts are followed where a place is known not to fit: it has to be mended first.
    pub(crate) fn found_with_hits(
        &self,
        rms: &Deviations,
        is_known_not_to_fit: bool,
    ) -> Result<(Cow<'_, Self>, Found), SpatialError> {
        let own = |found: Option<Found>| {
            let found = found.ok_or(SpatialError::NoStart)?;
            Ok((Cow::Borrowed(self), found))
        };
        if is_known_not_to_fit {
            return own(self.searched(rms, Extent::Likely)?);
        }
        if self.problem.tolerances.is_none() || self.problem.has_hits_anew() {
            return own(self.searched(rms, Extent::Unless(&mut || false))?);
        }
        let anew = || {
            let mut own = self.clone();
            own.problem = own.problem.with_hits(Some(HIT_ANEW));
            own
        };
        // what fails with them says nothing of what is found without
        let explained = |anew: Self, found: Result<Option<Found>, SpatialError>| {
            let found = found.ok().flatten()?;
            let is_explained = matches!(anew.is_explained(&found), Ok(true));
            is_explained.then_some((anew, found))
        };
        let first_of = |anew: Self| {
            let found = anew.searched(rms, Extent::First);
            explained(anew, found)
        };
        // with them, where the likely starts without them come to nothing
        let mut asked = None;
        let found = self.searched(
            rms,
            Extent::Unless(&mut || {
                let with = first_of(anew());
                let is_found = with.is_some();
                asked = Some(with);
                is_found
            }),
        )?;
        let with = match (asked, &found) {
            (Some(with), _) => with,
            (None, Some(found)) if self.is_explained(found)? => None,
            (None, Some(found)) if found.best.has_converged && !self.has_noise() => {
                let anew = anew();
                let begun = found.for_hits_anew(&self.problem, &anew.problem);
                let with = anew.found_from(rms, begun).map(Some);
                explained(anew, with)
            }
            (None, _) => first_of(anew()),
        };
        match with {
            Some((anew, with)) => Ok((Cow::Owned(anew), with)),
            None => own(found),
        }
    }

    /// Whether noise explains what is left: by its level where that is stated, else by what moves the interface.
    fn is_explained(&self, found: &Found) -> Result<bool, SpatialError> {
        let left = found.joint.squares / found.joint.numbers as f64;
        let by_level = match self.level {
            Level::Relative(_) => left < EXPLAINED,
            Level::OfResiduals => true,
        };
        let by_motion =
            self.has_noise() || lack::of(&found.shown, &found.joint.unknowns)? < lack::LACKING;
        Ok(found.joint.has_converged && by_level && by_motion)
    }
}

impl Problem {
    pub(crate) fn has_hits_anew(&self) -> bool {
        self.sides.iter().any(|side| side.hits_anew.is_some())
    }

    /// Unknowns of a problem without hits anew, for this one, which has them.
    pub(crate) fn unknowns_with_hits(&self, before: &Problem, unknowns: &Unknowns) -> Unknowns {
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
