//! Which terms the data call for, by likelihood.

use bolted_joint_identify::parallel;
use serde::Serialize;

use super::backbone::BackboneRun;
use super::data::{SineLine, SineRun, Use};
use super::decay::{Effort, Following, InTime, corrected, fitted, followed};
use super::fit::{self, Data, Fit, Kind};
use super::kinks::at_kinks;
use super::model::Model;
use super::passive::Limit;
use super::reliability::{ABSURD, FEW_STARTS};
use super::start;
use super::study::LapResponseStudy;
use super::terms::TermSet;
use crate::error::LapError;
use bolted_joint_study::StudyError;
use bolted_joint_wanted::{Pieces, step};

/// How often decays are read anew as the model of the fit before would be, while models are compared, …
const READINGS: usize = 2;
/// … and at most for the one that is chosen, until the estimate moves by less than this part of its deviations.
const MOST_READINGS: usize = 8;
const READ: f64 = 0.1;
/// Polynomials that are tried on the samples of decays where the first law fails, the best by what was read.
const MOST_POLYNOMIALS: usize = 3;
/// Deviations within which what is read grows with the unknowns as before.
const NEAR: f64 = 0.5;

/// A model beside the others: the passive joint of it that fits best.
#[derive(Clone, Debug, Serialize)]
pub struct ModelComparison {
    /// Its terms.
    pub terms: TermSet,
    /// Number of its unknowns, less the limits that it stands at.
    pub unknowns: usize,
    /// χ² per degree of freedom with the stated noise, or with 1 % where none is stated.
    pub reduced_chi_squared: f64,
    /// Schwarz's criterion less that of the best.
    pub bic_difference: f64,
    /// Whether the free estimate is passive as well: then the two are one.
    pub is_passive: bool,
    /// By how much −2 ln L is above that of the free estimate.
    pub price: f64,
    /// Limits that the estimate stands at: free it would exceed them.
    pub held: Vec<Limit>,
}

/// A fitted candidate.
pub(super) struct Candidate {
    pub(super) terms: TermSet,
    /// The passive estimate.
    pub(super) fit: Fit,
    /// The one before decays were corrected, and before they were followed.
    first: Fit,
    corrected: Fit,
    /// The free one, where that is another and active.
    pub(super) free: Option<Fit>,
    pub(super) starts: (usize, usize),
    /// Standard deviations by which it moved as decays were read the last time.
    pub(super) unrest: f64,
    /// How decays went into it.
    pub(super) in_time: InTime,
    /// The law that explains best what was read of decays, where no motion of it leaves noise, and this one was taken instead.
    pub(super) instead_of: Option<TermSet>,
    /// Highest harmonic of the relative motion in `fit`.
    pub(super) harmonics: usize,
    /// Backbones and decays as they were fitted.
    pub(super) backbones: Vec<BackboneRun>,
    /// By how much the deviation of each unknown, as it is searched, has to be raised.
    pub(super) raised: Vec<f64>,
}

impl Candidate {
    /// The model that was fitted.
    pub(super) fn model(&self, study: &LapResponseStudy) -> Model {
        Model {
            harmonics: self.harmonics,
            ..study.model(&self.terms)
        }
    }

    /// Schwarz's criterion: −2 ln L + p ln n; a limit takes an unknown away.
    fn bic(&self, is_stated: bool) -> f64 {
        let count = (self.fit.degrees_of_freedom + self.fit.information.nrows()) as f64;
        let unknowns = self.fit.information.nrows() - self.fit.at_limits.len();
        deviance(&self.fit, is_stated) + unknowns as f64 * count.ln()
    }
}

/// By how much −2 ln L of the passive estimate is above that of the free one.
pub(super) fn price(fit: &Fit, free: Option<&Fit>, is_stated: bool) -> f64 {
    free.map_or(0.0, |free| {
        (deviance(fit, is_stated) - deviance(free, is_stated)).max(0.0)
    })
}

