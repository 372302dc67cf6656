//! Decays sample by sample: the last fit, by maximum likelihood of the records themselves.
//!
//! What is read of a record over ten half-periods at a time leaves out what happens within them, and so some of what the record
//! says of a law that slips. The model's own motion, let go as the record was, is compared with every sample. That is right
//! where the rest is white noise; where it is not, the estimate by reading stays, which a wrong law or another mode disturbs less.

mod release;
mod rows;
mod scan;
mod search;
mod slopes;
mod whiteness;

use std::borrow::Cow;
use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use self::search::{Run, Search, State};
use super::motion::{Grid, Release, sampled};
use super::recorded::Recorded;
use crate::response::backbone::BackboneRun;
use crate::response::fit::{Fit, Kind};
use crate::response::model::{Model, Values};
use crate::response::passive::Passive;
use crate::response::study::{LapResponseStudy, NoiseIs};
use crate::response::told::{Searched, by_searched};

pub(in crate::response) use self::rows::Rows;
pub use self::whiteness::Coloured;

/// Steps of a motion at most.
pub(super) const MOST_STEPS: usize = 400_000;
/// Motions of a search at most, and steps of them.
const MOST_MOTIONS: usize = 1000;
const MOST_WORK: usize = 50_000_000;
/// Samples of a motion below this part of the noise say nothing.
const FADED: f64 = 0.1;
/// Fewest samples of a record.
const FEWEST: usize = 200;
/// Mean square of a residual, in that of the noise, below which a start is near the end, and below which a search from one that
/// was brought near may come to it.
const NEAR: f64 = 2.0;
const PROMISING: f64 = 10.0;
/// Amplitude that a law's unknowns are about, over the largest displacement in the samples.
const BEYOND: f64 = 1.1;
/// Standard deviations within which two searches came to the same estimate, and beyond which their starts are two.
const AGREES: f64 = 2.0;
const APART: f64 = 3.0;
/// Shares of the records that others are brought near by.
const SHARES: [f64; 5] = [0.1, 0.2, 0.35, 0.6, 1.0];

/// How much is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::response) enum Effort {
    /// All that may help, with work for each start; where one search alone came to the fit of what was read, another one has to
    /// come to the same end, to confirm it.
    Whole { confirm: bool },
    /// One law of several: with work for all starts together.
    Shared,
}

/// How free decays went into an estimate.
#[derive(Clone, Debug, PartialEq)]
pub enum InTime {
    /// None was fitted.
    NoDecay,
    /// Sample by sample.
    Fitted,
    /// By what was read of them, for this reason.
    Read(NotInTime),
}

/// Why decays are not fitted sample by sample.
#[derive(Clone, Debug, PartialEq)]
pub enum NotInTime {
    /// Other data are in the estimate.
    OtherData,
    /// The study states errors of what is read.
    StatedErrors,
    /// This run has a band, and what is outside of it are no modes that could be taken out.
    Band(String),
    /// This run would take so many steps.
    TooLong(String, usize),
    /// No motion of the law follows the records.
    Lost,
    /// The samples do not tell all unknowns apart.
    Undetermined,
    /// The search ended while it still moved by so many standard deviations.
    Unsettled(f64),
    /// What is left is no white noise.
    Coloured(Coloured),
    /// A number of the result would not be finite.
    NotFinite,
}

impl NotInTime {
    /// Whether another law may be fitted where this one was not.
    pub(in crate::response) fn is_of_law(&self) -> bool {
        match self {
            Self::OtherData | Self::StatedErrors | Self::Band(_) | Self::TooLong(..) => false,
            Self::Lost
            | Self::Undetermined
            | Self::Unsettled(_)
            | Self::Coloured(_)
            | Self::NotFinite => true,
        }
    }
}

