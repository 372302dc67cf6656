//! Searches beside noise of the substructures where the functions do not reach all motions of the joint.
//!
//! They may have other joints as well then, of which noise explains some nearly as well as the joint itself: that it clearly explains
//! the first one says nothing of the others. So all of the first starts are followed, and what they came to is compared at the same
//! lines.

use bolted_joint_wanted::{Pieces, Step, step};

use super::Beside;
use super::search::{EXPLAINED, Given, estimated, let_down};
use crate::error::SpatialError;
use crate::fit::{Effort, Fit, Squares};
use crate::parallel::over_each;
use crate::problem::Unknowns;
use crate::rivals::{DECISIVE, as_good, is_elsewhere, rivals};
use crate::search::{BY_CHANCE, CLEARLY, Searched};
use crate::valley;

/// Starts that are followed, and of how many most may agree on what noise does not explain.
const COMPARED: usize = 6;
const ENOUGH: usize = 4;

/// Squares, and the unknowns that they belong to.
pub(super) type Start = (f64, Unknowns);

/// What the searches came to so far.
pub(super) struct Comparison<'p> {
    given: Given<'p>,
    /// The squares of a few lines.
    few: Beside<'p>,
    /// What the searches ended in there.
    ended: Vec<Fit>,
    tried: usize,
    /// How many are done, for who waits.
    step: Step,
}

/// The lowest at the lines of the estimate.
pub(super) struct AtMore {
    lowest: Fit,
    /// Whether noise explains it, of the assembly by itself, too.
    pub(super) is_explained: bool,
    /// How many searches there were, and how many came to it: one to what is beside that of the others.
    starts: [usize; 2],
    /// Others that noise explains as well.
    rivals: usize,
}

impl<'p> Comparison<'p> {
    pub(super) fn new(given: Given<'p>, few: Beside<'p>) -> Self {
        Self {
            given,
            few,
            ended: Vec::new(),
            tried: 0,
            step: step("searches", Pieces::Unknown),
        }
    }

    /// Follows the first of these.
    pub(super) fn follow(&mut self, starts: impl Iterator<Item = Start>) {
        let starts: Vec<Start> = starts.take(COMPARED).collect();
        self.tried += starts.len();
        let ended = over_each(&starts, |(residual, start)| {
            let fit = let_down(&mut self.few.clone(), start.clone(), *residual);
            self.step.done();
            fit
        });
        self.ended.extend(ended.into_iter().flatten());
        (self.ended).sort_by(|one, other| one.cost.total_cmp(&other.cost));
    }

    /// Takes what low frequencies lead to, too.
    pub(super) fn take_of_low(&mut self) {
        for unknowns in self.given.of_low() {
            let mut few = self.few.clone();
            self.ended.extend(Fit::by(&mut few, unknowns, Effort::Full));
        }
        (self.ended).sort_by(|one, other| one.cost.total_cmp(&other.cost));
    }

    /// Those that are not far above the lowest, none of them twice.
    fn candidates(&self) -> Vec<&Fit> {
        let Some(lowest) = self.ended.first() else {
            return Vec::new();
        };
        let most = as_good(lowest.cost, self.few.numbers() as f64);
        let mut candidates: Vec<&Fit> = Vec::new();
        for fit in self.ended.iter().filter(|fit| fit.cost <= most) {
            let is_same = |other: &&Fit| !is_elsewhere(self.given.problem, fit, other);
            if !candidates.iter().any(is_same) {
                candidates.push(fit);
            }
        }
        candidates
    }

    /// What these leave at the lines of the estimate, the lowest first.
    pub(super) fn at_more(&self) -> Result<AtMore, SpatialError> {
        let &Given {
            problem,
            level,
            noise,
        } = &self.given;
        let candidates = self.candidates();
        // at the lines of the lowest one that has some
        let mut lines = candidates.iter().filter_map(|fit| {
            let own = estimated(problem, level, noise, &fit.unknowns).ok()?;
            Some((own, &fit.unknowns))
        });
        let (lines, at) = lines.next().ok_or(SpatialError::NoStart)?;
        let squares = Beside::of(&lines, level, noise, at)?;
        let checked = over_each(&candidates, |&from| {
            let mut own = squares.clone();
            let fit = Fit::by(&mut own, from.unknowns.clone(), Effort::Near);
            fit.ok().map(|fit| (from.clone(), fit))
        });
        let (from, mut checked): (Vec<Fit>, Vec<Fit>) = checked.into_iter().flatten().unzip();
        let of_searches = lowest(&checked).ok_or(SpatialError::NoStart)?;
        let information = |at: &Unknowns| Ok(squares.clone().normal(at)?.information);
        let beside = valley::beside(&checked[of_searches], information, |start| {
            Fit::by(&mut squares.clone(), start.clone(), Effort::Near)
        })?;
        checked.extend(beside);
        let place = lowest(&checked).unwrap_or(of_searches);
        let lowest = &checked[place];
        let left = squares.left_in_assembly(&lowest.unknowns, lowest.cost)?;
        let free = lines.free_numbers() as f64;
        // χ² of ν numbers is ν ± √(2 ν)
        let beyond = (left - 1.0) / (2.0 / free).sqrt();
        let is_explained = lowest.cost < EXPLAINED * squares.numbers() as f64;
        let above = match is_explained && beyond < CLEARLY {
            true => DECISIVE,
            false => as_good(left.max(1.0) * free, free) - left.max(1.0) * free,
        };
        // one that creeps may be on its way to the lowest
        let ended = checked.iter().enumerate();
        let ended = ended.filter(|(n, fit)| *n == place || fit.has_converged);
        let ended: Vec<Fit> = ended.map(|(_, fit)| fit.clone()).collect();
        let rivals = rivals(&lines, &ended, lowest.cost + above, |best| {
            information(&best.unknowns)
        })?;
        let starts = match from.get(place) {
            Some(from) => {
                let all = self.ended.iter();
                let agree = all.filter(|fit| !is_elsewhere(problem, fit, from));
                [self.tried, agree.count()]
            }
            None => [self.tried + 1, 1],
        };
        Ok(AtMore {
            starts,
            lowest: lowest.clone(),
            is_explained: is_explained && beyond < BY_CHANCE,
            rivals,
        })
    }

    /// The lowest, of which nothing is known where it fits no lines of the estimate.
    pub(super) fn ended(mut self, at_more: Option<AtMore>) -> Result<Searched, SpatialError> {
        let Some(own) = at_more else {
            self.ended.truncate(1);
            let fit = self.ended.pop().ok_or(SpatialError::NoStart)?;
            return Ok(Searched {
                fit: Fit {
                    has_converged: false,
                    ..fit
                },
                starts: [self.tried, 1],
                rivals: 0,
            });
        };
        let [tried, agreeing] = own.starts;
        let do_agree = tried >= ENOUGH && 2 * agreeing > tried;
        Ok(Searched {
            fit: Fit {
                has_converged: own.is_explained || own.lowest.has_converged && do_agree,
                ..own.lowest
            },
            starts: own.starts,
            rivals: own.rivals,
        })
    }
}

fn lowest(fits: &[Fit]) -> Option<usize> {
    (0..fits.len()).min_by(|&one, &other| fits[one].cost.total_cmp(&fits[other].cost))
}
