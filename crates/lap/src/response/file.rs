//! The joint file of a lap model identified from responses.

use std::f64::consts::TAU;

use bolted_joint_dynamics::law::Term;
use nalgebra::DVector;
use num_complex::Complex64;

use super::data::{SineRun, Use};
use super::decay::InTime;
use super::model::{ResponseUnknown, Values};
use super::prediction::Expected;
use super::result::{Estimate, LapResponse};
use super::slider::SliderParameter;
use super::study::{LapResponseStudy, NoiseIs};
use super::warnings::NO_CURE;
use bolted_joint_joint::{
    Bodies, Body, Correlation, DofSet, Format, FreeEstimate, Friction, FunctionResidual,
    HigherTerms, Intervals, Joint, JointFile, NoiseRecord, Residual, StandardDeviation, Status,
    Uncertainty, Validity,
};

impl LapResponse {
    /// The joint file: law, bodies, uncertainty, amplitudes that it holds for.
    #[must_use]
    pub fn joint_file(&self, study: &LapResponseStudy) -> JointFile {
        let values = &self.fit.values;
        let higher = HigherTerms::of(&[values.terms], vec![self.amplitude_m]);
        let mut terms = self.model.terms.terms().iter();
        let has_higher = terms.any(|term| *term != Term::CUBIC) || values.slider.is_some();
        let linear = Joint::linear(
            DofSet::TRANSLATION,
            vec![vec![values.spring().max(0.0)]],
            vec![vec![values.joint_damping]],
        );
        let friction = self.friction(|own| own);
        let body = Body {
            inertia: vec![values.mass],
            stiffness: vec![values.support_stiffness.max(0.0)],
            damping: vec![values.support_damping.max(0.0)],
        };
        JointFile {
            about: None,
            format: Format::V1,
            name: self.name.clone(),
            status: Status::against(&self.reasons_against(study)),
            joint: Joint {
                cubic: vec![values.term(Term::CUBIC)],
                higher: has_higher.then_some(higher),
                friction: friction.into_iter().collect(),
                ..linear
            },
            bodies: Some(Bodies {
                a: body.clone(),
                b: body,
            }),
            uncertainty: self.uncertainty(study),
            validity: Some(self.validity(study)),
            residual: Some(self.residual(study)),
            provenance: Some(self.provenance.clone()),
        }
    }

