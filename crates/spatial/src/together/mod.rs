//! The joint together with the errors of the set-up.
//!
//! Beside noise of a thousandth, sensors a millimetre off leave residuals of a half, and the search for both goes astray. So
//! the noise is taken as large as the residuals at first, and let down as they shrink: the errors that matter most come first, and
//! each step begins near its end. Starts are those beside the errors that each structure tells by itself, and those without
//! errors: where one kind leads astray, the other one often does not.

mod by_all_numbers;
mod compare;
mod down;

use bolted_joint_wanted::{Pieces, Step, step};

use self::compare::compared;
use self::down::let_down;
use crate::error::SpatialError;
use crate::fit::{Effort, Fit};
use crate::normal::{Deviations, cost, squares_of_errors};
use crate::problem::{Problem, Unknowns};
use crate::search::{
    AS_LOW_BESIDE_ERRORS, BY_CHANCE, CLEARLY, Extent, NOTHING, Searched, agreeing_with, by_chance,
};
use crate::starts::starts;

/// Lines of the search from several starts: thousands of numbers, for hundreds of unknowns.
const LINES: usize = 12;

/// Lines at which a search ends. The estimate goes on from there at more.
pub(crate) const LINES_MAX: usize = 60;

/// Squares over numbers that do not follow it, and those that noise and the budget explain.
const LAGGING: f64 = 3.0;
const EXPLAINED: f64 = 1.05;

/// Likewise of a set-up that no joint goes with, with noise as it is stated and as it is taken to be where it is not.
const HOPELESS: [f64; 2] = [30.0, 1000.0];

/// Likewise of the errors of the set-up.
const EXPECTED: f64 = 1.3;

/// Stiffness in parts of the structures' own from which on a joint is as good as rigid: a search may have lost it there.
const RIGID: f64 = 1e4;
/// Likewise of a negative one.
const NEGATIVE: f64 = 0.1;

/// Starts of each kind that are followed before those beside the errors of the lowest search; and where something else is known to
/// be wrong.
const AT_FIRST: usize = 4;
const LIKELY: usize = 2;

/// Starts beside errors of the set-up where a motion of the joint got lost.
const BESIDE_LOST: usize = 3;

/// Minima that noise explains at the lines of the search and not at those of the estimate, after which no other is looked for.
const MOST_CHECKED: usize = 6;

/// The joint and the errors of the set-up, at [`LINES_MAX`] lines; how many searches there were, and how many came to the same
/// minimum. None follows one that noise explains at all these lines, where its level is stated, one that leaves nothing, or two that
/// agree: on what noise explains at the lines of the searches, or is not far above it. Where there may be other joints, none of the
/// first ones is left out but after one that noise clearly explains. `None` where the likely starts came to nothing, and no others were
/// to be followed.
pub(crate) fn together(
    problem: &Problem,
    level: &Deviations,
    is_stated: bool,
    extent: Extent<'_>,
) -> Result<Option<Searched>, SpatialError> {
    let likely = problem.likely_errors()?;
    let mut searches = Searches::new(problem, &likely, level, is_stated)?;
    let beside = searches.beside(&likely)?;
    let is_in_doubt = searches.is_in_doubt;
    let alone = searches.lowest_first(starts(&searches.thin, level)?.all);
    let tries = (0..beside.len().max(alone.len())).map(|i| {
        let of = |way, starts: &[Start]| starts.get(i).map(|start| (way, start.clone()));
        [
            of(Way::Curved, &beside),
            of(Way::Straight, &alone),
            of(Way::Straight, &beside),
        ]
    });
    let mut tries = tries.map(|kinds| kinds.into_iter().flatten());
    let at_first = match extent {
        Extent::Likely => LIKELY,
        Extent::First | Extent::Unless(_) => AT_FIRST,
    };
    let is_enough = match is_in_doubt {
        true => searches.compare(compared(&beside, &alone))?,
        false => {
            searches.follow(tries.by_ref().take(at_first).flatten())
                || !matches!(extent, Extent::First) && searches.by_all_numbers(&likely)?
        }
    };
    if !is_enough {
        let is_all = match extent {
            Extent::First => return Ok(None),
            Extent::Likely => false,
            Extent::Unless(elsewhere) => match elsewhere() {
                true => return Ok(None),
                false => true,
            },
        };
        // where the joint is wrong, the errors of the set-up need not be
        let again = match &searches.best {
            Some(best) if is_all => searches.beside(&searches.thin.errors(&best.unknowns))?,
            _ => Vec::new(),
        };
        let again = again.into_iter().take(AT_FIRST);
        if is_in_doubt {
            searches.compare(again.map(|start| (Way::Straight, start)).collect())?;
        } else if is_all {
            let both = |start: Start| [(Way::Straight, start.clone()), (Way::Curved, start)];
            let _ = searches.follow(again.flat_map(both))
                || searches.ends_within_noise()
                || searches.is_hopeless()
                || searches.follow(tries.flatten());
        }
    }
    searches.ended().map(Some)
}

