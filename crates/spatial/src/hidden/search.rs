//! The joint, and the errors of the set-up where there are any, beside noise of the substructures: from several starts at a few
//! lines, then at more.

use super::Beside;
use super::held::AtMore;
use crate::error::SpatialError;
use crate::fit::{Effort, Fit};
use crate::normal::{Deviations, squares_of_errors};
use crate::problem::{Problem, Unknowns};
use crate::search::{BY_CHANCE, Extent, SEARCHED, Searched, agreeing_with, by_chance};
use crate::starts::starts;
use crate::together::LINES_MAX;

/// Lines that are looked at for each one of the estimate.
const LOOKED_AT: usize = 10;

/// Lines of the search from several starts.
const LINES: usize = 12;

/// Noise of a step, in parts of that of the step before, at most; and steps after which squares that do not follow it will not.
const LET_DOWN: f64 = 0.3;
const PATIENCE: usize = 6;
const LAGGING: f64 = 3.0;

/// Squares over numbers that noise explains, and those of the errors of the set-up that the budget does.
pub(super) const EXPLAINED: f64 = 1.2;
const EXPECTED: f64 = 1.5;

/// Starts that are followed before low frequencies are asked, and there.
const AT_FIRST: usize = 2;

/// Likewise where the functions may have other joints, unless noise clearly explains one; and of how many most may agree there.
const COMPARED: usize = 6;
const ENOUGH: usize = 4;

/// Lines of low frequencies, one of so many; and the least of them.
const LOW: [usize; 2] = [8, 4];
const LOW_MIN: usize = LINES;

/// The lowest of the searches at a few lines, how many starts were tried and how many came as low. None is tried after one that
/// noise and budget explain as chance has it, or after two that agree on what is not far above. Where the functions may have other
/// joints, that two agree says little: what is left has to be what noise leaves of the assembly by itself.
///
/// A soft joint is seen at low frequencies alone: above, what all lines say of it is the noise of the substructures. So where the
/// first searches come to nothing, low frequencies are searched by themselves, and all from where these lead. `None` where the likely
/// starts came to nothing, and no others were to be followed.
pub(crate) fn searched_beside(
    problem: &Problem,
    level: &Deviations,
    noise: [f64; 2],
    extent: Extent<'_>,
) -> Result<Option<Searched>, SpatialError> {
    let given = Given {
        problem,
        level,
        noise,
    };
    let begun = given.starts()?;
    let is_in_doubt = problem.has_few_functions();
    let first = begun.first().ok_or(SpatialError::NoStart)?;
    let few = given.few(first)?;
    let squares = Beside::of(&few, level, noise, first)?;
    let mut searches = Searches::new(given, squares);
    let mut starts = searches.lowest_first(begun).into_iter();
    let at_first = if is_in_doubt { COMPARED } else { AT_FIRST };
    if !searches.follow(starts.by_ref().take(at_first)) && searches.held.is_none() {
        let low = given.low();
        let mut of_low = low.iter().filter_map(|problem| {
            let own = Given { problem, ..given };
            own.held().ok().flatten()
        });
        if !of_low.any(|found| searches.holds(found)) {
            match extent {
                Extent::First => return Ok(None),
                Extent::Likely => {}
                Extent::Unless(elsewhere) => match elsewhere() {
                    true => return Ok(None),
                    false => {
                        searches.follow(starts);
                    }
                },
            }
        }
    }
    searches.ended().map(Some)
}

/// What is searched.
#[derive(Clone, Copy)]
pub(super) struct Given<'p> {
    pub(super) problem: &'p Problem,
    pub(super) level: &'p Deviations,
    pub(super) noise: [f64; 2],
}

impl<'p> Given<'p> {
    fn starts(&self) -> Result<Vec<Unknowns>, SpatialError> {
        let likely = self.problem.likely_errors()?;
        let known = self.problem.thinned(SEARCHED);
        let known = known.with_errors(&likely)?.smoothed()?;
        let joints = starts(&known, self.level)?.all;
        Ok(joints.map(|joint| joint.beside(&likely)).collect())
    }

    /// The lines at which noise moves least, as far as the joint is known.
    fn few(&self, first: &Unknowns) -> Result<Problem, SpatialError> {
        let some = self.problem.thinned(10 * LINES);
        let steady = Beside::of(&some, self.level, self.noise, first)?.steadiest(first)?;
        Ok(Problem {
            balance: Some(self.problem.thinned(LINES_MAX).balance()?),
            ..some.with_lines(&steady).thinned(LINES)
        })
    }

    /// Low frequencies by themselves, the lowest first.
    fn low(&self) -> Vec<Problem> {
        let lines = self.problem.frequency_hz.len();
        let mut counts = LOW.map(|part| (lines / part).max(LOW_MIN)).to_vec();
        counts.dedup();
        let counts = counts.into_iter().filter(|&count| 2 * count <= lines);
        let of = |count: usize| self.problem.with_lines(&(0..count).collect::<Vec<_>>());
        counts.map(of).collect()
    }

    /// What noise explains at these lines, if likely starts lead there.
    fn held(&self) -> Result<Option<Unknowns>, SpatialError> {
        let begun = self.starts()?;
        let first = begun.first().ok_or(SpatialError::NoStart)?;
        let few = self.few(first)?;
        let squares = Beside::of(&few, self.level, self.noise, first)?;
        let mut searches = Searches::new(*self, squares);
        let starts = searches.lowest_first(begun).into_iter();
        searches.follow(starts.take(AT_FIRST));
        Ok(searches.held.map(|held| held.unknowns))
    }
}

