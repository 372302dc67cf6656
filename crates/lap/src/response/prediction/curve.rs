//! Frequencies and damping ratios along a backbone or a free decay, measured and of the model, and where those of a run that
//! was left out are expected.
//!
//! A decay is compared at the amplitudes that were read, as the model's own decay would be read. So the amplitude that it was
//! released at is known as well as it was read, and that error is part of the interval.

use std::f64::consts::TAU;

use bolted_joint_statistics::student_975;
use nalgebra::DMatrix;
use serde::Serialize;

use super::between::{BetweenRuns, PointError, RunScatter};
use super::directions;
use crate::response::backbone::BackboneRun;
use crate::response::data::Use;
use crate::response::decay::{beside, corrected};
use crate::response::fit::Fit;
use crate::response::model::{Model, Values};
use crate::response::study::Noise;

/// Part of an unknown's standard deviation by which it is moved to each side for a difference: a curve with a corner is not
/// straight over less.
const PART: f64 = 0.5;

/// How far a backbone or a free decay is from the model's.
#[derive(Clone, Debug, Serialize)]
pub struct BackbonePrediction {
    /// The run.
    pub run: String,
    /// Whether the run was left out of the estimate.
    pub left_out: bool,
    /// Root of the mean square error of the frequencies, Hz.
    pub frequency_error_hz: f64,
    /// Root of the mean square relative error of the damping ratios, where they were measured.
    pub damping_error: Option<f64>,
    /// Every point.
    pub points: Vec<PointPrediction>,
    /// How long a decay takes.
    pub fall: Option<Fall>,
}

/// A point of a curve beside the model's.
#[derive(Clone, Debug, Serialize)]
pub struct PointPrediction {
    /// Amplitude of the relative motion, m.
    pub amplitude_m: f64,
    /// Hz.
    pub frequency_hz: Expected,
    /// Damping ratio, where it was measured.
    pub damping_ratio: Option<Expected>,
}

/// The time that a decay takes from the first amplitude that was read to the last.
#[derive(Clone, Debug, Serialize)]
pub struct Fall {
    /// First and last amplitude, m.
    pub amplitudes_m: [f64; 2],
    /// s
    pub duration_s: Expected,
}

/// A number that was measured, and what the model has for it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Expected {
    /// Measured.
    pub measured: f64,
    /// Of the model.
    pub predicted: f64,
    /// Where a measurement is expected, with 95 %, of a run that was left out: by the deviations of the unknowns, the noise of
    /// the run, the errors of its amplitudes and, where several runs were fitted, what they differ by as a whole. A law that is
    /// wrong beyond the amplitudes that were fitted is not in it.
    pub interval_95: Option<[f64; 2]>,
    /// Where the model's own curve is, with 95 %, by the deviations of the unknowns alone; of fitted runs and of others.
    pub curve_95: Option<[f64; 2]>,
}

impl Expected {
    /// Whether the measured value lies where it was expected.
    #[must_use]
    pub fn holds(&self) -> Option<bool> {
        let [low, high] = self.interval_95?;
        Some((low..=high).contains(&self.measured))
    }
}

/// What is known of errors: of the unknowns, and of what is measured.
pub(in crate::response) struct Spread<'a> {
    /// Of the unknowns, as they are searched.
    pub(in crate::response) covariance: &'a DMatrix<f64>,
    /// Noise of a backbone's points.
    pub(in crate::response) noise: &'a Noise,
    /// By how much its variances, and those of what is read from records, are larger than was taken.
    pub(in crate::response) factor: f64,
    /// Half an interval of 95 % in standard deviations.
    pub(in crate::response) quantile: f64,
}

/// A run as the model has it: ln ω and ζ at each amplitude, and the duration of a decay.
struct Course {
    points: Vec<[f64; 2]>,
    duration_s: Option<f64>,
}

impl Course {
    fn of(model: &Model, values: &Values, run: &BackboneRun) -> Self {
        let (beyond, duration_s) = beside(model, values, run);
        let pairs = run.lines.iter().zip(beyond);
        let points = pairs.map(|(line, [of_frequency, of_ratio])| {
            let ratio = line.damping_ratio.unwrap_or(0.0);
            [line.omega.ln() - of_frequency, ratio - of_ratio]
        });
        Self {
            points: points.collect(),
            duration_s,
        }
    }

    /// δ = ζω at a point, 1/s.
    fn rate(&self, place: usize) -> f64 {
        let [log_omega, ratio] = self.points[place];
        ratio * log_omega.exp()
    }
}

impl BackbonePrediction {
    /// Of all runs, with what those that were fitted differ by as a whole, where there are several.
    pub(in crate::response) fn of_all(
        model: &Model,
        fit: &Fit,
        runs: &[BackboneRun],
        spread: &Spread<'_>,
    ) -> (Vec<Self>, Option<BetweenRuns>) {
        let courses = runs.iter().map(|run| Course::of(model, &fit.values, run));
        let all: Vec<(&BackboneRun, Course)> = runs.iter().zip(courses).collect();
        let between = spread.between(model, fit, &all);
        let each = all
            .iter()
            .map(|(run, course)| Self::of(model, fit, run, course, (spread, between.as_ref())));
        (each.collect(), between)
    }

