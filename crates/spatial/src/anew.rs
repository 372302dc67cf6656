//! Hits and sensors of the assembly that are not where those of the substructures' tests were, though the study does not say so.
//!
//! Nobody hits a place twice, nor mounts a sensor twice at one. Two tenths of a millimetre are many times the noise of a good test,
//! and one error for each of both tests cannot say them: what is left of the functions moves the interface as a rigid body
//! ([`lack`]). So errors of the assembly's own hits join, or of its sensors, or both, and stay where they explain that.

use std::borrow::Cow;

use bolted_joint_virtual_point::{Change, Role};
use bolted_joint_wanted::{Pieces, step};

use crate::budget::TYPICAL_ANEW;
use crate::error::SpatialError;
use crate::estimate::{Found, Refined};
use crate::fit::{Effort, Fit};
use crate::lack;
use crate::level::{first, of_residuals};
use crate::normal::{Deviations, cost};
use crate::problem::{Problem, Unknowns};
use crate::search::{BY_CHANCE, Extent, by_chance};
use crate::side::{Anew, Test};
use crate::study::SpatialStudy;
use crate::together::LINES_MAX;

/// Squares over numbers that noise of a stated level explains.
const EXPLAINED: f64 = 1.2;

/// What is left of that beside noise after a few steps that promise something.
const PROMISING: f64 = 0.5;

/// What may be elsewhere.
const HITS: Anew = Anew {
    sensors: None,
    hits: Some(TYPICAL_ANEW),
};
const SENSORS: Anew = Anew {
    sensors: Some(TYPICAL_ANEW),
    hits: None,
};
const BOTH: Anew = Anew {
    sensors: Some(TYPICAL_ANEW),
    hits: Some(TYPICAL_ANEW),
};

impl SpatialStudy {
    /// What fits best; with hits or sensors of the assembly that are elsewhere, where that explains what nothing else does.
    ///
    /// Not all starts are followed where a place is known not to fit: it has to be mended first.
    pub(crate) fn found_with_anew(
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
        if self.problem.tolerances.is_none() || self.problem.has_anew() {
            return own(self.searched(rms, Extent::Unless(&mut || false))?);
        }
        // what fails with them says nothing of what is found without
        let explained = |anew: Self, found: Result<Option<Found>, SpatialError>| {
            let found = found.ok().flatten()?;
            let is_explained = matches!(anew.is_explained(&found), Ok(true));
            is_explained.then_some((anew, found))
        };
        // from what was found with others, or with none
        let near = |kind: Anew, before: &Problem, found: &Found| {
            let anew = self.with_anew(kind);
            let begun = found.for_anew(before, &anew.problem);
            let with = anew.found_from(rms, begun).map(Some);
            explained(anew, with)
        };
        // of one search alone: most that come to nothing have another reason
        let searched = || {
            let _step = step("sensors or hits elsewhere", Pieces::Unknown);
            let both = self.with_anew(BOTH);
            let found = both.searched(rms, Extent::First);
            let (both, found) = explained(both, found)?;
            let mut one = [HITS, SENSORS].into_iter();
            let one = one.find_map(|kind| {
                let (anew, one) = near(kind, &both.problem, &found)?;
                let fewer = both.problem.error_count() - anew.problem.error_count();
                is_as_good(&one.joint, &found.joint, fewer).then_some((anew, one))
            });
            one.or(Some((both, found)))
        };
        // with them, where the likely starts without them come to nothing
        let mut asked = None;
        let found = self.searched(
            rms,
            Extent::Unless(&mut || {
                let with = searched();
                let is_found = with.is_some();
                asked = Some(with);
                is_found
            }),
        )?;
        let with = match (asked, &found) {
            (Some(with), _) => with,
            (None, Some(found)) if self.is_explained(found)? => match self.is_by_chance(found) {
                true => None,
                false => [HITS, SENSORS].into_iter().find_map(|kind| {
                    let is_promising = self.lowers(kind, found, rms).unwrap_or(false);
                    let (anew, one) = is_promising.then(|| near(kind, &self.problem, found))??;
                    let more = anew.problem.error_count() - self.problem.error_count();
                    let lines = found.estimated.frequency_hz.len();
                    let before = self.badness(found, lines, rms).ok()?;
                    let after = anew.badness(&one, lines, rms).ok()?;
                    is_lower(found, [before, after], more).then_some((anew, one))
                }),
            },
            (None, Some(found)) if found.best.has_converged && !self.has_noise() => {
                let [over_channels, over_impacts] =
                    lack::of_each(&found.shown, &found.joint.unknowns)?;
                let likely = if over_channels < over_impacts {
                    SENSORS
                } else {
                    HITS
                };
                let mut kinds = [likely, BOTH].into_iter();
                kinds.find_map(|kind| {
                    let is_promising = self.promises(kind, found, rms).unwrap_or(false);
                    is_promising.then(|| near(kind, &self.problem, found))?
                })
            }
            (None, _) => searched(),
        };
        match with {
            Some((anew, with)) => Ok((Cow::Owned(anew), with)),
            None => own(found),
        }
    }

