//! The joint together with the errors of the set-up.
//!
//! Beside noise of a thousandth, sensors a millimetre off leave residuals of a half, and the search for both goes astray. So
//! the noise is taken as large as the residuals at first, and let down as they shrink: the errors that matter most come first, and
//! each step begins near its end. Starts are those beside the errors that each structure tells by itself, and those without
//! errors: where one kind leads astray, the other one often does not.
//!
//! Where the functions do not reach all motions of the joint, they may have other joints as well, and several searches agree on the
//! wrong one. Only χ² tells them apart then, so that all of the first starts are followed unless noise clearly explains one.

use crate::error::SpatialError;
use crate::fit::{Effort, Fit};
use crate::normal::{Deviations, Normal, cost, squares_of_errors};
use crate::parallel::over_each;
use crate::problem::{Problem, Unknowns};
use crate::rivals::{as_good, rivals};
use crate::search::{
    AS_LOW_BESIDE_ERRORS, BY_CHANCE, CLEARLY, Extent, NOTHING, Searched, agreeing_with,
};
use crate::starts::{Starts, starts};

/// Lines of the search from several starts: thousands of numbers, for hundreds of unknowns.
const LINES: usize = 12;

/// Lines at which a search ends. The estimate goes on from there at more.
pub(crate) const LINES_MAX: usize = 60;

/// Noise of a step, in parts of the residuals of the step before.
const LET_DOWN: f64 = 0.3;

/// Residuals of a step that hardly shrinks them, in parts of those before, and such steps one after the other that are enough.
const STALLED: f64 = 0.8;
const PATIENCE: usize = 2;

/// Squares over numbers that do not follow it, and those that noise and the budget explain.
const LAGGING: f64 = 3.0;
const EXPLAINED: f64 = 1.05;

/// Likewise of a set-up that no joint goes with, with noise as it is stated and as it is taken to be where it is not.
const HOPELESS: [f64; 2] = [30.0, 1000.0];

/// Likewise of the errors of the set-up.
const EXPECTED: f64 = 1.3;

/// Stiffness in parts of the structures' own from which on a joint is as good as rigid: a search may have lost it there.
const RIGID: f64 = 1e4;

/// Starts of each kind that are followed before those beside the errors of the lowest search; and where something else is known to
/// be wrong.
const AT_FIRST: usize = 4;
const LIKELY: usize = 2;

/// Likewise of those that are compared, where the functions may have other joints: beside errors of the set-up, and alone.
const COMPARED: [usize; 2] = [5, 2];

/// How far χ² of other joints is above that of one that noise clearly explains where they are out of the question: five deviations.
const DECISIVE: f64 = 25.0;

/// Minima that noise explains at the lines of the search and not at those of the estimate, after which no other is looked for.
const MOST_CHECKED: usize = 6;

/// The joint and the errors of the set-up, at [`LINES_MAX`] lines; how many searches there were, and how many came to the same
/// minimum. None follows one that noise explains at all these lines, where its level is stated, one that leaves nothing, or two that
/// agree: on what noise explains at the lines of the searches, or is not far above it. Where there may be other joints, none of the
/// first ones is left out but after one that noise clearly explains. `None` where the likely starts alone were to be followed, and came
/// to nothing.
pub(crate) fn together(
    problem: &Problem,
    level: &Deviations,
    is_stated: bool,
    extent: Extent,
) -> Result<Option<Searched>, SpatialError> {
    let likely = problem.likely_errors()?;
    let mut searches = Searches::new(problem, &likely, level, is_stated)?;
    let (beside, is_in_doubt) = searches.beside(&likely)?;
    searches.is_in_doubt = is_in_doubt;
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
        Extent::First | Extent::All => AT_FIRST,
    };
    let is_enough = match is_in_doubt {
        true => searches.compare(compared(&beside, &alone)),
        false => searches.follow(tries.by_ref().take(at_first).flatten()),
    };
    if !is_enough {
        if extent == Extent::First {
            return Ok(None);
        }
        let is_all = extent == Extent::All;
        // where the joint is wrong, the errors of the set-up need not be
        let again = match &searches.best {
            Some(best) if is_all => searches.beside(&searches.thin.errors(&best.unknowns))?.0,
            _ => Vec::new(),
        };
        let again = again.into_iter().take(AT_FIRST);
        let mut again =
            again.flat_map(|start| [(Way::Straight, start.clone()), (Way::Curved, start)]);
        let _ = !is_all
            || match is_in_doubt {
                true => searches.compare(again.step_by(2).collect()),
                false => searches.follow(again.by_ref()),
            }
            || is_in_doubt
            || searches.ends_within_noise()
            || searches.is_hopeless()
            || searches.follow(tries.flatten());
    }
    searches.ended().map(Some)
}