    fn uncertainty(&self, study: &LapResponseStudy) -> Option<Uncertainty> {
        let linear = [
            ResponseUnknown::JointStiffness,
            ResponseUnknown::JointDamping,
        ];
        let is_silent =
            |own: &Estimate| linear.contains(&own.unknown) && !own.standard_deviation.is_finite();
        let is_finite = self.covariance.iter().all(|entry| entry.is_finite());
        if !is_finite || self.estimates.iter().any(is_silent) {
            return None;
        }
        let entry = |unknown| vec![vec![self.deviation(unknown)]];
        let interval = |unknown: ResponseUnknown| {
            let found = self
                .estimates
                .iter()
                .find(|estimate| estimate.unknown == unknown);
            let known = self.fit.values.of(unknown);
            vec![vec![
                found.map_or([known, known], |estimate| estimate.interval_95),
            ]]
        };
        let base = &self.free.as_ref().unwrap_or(&self.fit).values;
        let (stiffness, free) = (self.fit.values.spring().max(0.0), base.spring());
        let [deviation_of_stiffness, interval_of_stiffness] = self.stiffness_deviations(base);
        let [low, high] = [-1.0, 1.0].map(|side| free + side * interval_of_stiffness);
        let ends = [low.min(stiffness), high.max(stiffness)];
        let size = self.estimates.len();
        let deviation = self.covariance.diagonal().map(f64::sqrt);
        let correlation = |i: usize, j: usize| match deviation[i] * deviation[j] {
            _ if i == j => 1.0,
            // taken as known where the data say nothing of it
            0.0 => 0.0,
            both => (self.covariance[(i, j)] / both).clamp(-1.0, 1.0),
        };
        let noise = match study.noise_is() {
            NoiseIs::Stated => "the stated noise",
            NoiseIs::OfRecords => "the noise of the records",
            NoiseIs::Nominal => "the noise that the residual shows",
        };
        let raised = match study.knows_noise() && self.inflation > 1.0 {
            true => format!(", raised {:.2} times by the residual", self.inflation),
            false => String::new(),
        };
        let of_decays = match &self.in_time {
            InTime::NoDecay => String::new(),
            InTime::Fitted => ", decays sample by sample".to_owned(),
            InTime::Read(reason) => format!(", decays as they are read ({reason})"),
        };
        let no_cure = match self.is_far_from_noise(study) {
            true => format!("; {NO_CURE}"),
            false => String::new(),
        };
        let others = self.estimates.iter().map(|estimate| {
            let symbol = estimate.unknown.symbol();
            match estimate.standard_deviation.is_finite() {
                true => format!(
                    "{symbol} = {:.4e} ± {:.1e} {}",
                    estimate.value,
                    estimate.standard_deviation,
                    estimate.unknown.unit()
                ),
                false => format!("{symbol} = {:.4e}, not identified", estimate.value),
            }
        });
        Some(Uncertainty {
            standard_deviation: StandardDeviation {
                stiffness: vec![vec![deviation_of_stiffness]],
                damping: entry(ResponseUnknown::JointDamping),
                friction: self.friction_deviations(),
            },
            basis: format!(
                "information matrix of the maximum-likelihood estimate with {noise}{raised}{of_decays}{no_cure}; {}",
                others.collect::<Vec<_>>().join(", ")
            ),
            correlation: Some(Correlation {
                unknowns: self
                    .estimates
                    .iter()
                    .map(|estimate| estimate.unknown.symbol().to_owned())
                    .collect(),
                matrix: (0..size)
                    .map(|i| (0..size).map(|j| correlation(i, j)).collect())
                    .collect(),
            }),
            interval_95: Some(Intervals {
                stiffness: vec![vec![ends]],
                damping: interval(ResponseUnknown::JointDamping),
            }),
            inflation: (study.knows_noise() && self.inflation > 1.0).then_some(self.inflation),
            not_identified: self
                .not_identified()
                .into_iter()
                .map(str::to_owned)
                .collect(),
            free_estimate: self.free.as_ref().map(|free| FreeEstimate {
                stiffness: vec![vec![free.values.spring()]],
                damping: vec![vec![free.values.joint_damping]],
                unknowns: self.estimates.iter().map(|own| own.free_value).collect(),
                reduced_chi_squared: Some(free.reduced_chi_squared()),
                price: Some(self.price),
            }),
            ..Uncertainty::default()
        })
    }

    /// Deviations of the numbers of the law that slips, in place of these; 0 of those that the data do not tell.
    fn friction_deviations(&self) -> Vec<Friction> {
        let Some(slider) = self.fit.values.slider else {
            return Vec::new();
        };
        let deviation = |parameter: SliderParameter| match slider.index(parameter) {
            Some(_) => self.deviation(ResponseUnknown::Slider(parameter)),
            None if parameter == SliderParameter::Stiffness => {
                let by = slider.stiffness_by_parameters();
                let of = |unknown: ResponseUnknown| match unknown {
                    ResponseUnknown::Slider(own) => slider.index(own).map_or(0.0, |i| by[i]),
                    _ => 0.0,
                };
                let by = self.estimates.iter().map(|own| of(own.unknown));
                let by = DVector::from_iterator(self.estimates.len(), by);
                by.dot(&(&self.covariance * &by)).max(0.0).sqrt()
            }
            None => 0.0,
        };
        let parameters = slider.slider.in_file();
        let deviations = parameters.iter().map(|&own| deviation(own)).collect();
        self.friction(|_| deviations).into_iter().collect()
    }