/// Along curves on which the functions are nearly straight, or straight on: each finds what the other one misses.
#[derive(Clone, Copy)]
enum Way {
    Curved,
    Straight,
}

/// Squares, and the unknowns that they belong to.
type Start = (f64, Unknowns);

/// What came of the searches so far.
struct Searches<'p> {
    problem: &'p Problem,
    level: &'p Deviations,
    is_stated: bool,
    /// Whether the functions may have other joints as well.
    is_in_doubt: bool,
    /// The lines of the searches, to be followed straight on …
    thin: Problem,
    /// … and along curves.
    curved: Problem,
    /// Those of the estimate.
    lines: Problem,
    /// The structures' own stiffnesses.
    balance: Vec<f64>,
    best: Option<Fit>,
    /// At the lines of the estimate, what noise of a stated level explains at those of the searches.
    checked: Vec<Fit>,
    /// Squares at the lines of the searches of those among these that are compared.
    compared: Vec<f64>,
    tried: usize,
    agreeing: usize,
    /// How many are done, for who waits.
    step: Step,
}

impl<'p> Searches<'p> {
    fn new(
        problem: &'p Problem,
        likely: &[Vec<f64>; 2],
        level: &'p Deviations,
        is_stated: bool,
    ) -> Result<Self, SpatialError> {
        let balance = problem.thinned(LINES_MAX).with_errors(likely)?.balance()?;
        let thin = Problem {
            balance: None,
            ..problem.thinned(LINES)
        };
        Ok(Self {
            problem,
            level,
            is_stated,
            is_in_doubt: problem.has_few_functions(),
            curved: Problem {
                balance: Some(balance.clone()),
                ..thin.clone()
            },
            thin,
            lines: problem.thinned(LINES_MAX),
            balance,
            best: None,
            checked: Vec::new(),
            compared: Vec::new(),
            tried: 0,
            agreeing: 0,
            step: step("searches", Pieces::Unknown),
        })
    }

    /// Starts beside these errors of the set-up, of more lines than the searches have.
    fn beside(&self, errors: &[Vec<f64>; 2]) -> Result<Vec<Start>, SpatialError> {
        let known = self.problem.thinned(LINES_MAX).with_errors(errors)?;
        let joints = starts(&known, self.level)?.all;
        Ok(self.lowest_first(joints.map(|joint| joint.beside(errors))))
    }

    fn lowest_first(&self, starts: impl Iterator<Item = Unknowns>) -> Vec<Start> {
        let known =
            starts.filter_map(|start| Some((cost(&self.thin, &start, self.level).ok()?, start)));
        let mut sorted: Vec<Start> = known.collect();
        sorted.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        sorted
    }