/// What is compared where the functions may have other joints: from each start in one way.
fn compared(beside: &[Start], alone: &[Start]) -> Vec<(Way, Start)> {
    let ways = [Way::Curved, Way::Straight].into_iter().cycle();
    let beside = ways.zip(beside.iter().cloned()).take(COMPARED[0]);
    let alone = alone.iter().cloned().map(|start| (Way::Straight, start));
    beside.chain(alone.take(COMPARED[1])).collect()
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
            is_in_doubt: false,
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
        })
    }

    /// Starts beside these errors of the set-up, of more lines than the searches have; and whether they are in doubt.
    fn beside(&self, errors: &[Vec<f64>; 2]) -> Result<(Vec<Start>, bool), SpatialError> {
        let known = self.problem.thinned(LINES_MAX).with_errors(errors)?;
        let Starts { all, in_doubt } = starts(&known, self.level)?;
        let beside = self.lowest_first(all.map(|joint| joint.beside(errors)));
        Ok((beside, in_doubt > 0))
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
            let Some(fit) = self.let_down(way, residual, start) else {
                continue;
            };
            let lowest = self.came_to(&fit);
            // noise explains other minima as well at a few lines
            if self.is_stated && self.explains(&fit) {
                let start = fit.unknowns.clone();
                if let Ok(at_more) = Fit::of(&self.lines, start, self.level, Effort::Full) {
                    self.checked.push(at_more);
                    if self.is_checked() || self.agreeing() > 1 {
                        self.best = Some(fit);
                        return true;
                    }
                    if self.checked.len() == MOST_CHECKED {
                        return true;
                    }
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

    /// Follows all, unless noise clearly explains the first; says whether noise explains the lowest, or several agree where its level
    /// is not stated.
    fn compare(&mut self, tries: Vec<(Way, Start)>) -> bool {
        let (first, others) = tries.split_at(tries.len().min(1));
        for tries in [first, others] {
            let ended = over_each(tries, |(way, (residual, start))| {
                self.let_down(*way, *residual, start.clone())
            });
            self.tried += tries.len();
            let ended: Vec<Fit> = ended.into_iter().flatten().collect();
            for fit in &ended {
                if fit.cost < self.came_to(fit) {
                    self.best = Some(fit.clone());
                }
            }
            let others = self.others_among(&ended);
            let at_more = over_each(&others, |fit| {
                Fit::of(&self.lines, fit.unknowns.clone(), self.level, Effort::Near)
            });
            self.checked.extend(at_more.into_iter().flatten());
            if self.is_clear() {
                return true;
            }
        }
        self.is_confirmed()
    }

    /// Those that are not far above the lowest, and of which none came to where another one did.
    fn others_among<'f>(&mut self, ended: &'f [Fit]) -> Vec<&'f Fit> {
        let Some(lowest) = self.best.as_ref().map(|best| best.cost) else {
            return Vec::new();
        };
        let most = as_good(lowest, self.thin.numbers() as f64);
        let mut others = Vec::new();
        for fit in ended.iter().filter(|fit| fit.cost <= most) {
            if !self.compared.iter().any(|&cost| is_same(cost, fit.cost)) {
                self.compared.push(fit.cost);
                others.push(fit);
            }
        }
        others
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

    /// Whether noise explains the latest of them at the lines of the estimate, too.
    fn is_checked(&self) -> bool {
        let latest = self.checked.last();
        latest.is_some_and(|fit| {
            fit.cost < self.by_chance(self.lines.numbers(), BY_CHANCE) && !self.is_rigid(fit)
        })
    }

    /// Whether noise clearly explains the lowest of them, or nothing is left.
    fn is_clear(&self) -> bool {
        let leaves_nothing = |fit: &Fit| fit.cost < NOTHING * self.lines.numbers() as f64;
        self.lowest_checked().is_some_and(|fit| {
            leaves_nothing(fit) || self.is_stated && self.is_left_by(fit, CLEARLY)
        })
    }

    /// Whether chance explains what this one of them leaves, beside what its unknowns took.
    fn is_left_by(&self, fit: &Fit, deviations: f64) -> bool {
        let free = self.lines.numbers() - self.lines.joint_count();
        fit.cost < self.by_chance(free, deviations) && !self.is_rigid(fit)
    }

    fn by_chance(&self, numbers: usize, deviations: f64) -> f64 {
        // χ² of ν numbers is ν ± √(2 ν)
        numbers as f64 + deviations * (2.0 * numbers as f64).sqrt()
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
                self.is_left_by(lowest, BY_CHANCE)
            }
            Some(_) => self.is_checked() || self.agreeing() > 1,
            None => {
                let best = self.best.as_ref();
                best.is_some_and(|best| self.agree(best) || self.explains(best))
            }
        }
    }

    fn rivals(&self) -> Result<usize, SpatialError> {
        if !self.is_in_doubt {
            return Ok(0);
        }
        let lowest = self.lowest_checked().map_or(0.0, |fit| fit.cost);
        let most = match self.is_clear() && self.is_stated {
            true => lowest + DECISIVE,
            false => as_good(lowest, self.lines.numbers() as f64),
        };
        // one that creeps may be on its way to the lowest
        let ended = self.checked.iter().filter(|fit| fit.has_converged);
        let ended: Vec<Fit> = ended.cloned().collect();
        rivals(&self.lines, &ended, most, |best| {
            Ok(Normal::of(&self.lines, &best.unknowns, self.level)?.information)
        })
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

/// Whether two searches beside errors of the set-up came to the same minimum.
fn is_same(one: f64, other: f64) -> bool {
    (one - other).abs() <= AS_LOW_BESIDE_ERRORS * one.min(other)
}

/// Whether squares are many more than noise leaves.
fn lags(problem: &Problem, cost: f64) -> bool {
    cost > LAGGING * problem.numbers() as f64
}

/// From one start, whose squares are known.
fn let_down(
    problem: &Problem,
    start: Unknowns,
    residual: f64,
    level: &Deviations,
) -> Result<Fit, SpatialError> {
    let numbers = problem.numbers() as f64;
    let mut unknowns = start;
    let mut left = (residual / numbers).sqrt();
    let mut factor = left;
    let mut stalled = 0;
    while factor > 1.0 {
        let own: Deviations = level.iter().map(|level| factor * level).collect();
        let fit = Fit::of(problem, unknowns, &own, Effort::Coarse)?;
        unknowns = fit.unknowns;
        let now = factor * (fit.cost / numbers).sqrt();
        stalled = if now > STALLED * left { stalled + 1 } else { 0 };
        if stalled >= PATIENCE {
            return Ok(Fit {
                cost: cost(problem, &unknowns, level)?,
                unknowns,
                has_converged: false,
            });
        }
        left = now;
        factor = LET_DOWN * left;
    }
    Fit::of(problem, unknowns, level, Effort::Near)
}

/// Whether a joint is as good as rigid in a motion, beside the structures' own stiffnesses.
fn is_rigid(problem: &Problem, balance: &[f64], unknowns: &Unknowns) -> bool {
    let values = unknowns.0.as_slice();
    (problem.links.sought_matrices(values)).is_ok_and(|[stiffness, _]| {
        let own = stiffness.diagonal();
        let mut pairs = own.iter().zip(balance);
        pairs.any(|(own, balance)| own.abs() > RIGID * balance)
    })
}
