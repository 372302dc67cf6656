//! The identified lap model: its unknowns with intervals, which of them the data determine, and how it does on every run.

use bolted_joint_statistics::{NORMAL_975, student_975};
use nalgebra::DMatrix;
use num_complex::Complex64;
use serde::Serialize;

use super::super::input;
use super::choice::{self, ModelComparison};
use super::data::{SineRun, Use};
use super::fit::Fit;
use super::model::{Model, ResponseUnknown, Values};
use super::prediction::{BackbonePrediction, BetweenRuns, Prediction, Spread};
use super::slider::{Slider, SliderParameter};
use super::study::LapResponseStudy;
use crate::error::LapError;
use bolted_joint_identify::Watch;
use bolted_joint_identify::unit_covariance;
use bolted_joint_joint::Provenance;
use bolted_joint_study::Method;

/// Share of the linear stiffness or damping that a term's standard deviation may be at the largest amplitude for the term to count as
/// determined although it may be zero.
const NEGLIGIBLE: f64 = 0.01;

/// An unknown with what is known of it.
#[derive(Clone, Debug, Serialize)]
pub struct Estimate {
    /// Which.
    pub unknown: ResponseUnknown,
    /// Its value in its SI unit.
    pub value: f64,
    /// The value that it has where the joint is free to be active; the same where it need not be.
    pub free_value: f64,
    /// One standard deviation, of the free estimate.
    pub standard_deviation: f64,
    /// Interval of 95 %: that of the free estimate, extended to the passive one where that lies beyond it.
    pub interval_95: [f64; 2],
    /// Whether the data determine it.
    pub is_identified: bool,
}

/// A lap model identified from responses.
#[derive(Clone, Debug)]
pub struct LapResponse {
    /// Name of the joint.
    pub name: String,
    /// The model.
    pub model: Model,
    /// The fit, of a joint that is passive.
    pub fit: Fit,
    /// The fit that is free to be active, where it is.
    pub free: Option<Fit>,
    /// By how much −2 ln L of the passive fit is above that of the free one.
    pub price: f64,
    /// The unknowns.
    pub estimates: Vec<Estimate>,
    /// Covariance of the unknowns.
    pub covariance: DMatrix<f64>,
    /// Half an interval of 95 % in standard deviations.
    pub(super) quantile: f64,
    /// By how much the standard deviations were raised because the residual is larger than the stated noise, or the factor that makes
    /// the nominal noise that of the residual.
    pub inflation: f64,
    /// Models beside each other.
    pub comparison: Vec<ModelComparison>,
    /// Starts tried, and how many came to the same estimate.
    pub starts: (usize, usize),
    /// Resonances of all runs, measured and of the model.
    pub predictions: Vec<Prediction>,
    /// Backbones and free decays beside the model's.
    pub backbones: Vec<BackbonePrediction>,
    /// What those that were fitted differ by as a whole; `None` where fewer than two tell it.
    pub between_runs: Option<BetweenRuns>,
    /// Largest amplitude of the relative motion that was fitted, m.
    pub amplitude_m: f64,
    /// Where the joint comes from.
    pub provenance: Provenance,
}