    /// Of a run; of one that was left out it is told where it is expected.
    fn of(
        model: &Model,
        fit: &Fit,
        run: &BackboneRun,
        course: &Course,
        (spread, between): (&Spread<'_>, Option<&BetweenRuns>),
    ) -> Self {
        let left_out = run.used_for == Use::Predict;
        let halves = spread.of_course(model, fit, run, course, between);
        let interval = |kind: usize, place: usize| {
            let half = Some(halves.points[place][kind]).filter(|_| left_out);
            half.filter(|half| half.is_finite())
        };
        let curve = |kind: usize, place: usize| {
            Some(halves.curve[place][kind]).filter(|half| half.is_finite())
        };
        let lines = run.lines.iter().zip(&course.points).enumerate();
        let points = lines.map(|(place, (line, &[log_omega, ratio]))| PointPrediction {
            amplitude_m: line.amplitude_m,
            frequency_hz: Expected {
                measured: line.omega / TAU,
                predicted: log_omega.exp() / TAU,
                interval_95: interval(0, place).map(|half| around_hz(log_omega, half)),
                curve_95: curve(0, place).map(|half| around_hz(log_omega, half)),
            },
            damping_ratio: line.damping_ratio.map(|measured| Expected {
                measured,
                predicted: ratio,
                interval_95: interval(1, place).map(|half| [ratio - half, ratio + half]),
                curve_95: curve(1, place).map(|half| [ratio - half, ratio + half]),
            }),
        });
        let points: Vec<PointPrediction> = points.collect();
        let mean = |squares: Vec<f64>| {
            let count = squares.len().max(1) as f64;
            (squares.iter().sum::<f64>() / count).sqrt()
        };
        let of_frequency = points.iter().map(|point| {
            let own = &point.frequency_hz;
            (own.measured - own.predicted).powi(2)
        });
        let of_damping = points.iter().filter_map(|point| {
            let own = point.damping_ratio.as_ref()?;
            Some((own.measured / own.predicted - 1.0).powi(2))
        });
        let of_damping: Vec<f64> = of_damping.collect();
        Self {
            run: run.name.clone(),
            left_out,
            frequency_error_hz: mean(of_frequency.collect()),
            damping_error: (!of_damping.is_empty()).then(|| mean(of_damping)),
            points,
            fall: fall(run, course, halves.duration_s.filter(|_| left_out)),
        }
    }

    /// How many numbers have an interval, and how many of them lie outside.
    #[must_use]
    pub fn outside(&self) -> (usize, usize) {
        let each = self.points.iter().flat_map(|point| {
            let of_ratio = point.damping_ratio.and_then(|own| own.holds());
            [point.frequency_hz.holds(), of_ratio]
        });
        let each = each.flatten();
        each.fold((0, 0), |(all, outside), holds| {
            (all + 1, outside + usize::from(!holds))
        })
    }
}

/// Frequencies, Hz, so far on either side of ln ω.
fn around_hz(log_omega: f64, half: f64) -> [f64; 2] {
    [-half, half].map(|by| (log_omega + by).exp() / TAU)
}

fn fall(run: &BackboneRun, course: &Course, half: Option<f64>) -> Option<Fall> {
    let (first, last) = (run.lines.first()?, run.lines.last()?);
    let predicted = course.duration_s?;
    Some(Fall {
        amplitudes_m: [first.amplitude_m, last.amplitude_m],
        duration_s: Expected {
            measured: last.time_s? - first.time_s?,
            predicted,
            interval_95: half.map(|half| [(predicted - half).max(0.0), predicted + half]),
            curve_95: None,
        },
    })
}

/// Halves of intervals of 95 %.
struct Halves {
    points: Vec<[f64; 2]>,
    /// Those of the model's curve by the unknowns alone.
    curve: Vec<[f64; 2]>,
    duration_s: Option<f64>,
}

impl Spread<'_> {
    /// Variances of the noise of each point, of the logarithm of its frequency and of its damping ratio, as they were taken.
    fn of_points(
        &self,
        model: &Model,
        fit: &Fit,
        run: &BackboneRun,
        course: &Course,
    ) -> Vec<[f64; 2]> {
        // how the model's own curve falls or rises makes errors of the amplitudes errors of what is compared there
        let errors = corrected(model, &fit.values, run).errors;
        let places = course.points.iter().enumerate();
        let each = places.map(|(place, &[_, ratio])| match &errors {
            Some(errors) => errors.variances_of(place),
            None => [self.noise.frequency, self.noise.damping * ratio].map(|own| own * own),
        });
        each.collect()
    }