impl fmt::Display for NotInTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherData => f.write_str("other data are fitted beside them"),
            Self::StatedErrors => {
                f.write_str("[noise] states errors of frequencies and damping ratios, which samples do not have")
            }
            Self::Band(run) => write!(
                f,
                "`band` says that {run} has other modes, and they are too many, or no decaying ones, to be taken out"
            ),
            Self::TooLong(run, steps) => write!(
                f,
                "the motion of {run} takes {steps} steps, and {MOST_STEPS} is the most"
            ),
            Self::Lost => f.write_str("no motion of the law was found that follows the records"),
            Self::Undetermined => f.write_str("the samples do not tell all unknowns apart"),
            Self::Unsettled(left) if !left.is_finite() => {
                f.write_str("the search over the samples found no step from where it began")
            }
            Self::Unsettled(left) => write!(
                f,
                "the search over the samples ended while it still moved by {left:.1} standard deviations"
            ),
            Self::Coloured(what) => {
                write!(f, "what the law leaves of the samples is no white noise: {what}")
            }
            Self::NotFinite => f.write_str("a number of that fit is not finite"),
        }
    }
}

/// A fit to the samples.
pub(in crate::response) struct Found {
    pub(in crate::response) fit: Fit,
    /// The one that is free to be active, where that is another.
    pub(in crate::response) free: Option<Fit>,
    /// Standard deviations of the last step.
    pub(in crate::response) moved: f64,
    pub(in crate::response) runs: Vec<BackboneRun>,
    /// Searches that were followed, and how many came to this estimate from starts apart.
    pub(in crate::response) searches: (usize, usize),
}

/// Fits a model to the samples of decays, from fits to what was read of them: the last one first.
pub(in crate::response) fn fitted(
    (study, model): (&LapResponseStudy, &Model),
    read: &[&Fit],
    runs: &[&BackboneRun],
    effort: Effort,
) -> Result<Found, NotInTime> {
    if study.noise.is_of_curves {
        return Err(NotInTime::StatedErrors);
    }
    if study.noise_is() != NoiseIs::OfRecords {
        return Err(NotInTime::OtherData);
    }
    let mut alone = Vec::with_capacity(runs.len());
    for run in runs {
        let record = run.recorded.as_deref().ok_or(NotInTime::OtherData)?;
        if record.values.len() > MOST_STEPS {
            return Err(NotInTime::TooLong(run.name.clone(), record.values.len()));
        }
        let own = record.alone();
        alone.push((*run, own.ok_or_else(|| NotInTime::Band(run.name.clone()))?));
    }
    let grids = runs.iter().filter_map(|run| {
        let record = run.recorded.as_deref()?;
        let first = run.lines.first()?;
        Some(Grid::of(record, record.values.len(), first.omega))
    });
    let longest = grids.map(|grid| grid.steps()).max().unwrap_or(0);
    let of_each = MOST_WORK.min(MOST_MOTIONS * runs.len() * longest);
    let starts = read.iter().flat_map(|read| {
        let moderate = read.values.moderate();
        std::iter::once(read.values).chain(moderate)
    });
    let left = AtomicUsize::new(of_each);
    // what slips only before the first point that is read has left no trace there
    let scan = || scan::starts((study, model), runs, &alone, of_each);
    let (first, confirm) = match effort {
        Effort::Whole { confirm } => (Vec::new(), confirm),
        Effort::Shared => (scan(), false),
    };
    let last = std::iter::once_with(|| match effort {
        Effort::Whole { .. } => scan(),
        Effort::Shared => Vec::new(),
    });
    let starts = first.into_iter().chain(starts).chain(last.flatten());
    let mut reason = NotInTime::Lost;
    let mut ends: Vec<(Values, Found)> = Vec::new();
    let mut followed = 0;
    for values in starts {
        let is_near =
            |(other, found): &(Values, Found)| found.is_within(model, APART, [other, &values]);
        if ends.iter().any(is_near) {
            continue;
        }
        if effort != Effort::Shared {
            left.store(of_each, Ordering::Relaxed);
        }
        let start = match Start::of((study, model), values, &alone, &left) {
            Err(NotInTime::Lost) => continue,
            other => other?.brought_near(),
        };
        if !start.is_within(PROMISING) {
            continue;
        }
        followed += 1;
        match start.ended() {
            Ok(found) => ends.push((values, found)),
            // another start may come to a better end
            Err(problem) => reason = problem,
        }
        if !ends.is_empty() && (!confirm || agreeing(model, &ends) > 1) {
            break;
        }
    }
    let searches = (followed, agreeing(model, &ends));
    let of_found = |found: &Found| found.fit.chi_squared;
    let best = ends
        .into_iter()
        .map(|(_, found)| found)
        .min_by(|one, other| of_found(one).total_cmp(&of_found(other)));
    best.map(|found| Found { searches, ..found }).ok_or(reason)
}

