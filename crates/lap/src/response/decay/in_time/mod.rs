//! Decays sample by sample: the last fit, by maximum likelihood of the records themselves.
//!
//! What is read of a record over ten half-periods at a time leaves out what happens within them, and so some of what the record
//! says of a law that slips. The model's own motion, let go as the record was, is compared with every sample. That is right
//! where the rest is white noise; where it is not, the estimate by reading stays, which a wrong law or another mode disturbs less.

mod release;
mod rows;
mod search;
mod whiteness;

use std::f64::consts::TAU;
use std::fmt;

use self::search::{Ended, Run, Search, State};
use super::motion::{Grid, Release, sampled};
use super::recorded::Recorded;
use crate::response::backbone::BackboneRun;
use crate::response::fit::{Fit, Kind};
use crate::response::model::Model;
use crate::response::passive::Passive;
use crate::response::study::{LapResponseStudy, NoiseIs};
use crate::response::told::{Searched, by_searched};

pub(in crate::response) use self::rows::Rows;
pub use self::whiteness::Coloured;

/// Steps of a motion at most.
const MOST_STEPS: usize = 400_000;
/// Samples of a motion below this part of the noise say nothing.
const FADED: f64 = 0.1;
/// Fewest samples of a record.
const FEWEST: usize = 200;

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
    /// This run has a band.
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

impl fmt::Display for NotInTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherData => f.write_str("other data are fitted beside them"),
            Self::StatedErrors => {
                f.write_str("[noise] states errors of frequencies and damping ratios, which samples do not have")
            }
            Self::Band(run) => write!(f, "`band` says that {run} has other modes"),
            Self::TooLong(run, steps) => write!(
                f,
                "the motion of {run} takes {steps} steps, and {MOST_STEPS} is the most"
            ),
            Self::Lost => f.write_str("no motion of the law was found that follows the records"),
            Self::Undetermined => f.write_str("the samples do not tell all unknowns apart"),
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
}

/// Fits a model to the samples of decays, from what was read of them.
pub(in crate::response) fn fitted(
    study: &LapResponseStudy,
    model: &Model,
    read: &Fit,
    runs: &[&BackboneRun],
) -> Result<Found, NotInTime> {
    if study.noise.is_of_curves {
        return Err(NotInTime::StatedErrors);
    }
    if study.noise_is() != NoiseIs::OfRecords {
        return Err(NotInTime::OtherData);
    }
    let passive = Passive {
        model,
        amplitude_m: read.amplitude_m,
    };
    let values = passive.within(read.values);
    let mut followed = Vec::new();
    let mut releases = Vec::new();
    for run in runs {
        let record = run.recorded.as_deref().ok_or(NotInTime::OtherData)?;
        if record.has_band {
            return Err(NotInTime::Band(run.name.clone()));
        }
        let (grid, release) = begun(&values, run, record)?;
        followed.push(Run {
            record,
            grid,
            plain: plain(run),
        });
        releases.push(release);
    }
    let information = read.information.diagonal();
    let search = Search {
        model,
        noise: &study.noise,
        runs: followed,
        deviations: information.iter().map(|own| own.sqrt().recip()).collect(),
    };
    let from = |values| State::of(&search, values, &releases).ok_or(NotInTime::Lost);
    let held = search.ended(from(values)?, Kind::Passive)?;
    // errors and noise are those of the estimate that is free to be active, where limits hold the other
    let free = match held.fit.at_limits.is_empty() {
        true => None,
        false => Some(search.ended(from(read.values)?, Kind::Free)?),
    };
    let base = free.as_ref().unwrap_or(&held);
    let left = search.runs.iter().zip(&base.state.courses);
    let left: Vec<_> = left
        .map(|(run, course)| (run.record, &run.grid, course))
        .collect();
    let coloured = whiteness::coloured(&base.fit.values, &left, model.unknowns.len());
    if let Some(coloured) = coloured {
        return Err(NotInTime::Coloured(coloured));
    }
    let all = [Some(&held), free.as_ref()];
    if !all.iter().flatten().all(|ended| is_finite(model, &ended.fit)) {
        return Err(NotInTime::NotFinite);
    }
    let Ended {
        fit, moved, runs, ..
    } = held;
    let moved = free.as_ref().map_or(moved, |free| moved.max(free.moved));
    let free = free.map(|free| free.fit);
    Ok(Found {
        free: free.filter(|free| free.chi_squared < fit.chi_squared),
        fit,
        moved,
        runs,
    })
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
    values: &crate::response::model::Values,
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