    /// What the runs that were fitted differ by as a whole.
    fn between(
        &self,
        model: &Model,
        fit: &Fit,
        all: &[(&BackboneRun, Course)],
    ) -> Option<BetweenRuns> {
        let fitted: Vec<_> = all
            .iter()
            .filter(|(run, _)| run.used_for == Use::Fit)
            .collect();
        let runs = fitted.len();
        if runs < 2 {
            return None;
        }
        let mut errors = [Vec::new(), Vec::new()];
        for (index, (run, course)) in fitted.into_iter().enumerate() {
            let variances = self.of_points(model, fit, run, course);
            let points = run.lines.iter().zip(&course.points).zip(variances);
            for ((line, &[log_omega, ratio]), [of_frequency, of_ratio]) in points {
                let relative = line.damping_ratio.map(|measured| measured / ratio - 1.0);
                let both = [
                    (Some(line.omega.ln() - log_omega), of_frequency),
                    (relative, of_ratio / (ratio * ratio)),
                ];
                for (own, (error, variance)) in errors.iter_mut().zip(both) {
                    let error = error.filter(|error| error.is_finite());
                    let Some(error) = error.filter(|_| variance > 0.0 && variance.is_finite())
                    else {
                        continue;
                    };
                    own.push(PointError {
                        run: index,
                        log_amplitude: line.amplitude_m.ln(),
                        error,
                        variance,
                    });
                }
            }
        }
        Some(BetweenRuns {
            runs,
            frequency: RunScatter::of(runs, &errors[0])?,
            damping: RunScatter::of(runs, &errors[1]),
        })
    }

    /// g Σ gᵀ of the unknowns beside the variance of what is measured.
    fn of_course(
        &self,
        model: &Model,
        fit: &Fit,
        run: &BackboneRun,
        course: &Course,
        between: Option<&BetweenRuns>,
    ) -> Halves {
        let mut points = vec![[0.0; 2]; run.lines.len()];
        let mut duration = Some(0.0);
        for direction in directions(&fit.within_limits(self.covariance)).column_iter() {
            let moved = |side: f64| {
                let values = model.moved(&fit.values, &(side * PART * direction));
                Course::of(model, &values, run)
            };
            let (above, below) = (moved(1.0), moved(-1.0));
            let change = |above: f64, below: f64| ((above - below) / (2.0 * PART)).powi(2);
            for (place, variances) in points.iter_mut().enumerate() {
                for kind in [0, 1] {
                    variances[kind] += change(above.points[place][kind], below.points[place][kind]);
                }
            }
            let both = above.duration_s.zip(below.duration_s);
            duration = duration
                .zip(both)
                .map(|(sum, (above, below))| sum + change(above, below));
        }
        let errors = corrected(model, &fit.values, run).errors;
        // what runs differ by is no noise of their points
        let factor = |kind: usize| {
            let within = between.and_then(|between| between.of_kind(kind));
            let factor = within.map_or(self.factor, |own| own.within);
            // noise of records is known by itself: a residual below it is chance
            if errors.is_some() {
                factor.max(1.0)
            } else {
                factor
            }
        };
        let factors = [0, 1].map(factor);
        // Student's quantile of as many runs as there are beside their mean
        let of_run = |kind: usize, size: f64| {
            between.map_or(0.0, |between| {
                let quantile = student_975(between.runs - 1);
                between.variance(kind) * (quantile * size).powi(2)
            })
        };
        let half =
            |variance: f64, of_run: f64| (self.quantile * self.quantile * variance + of_run).sqrt();
        let curve = points
            .iter()
            .map(|variances| variances.map(|own| half(own, 0.0)));
        let curve = curve.collect();
        let measured = self.of_points(model, fit, run, course);
        let of_points = points.iter().zip(&course.points).zip(measured);
        let of_points = of_points.map(|((of_unknowns, &[_, ratio]), measured)| {
            [0, 1].map(|kind| {
                let size = [1.0, ratio][kind];
                let variance = of_unknowns[kind] + measured[kind] * factors[kind];
                half(variance, of_run(kind, size))
            })
        });
        let of_ends = errors.as_ref().map(|errors| {
            // t = ∫ d ln A/δ(A): by the first amplitude 1/δ there, by the last −1/δ
            let (first, last) = (0, run.lines.len().saturating_sub(1));
            let by = [first, last].map(|place| course.rate(place).recip());
            let squares = by[0] * by[0] * errors.of_amplitudes(first, first)
                + by[1] * by[1] * errors.of_amplitudes(last, last)
                - 2.0 * by[0] * by[1] * errors.of_amplitudes(first, last);
            squares * self.factor.max(1.0)
        });
        Halves {
            curve,
            points: of_points.collect(),
            duration_s: duration.zip(of_ends).map(|(of_unknowns, of_ends)| {
                // t falls as ζω of the run is larger
                let size = course.duration_s.unwrap_or(0.0);
                half(of_unknowns + of_ends, of_run(0, size) + of_run(1, size))
            }),
        }
    }
}