/// −2 ln L = χ², or n ln(χ²/n) where the level of the noise is estimated, too.
fn deviance(fit: &Fit, is_stated: bool) -> f64 {
    let count = (fit.degrees_of_freedom + fit.information.nrows()) as f64;
    match is_stated {
        true => fit.chi_squared,
        false => count * (fit.chi_squared / count).ln(),
    }
}

/// Fits every candidate. The best by Schwarz's criterion comes first in what is returned, the comparison is in the candidates'
/// order.
pub(super) fn choose(
    study: &LapResponseStudy,
) -> Result<(Candidate, Vec<ModelComparison>), LapError> {
    let runs: Vec<&SineRun> = study
        .sines
        .iter()
        .filter(|run| run.used_for == Use::Fit)
        .collect();
    let backbones = fitted_backbones(study);
    // The study's own choice counts, but all are compared, unless the study wants none of that.
    let mut all = match study.compare {
        true => TermSet::candidates(),
        false => Vec::new(),
    };
    if let Some(own) = study.terms.as_ref().filter(|own| !all.contains(own)) {
        all.push(own.clone());
    }
    let mut candidates = Vec::new();
    let mut failure = None;
    let (count, weight) = (all.len(), all.iter().map(TermSet::effort).sum());
    let step = step("laws", Pieces::Weighed { count, weight });
    let fitted = parallel::map_each(all, |terms| {
        let effort = terms.effort();
        let own = candidate(study, &runs, &backbones, terms);
        let own = own.map(|own| at_kinks(study, own));
        step.done_weighing(effort);
        own
    });
    drop(step);
    for fitted in fitted {
        match fitted {
            Ok(candidate) => candidates.push(candidate),
            Err(error) => failure = Some(failure.unwrap_or(error)),
        }
    }
    let bic = |candidate: &Candidate| candidate.bic(study.noise.is_stated);
    let least = candidates.iter().map(bic).fold(f64::INFINITY, f64::min);
    let comparison = candidates.iter().map(|candidate| ModelComparison {
        terms: candidate.terms.clone(),
        unknowns: candidate.fit.information.nrows() - candidate.fit.at_limits.len(),
        reduced_chi_squared: candidate.fit.chi_squared
            / candidate.fit.degrees_of_freedom.max(1) as f64,
        bic_difference: bic(candidate) - least,
        is_passive: candidate.free.is_none(),
        price: price(
            &candidate.fit,
            candidate.free.as_ref(),
            study.noise.is_stated,
        ),
        held: candidate.fit.at_limits.iter().map(|at| at.limit).collect(),
    });
    let comparison: Vec<ModelComparison> = comparison.collect();
    candidates.sort_by(|one, other| bic(one).total_cmp(&bic(other)));
    let chosen = match &study.terms {
        Some(own) => candidates.iter().position(|one| one.terms == *own),
        None => (!candidates.is_empty()).then_some(0),
    };
    match chosen.map(|place| candidates.remove(place)) {
        Some(chosen) => {
            let read = read_to_the_end(study, chosen, &runs);
            let found = in_time(study, refined(study, read, &runs), true);
            let is_lost = matches!(&found.in_time, InTime::Read(reason) if reason.is_of_law());
            let other = match is_lost && study.terms.is_none() {
                true => of_another_law(study, &found.terms, candidates),
                false => None,
            };
            Ok((other.unwrap_or(found), comparison))
        }
        None => {
            let reason = failure.unwrap_or(LapError::NoEstimate);
            Err(StudyError::model(&study.path, None, reason).into())
        }
    }
}