/// What came of the searches so far.
struct Searches<'p> {
    given: Given<'p>,
    squares: Beside<'p>,
    /// Whether the functions may have other joints as well.
    is_in_doubt: bool,
    best: Option<Fit>,
    /// What noise explains at the lines of the estimate.
    held: Option<AtMore>,
    /// Whether noise does not explain there what the lowest leaves.
    is_refuted: bool,
    tried: usize,
    agreeing: usize,
}

impl<'p> Searches<'p> {
    fn new(given: Given<'p>, squares: Beside<'p>) -> Self {
        Self {
            given,
            squares,
            is_in_doubt: given.problem.has_few_functions(),
            best: None,
            held: None,
            is_refuted: false,
            tried: 0,
            agreeing: 0,
        }
    }

    fn lowest_first(&self, begun: Vec<Unknowns>) -> Vec<(f64, Unknowns)> {
        let mut starts: Vec<(f64, Unknowns)> = (begun.into_iter())
            .filter_map(|start| Some((self.squares.cost_as_measured(&start).ok()?, start)))
            .collect();
        starts.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        starts
    }

    /// Follows one after the other until there is no need of more; says whether that is so.
    fn follow(&mut self, starts: impl Iterator<Item = (f64, Unknowns)>) -> bool {
        let by_chance = by_chance(self.squares.numbers(), BY_CHANCE);
        for (residual, start) in starts {
            self.tried += 1;
            let Ok(fit) = let_down(&mut self.squares, start, residual) else {
                continue;
            };
            let lowest = self.best.as_ref().map_or(f64::INFINITY, |best| best.cost);
            self.agreeing = agreeing_with(self.agreeing, lowest, fit.cost);
            let own = self.is_in_doubt.then(|| fit.clone());
            if fit.cost < lowest {
                self.best = Some(fit);
                self.is_refuted = false;
            }
            let is_enough =
                |best: &&Fit| self.explains(best) && (best.cost < by_chance || self.agreeing > 1);
            // the lowest of a few lines need not be that of more
            let enough = own.as_ref().or(self.best.as_ref()).filter(is_enough);
            let enough = enough.map(|best| best.unknowns.clone());
            if let Some(unknowns) = enough {
                if self.holds(unknowns) {
                    return true;
                }
                self.is_refuted = true;
            }
        }
        false
    }

    /// Whether noise clearly explains what these leave at the lines of the estimate, too. The search is at its end there.
    fn holds(&mut self, unknowns: Unknowns) -> bool {
        let Ok(own) = AtMore::of(&self.given, unknowns, self.is_in_doubt) else {
            return false;
        };
        let is_clear = own.is_clear;
        let is_lower = self.held.as_ref().is_none_or(|held| own.left < held.left);
        if own.is_explained && is_lower {
            self.held = Some(own);
        }
        is_clear
    }

    /// Whether noise and budget explain what is left, or nearly so.
    fn explains(&self, fit: &Fit) -> bool {
        let errors = self.given.problem.error_count() as f64;
        fit.cost < EXPLAINED * self.squares.numbers() as f64
            && squares_of_errors(self.given.problem, &fit.unknowns) <= EXPECTED * errors
    }

    fn ended(mut self) -> Result<Searched, SpatialError> {
        let mut best = self.best.take().ok_or(SpatialError::NoStart)?;
        match self.held.take() {
            Some(held) => {
                best.unknowns = held.unknowns;
                best.has_converged = true;
            }
            None => {
                let is_known = self.explains(&best) && !self.is_refuted;
                let are_enough = !self.is_in_doubt || self.tried >= ENOUGH;
                let do_agree = are_enough && 2 * self.agreeing > self.tried;
                best.has_converged &= is_known || do_agree;
            }
        }
        Ok(Searched {
            fit: best,
            starts: [self.tried, self.agreeing],
            rivals: 0,
        })
    }
}

/// The lines of the estimate, near these unknowns: some at which noise of the substructures moves little, and explains what is left.
pub(crate) fn estimated(
    problem: &Problem,
    level: &Deviations,
    noise: [f64; 2],
    unknowns: &Unknowns,
) -> Result<Problem, SpatialError> {
    let some = problem.thinned(LOOKED_AT * LINES_MAX);
    let kept = Beside::of(&some, level, noise, unknowns)?.kept(unknowns)?;
    let lines = some.with_lines(&kept).thinned(LINES_MAX);
    let explained = Beside::of(&lines, level, noise, unknowns)?.explained(unknowns)?;
    Ok(Problem {
        balance: Some(problem.thinned(LINES_MAX).balance()?),
        ..lines.with_lines(&explained)
    })
}

/// From one start, whose squares are known: with noise as large as they are at first, which is let down to what it is.
fn let_down(squares: &mut Beside<'_>, start: Unknowns, residual: f64) -> Result<Fit, SpatialError> {
    let numbers = squares.numbers() as f64;
    squares.begin();
    let mut unknowns = start;
    let mut factor = (residual / numbers).sqrt();
    for step in 1.. {
        if factor <= 1.0 {
            break;
        }
        squares.raise(factor);
        let fit = Fit::by(squares, unknowns, Effort::Coarse)?;
        unknowns = fit.unknowns;
        if step >= PATIENCE && fit.cost > LAGGING * numbers {
            squares.raise(1.0);
            return Ok(Fit {
                cost: fit.cost * factor.powi(2),
                unknowns,
                has_converged: false,
            });
        }
        factor *= (fit.cost / numbers).sqrt().min(LET_DOWN);
    }
    squares.raise(1.0);
    Fit::by(squares, unknowns, Effort::Full)
}
