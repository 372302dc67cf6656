//! Which terms the data call for, by likelihood.

use bolted_joint_dynamics::Linear;
use serde::Serialize;

use super::backbone::BackboneLine;
use super::data::{SineLine, SineRun, Use};
use super::fit::{Data, Fit, fit};
use super::model::{Model, ResponseUnknown};
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
    /// Whether the joint takes energy at every amplitude that was fitted.
    pub is_passive: bool,
    /// Unknowns that are held at zero, since they would be negative.
    pub held: Vec<ResponseUnknown>,
}

/// A fitted candidate.
pub(super) struct Candidate {
    pub(super) terms: TermSet,
    pub(super) fit: Fit,
    pub(super) starts: (usize, usize),
    /// Highest harmonic of the relative motion in `fit`.
    pub(super) harmonics: usize,
    is_passive: bool,
    held: Vec<ResponseUnknown>,
    bic: f64,
}

impl Candidate {
    /// The model that was fitted.
    pub(super) fn model(&self, study: &LapResponseStudy) -> Model {
        let mut model = study.model(&self.terms);
        model
            .unknowns
            .retain(|unknown| !self.held.contains(unknown));
        Model {
            harmonics: self.harmonics,
            ..model
        }
    }
}

/// Fits every candidate. The best by Schwarz's criterion of those that are passive, if one is, comes first in what is returned, the
/// comparison is in the candidates' order.
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
        is_passive: candidate.is_passive,
        held: candidate.held.clone(),
    });
    let comparison: Vec<ModelComparison> = comparison.collect();
    let any_is_passive = candidates.iter().any(|candidate| candidate.is_passive);
    let chosen = match &study.terms {
        Some(own) => candidates.into_iter().find(|one| one.terms == *own),
        None => candidates
            .into_iter()
            .filter(|one| one.is_passive || !any_is_passive)
            .min_by(|one, other| one.bic.total_cmp(&other.bic)),
    };
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
    let model = Model {
        harmonics: study.harmonics,
        ..candidate.model(study)
    };
    let lines: Vec<SineLine> = runs
        .iter()
        .flat_map(|run| run.lines.iter().copied())
        .collect();
    if model.harmonics == 1 || lines.is_empty() || model.terms.slider().is_some() {
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

/// Whether the joint takes energy up to the largest amplitude that was fitted.
fn is_passive(fit: &Fit, backbone: &[BackboneLine]) -> bool {
    let values = &fit.values;
    let law = Linear {
        stiffness: [[values.joint_stiffness]],
        damping: [[values.joint_damping]],
    }
    .beside([values.terms]);
    let largest = fit.largest_amplitude_m(backbone);
    let [active] = law.active_amplitude();
    values.joint_stiffness >= 0.0 && active.is_none_or(|from| from >= largest)
}

fn candidate(
    study: &LapResponseStudy,
    runs: &[&SineRun],
    backbone: &[BackboneLine],
    terms: TermSet,
) -> Result<Candidate, LapError> {
    // All models are compared in the closed form of one harmonic.
    let mut model = Model {
        harmonics: 1,
        ..study.model(&terms)
    };
    let known = study.known_values();
    let find = |model: &Model| start::best(model, runs, backbone, &study.noise, &known);
    let (mut fit, mut tried, mut agreeing) = find(&model)?;
    let mut held = Vec::new();
    // beside a law that slips no damper is needed; one that pushes is none
    if terms.slider().is_some() && fit.values.joint_damping < 0.0 {
        held.push(ResponseUnknown::JointDamping);
        model.unknowns.retain(|unknown| !held.contains(unknown));
        (fit, tried, agreeing) = find(&model)?;
    }
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
        is_passive: is_passive(&fit, backbone),
        held,
        terms,
        bic: deviance + unknowns as f64 * count.ln(),
        fit,
        starts: (tried, agreeing),
    })
}
