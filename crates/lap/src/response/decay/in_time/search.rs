//! The likelihood of all samples at its maximum: Gauss–Newton steps over the model's numbers, with each record's release eliminated.
//!
//! Each step is a fit to the square forms of the records, within the limits of a passive joint. Derivatives hold for a few steps.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use bolted_joint_identify::parallel;
use nalgebra::{DMatrix, DVector, Vector2};

use super::NotInTime;
use super::release::{self, Course};
use super::rows::Rows;
use super::slopes::Slopes;
use crate::response::backbone::BackboneRun;
use crate::response::decay::motion::{Direction, Grid, Release};
use crate::response::decay::recorded::Recorded;
use crate::response::fit::{Data, Fit, Kind, fit};
use crate::response::model::{Model, ResponseUnknown, Values};
use crate::response::study::Noise;

/// How often derivatives are taken, and steps with the same ones.
const DERIVED: usize = 40;
const STEPS: usize = 2;
/// Standard deviations of a step that is none with derivatives of the same place, and with older ones.
const SETTLED: f64 = 0.05;
const SMALL: f64 = 0.02;
/// Trials of a step, how strongly the first one is drawn back that is, and by how much more each that follows.
const TRIALS: usize = 8;
const DRAWN: f64 = 1e-6;
const STRONGER: f64 = 30.0;
/// Length of such a step beyond which derivatives are taken anew.
const DRAWN_FAR: f64 = 0.3;
/// By how much χ² falls from one taking of derivatives to the next where nothing more is to be had, in its value per degree of
/// freedom. A law with a corner that the motion just reaches has no smooth likelihood: there a step may be refused that is short.
const AT_REST: f64 = 0.01;
/// Steps that bring a start near, how strongly they are drawn back, and the step in standard deviations that is short enough.
const IMPROVEMENTS: usize = 10;
const DRAWN_AT_FIRST: f64 = 1e-2;
const DRAWN_AT_LAST: f64 = 1e-5;
const ROUGH: f64 = 0.5;
/// Longest step of the logarithm of a law's number.
const LONGEST: f64 = 0.7;
/// Part of χ² that is rounding.
const ROUNDING: f64 = 1e-10;
/// Least eigenvalue of the scaled information that is more than rounding.
const TOLD: f64 = 1e-9;
/// Numbers of each record that are its own: displacement and time of the release, and the offset.
pub(super) const OWN: usize = 3;

/// A record that is followed.
#[derive(Clone)]
pub(super) struct Run<'a> {
    pub(super) record: &'a Recorded,
    pub(super) grid: Grid,
    /// An orthonormal basis of what errors of other modes are in all of its samples, and an offset.
    pub(super) beside: Option<Arc<DMatrix<f64>>>,
    /// What of the run stays with its rows.
    pub(super) plain: BackboneRun,
}

/// A place among the unknowns.
#[derive(Clone)]
pub(super) struct State {
    pub(super) values: Values,
    pub(super) courses: Vec<Course>,
    pub(super) chi_squared: f64,
}

/// Where a search ended.
pub(super) struct Ended {
    pub(super) fit: Fit,
    pub(super) state: State,
    /// Standard deviations of the last step.
    pub(super) moved: f64,
    pub(super) runs: Vec<BackboneRun>,
}

/// The search.
pub(super) struct Search<'a> {
    pub(super) model: &'a Model,
    pub(super) noise: &'a Noise,
    pub(super) runs: Vec<Run<'a>>,
    /// Steps of motions that may still be taken.
    pub(super) left: &'a AtomicUsize,
}

/// A step that was taken.
struct Step {
    state: State,
    fit: Fit,
    runs: Vec<BackboneRun>,
    /// Its length in standard deviations.
    length: f64,
    is_drawn: bool,
}

impl State {
    pub(super) fn of(search: &Search<'_>, values: Values, releases: &[Release]) -> Option<Self> {
        let pairs = search.runs.iter().zip(releases);
        let courses = pairs.map(|(run, release)| search.course(&values, *release, run));
        let courses: Vec<Course> = courses.collect::<Option<_>>()?;
        let chi_squared = courses.iter().map(Course::chi_squared).sum();
        Some(Self {
            values,
            courses,
            chi_squared,
        })
    }
}