/// How many searches came to the estimate of the best of them.
fn agreeing(model: &Model, ends: &[(Values, Found)]) -> usize {
    let all = ends.iter().map(|(_, found)| found);
    let best = all
        .clone()
        .min_by(|one, other| one.fit.chi_squared.total_cmp(&other.fit.chi_squared));
    let Some(best) = best else {
        return 0;
    };
    let most = AGREES * AGREES * best.fit.reduced_chi_squared();
    let agree = |own: &&Found| {
        own.fit.chi_squared <= best.fit.chi_squared + most
            && best.is_within(model, AGREES, [&best.fit.values, &own.fit.values])
    };
    all.filter(agree).count()
}

impl Found {
    /// Whether two places are within so many standard deviations of each other.
    fn is_within(&self, model: &Model, deviations: f64, [one, other]: [&Values; 2]) -> bool {
        let change = model.change(one, other);
        let along = change.dot(&(&self.fit.information * &change));
        along <= deviations * deviations * self.fit.reduced_chi_squared()
    }
}

/// Where a search over samples may start.
struct Start<'a> {
    search: Search<'a>,
    from: State,
}

impl<'a> Start<'a> {
    fn of(
        (study, model): (&'a LapResponseStudy, &'a Model),
        values: Values,
        runs: &'a [(&'a BackboneRun, Cow<'a, Recorded>)],
        left: &'a AtomicUsize,
    ) -> Result<Self, NotInTime> {
        let read = runs.iter().map(|(run, _)| run.largest_m());
        let largest_m = read.fold(0.0, f64::max);
        let passive = Passive {
            model,
            amplitude_m: largest_m,
        };
        let mut values = passive.within(values);
        if let Some(slider) = &mut values.slider {
            // samples reach from the release on, points from some periods behind it
            let of_runs = runs.iter().map(|(run, record)| farthest_m(run, record));
            *slider = slider.about(BEYOND * of_runs.fold(0.0, f64::max));
        }
        let mut followed = Vec::new();
        let mut releases = Vec::new();
        for (run, record) in runs {
            let (grid, release) = begun(&values, run, record)?;
            followed.push(Run {
                record,
                beside: record.beside(grid.samples).map(Arc::new),
                grid,
                plain: plain(run),
            });
            releases.push(release);
        }
        let search = Search {
            model,
            noise: &study.noise,
            runs: followed,
            left,
        };
        let from = State::of(&search, values, &releases).ok_or(NotInTime::Lost)?;
        Ok(Self { search, from })
    }

    /// Whether the mean square of what its motion leaves of the records is below so many times that of the noise.
    fn is_within(&self, times: f64) -> bool {
        self.from.chi_squared < times * self.search.samples() as f64
    }

    /// The joint that the samples are most likely of, from here.
    fn ended(&self) -> Result<Found, NotInTime> {
        let Self { search, from } = self;
        let held = search.ended(from.clone(), Kind::Passive)?;
        // errors and noise are those of the estimate that is free to be active, where limits hold the other
        let free = match held.fit.at_limits.is_empty() {
            true => None,
            false => Some(search.ended(from.clone(), Kind::Free)?),
        };
        let base = free.as_ref().unwrap_or(&held);
        let left = search.runs.iter().zip(&base.state.courses);
        let left: Vec<_> = left
            .map(|(run, course)| (run.record, &run.grid, course))
            .collect();
        let unknowns = search.model.unknowns.len();
        if let Some(coloured) = whiteness::coloured(&base.state.values, &left, unknowns) {
            return Err(NotInTime::Coloured(coloured));
        }
        let mut all = std::iter::once(&held).chain(&free);
        if !all.all(|ended| is_finite(search.model, &ended.fit)) {
            return Err(NotInTime::NotFinite);
        }
        let moved = free
            .as_ref()
            .map_or(held.moved, |free| held.moved.max(free.moved));
        let free = free.map(|free| free.fit);
        Ok(Found {
            free: free.filter(|free| free.chi_squared < held.fit.chi_squared),
            fit: held.fit,
            moved,
            runs: held.runs,
            searches: (1, 1),
        })
    }

