//! The estimate: search, level of the noise, the joint alone with all lines, and what all errors together do to it.

use std::borrow::Cow;

use bolted_joint_wanted::{Pieces, step};
use nalgebra::DMatrix;

use crate::contradicted;
use crate::error::SpatialError;
use crate::fit::{Effort, Fit, Squares, covariance};
use crate::further::{Further, Score, scores};
use crate::hidden::{self, Beside, searched_beside};
use crate::identification::SpatialIdentification;
use crate::lack;
use crate::level::{first, relative_rms, sizes};
use crate::misfits::Misfit;
use crate::normal::{Deviations, Normal, cost, squares_of_errors};
use crate::outcome::{LARGEST_RESIDUAL, undetermined};
use crate::problem::{Problem, Unknowns};
use crate::richer::{Richer, richer};
use crate::search::{Extent, SEARCHED, Searched, searched};
use crate::settled::Settled;
use crate::study::SpatialStudy;
use crate::together::together;

/// Rounds in which the level of the noise follows the residuals, and the budget what it does not allow for.
const ROUNDS: usize = 5;

/// Lines of the joint before all take part, where the substructures have noise.
const FEW: usize = 200;

/// The joint that fits best, beside what else is unknown.
pub(crate) struct Refined {
    /// Of the joint alone.
    pub(crate) unknowns: Unknowns,
    /// Covariance of these.
    pub(crate) covariance: DMatrix<f64>,
    /// χ², and of how many numbers.
    pub(crate) squares: f64,
    pub(crate) numbers: usize,
    /// What the joint leaves in the assembly, by itself: χ² over degrees of freedom, where the substructures have noise.
    pub(crate) left_in_assembly: Option<f64>,
    /// Lines that took part.
    pub(crate) kept: Vec<usize>,
    /// R.m.s. over these lines of what the substructures' noise moves, in parts of the functions.
    pub(crate) moved: f64,
    pub(crate) has_converged: bool,
}

/// The search's end.
pub(crate) struct Found {
    /// Joint and errors of the set-up, at the lines of `estimated`.
    pub(crate) best: Fit,
    pub(crate) estimated: Problem,
    /// What these say of both.
    pub(crate) information: DMatrix<f64>,
    /// The substructures as they were found, and an exact set-up, at all lines.
    pub(crate) shown: Problem,
    /// The joint alone, with the errors as they were found, at all lines.
    pub(crate) joint: Refined,
    /// Starts that were tried, and that agree.
    pub(crate) starts: [usize; 2],
    /// Other joints that explain the functions as well.
    pub(crate) rivals: usize,
    /// That the joint is not what its model says.
    pub(crate) richer: Option<Richer>,
    /// Part of the noise of the assembly that goes with the values of its functions.
    pub(crate) of_values: f64,
    /// What further numbers would explain; of none where nothing is known of that.
    pub(crate) further: Vec<(Further, Score)>,
}

/// Where an estimate goes on from, and the searches that led there.
pub(crate) struct Begun(Searched);

impl Found {
    fn begun(self) -> Begun {
        Begun(Searched {
            fit: self.best,
            starts: self.starts,
            rivals: self.rivals,
        })
    }

    /// With errors of sensors and hits that it does not have yet.
    pub(crate) fn for_anew(&self, before: &Problem, anew: &Problem) -> Begun {
        Begun(Searched {
            fit: Fit {
                unknowns: anew.unknowns_with_anew(before, &self.best.unknowns),
                ..self.best
            },
            starts: self.starts,
            rivals: self.rivals,
        })
    }
}

impl SpatialStudy {
    /// The joint. Beside places that do not fit, as [`Self::misfits`] tells them, the likely starts alone are followed.
    ///
    /// # Errors
    /// [`SpatialError`] where the functions do not determine one.
    pub fn identify(&self, misfits: &[Misfit]) -> Result<SpatialIdentification, SpatialError> {
        match &self.uneven {
            Some(uneven) => self.identify_with(uneven, misfits),
            None => self.identify_alone(misfits),
        }
    }