    /// The law that slips as files have it, with numbers that stand in the place of its own.
    fn friction(&self, numbers: impl FnOnce(Vec<f64>) -> Vec<f64>) -> Option<Friction> {
        let (name, parameters) = self.fit.values.slider?.in_file();
        let law = Friction::laws().find(|law| law.name == name)?;
        Some(Friction {
            dof: DofSet::TRANSLATION.row(0),
            law,
            parameters: numbers(parameters),
        })
    }

    /// Standard deviation of the file's stiffness, which is less by that of a law that slips, and half its interval of 95 %. Where the
    /// data do not tell the law's part, it stands as the file has it.
    fn stiffness_deviations(&self, base: &Values) -> [f64; 2] {
        let slider = base.slider;
        let by = |own: &Estimate| match (own.unknown, slider) {
            (ResponseUnknown::JointStiffness, _) => 1.0,
            _ if !own.standard_deviation.is_finite() => 0.0,
            (ResponseUnknown::Slider(parameter), Some(slider)) => {
                let index = slider.index(parameter);
                index.map_or(0.0, |index| -slider.stiffness_by_parameters()[index])
            }
            _ => 0.0,
        };
        let by = DVector::from_iterator(self.estimates.len(), self.estimates.iter().map(by));
        let deviation = by.dot(&(&self.covariance * &by)).sqrt();
        [deviation, self.quantile * deviation]
    }

    fn residual(&self, study: &LapResponseStudy) -> Residual {
        let mut runs = self.run_residuals(study);
        let of_sines = runs.len();
        runs.extend(self.curve_residuals());
        let lines: usize = runs.iter().map(|(_, lines, _)| lines).sum();
        let squares: f64 = runs
            .iter()
            .map(|(_, lines, rms)| rms * rms * *lines as f64)
            .sum();
        let reduced = self.fit.reduced_chi_squared();
        let level = if study.noise.is_stated {
            1.0
        } else {
            self.inflation
        };
        Residual {
            relative_rms: (squares / lines.max(1) as f64).sqrt(),
            lines,
            functions: runs
                .into_iter()
                .enumerate()
                .map(|(place, (name, _, relative_rms))| FunctionResidual {
                    response: name,
                    reference: match place < of_sines {
                        true => "force".to_owned(),
                        false => "amplitude".to_owned(),
                    },
                    relative_rms,
                })
                .collect(),
            reduced_chi_squared: study.knows_noise().then_some(reduced),
            line_correlation: None,
            outliers: Vec::new(),
            lines_left_out: None,
            // that of receptances
            noise: (of_sines > 0).then(|| NoiseRecord {
                relative: study.noise.response.hypot(study.noise.force) * level,
                floor: 0.0,
                stated: study.noise.is_stated,
            }),
        }
    }

    /// The same of frequencies and damping ratios over the amplitude, of each curve in the estimate.
    fn curve_residuals(&self) -> Vec<(String, usize, f64)> {
        let runs = self.backbones.iter().filter(|run| !run.left_out);
        let both = runs.flat_map(|run| {
            let relative = |own: &Expected| own.measured / own.predicted - 1.0;
            let points = run.points.iter();
            let frequencies = points.clone().map(|point| relative(&point.frequency_hz));
            let ratios = points.filter_map(|point| Some(relative(point.damping_ratio.as_ref()?)));
            let kinds: [(&str, Vec<f64>); 2] = [
                ("frequency", frequencies.collect()),
                ("damping ratio", ratios.collect()),
            ];
            kinds.map(|(kind, errors)| {
                let squares: f64 = errors.iter().map(|error| error * error).sum();
                let count = errors.len();
                let rms = (squares / count.max(1) as f64).sqrt();
                (format!("{}, {kind}", run.run), count, rms)
            })
        });
        both.filter(|(_, count, _)| *count > 0).collect()
    }