    /// The start brought near by the first samples, then by more and more of them: a phase that has run ahead by half a turn
    /// would draw a search the wrong way.
    fn brought_near(mut self) -> Self {
        if self.is_within(NEAR) {
            return self;
        }
        for share in SHARES {
            let part = self.search.up_to(share);
            let releases: Vec<Release> = self
                .from
                .courses
                .iter()
                .map(|course| course.release)
                .collect();
            let Some(from) = State::of(&part, self.from.values, &releases) else {
                return self;
            };
            let better = part.improved(from);
            let releases: Vec<Release> =
                better.courses.iter().map(|course| course.release).collect();
            match State::of(&self.search, better.values, &releases) {
                Some(from) => self.from = from,
                None => return self,
            }
        }
        self
    }
}

/// The largest displacement in the samples of a run, m.
fn farthest_m(run: &BackboneRun, record: &Recorded) -> f64 {
    let Some(first) = run.lines.first() else {
        return 0.0;
    };
    let derived = first.omega.powi(record.quantity.order()) * record.share.abs();
    let samples = record.values.iter();
    samples.fold(0.0_f64, |most, value| most.max(value.abs())) / derived
}

/// A run without what is of its reading alone.
fn plain(run: &BackboneRun) -> BackboneRun {
    BackboneRun {
        name: run.name.clone(),
        path: run.path.clone(),
        used_for: run.used_for,
        lines: run.lines.clone(),
        errors: None,
        following: None,
        recorded: None,
        rows: None,
    }
}

/// Which samples of a record are followed, and where it began.
fn begun(
    values: &Values,
    run: &BackboneRun,
    record: &Recorded,
) -> Result<(Grid, Release), NotInTime> {
    let first = run.lines.first().ok_or(NotInTime::Lost)?;
    if !(record.noise > 0.0 && record.noise.is_finite()) {
        return Err(NotInTime::Lost);
    }
    let grid = Grid::of(record, record.values.len(), first.omega);
    if grid.steps() > MOST_STEPS {
        return Err(NotInTime::TooLong(run.name.clone(), grid.steps()));
    }
    let rate = first.damping_ratio.unwrap_or(0.0).max(0.0) * first.omega;
    let release = release::found(values, record, &grid, rate).ok_or(NotInTime::Lost)?;
    let motion = sampled(values, &release, record, &grid).ok_or(NotInTime::Lost)?;
    let least = FADED * record.noise;
    let last = motion.iter().rposition(|value| value.abs() > least);
    let period = (TAU / first.omega / record.interval_s) as usize;
    let samples = last.unwrap_or(0) + period + 1;
    if samples < FEWEST || record.values.len() < FEWEST {
        return Err(NotInTime::Lost);
    }
    Ok((grid.up_to(samples), release))
}

/// Whether every number that is told of a fit is finite.
fn is_finite(model: &Model, fit: &Fit) -> bool {
    let told = by_searched(model, &fit.values);
    let covariance = Searched::of(model, fit, fit.reduced_chi_squared()).covariance;
    let covariance = &told * covariance * told.transpose();
    let mut values = model.unknowns.iter().map(|unknown| fit.values.of(*unknown));
    values.all(f64::is_finite)
        && fit.values.spring().is_finite()
        && fit.chi_squared.is_finite()
        && covariance.iter().all(|entry| entry.is_finite())
        && covariance.diagonal().iter().all(|&variance| variance > 0.0)
}