/// The candidate with decays that are read as its own would be.
fn read_to_the_end(study: &LapResponseStudy, candidate: Candidate, runs: &[&SineRun]) -> Candidate {
    let measured = fitted_backbones(study);
    if measured.iter().all(|run| run.errors.is_none()) {
        return candidate;
    }
    let model = candidate.model(study);
    let lines: Vec<SineLine> = runs.iter().flat_map(|run| run.lines.clone()).collect();
    let mut found = candidate;
    let mut moved_by = f64::INFINITY;
    let step = step("readings of decays", Pieces::AtMost(MOST_READINGS));
    for _ in 0..MOST_READINGS {
        let near = |run: &BackboneRun| match moved_by < NEAR {
            true => run.following.clone(),
            false => None,
        };
        let near: Vec<Option<Following>> = found.backbones.iter().map(near).collect();
        let read = measured.iter().enumerate().map(|(number, run)| {
            let near = near.get(number).and_then(Option::as_ref);
            followed(&model, &found.fit, run, near)
        });
        let read: Vec<BackboneRun> = read.collect();
        let backbones: Vec<&BackboneRun> = read.iter().collect();
        let data = Data {
            lines: &lines,
            backbones: &backbones,
        };
        let before = found.fit.values;
        let again = |kind| fit::fit_near(&model, data, &study.noise, &found.fit, kind);
        let Ok(fit) = again(Kind::Passive) else {
            return found;
        };
        let free = match fit.at_limits.is_empty() {
            true => None,
            false => again(Kind::Free).ok(),
        };
        let moved = model.change(&before, &fit.values);
        let moved = moved.dot(&(&fit.information * &moved));
        moved_by = moved.max(0.0).sqrt();
        found.unrest = moved_by;
        found.free = free.filter(|free| free.chi_squared < fit.chi_squared);
        found.fit = fit;
        found.backbones = read;
        step.done();
        if moved < READ * READ {
            break;
        }
    }
    found
}

/// The candidate fitted to the samples of decays, where what it leaves of them is noise.
fn in_time(study: &LapResponseStudy, candidate: Candidate, is_first: bool) -> Candidate {
    let measured = fitted_backbones(study);
    if measured.iter().all(|run| run.recorded.is_none()) {
        return candidate;
    }
    let _step = step("samples of decays", Pieces::Unknown);
    let model = candidate.model(study);
    // where reading came to nothing one of the fits before may be nearer
    let read = [&candidate.fit, &candidate.corrected, &candidate.first];
    // one search alone says nothing of whether there is a better estimate; two over the samples, from starts apart, do
    let is_alone = candidate.starts.0 >= FEW_STARTS && candidate.starts.1 < 2;
    let effort = match is_first {
        true => Effort::Whole { confirm: is_alone },
        false => Effort::Shared,
    };
    match fitted((study, &model), &read, &measured, effort) {
        Ok(found) => Candidate {
            starts: match is_alone && found.searches.1 > 1 {
                true => found.searches,
                false => candidate.starts,
            },
            fit: found.fit,
            free: found.free,
            unrest: found.moved,
            in_time: InTime::Fitted,
            backbones: found.runs,
            ..candidate
        },
        Err(reason) => Candidate {
            in_time: InTime::Read(reason),
            ..candidate
        },
    }
}

/// The candidate whose motion follows the samples of decays best, where that of the first one does not: what is read of them
/// leaves out what happens before the first point, and tells laws apart that little.
fn of_another_law(
    study: &LapResponseStudy,
    first: &TermSet,
    others: Vec<Candidate>,
) -> Option<Candidate> {
    let (with_slider, polynomials): (Vec<Candidate>, Vec<Candidate>) = others
        .into_iter()
        .partition(|one| one.terms.slider().is_some());
    let (alone, beside): (Vec<Candidate>, Vec<Candidate>) = with_slider
        .into_iter()
        .partition(|one| one.terms.terms().is_empty());
    let likely = polynomials.into_iter().take(MOST_POLYNOMIALS).chain(alone);
    let of_samples = |candidate: &Candidate| candidate.bic(study.noise.is_stated);
    let best = |candidates: Vec<Candidate>| {
        let step = step("laws on samples", Pieces::Exactly(candidates.len()));
        let fitted = parallel::map_each(candidates, |one| {
            let own = in_time(study, one, false);
            step.done();
            own
        });
        let fitted = fitted.into_iter();
        let fitted = fitted.filter(|one| one.in_time == InTime::Fitted);
        fitted.min_by(|one, other| of_samples(one).total_cmp(&of_samples(other)))
    };
    let found = best(likely.collect()).or_else(|| best(beside))?;
    Some(Candidate {
        instead_of: Some(first.clone()),
        ..found
    })
}