    /// With the noise that the problem has.
    pub(crate) fn identify_alone(
        &self,
        misfits: &[Misfit],
    ) -> Result<SpatialIdentification, SpatialError> {
        let problem = &self.problem;
        let (functions, lines) = (problem.observed.len(), problem.frequency_hz.len());
        if problem.numbers() <= problem.joint_count() {
            return Err(SpatialError::TooFewFunctions {
                found: functions,
                lines,
                unknowns: problem.joint_count(),
            });
        }
        let rms = sizes(problem);
        let (mut own, mut found) = self.found_with_anew(&rms, !misfits.is_empty())?;
        let of_anew = match own {
            Cow::Owned(_) => own.problem.told_anew(&found.best.unknowns),
            Cow::Borrowed(_) => Vec::new(),
        };
        let of_whole = match &own {
            Cow::Owned(anew) => self.better_as_a_whole(&rms, anew, &found),
            Cow::Borrowed(_) => None,
        };
        let mut result = own.result(&found)?;
        let step = step("rounds of the budget", Pieces::AtMost(ROUNDS));
        for _ in 0..ROUNDS {
            // what a budget that does not hold draws back draws the joint with it
            let is_near = found.joint.has_converged && result.relative_rms < LARGEST_RESIDUAL;
            let wider = contradicted::wider(&own.problem, &found.best.unknowns)
                .filter(|_| is_near && result.reasons_against.is_empty());
            let Some(wider) = wider else { break };
            own.to_mut().problem.wider = wider;
            found = own.found_from(&rms, found.begun())?;
            result = own.result(&found)?;
            step.done();
        }
        result.warnings.extend(of_anew);
        result.reasons_against.extend(of_whole);
        Ok(result)
    }

    /// Whether the substructures' functions have noise.
    pub(crate) fn has_noise(&self) -> bool {
        self.noise.iter().any(|noise| !noise.is_none())
    }

    /// What fits best, where searches as far as that lead.
    pub(crate) fn searched(
        &self,
        rms: &Deviations,
        extent: Extent<'_>,
    ) -> Result<Option<Found>, SpatialError> {
        let begun = self.begun(rms, extent)?;
        begun.map(|own| self.found_from(rms, own)).transpose()
    }

    fn begun(&self, rms: &Deviations, extent: Extent<'_>) -> Result<Option<Begun>, SpatialError> {
        let problem = &self.problem;
        let level = first(&self.problem, self.level, rms);
        let is_stated = self.level.is_known();
        let own = match (self.has_noise(), problem.error_count()) {
            (true, _) => searched_beside(problem, &level, &self.noise, extent)?,
            (false, 0) => {
                let own = searched(&problem.thinned(SEARCHED), &level, is_stated)?;
                let fit = own.fit.on(problem, &level)?;
                Some(Searched { fit, ..own })
            }
            (false, _) => together(problem, &level, is_stated, extent)?,
        };
        Ok(own.map(Begun))
    }

    /// What fits best near there.
    pub(crate) fn found_from(&self, rms: &Deviations, begun: Begun) -> Result<Found, SpatialError> {
        let _step = step("the estimate at more lines", Pieces::Unknown);
        match self.has_noise() {
            true => self.beside_noise(rms, begun),
            false => self.beside_exact(rms, begun),
        }
    }

    /// Where the substructures' functions are exact.
    fn beside_exact(&self, rms: &Deviations, begun: Begun) -> Result<Found, SpatialError> {
        let Begun(Searched {
            fit,
            starts,
            rivals,
        }) = begun;
        let is_stated = self.level.is_known();
        let first_level = first(&self.problem, self.level, rms);
        let Settled {
            problem,
            best,
            estimated,
            level,
            of_values,
        } = Settled::of(&self.problem, fit, (&first_level, is_stated), rms)?;
        let problem = &*problem;
        let errors = problem.error_count();
        // all lines, with the errors of the set-up as they were found
        let exact = problem.displaced(&best.unknowns)?;
        let start = joint_of(problem, &best.unknowns);
        let unknowns = match problem.frequency_hz.len() > estimated.frequency_hz.len() {
            true => Fit::from(&exact, start, &level)?.unknowns,
            false => start,
        };
        let normal = Normal::of(&exact, &unknowns, &level)?;
        let at = with_joint(&best.unknowns, &unknowns);
        let richer = richer(&estimated, &best.unknowns, |problem, unknowns| {
            Normal::of(problem, unknowns, &level)
        })?;
        let is_noise = relative_rms(&estimated, &best.unknowns)? > lack::ROUNDING;
        let further = match best.has_converged && is_noise {
            true => scores(&estimated, &best.unknowns, &level)?,
            false => Vec::new(),
        };
        Ok(Found {
            richer,
            further,
            of_values,
            joint: Refined {
                covariance: covariance(&normal.information)
                    .ok_or_else(|| undetermined(best.has_converged, starts))?,
                squares: cost(problem, &at, &level)?,
                numbers: problem.numbers(),
                left_in_assembly: None,
                kept: (0..problem.frequency_hz.len()).collect(),
                moved: 0.0,
                has_converged: best.has_converged,
                unknowns,
            },
            information: match errors {
                0 => DMatrix::zeros(0, 0),
                _ => Normal::of(&estimated, &best.unknowns, &level)?.information,
            },
            best,
            estimated,
            shown: exact,
            starts,
            rivals,
        })
    }

