//! The identified lap model: its unknowns with intervals, which of them the data determine, and how it does on every run.

use std::f64::consts::TAU;

use bolted_joint_statistics::{NORMAL_975, student_975};
use nalgebra::DMatrix;
use num_complex::Complex64;
use serde::Serialize;

use super::super::input;
use super::choice::{self, ModelComparison};
use super::data::{SineRun, Use};
use super::decay::InTime;
use super::fit::Fit;
use super::model::{Model, Motion, ResponseUnknown, Values};
use super::odd::{self, Misfit};
use super::prediction::{
    BackbonePrediction, BetweenRuns, CurvePoint, NoInterval, Prediction, Spread, Unpredicted,
    own_curve,
};
use super::slider::{Slider, SliderParameter};
use super::study::LapResponseStudy;
use super::terms::TermSet;
use super::told::{Searched, by_searched};
use crate::error::LapError;
use bolted_joint_identify::Watch;
use bolted_joint_joint::Provenance;
use bolted_joint_study::Method;
use bolted_joint_wanted::{Pieces, step};

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
    /// One standard deviation, of the free estimate; infinite where the data say nothing of it.
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
    /// Covariance of the unknowns, about those that the data say nothing of as if these were known.
    pub covariance: DMatrix<f64>,
    /// Half an interval of 95 % in standard deviations.
    pub(super) quantile: f64,
    /// By how much the standard deviations were raised because the residual is larger than the stated noise, or the factor that makes
    /// the nominal noise that of the residual.
    pub inflation: f64,
    /// Models beside each other.
    pub comparison: Vec<ModelComparison>,
    /// Searches that were followed to their end, and how many came to the same estimate.
    pub starts: (usize, usize),
    /// Standard deviations by which the estimate still moved as decays were read anew the last time.
    pub(super) unrest: f64,
    /// What may be behind a residual that is no noise.
    pub(super) misfit: Misfit,
    /// How free decays went into the estimate.
    pub in_time: InTime,
    /// The law that explains best what was read of them, where another one was taken for their samples.
    pub(super) instead_of: Option<TermSet>,
    /// Resonances of all runs, measured and of the model.
    pub predictions: Vec<Prediction>,
    /// Runs that were left out and have no resonance.
    pub unpredicted: Vec<Unpredicted>,
    /// Backbones and free decays beside the model's.
    pub backbones: Vec<BackbonePrediction>,
    /// Frequency and damping of the model over the amplitudes at which stepped sines resonate.
    pub curve: Vec<CurvePoint>,
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
        let predicting = step("predictions of the runs", Pieces::Unknown);
        let model = chosen.model(study);
        let raised = chosen.raised;
        let (fit, free) = (chosen.fit, chosen.free);
        // Errors are those of the free estimate: what the limits add to the residual is no noise.
        let base = free.as_ref().unwrap_or(&fit);
        let factor = study.raised_by(base);
        let of_base = Searched::of(&model, base, factor).raised(&raised);
        let by_searched = by_searched(&model, &base.values);
        let covariance = &by_searched * &of_base.covariance * by_searched.transpose();
        let amplitude_m = fit.amplitude_m;
        let quantile = if study.noise.is_stated {
            NORMAL_975
        } else {
            student_975(fit.degrees_of_freedom)
        };
        let estimates = model.unknowns.iter().enumerate().map(|(place, &unknown)| {
            let (value, free_value) = (fit.values.of(unknown), base.values.of(unknown));
            let is_told = of_base.tells((place, unknown), &by_searched, free_value);
            let deviation = match is_told {
                true => covariance[(place, place)].sqrt(),
                false => f64::INFINITY,
            };
            let [low, high] = match unknown {
                _ if !is_told => [f64::NEG_INFINITY, f64::INFINITY],
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
        let of_fit = Searched::of(&model, &fit, factor).raised(&raised);
        let (predictions, unpredicted) =
            Prediction::of_all(&model, &fit, &study.sines, &of_fit.covariance);
        let spread = Spread {
            covariance: &of_fit.covariance,
            noise: &study.noise,
            factor,
            quantile,
        };
        let (of_backbones, between_runs) =
            BackbonePrediction::of_all(&model, &fit, &study.backbones, &spread);
        let resonating_m = predictions
            .iter()
            .filter(|row| row.motion == Motion::Relative)
            .map(|row| row.relative_m(&model, &fit.values));
        let smallest_m = resonating_m.fold(f64::INFINITY, f64::min);
        let curve = match smallest_m < amplitude_m {
            true => own_curve(&model, &fit, &spread, [smallest_m, amplitude_m]),
            false => Vec::new(),
        };
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
        let mut found = Self {
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
            unrest: chosen.unrest,
            misfit: Misfit::default(),
            in_time: chosen.in_time,
            instead_of: chosen.instead_of,
            predictions,
            unpredicted,
            backbones: of_backbones,
            curve,
            between_runs,
            amplitude_m,
        };
        drop(predicting);
        // what is left of samples is no measure of what is left of points
        if found.is_far_from_noise(study) && found.in_time != InTime::Fitted {
            let _step = step("causes of the misfit", Pieces::Unknown);
            let base = found.free.as_ref().unwrap_or(&found.fit);
            found.misfit = odd::misfit(study, &found.model, base);
        }
        Ok(found)
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

    /// Why runs have no interval that their resonance is expected in, a sentence for each reason.
    #[must_use]
    pub fn without_interval(&self) -> Vec<String> {
        let mut reasons: Vec<(NoInterval, Vec<String>)> = Vec::new();
        for row in &self.predictions {
            let Some(reason) = row.no_interval else {
                continue;
            };
            let run = self.named(row);
            match reasons.iter_mut().find(|(own, _)| *own == reason) {
                Some((_, runs)) => runs.push(run),
                None => reasons.push((reason, vec![run])),
            }
        }
        let all = self.predictions.len();
        let told = reasons
            .iter()
            .map(|(reason, runs)| match runs.len() == all {
                true => format!("No run has an interval: {reason}."),
                false => format!("No interval for {}: {reason}.", runs.join(", ")),
            });
        let unpredicted = self.unpredicted.iter();
        let of_others = unpredicted
            .map(|own| format!("No resonance of {} is predicted: {}.", own.run, own.reason));
        told.chain(of_others).collect()
    }

    /// A resonance in words: the run, and what resonates where that may be one of two motions.
    #[must_use]
    pub fn named(&self, row: &Prediction) -> String {
        match (self.model.sees_sum(), row.motion) {
            (false, _) => row.run.clone(),
            (true, Motion::Together) => format!("{}, both bodies together", row.run),
            (true, Motion::Relative) => format!("{}, relative motion", row.run),
        }
    }

    /// Amplitude of the relative motion (m) and frequency (Hz) of its measured resonances, in the order of amplitude.
    #[must_use]
    pub fn measured_backbone(&self) -> Vec<(f64, f64)> {
        let rows = self.predictions.iter();
        let relative = rows.filter(|row| row.motion == Motion::Relative);
        let mut points: Vec<(f64, f64)> = relative
            .map(|row| {
                let amplitude_m = row.relative_m(&self.model, &self.fit.values);
                (amplitude_m, row.measured.frequency_hz)
            })
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    }

    /// Damping ratios at the measured phase resonances, over the amplitude (m); none where the motion of both bodies together is seen,
    /// too.
    #[must_use]
    pub fn measured_damping(&self) -> Vec<(f64, f64)> {
        if self.model.sees_sum() {
            return Vec::new();
        }
        let rows = self.predictions.iter();
        let relative = rows.filter(|row| row.motion == Motion::Relative);
        let points = relative.map(|row| {
            let amplitude_m = row.relative_m(&self.model, &self.fit.values);
            // the force is all damping: Im z R = |d| F, ζ = Im z/(2 M ω²) with M = m/2
            let load_n = self.model.relative_load().abs() * row.measured.force_n;
            let omega = TAU * row.measured.frequency_hz;
            let ratio = load_n / amplitude_m / (self.fit.values.mass * omega * omega);
            (amplitude_m, ratio)
        });
        let mut points: Vec<(f64, f64)> = points.collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    }

    /// How free decays went into the estimate, in a sentence; `None` where none did.
    #[must_use]
    pub fn of_decays(&self) -> Option<String> {
        match &self.in_time {
            InTime::NoDecay => None,
            InTime::Fitted => {
                let compared = match self.comparison.len() > 1 {
                    true => {
                        " Models are compared by what is read of them over ten half-periods at a time."
                    }
                    false => "",
                };
                let instead = self.instead_of.as_ref().map_or_else(String::new, |first| {
                    format!(
                        " That fits \"{first}\" best, of which no motion follows the samples; what \"{}\" leaves of them is noise.",
                        self.model.terms
                    )
                });
                Some(format!(
                    "Decays are fitted sample by sample.{compared}{instead}"
                ))
            }
            InTime::Read(reason) => Some(format!(
                "Decays are fitted as they are read, not sample by sample: {reason}."
            )),
        }
    }

    /// The standard deviation of an unknown; zero of what is known, and of what the data say nothing of.
    #[must_use]
    pub fn deviation(&self, unknown: ResponseUnknown) -> f64 {
        let mut estimates = self.estimates.iter();
        let deviation = estimates.find(|own| own.unknown == unknown);
        let deviation = deviation.map_or(0.0, |own| own.standard_deviation);
        if deviation.is_finite() {
            deviation
        } else {
            0.0
        }
    }
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
    let size = match unknown {
        // from −1 on: zero is a value like others
        ResponseUnknown::Slider(SliderParameter::Exponent) => values.of(unknown) + 1.0,
        _ => values.of(unknown).abs(),
    };
    deviation <= size.max(negligible)
}