    /// Follows one after the other until there is no need of more; says whether that is so.
    fn follow(&mut self, tries: impl Iterator<Item = (Way, Start)>) -> bool {
        for (way, (residual, start)) in tries {
            self.tried += 1;
            let fit = self.let_down(way, residual, start);
            self.step.done();
            let Some(fit) = fit else {
                continue;
            };
            let lowest = self.came_to(&fit);
            // noise explains other minima as well at a few lines
            let is_explained = self.is_stated && self.explains(&fit);
            if let Some(at_more) = is_explained.then(|| self.at_more(&fit).ok()).flatten() {
                self.checked.push(at_more);
                if self.is_explained_at_more(CLEARLY) || self.agreeing() > 1 {
                    self.best = Some(fit);
                    return true;
                }
                if self.checked.len() == MOST_CHECKED {
                    return true;
                }
            }
            if fit.cost < lowest {
                self.best = Some(fit);
            }
            if !self.checked.is_empty() {
                continue;
            }
            // two that are far above the noise agree on where a search gets stuck
            let is_low = |best: &Fit| !self.is_stated || !lags(&self.thin, best.cost);
            let is_enough = |best: &Fit| self.explains(best) || self.agree(best) && is_low(best);
            if self.best.as_ref().is_some_and(is_enough) {
                return true;
            }
        }
        false
    }

    /// The same at the lines of the estimate. Where a motion of the joint gets lost there, errors of the set-up may be right all the
    /// same: searches begin beside them.
    fn at_more(&self, fit: &Fit) -> Result<Fit, SpatialError> {
        let own = Fit::of(&self.lines, fit.unknowns.clone(), self.level, Effort::Full)?;
        if !self.is_rigid(&own) {
            return Ok(own);
        }
        let beside = self.beside(&self.lines.errors(&own.unknowns))?;
        let others = beside.into_iter().take(BESIDE_LOST);
        let others = others.map(|(_, start)| Fit::of(&self.lines, start, self.level, Effort::Full));
        let found = others.flatten().filter(|fit| !self.is_rigid(fit));
        let lowest = found.min_by(|one, other| one.cost.total_cmp(&other.cost));
        Ok(lowest.filter(|fit| fit.cost < own.cost).unwrap_or(own))
    }

    fn let_down(&self, way: Way, residual: f64, start: Unknowns) -> Option<Fit> {
        let problem = match way {
            Way::Curved => &self.curved,
            Way::Straight => &self.thin,
        };
        let_down(problem, start, residual, self.level).ok()
    }

    /// How low the searches came before this one.
    fn came_to(&mut self, fit: &Fit) -> f64 {
        let lowest = self.best.as_ref().map_or(f64::INFINITY, |best| best.cost);
        self.agreeing = agreeing_with(self.agreeing, lowest, fit.cost);
        lowest
    }

    /// Whether noise and budget explain what is left, and no motion of the joint got lost on the way.
    fn explains(&self, fit: &Fit) -> bool {
        fit.cost < NOTHING * self.thin.numbers() as f64
            || self.is_within_noise(fit) && !self.is_rigid(fit)
    }

    /// Whether two searches came to it, and neither has lost a motion of the joint.
    fn agree(&self, fit: &Fit) -> bool {
        self.agreeing > 1 && !(self.is_stated && self.is_rigid(fit))
    }

    fn is_rigid(&self, fit: &Fit) -> bool {
        is_rigid(&self.thin, &self.balance, &fit.unknowns)
    }

    fn is_within_noise(&self, fit: &Fit) -> bool {
        let errors = squares_of_errors(&self.thin, &fit.unknowns);
        self.is_stated
            && fit.cost < EXPLAINED * self.thin.numbers() as f64
            && errors < EXPECTED * self.problem.error_count() as f64
    }

    /// Whether noise explains the lowest one, though a motion of the joint be rigid: that may be all that the functions say.
    fn ends_within_noise(&self) -> bool {
        let best = self.best.as_ref();
        best.is_some_and(|best| self.is_within_noise(best))
    }

    /// Whether all searches so far are so far above the noise that the set-up is another one than the study says.
    fn is_hopeless(&self) -> bool {
        let [stated, taken] = HOPELESS;
        let most = if self.is_stated { stated } else { taken };
        let best = self.best.as_ref();
        best.is_some_and(|best| best.cost > most * self.thin.numbers() as f64)
    }

    /// Whether noise explains the lowest of them at the lines of the estimate, too, with so many deviations of χ².
    fn is_explained_at_more(&self, deviations: f64) -> bool {
        self.lowest_checked().is_some_and(|fit| {
            fit.cost < by_chance(self.lines.numbers(), deviations) && !self.is_rigid(fit)
        })
    }