    /// Where the substructures' functions have noise.
    fn beside_noise(&self, rms: &Deviations, begun: Begun) -> Result<Found, SpatialError> {
        let problem = &self.problem;
        let level = first(&self.problem, self.level, rms);
        let noise = &self.noise;
        let Begun(Searched {
            fit: best,
            starts,
            rivals,
        }) = begun;
        let mut has_converged = best.has_converged;
        let mut unknowns = best.unknowns;
        // joint and set-up at more lines
        let estimated = hidden::estimated(problem, &level, noise, &unknowns)?;
        let mut squares = Beside::of(&estimated, &level, noise, &unknowns)?;
        let best = Fit::by(&mut squares, unknowns, Effort::Full)?;
        has_converged &= best.has_converged;
        let information = squares.normal(&best.unknowns)?.information;
        let richer = richer(&estimated, &best.unknowns, |problem, unknowns| {
            Beside::of(problem, &level, noise, unknowns)?.normal(unknowns)
        })?;
        unknowns = best.unknowns.clone();
        // and the joint at all, beside the set-up that was found
        let exact = problem.displaced(&unknowns)?;
        let joint = joint_of(problem, &unknowns);
        let squares = Beside::of(&exact, &level, noise, &joint)?;
        let kept = squares.kept(&joint)?;
        let steady = exact.with_lines(&kept);
        let mut squares = squares.on(&steady, &kept);
        let explained = squares.explained(&joint)?;
        let kept: Vec<usize> = explained.iter().map(|&line| kept[line]).collect();
        let exact = steady.with_lines(&explained);
        let mut squares = squares.on(&exact, &explained);
        let few = exact.thinned(FEW);
        let first = Fit::by(
            &mut Beside::of(&few, &level, noise, &joint)?,
            joint,
            Effort::Near,
        )?;
        let fit = Fit::by(&mut squares, first.unknowns, Effort::Near)?;
        has_converged &= first.has_converged && fit.has_converged;
        let joint = fit.unknowns;
        let moved = squares.moved(&joint)?;
        let normal = squares.normal(&joint)?;
        let mut shown = problem.displaced(&unknowns)?.smoothed()?;
        let found = squares.found(&joint)?;
        for (side, found) in shown.sides.iter_mut().zip(found.sides) {
            for (&line, functions) in kept.iter().zip(found.lines) {
                side.lines[line] = functions;
            }
        }
        let moved: f64 = moved.iter().map(|moved| moved.powi(2)).sum();
        Ok(Found {
            joint: Refined {
                covariance: covariance(&normal.information)
                    .ok_or_else(|| undetermined(has_converged, starts))?,
                squares: normal.cost + squares_of_errors(problem, &best.unknowns),
                numbers: squares.numbers(),
                left_in_assembly: Some(squares.left_in_assembly(&joint, normal.cost)?),
                moved: (moved / kept.len().max(1) as f64).sqrt(),
                kept,
                has_converged,
                unknowns: joint,
            },
            best,
            estimated,
            information,
            shown,
            starts,
            rivals,
            richer,
            further: Vec::new(),
            of_values: 0.0,
        })
    }
}

/// The joint's unknowns of all.
fn joint_of(problem: &Problem, all: &Unknowns) -> Unknowns {
    Unknowns(all.0.rows(0, problem.joint_count()).into_owned())
}

/// All unknowns, with this joint.
fn with_joint(all: &Unknowns, joint: &Unknowns) -> Unknowns {
    let mut own = all.clone();
    own.0.rows_mut(0, joint.0.len()).copy_from(&joint.0);
    own
}