impl LapResponse {
    /// Identifies the study's lap model.
    ///
    /// # Errors
    /// [`LapError`] if the data determine no model, or if a file has vanished meanwhile.
    pub fn of(study: &LapResponseStudy, watch: &dyn Watch) -> Result<Self, LapError> {
        let (chosen, comparison) = choice::choose(study)?;
        let model = chosen.model(study);
        let (fit, free) = (chosen.fit, chosen.free);
        // Errors are those of the free estimate: what the limits add to the residual is no noise.
        let base = free.as_ref().unwrap_or(&fit);
        let reduced = base.reduced_chi_squared();
        let factor = if study.noise.is_stated {
            reduced.max(1.0)
        } else {
            reduced
        };
        // The covariance of χ²'s information is its inverse; the function gives half of it.
        let searched = |fit: &Fit| 2.0 * factor * unit_covariance(&fit.information);
        let by_searched = by_searched(&model, &base.values);
        let covariance = &by_searched * searched(base) * by_searched.transpose();
        let amplitude_m = fit.amplitude_m;
        let quantile = if study.noise.is_stated {
            NORMAL_975
        } else {
            student_975(fit.degrees_of_freedom)
        };
        let estimates = model.unknowns.iter().enumerate().map(|(place, &unknown)| {
            let (value, free_value) = (fit.values.of(unknown), base.values.of(unknown));
            let deviation = covariance[(place, place)].sqrt();
            let [low, high] = match unknown {
                // positive by their nature, and searched as logarithms
                ResponseUnknown::Slider(parameter) if parameter != SliderParameter::Exponent => {
                    let factor = (quantile * deviation / free_value).exp();
                    [free_value / factor, free_value * factor]
                }
                _ => [-1.0, 1.0].map(|side| free_value + side * quantile * deviation),
            };
            // a value at its limit is known by that
            let is_held = fit.is_held(place) && value == 0.0;
            Estimate {
                unknown,
                value,
                free_value,
                standard_deviation: deviation,
                interval_95: [low.min(value), high.max(value)],
                is_identified: is_held
                    || is_identified(unknown, deviation, &fit.values, amplitude_m),
            }
        });
        let estimates = estimates.collect();
        let predictions = match model.sees_sum() {
            true => Vec::new(),
            false => Prediction::of_all(&model, &fit, &study.sines, &searched(&fit)),
        };
        let spread = Spread {
            covariance: &searched(&fit),
            noise: &study.noise,
            factor,
            quantile,
        };
        let (of_backbones, between_runs) =
            BackbonePrediction::of_all(&model, &fit, &study.backbones, &spread);
        let role = |used: Use, what: &str| match used {
            Use::Fit => what.to_owned(),
            Use::Predict => format!("{what}, predicted"),
        };
        let sines = study
            .sines
            .iter()
            .map(|run| (role(run.used_for, "stepped sine"), run.path.clone()));
        let backbones = study
            .backbones
            .iter()
            .map(|run| (role(run.used_for, "backbone"), run.path.clone()));
        let files: Vec<_> = sines.chain(backbones).collect();
        Ok(Self {
            name: study.name.clone(),
            provenance: input::origin(
                Method::LapResponse,
                &chosen.terms.to_string(),
                &study.path,
                &files,
                study.notes.clone(),
                watch,
            )?,
            price: choice::price(&fit, free.as_ref(), study.noise.is_stated),
            model,
            fit,
            free,
            estimates,
            covariance,
            quantile,
            inflation: factor.sqrt(),
            comparison,
            starts: chosen.starts,
            predictions,
            backbones: of_backbones,
            between_runs,
            amplitude_m,
        })
    }

    /// The receptance of the model at the lines of a run, at the relative amplitudes that its measured responses mean.
    #[must_use]
    pub fn regenerated(&self, run: &SineRun) -> Vec<Complex64> {
        let values = &self.fit.values;
        let lines = run.lines.iter().map(|line| {
            let amplitude = self.model.relative_amplitude(values, line);
            self.model.receptance(values, amplitude, line.omega).0
        });
        lines.collect()
    }

    /// The symbols of the unknowns that the data do not determine.
    #[must_use]
    pub fn not_identified(&self) -> Vec<&'static str> {
        let open = self
            .estimates
            .iter()
            .filter(|estimate| !estimate.is_identified);
        // nothing slips through: the file has to have numbers for these
        let is_small = self.model.terms.slider() == Some(Slider::MicroSlip);
        let never_told = if is_small {
            &[SliderParameter::SlipForce, SliderParameter::Ratio][..]
        } else {
            &[]
        };
        let symbols = open.map(|estimate| estimate.unknown.symbol());
        let never_told = never_told.iter().map(|parameter| parameter.symbol());
        symbols.chain(never_told).collect()
    }

    /// The standard deviation of an unknown; zero of what is known.
    #[must_use]
    pub fn deviation(&self, unknown: ResponseUnknown) -> f64 {
        let mut estimates = self.estimates.iter();
        let found = estimates.find(|estimate| estimate.unknown == unknown);
        found.map_or(0.0, |estimate| estimate.standard_deviation)
    }
}

/// Derivatives of the unknowns as they are told (rows) by those that are searched, which are logarithms of a law that slips.
fn by_searched(model: &Model, values: &Values) -> DMatrix<f64> {
    let size = model.unknowns.len();
    let mut by = DMatrix::identity(size, size);
    let Some(slider) = &values.slider else {
        return by;
    };
    let own = slider.parameters();
    let index = |unknown: &ResponseUnknown| match unknown {
        ResponseUnknown::Slider(parameter) => slider.index(*parameter),
        _ => None,
    };
    for (row, unknown) in model.unknowns.iter().enumerate() {
        let Some(told) = index(unknown) else {
            continue;
        };
        for (column, searched) in model.unknowns.iter().enumerate() {
            if let Some(searched) = index(searched) {
                by[(row, column)] = own[told].1[searched];
            }
        }
    }
    by
}

/// Known better than its own size, or so well that it has no visible effect if it is zero.
fn is_identified(
    unknown: ResponseUnknown,
    deviation: f64,
    values: &Values,
    amplitude_m: f64,
) -> bool {
    let negligible = match unknown {
        ResponseUnknown::Term(term) => {
            let linear = match term.is_damper() {
                false => 0.5 * values.support_stiffness + values.joint_stiffness,
                true => 0.5 * values.support_damping + values.joint_damping,
            };
            NEGLIGIBLE * linear / (term.describing() * amplitude_m.powi(term.amplitude_power()))
        }
        _ => 0.0,
    };
    deviation <= values.of(unknown).abs().max(negligible)
}