/// The candidate with all harmonics that the study asks for; with one where the law is not that of the data: no other harmonic mends
/// that, and its motions far from what was measured may take minutes to balance.
fn refined(study: &LapResponseStudy, candidate: Candidate, runs: &[&SineRun]) -> Candidate {
    let model = Model {
        harmonics: study.harmonics,
        ..candidate.model(study)
    };
    let lines: Vec<SineLine> = runs
        .iter()
        .flat_map(|run| run.lines.iter().copied())
        .collect();
    let is_wrong = candidate.fit.reduced_chi_squared() > ABSURD;
    if model.harmonics == 1 || lines.is_empty() || model.terms.slider().is_some() || is_wrong {
        return candidate;
    }
    let _step = step("harmonics", Pieces::Unknown);
    let backbones = candidate.backbones.clone();
    let backbones: Vec<&BackboneRun> = backbones.iter().collect();
    let data = Data {
        lines: &lines,
        backbones: &backbones,
    };
    let again = |fitted: &Fit, kind| fit::fit(&model, data, &study.noise, fitted, kind);
    let Ok(fit) = again(&candidate.fit, Kind::Passive) else {
        // That of one harmonic stands, and the user is told.
        return candidate;
    };
    let from = candidate.free.as_ref().unwrap_or(&fit);
    let free = match fit.at_limits.is_empty() {
        true => None,
        false => again(from, Kind::Free).ok(),
    };
    Candidate {
        free: free.filter(|free| free.chi_squared < fit.chi_squared),
        fit,
        harmonics: model.harmonics,
        ..candidate
    }
}

/// All backbones and decays that go into the estimate.
fn fitted_backbones(study: &LapResponseStudy) -> Vec<&BackboneRun> {
    let runs = study.backbones.iter();
    runs.filter(|run| run.used_for == Use::Fit).collect()
}

fn candidate(
    study: &LapResponseStudy,
    runs: &[&SineRun],
    backbones: &[&BackboneRun],
    terms: TermSet,
) -> Result<Candidate, LapError> {
    // All models are compared in the closed form of one harmonic.
    let model = Model {
        harmonics: 1,
        ..study.model(&terms)
    };
    let (noise, known) = (&study.noise, study.known_values());
    let (mut fit, followed, agreeing) =
        start::best(&model, runs, backbones, noise, &known, Kind::Passive)?;
    let first = fit.clone();
    let lines: Vec<SineLine> = runs.iter().flat_map(|run| run.lines.clone()).collect();
    let mut own: Vec<BackboneRun> = backbones.iter().map(|run| (*run).clone()).collect();
    for _ in 0..READINGS {
        if backbones.iter().all(|run| run.errors.is_none()) {
            break;
        }
        let runs = backbones.iter();
        own = runs
            .map(|run| corrected(&model, &fit.values, run))
            .collect();
        let read: Vec<&BackboneRun> = own.iter().collect();
        let data = Data {
            lines: &lines,
            backbones: &read,
        };
        fit = fit::fit_near(&model, data, noise, &fit, Kind::Passive)?;
    }
    let read: Vec<&BackboneRun> = own.iter().collect();
    // where no limit holds the passive estimate it is the free one, else the free one is downhill from it
    let free = match fit.at_limits.is_empty() {
        true => None,
        false => {
            let data = Data {
                lines: &lines,
                backbones: &read,
            };
            let free = fit::fit(&model, data, noise, &fit, Kind::Free).ok();
            free.filter(|free| free.chi_squared < fit.chi_squared)
        }
    };
    Ok(Candidate {
        harmonics: 1,
        instead_of: None,
        terms,
        first,
        corrected: fit.clone(),
        fit,
        free,
        starts: (followed, agreeing),
        unrest: 0.0,
        in_time: InTime::NoDecay,
        backbones: own,
        raised: vec![1.0; model.unknowns.len()],
    })
}
