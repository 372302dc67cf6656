//! The joint, and the errors of the set-up where there are any, beside noise of the substructures: from several starts at a few
//! lines, then at more.

use bolted_joint_wanted::{Pieces, Step, step};

use super::Beside;
use super::compare::{Comparison, Start};
use crate::error::SpatialError;
use crate::fit::{Effort, Fit};
use crate::normal::{Deviations, squares_of_errors};
use crate::part_noise::PartNoise;
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

/// Lines of low frequencies, one of so many; and the least of them.
const LOW: [usize; 2] = [8, 4];
const LOW_MIN: usize = LINES;

/// The lowest of the searches at a few lines, how many starts were tried and how many came as low. None is tried after one that
/// noise and budget explain as chance has it, or after two that agree on what is not far above. Where the functions may have other
/// joints, several are compared.
///
/// A soft joint is seen at low frequencies alone: above, what all lines say of it is the noise of the substructures. So where the
/// first searches come to nothing, low frequencies are searched by themselves, and all from where these lead. `None` where the likely
/// starts came to nothing, and no others were to be followed.
pub(crate) fn searched_beside(
    problem: &Problem,
    level: &Deviations,
    noise: &[PartNoise; 2],
    extent: Extent<'_>,
) -> Result<Option<Searched>, SpatialError> {
    let given = Given {
        problem,
        level,
        noise,
    };
    let begun = given.starts()?;
    let first = begun.first().ok_or(SpatialError::NoStart)?;
    let few = given.few(first)?;
    let squares = Beside::of(&few, level, noise, first)?;
    let mut starts = lowest_first(&squares, begun).into_iter();
    if problem.has_few_functions() {
        return compared(Comparison::new(given, squares), starts, extent);
    }
    let mut searches = Searches::new(given, squares);
    if !searches.follow(starts.by_ref().take(AT_FIRST))
        && !given.of_low().any(|found| searches.holds(found))
    {
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
    searches.ended().map(Some)
}

/// Likewise of several that are compared.
fn compared(
    mut searches: Comparison<'_>,
    mut starts: impl Iterator<Item = Start>,
    extent: Extent<'_>,
) -> Result<Option<Searched>, SpatialError> {
    searches.follow(&mut starts);
    let mut at_more = searches.at_more();
    if !at_more.as_ref().is_ok_and(|own| own.is_explained) {
        searches.take_of_low();
        at_more = searches.at_more();
    }
    if !at_more.as_ref().is_ok_and(|own| own.is_explained) {
        match extent {
            Extent::First => return Ok(None),
            Extent::Likely => {}
            Extent::Unless(elsewhere) => {
                if elsewhere() {
                    return Ok(None);
                }
                searches.follow(&mut starts);
                at_more = searches.at_more();
            }
        }
    }
    searches.ended(at_more.ok()).map(Some)
}

/// What is searched.
#[derive(Clone, Copy)]
pub(super) struct Given<'p> {
    pub(super) problem: &'p Problem,
    pub(super) level: &'p Deviations,
    pub(super) noise: &'p [PartNoise; 2],
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

    /// What noise explains at low frequencies, if likely starts lead there.
    pub(super) fn of_low(self) -> impl Iterator<Item = Unknowns> {
        self.low().into_iter().filter_map(move |problem| {
            let own = Given {
                problem: &problem,
                ..self
            };
            own.likely().ok().flatten()
        })
    }

    /// What noise explains at these lines, if likely starts lead there.
    fn likely(&self) -> Result<Option<Unknowns>, SpatialError> {
        let begun = self.starts()?;
        let first = begun.first().ok_or(SpatialError::NoStart)?;
        let few = self.few(first)?;
        let squares = Beside::of(&few, self.level, self.noise, first)?;
        let starts = lowest_first(&squares, begun).into_iter();
        let mut searches = Searches::new(*self, squares);
        searches.follow(starts.take(AT_FIRST));
        Ok(searches.held)
    }
}

fn lowest_first(squares: &Beside<'_>, begun: Vec<Unknowns>) -> Vec<Start> {
    let known = begun.into_iter();
    let known = known.filter_map(|start| Some((squares.cost_as_measured(&start).ok()?, start)));
    let mut starts: Vec<Start> = known.collect();
    starts.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    starts
}

/// What came of the searches so far.
struct Searches<'p> {
    given: Given<'p>,
    squares: Beside<'p>,
    best: Option<Fit>,
    /// What noise explains at the lines of the estimate.
    held: Option<Unknowns>,
    /// Whether noise does not explain there what the lowest leaves.
    is_refuted: bool,
    tried: usize,
    agreeing: usize,
    /// How many are done, for who waits.
    step: Step,
}

impl<'p> Searches<'p> {
    fn new(given: Given<'p>, squares: Beside<'p>) -> Self {
        Self {
            given,
            squares,
            best: None,
            held: None,
            is_refuted: false,
            tried: 0,
            agreeing: 0,
            step: step("searches", Pieces::Unknown),
        }
    }

    /// Follows one after the other until there is no need of more; says whether that is so.
    fn follow(&mut self, starts: impl Iterator<Item = (f64, Unknowns)>) -> bool {
        let by_chance = by_chance(self.squares.numbers(), BY_CHANCE);
        for (residual, start) in starts {
            self.tried += 1;
            let fit = let_down(&mut self.squares, start, residual);
            self.step.done();
            let Ok(fit) = fit else {
                continue;
            };
            let lowest = self.best.as_ref().map_or(f64::INFINITY, |best| best.cost);
            self.agreeing = agreeing_with(self.agreeing, lowest, fit.cost);
            if fit.cost < lowest {
                self.best = Some(fit);
                self.is_refuted = false;
            }
            let is_enough =
                |best: &&Fit| self.explains(best) && (best.cost < by_chance || self.agreeing > 1);
            let enough = self.best.as_ref().filter(is_enough);
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

    /// Whether noise explains what these leave at the lines of the estimate, too. The search is at its end there.
    fn holds(&mut self, unknowns: Unknowns) -> bool {
        self.held = self.given.held(unknowns).ok().flatten();
        self.held.is_some()
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
            Some(unknowns) => {
                best.unknowns = unknowns;
                best.has_converged = true;
            }
            None => {
                let is_known = self.explains(&best) && !self.is_refuted;
                best.has_converged &= is_known || 2 * self.agreeing > self.tried;
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
    noise: &[PartNoise; 2],
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
pub(super) fn let_down(
    squares: &mut Beside<'_>,
    start: Unknowns,
    residual: f64,
) -> Result<Fit, SpatialError> {
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