    fn lowest_checked(&self) -> Option<&Fit> {
        let all = self.checked.iter();
        all.min_by(|one, other| one.cost.total_cmp(&other.cost))
    }

    /// Searches that came to the lowest minimum.
    fn agreeing(&self) -> usize {
        match self.lowest_checked() {
            Some(lowest) if !self.is_in_doubt => {
                let costs = self.checked.iter().map(|fit| fit.cost);
                let agree =
                    costs.filter(|cost| *cost <= lowest.cost * (1.0 + AS_LOW_BESIDE_ERRORS));
                agree.count()
            }
            _ => self.agreeing,
        }
    }

    fn is_confirmed(&self) -> bool {
        match self.lowest_checked() {
            // several searches agree on wrong ones, too
            Some(lowest) if self.is_in_doubt && self.is_stated => {
                self.is_left_by(lowest, BY_CHANCE) || self.is_the_only_one()
            }
            Some(_) if self.is_in_doubt => self.is_clear() || self.agreeing > 1,
            Some(_) => self.is_explained_at_more(BY_CHANCE) || self.agreeing() > 1,
            None => {
                let best = self.best.as_ref();
                best.is_some_and(|best| self.agree(best) || self.explains(best))
            }
        }
    }

    /// The lowest of the searches.
    fn ended(mut self) -> Result<Searched, SpatialError> {
        let rivals = self.rivals()?;
        let starts = [self.tried, self.agreeing()];
        // a minimum that nothing confirms may be another one
        let is_confirmed = self.is_confirmed();
        let (found, is_beyond_noise) = match self.lowest_checked() {
            Some(lowest) => (lowest.clone(), false),
            None => {
                let best = self.best.take().ok_or(SpatialError::NoStart)?;
                let lags = lags(&self.thin, best.cost);
                (best, lags)
            }
        };
        let is_at_end = !self.is_in_doubt && !self.checked.is_empty();
        let mut fit = match is_at_end {
            true => found,
            false => {
                // what nothing explains has no bottom that is worth the way there
                let effort = match is_beyond_noise && !is_confirmed {
                    true => Effort::Coarse,
                    false => Effort::Full,
                };
                Fit::of(&self.lines, found.unknowns, self.level, effort)?
            }
        };
        // more lines may lead where a motion gets lost
        let is_lost = (is_at_end || self.is_stated) && self.is_rigid(&fit);
        fit.has_converged &= is_confirmed && !is_lost;
        Ok(Searched {
            fit,
            starts,
            rivals,
        })
    }
}

/// Whether squares are many more than noise leaves.
fn lags(problem: &Problem, cost: f64) -> bool {
    cost > LAGGING * problem.numbers() as f64
}

/// Whether a joint is as good as rigid in a motion, beside the structures' own stiffnesses, or beyond that: the functions are smooth
/// in 1/k, and past zero k is negative.
fn is_rigid(problem: &Problem, balance: &[f64], unknowns: &Unknowns) -> bool {
    let values = unknowns.0.as_slice();
    (problem.links.sought_matrices(values)).is_ok_and(|[stiffness, _]| {
        let own = stiffness.diagonal();
        let mut pairs = own.iter().zip(balance);
        pairs.any(|(own, balance)| own.abs() > RIGID * balance || *own < -NEGATIVE * balance)
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix6;

    use super::*;
    use crate::samples::problem;

    #[test]
    fn a_motion_is_lost_where_it_is_rigid_or_beyond() {
        let problem = problem();
        let balance = [2e7; 6];
        let with = |part: f64| {
            let mut stiffness = Matrix6::identity() * 2e7;
            stiffness[(2, 2)] = part * 2e7;
            let joints = problem.links.nearest(&[[stiffness, stiffness * 1e-5]]);
            is_rigid(&problem, &balance, &Unknowns(joints.unwrap()))
        };
        assert!([1e5, -1e5, -0.2].into_iter().all(with));
        assert!(![1e3, 1e-3, 0.0, -0.05].into_iter().any(with));
    }
}
