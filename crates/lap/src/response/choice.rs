//! Which terms the data call for, by likelihood.

use serde::Serialize;

use super::backbone::BackboneLine;
use super::data::{SineLine, SineRun, Use};
use super::fit::{Data, Fit, fit};
use super::model::Model;
use super::start;
use super::study::LapResponseStudy;
use super::terms::TermSet;
use crate::error::LapError;
use bolted_joint_study::StudyError;

/// A model beside the others.
#[derive(Clone, Debug, Serialize)]
pub struct ModelComparison {
    /// Its terms.
    pub terms: TermSet,
    /// Number of its unknowns.
    pub unknowns: usize,
    /// χ² per degree of freedom with the stated noise, or with 1 % where none is stated.
    pub reduced_chi_squared: f64,
    /// Schwarz's criterion less that of the best.
    pub bic_difference: f64,
}

/// A fitted candidate.
pub(super) struct Candidate {
    pub(super) terms: TermSet,
    pub(super) fit: Fit,
    pub(super) starts: (usize, usize),
    /// Highest harmonic of the relative motion in `fit`.
    pub(super) harmonics: usize,
    bic: f64,
}

/// Fits every candidate. The best by Schwarz's criterion comes first in what is returned, the comparison is in the candidates' order.
pub(super) fn choose(
    study: &LapResponseStudy,
) -> Result<(Candidate, Vec<ModelComparison>), LapError> {
    let runs: Vec<&SineRun> = study
        .sines
        .iter()
        .filter(|run| run.used_for == Use::Fit)
        .collect();
    let backbone = fitted_backbone(study);
    // The study's own choice counts, but all are compared.
    let mut all = TermSet::candidates();
    if let Some(own) = study.terms.as_ref().filter(|own| !all.contains(own)) {
        all.push(own.clone());
    }
    let mut candidates = Vec::new();
    let mut failure = None;
    for terms in all {
        match candidate(study, &runs, &backbone, terms) {
            Ok(candidate) => candidates.push(candidate),
            Err(error) => failure = Some(failure.unwrap_or(error)),
        }
    }
    let least = candidates
        .iter()
        .map(|candidate| candidate.bic)
        .fold(f64::INFINITY, f64::min);
    let comparison = candidates.iter().map(|candidate| ModelComparison {
        terms: candidate.terms.clone(),
        unknowns: candidate.fit.information.nrows(),
        reduced_chi_squared: candidate.fit.chi_squared
            / candidate.fit.degrees_of_freedom.max(1) as f64,
        bic_difference: candidate.bic - least,
    });
    let comparison: Vec<ModelComparison> = comparison.collect();
    let chosen = candidates.into_iter().find(|candidate| match &study.terms {
        Some(own) => candidate.terms == *own,
        None => candidate.bic == least,
    });
    match chosen {
        Some(chosen) => Ok((refined(study, chosen, &runs, &backbone), comparison)),
        None => {
            let reason = failure.unwrap_or(LapError::NoEstimate);
            Err(StudyError::model(&study.path, None, reason).into())
        }
    }
}

/// The candidate with all harmonics that the study asks for.
fn refined(
    study: &LapResponseStudy,
    candidate: Candidate,
    runs: &[&SineRun],
    backbone: &[BackboneLine],
) -> Candidate {
    let model = study.model(&candidate.terms);
    let lines: Vec<SineLine> = runs
        .iter()
        .flat_map(|run| run.lines.iter().copied())
        .collect();
    if model.harmonics == 1 || lines.is_empty() {
        return candidate;
    }
    let data = Data {
        lines: &lines,
        backbone,
    };
    match fit(&model, data, &study.noise, &candidate.fit.values) {
        Ok(fit) => Candidate {
            fit,
            harmonics: model.harmonics,
            ..candidate
        },
        // That of one harmonic stands, and the user is told.
        Err(_) => candidate,
    }
}

/// Points of all backbones that go into the estimate.
pub(super) fn fitted_backbone(study: &LapResponseStudy) -> Vec<BackboneLine> {
    let runs = study
        .backbones
        .iter()
        .filter(|run| run.used_for == Use::Fit);
    runs.flat_map(|run| run.lines.iter().copied()).collect()
}

fn candidate(
    study: &LapResponseStudy,
    runs: &[&SineRun],
    backbone: &[BackboneLine],
    terms: TermSet,
) -> Result<Candidate, LapError> {
    // All models are compared in the closed form of one harmonic.
    let model = Model {
        harmonics: 1,
        ..study.model(&terms)
    };
    let (fit, tried, agreeing) =
        start::best(&model, runs, backbone, &study.noise, &study.known_values())?;
    let unknowns = fit.information.nrows();
    let count = (fit.degrees_of_freedom + unknowns) as f64;
    // −2 ln L = χ², or n ln(χ²/n) where the level of the noise is estimated, too; Schwarz adds p ln n.
    let deviance = if study.noise.is_stated {
        fit.chi_squared
    } else {
        count * (fit.chi_squared / count).ln()
    };
    Ok(Candidate {
        harmonics: 1,
        terms,
        bic: deviance + unknowns as f64 * count.ln(),
        fit,
        starts: (tried, agreeing),
    })
}