impl Ended {
    /// Where the samples tell all unknowns apart.
    fn told(fit: Fit, state: State, runs: Vec<BackboneRun>, moved: f64) -> Result<Self, NotInTime> {
        match is_told(&fit.information) {
            true => Ok(Self {
                fit,
                state,
                moved,
                runs,
            }),
            false => Err(NotInTime::Undetermined),
        }
    }
}

impl Search<'_> {
    /// All samples that are followed.
    pub(super) fn samples(&self) -> usize {
        self.runs.iter().map(|run| run.grid.samples).sum()
    }

    /// The search over a share of the samples, the first ones of each record.
    pub(super) fn up_to(&self, share: f64) -> Self {
        let runs = self.runs.iter().map(|run| Run {
            grid: run.grid.up_to((share * run.grid.samples as f64) as usize),
            // over a few periods they would take what is the motion's
            beside: run.beside.clone().filter(|_| share >= 1.0),
            ..run.clone()
        });
        Self {
            model: self.model,
            noise: self.noise,
            runs: runs.collect(),
            left: self.left,
        }
    }

    /// The motion of a run, as long as there are steps left.
    pub(super) fn course(
        &self,
        values: &Values,
        release: Release,
        run: &Run<'_>,
    ) -> Option<Course> {
        self.takes(run.grid.steps())?;
        let beside = run.beside.as_deref();
        Course::of(values, release, (run.record, beside), &run.grid)
    }

    /// How what it leaves of a record changes along each direction, likewise.
    pub(super) fn changes(
        &self,
        values: &Values,
        release: Release,
        run: &Run<'_>,
        directions: &[Direction],
    ) -> Option<DMatrix<f64>> {
        self.takes(run.grid.steps().saturating_mul(directions.len()))?;
        let beside = run.beside.as_deref();
        release::changes(values, release, (run.record, beside), &run.grid, directions)
    }

    /// Takes so many steps of those that are left.
    fn takes(&self, steps: usize) -> Option<()> {
        let fewer = |left: usize| left.checked_sub(steps);
        let order = Ordering::Relaxed;
        self.left.fetch_update(order, order, fewer).ok().map(|_| ())
    }

    /// A better place, after a few steps that are drawn back: what the samples do not tell stays as it is.
    pub(super) fn improved(&self, from: State) -> State {
        let mut state = from;
        let mut drawn = DRAWN_AT_FIRST;
        for _ in 0..IMPROVEMENTS {
            let Some(slopes) = self.slopes(&state) else {
                break;
            };
            let Ok(Some(step)) = self.step(&state, &slopes, Kind::Passive, &mut drawn) else {
                break;
            };
            let length = step.length;
            state = step.state;
            if length < ROUGH {
                break;
            }
            drawn = (drawn / STRONGER).max(DRAWN_AT_LAST);
        }
        state
    }

    /// Follows the likelihood from a place to its maximum.
    pub(super) fn ended(&self, from: State, kind: Kind) -> Result<Ended, NotInTime> {
        let mut state = from;
        let mut left = f64::INFINITY;
        let mut drawn = 0.0;
        for _ in 0..DERIVED {
            let slopes = self.slopes(&state).ok_or(NotInTime::Lost)?;
            let before = state.chi_squared;
            for number in 0..STEPS {
                let Some(step) = self.step(&state, &slopes, kind, &mut drawn)? else {
                    drawn = 0.0;
                    break;
                };
                left = step.length;
                if number == 0 && left < SETTLED && !step.is_drawn {
                    return Ended::told(step.fit, step.state, step.runs, left);
                }
                state = step.state;
                drawn = match drawn / (STRONGER * STRONGER) {
                    less if less < DRAWN => 0.0,
                    less => less,
                };
                if left < SMALL || step.is_drawn && left > DRAWN_FAR {
                    break;
                }
            }
            let gain = (before - state.chi_squared) / self.reduced(&state);
            if gain < AT_REST {
                let (found, runs) = self.fit(&state, &slopes, kind, 0.0)?;
                let found = Fit {
                    values: state.values,
                    chi_squared: state.chi_squared,
                    ..found
                };
                return Ended::told(found, state, runs, gain.max(0.0).sqrt());
            }
        }
        Err(NotInTime::Unsettled(left))
    }

    /// χ² per number.
    fn reduced(&self, state: &State) -> f64 {
        state.chi_squared / self.samples().max(1) as f64
    }

    /// A step that does not raise χ²; `None` where there is none with these slopes.
    fn step(
        &self,
        from: &State,
        slopes: &[Slopes],
        kind: Kind,
        drawn: &mut f64,
    ) -> Result<Option<Step>, NotInTime> {
        for _ in 0..TRIALS {
            let (found, runs) = self.fit(from, slopes, kind, *drawn)?;
            let change = self.model.change(&from.values, &found.values);
            let pairs = self.model.unknowns.iter().zip(change.iter());
            let is_short = pairs.fold(true, |is_short, (unknown, change)| match unknown {
                ResponseUnknown::Slider(_) => is_short && change.abs() < LONGEST,
                _ => is_short && change.is_finite(),
            });
            let trial = is_short.then(|| {
                let releases = self.releases(from, slopes, &change);
                State::of(self, found.values, &releases)
            });
            if let Some(state) = trial.flatten()
                && state.chi_squared <= from.chi_squared * (1.0 + ROUNDING)
            {
                let along = change.dot(&(&found.information * &change));
                let length = (along.max(0.0) / found.reduced_chi_squared()).sqrt();
                return Ok(Some(Step {
                    state,
                    fit: found,
                    runs,
                    length,
                    is_drawn: *drawn > 0.0,
                }));
            }
            *drawn = if *drawn > 0.0 {
                STRONGER * *drawn
            } else {
                DRAWN
            };
        }
        Ok(None)
    }

    /// The best joint by the square forms about a place.
    fn fit(
        &self,
        from: &State,
        slopes: &[Slopes],
        kind: Kind,
        drawn: f64,
    ) -> Result<(Fit, Vec<BackboneRun>), NotInTime> {
        let all = self.runs.iter().zip(&from.courses).zip(slopes);
        let runs = all.map(|((run, course), slopes)| {
            let numbers = (
                run.grid
                    .samples
                    .saturating_sub(OWN + run.record.beside_count()),
                course.release.displacement_m.abs(),
            );
            let rows = Rows::of(&from.values, &slopes.normal(course), numbers);
            BackboneRun {
                rows: Some(rows.damped(drawn)),
                ..run.plain.clone()
            }
        });
        let runs: Vec<BackboneRun> = runs.collect();
        let backbones: Vec<&BackboneRun> = runs.iter().collect();
        let data = Data {
            lines: &[],
            backbones: &backbones,
        };
        let found = fit(self.model, data, self.noise, &from.values, kind);
        let found = found.map_err(|_| NotInTime::Lost)?;
        Ok((found, runs))
    }

    /// Where each record begins after a step of the unknowns.
    fn releases(&self, from: &State, slopes: &[Slopes], change: &DVector<f64>) -> Vec<Release> {
        let pairs = from.courses.iter().zip(slopes);
        let moved = pairs.map(|(course, slopes)| {
            let residual = slopes.by_release.transpose() * &course.residual;
            let right = residual + &slopes.between * change;
            let solved = slopes
                .of_release
                .lu()
                .solve(&Vector2::new(right[0], right[1]));
            let by = solved.unwrap_or_default();
            release::moved(&course.release, [-by[0], -by[1]])
        });
        moved.collect()
    }

    fn slopes(&self, state: &State) -> Option<Vec<Slopes>> {
        let pairs: Vec<_> = self.runs.iter().zip(&state.courses).collect();
        let slopes = parallel::map(&pairs, |(run, course)| {
            Slopes::about(self, &state.values, run, course)
        });
        slopes.into_iter().collect()
    }
}

/// Whether the information tells every direction of the unknowns.
fn is_told(information: &DMatrix<f64>) -> bool {
    let scale = information.diagonal().map(|entry| entry.sqrt().recip());
    let size = scale.len();
    let scaled = DMatrix::from_fn(size, size, |i, j| information[(i, j)] * scale[i] * scale[j]);
    let is_finite = scaled.iter().all(|entry| entry.is_finite());
    is_finite
        && scaled
            .symmetric_eigenvalues()
            .iter()
            .all(|&value| value > TOLD)
}