    /// Name, lines and relative residual of the receptance at the fitted amplitudes, of each run in the estimate.
    #[must_use]
    pub fn run_residuals(&self, study: &LapResponseStudy) -> Vec<(String, usize, f64)> {
        let runs = study.sines.iter().filter(|run| run.used_for == Use::Fit);
        let residuals = runs.zip(self.receptance_residuals(study));
        let rms = residuals.map(|(run, residuals)| {
            let squares: f64 = residuals.iter().map(|own| own.norm_sqr()).sum();
            let count = residuals.len();
            (run.name.clone(), count, (squares / count as f64).sqrt())
        });
        rms.collect()
    }

    /// (measured − computed)/computed of the receptance at the fitted amplitudes, line by line of each sine in the estimate.
    fn receptance_residuals(&self, study: &LapResponseStudy) -> Vec<Vec<Complex64>> {
        let mut amplitudes = self.fit.amplitudes_m.iter();
        let runs = study.sines.iter().filter(|run| run.used_for == Use::Fit);
        let of_run = |run: &SineRun| {
            let lines = run.lines.iter().zip(amplitudes.by_ref());
            let residuals = lines.map(|(line, &amplitude)| {
                let values = &self.fit.values;
                let (computed, _) = self.model.receptance(values, amplitude, line.omega);
                let size = line.displacement_m / line.force_n;
                (Complex64::from_polar(size, line.phase_rad) - computed) / computed
            });
            residuals.collect()
        };
        runs.map(of_run).collect()
    }

    /// Residuals of what is fitted point by point, in the order of the points: receptances of each sine, frequencies of each
    /// backbone that is no decay, its damping ratios.
    pub(super) fn residuals_by_run(&self, study: &LapResponseStudy) -> Vec<Vec<Complex64>> {
        let mut all = self.receptance_residuals(study);
        let is_decay = |name: &str| {
            let mut runs = study.backbones.iter();
            runs.any(|run| run.name == name && run.recorded.is_some())
        };
        let runs = self.backbones.iter();
        for run in runs.filter(|run| !run.left_out && !is_decay(&run.run)) {
            let relative = |own: &Expected| Complex64::from(own.measured / own.predicted - 1.0);
            all.push(
                run.points
                    .iter()
                    .map(|point| relative(&point.frequency_hz))
                    .collect(),
            );
            let ratios = run
                .points
                .iter()
                .filter_map(|point| point.damping_ratio.as_ref());
            all.push(ratios.map(relative).collect());
        }
        all
    }

    fn validity(&self, study: &LapResponseStudy) -> Validity {
        let runs = || study.sines.iter().filter(|run| run.used_for == Use::Fit);
        let backbones = || {
            study
                .backbones
                .iter()
                .filter(|run| run.used_for == Use::Fit)
        };
        let of_runs = runs().flat_map(|run| {
            run.lines
                .iter()
                .map(|line| (line.omega, line.displacement_m))
        });
        let of_backbones =
            backbones().flat_map(|run| run.lines.iter().map(|line| (line.omega, line.amplitude_m)));
        let unbounded = [f64::INFINITY, 0.0];
        let wider = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
        let (omega, mut amplitude) = of_runs.chain(of_backbones).fold(
            (unbounded, unbounded),
            |(omegas, amplitudes), (omega, amplitude)| {
                (wider(omegas, omega), wider(amplitudes, amplitude))
            },
        );
        if self.in_time == InTime::Fitted {
            // samples reach from the release on, points from some periods behind it
            amplitude[1] = amplitude[1].max(self.amplitude_m);
        }
        Validity {
            frequency_hz: omega.map(|omega| omega / TAU),
            torque_n_m: study.torque_n_m.map(|torque| [torque, torque]),
            level: Some(format!(
                "displacement amplitudes from {:.3e} to {:.3e} m",
                amplitude[0], amplitude[1]
            )),
        }
    }
}