    /// Whether a few steps with these lead to where the interface moves less as a rigid body in what is left. Where something else is
    /// wrong, a search to the end creeps.
    fn promises(&self, kind: Anew, found: &Found, rms: &Deviations) -> Result<bool, SpatialError> {
        let level = of_residuals(&self.problem, &found.best.unknowns, rms)?;
        let thin = self.problem.thinned(LINES_MAX).with_anew(kind);
        let start = thin.unknowns_with_anew(&self.problem, &found.best.unknowns);
        let lack = |unknowns: &Unknowns| {
            let joint = unknowns.0.rows(0, thin.joint_count()).into_owned();
            lack::of(&thin.displaced(unknowns)?, &Unknowns(joint))
        };
        let before = lack(&start)?;
        let fit = Fit::of(&thin, start, &level, Effort::Coarse)?;
        Ok(lack(&fit.unknowns)? < (PROMISING * before).max(lack::LACKING))
    }

    /// Whether a few steps with these lower the squares by more than chance makes of so many unknowns.
    fn lowers(&self, kind: Anew, found: &Found, rms: &Deviations) -> Result<bool, SpatialError> {
        let level = first(&self.problem, self.level, rms);
        let own = self.problem.thinned(LINES_MAX);
        let thin = own.clone().with_anew(kind);
        let start = thin.unknowns_with_anew(&self.problem, &found.best.unknowns);
        let before = cost(&own, &found.best.unknowns, &level)?;
        let fit = Fit::of(&thin, start, &level, Effort::Coarse)?;
        let more = thin.error_count() - own.error_count();
        Ok(is_lower(found, [before, fit.cost], more))
    }

    /// Whether chance explains what is left of functions with noise of a stated level; of others nobody knows.
    fn is_by_chance(&self, found: &Found) -> bool {
        let Refined {
            squares, numbers, ..
        } = found.joint;
        self.has_noise() || !self.level.is_known() || squares < by_chance(numbers, BY_CHANCE)
    }

    fn with_anew(&self, kind: Anew) -> Self {
        let mut own = self.clone();
        own.problem = own.problem.with_anew(kind);
        own
    }

    /// Whether noise explains what is left: by its level where that is stated, else by what moves the interface.
    pub(crate) fn is_explained(&self, found: &Found) -> Result<bool, SpatialError> {
        let by_level = !self.level.is_known() || left(found) < EXPLAINED;
        let by_motion =
            self.has_noise() || lack::of(&found.shown, &found.joint.unknowns)? < lack::LACKING;
        Ok(found.joint.has_converged && by_level && by_motion)
    }
}

/// Squares over numbers.
fn left(found: &Found) -> f64 {
    found.joint.squares / found.joint.numbers as f64
}

/// Whether so many unknowns more lower these squares by more than chance makes of them, beside what is left of all.
fn is_lower(found: &Found, [before, after]: [f64; 2], more: usize) -> bool {
    before - after > left(found) * by_chance(more, BY_CHANCE)
}

/// Whether so many unknowns fewer leave no more than by chance.
fn is_as_good(one: &Refined, both: &Refined, fewer: usize) -> bool {
    let [own, of_both] = [one, both].map(|own| own.squares / own.numbers as f64);
    (own - of_both) * (both.numbers as f64) < by_chance(fewer, BY_CHANCE)
}

impl Problem {
    pub(crate) fn has_anew(&self) -> bool {
        self.sides.iter().any(|side| side.anew != Anew::default())
    }

    /// Unknowns of a problem with others anew, or with nothing, for this one.
    pub(crate) fn unknowns_with_anew(&self, before: &Problem, unknowns: &Unknowns) -> Unknowns {
        let mut errors = before.errors(unknowns);
        for (errors, side) in errors.iter_mut().zip(&self.sides) {
            let parameters = side.parameters();
            errors.truncate(
                parameters
                    .iter()
                    .filter(|one| one.test == Test::All)
                    .count(),
            );
            errors.resize(parameters.len(), 0.0);
        }
        let joint = unknowns.0.rows(0, before.joint_count()).into_owned();
        Unknowns(joint).beside(&errors)
    }

    /// What is said of sensors and hits that the study has not as such.
    pub(crate) fn told_anew(&self, unknowns: &Unknowns) -> Vec<String> {
        let kinds = [
            (Role::Channel, "sensors", 1.0),
            // a hit's own direction says nothing of where along it the hit is, nor of its turns about it
            (Role::Impact, "hits", 2.0 / 3.0),
        ];
        let told = kinds.map(|(role, name, seen)| {
            let parameters = self.sides.iter().flat_map(|side| side.parameters());
            let errors = unknowns.0.iter().skip(self.joint_count());
            let (mut along, mut about) = (Vec::new(), Vec::new());
            for (one, error) in parameters.zip(errors) {
                match (one.test == Test::Assembly(role), one.parameter.change) {
                    (true, Change::Pose(dof)) if dof.is_rotation() => about.push(*error),
                    (true, _) => along.push(*error),
                    (false, _) => {}
                }
            }
            let rms = |all: &[f64]| {
                let squares: f64 = all.iter().map(|error| error * error).sum();
                (squares / (seen * all.len() as f64).max(1.0)).sqrt()
            };
            (!along.is_empty()).then(|| {
                format!(
                    "{name} of the assembly are not where those of a and b were (by {:.2} mm and {:.1}° in each direction, r.m.s.), \
                     and the budget has no {name}: they were estimated with errors of their own; state {name} in [budget]",
                    1e3 * rms(&along),
                    rms(&about).to_degrees()
                )
            })
        });
        told.into_iter().flatten().collect()
    }
}
