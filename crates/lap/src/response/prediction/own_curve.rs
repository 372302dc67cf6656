//! Frequency and damping of the model over the amplitude, with where they may be by the deviations of the unknowns: what stepped
//! sines tell of the joint, as backbones and decays would show it.

use std::f64::consts::TAU;

use serde::Serialize;

use super::curve::Spread;
use super::directions;
use crate::response::dynamic_stiffness::RelativeMotion;
use crate::response::fit::Fit;
use crate::response::model::{Model, Values};

/// Points of the curve.
const POINTS: usize = 60;
/// Part of an unknown's standard deviation by which it is moved to each side for a difference, as along measured curves.
const PART: f64 = 0.5;

/// The relative motion of the model at an amplitude.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CurvePoint {
    /// Amplitude of the relative motion, m.
    pub amplitude_m: f64,
    /// Frequency of free motion, or of phase resonance, Hz.
    pub frequency_hz: f64,
    /// Where it may be by the deviations of the unknowns, with 95 %.
    pub frequency_95: [f64; 2],
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Where it may be.
    pub damping_95: [f64; 2],
}

/// ln ω and ζ at an amplitude, m.
fn at(values: &Values, motion: &RelativeMotion<'_>, amplitude_m: f64) -> [f64; 2] {
    let mass = 0.5 * values.mass;
    // ω² = K/M, of what does not depend on the frequency
    let square = motion.stiffness(amplitude_m, 0.0).value.re / mass;
    let omega = square.sqrt();
    // ζ = Im z/(2 M ω²)
    let loss = motion.stiffness(amplitude_m, omega).value.im;
    [omega.ln(), loss / (2.0 * mass * square)]
}

/// The curve between two amplitudes, m; nothing where the model does not vibrate.
pub(in crate::response) fn own_curve(
    model: &Model,
    fit: &Fit,
    spread: &Spread<'_>,
    [from_m, to_m]: [f64; 2],
) -> Vec<CurvePoint> {
    let amplitudes_m: Vec<f64> = (0..POINTS)
        .map(|n| from_m * (to_m / from_m).powf(n as f64 / (POINTS - 1) as f64))
        .collect();
    let course = |values: &Values| -> Vec<[f64; 2]> {
        let motion = RelativeMotion::fundamental(values);
        let points = amplitudes_m.iter();
        points.map(|&own| at(values, &motion, own)).collect()
    };
    let own = course(&fit.values);
    let mut variances = vec![[0.0; 2]; POINTS];
    for direction in directions(&fit.within_limits(spread.covariance)).column_iter() {
        let moved = |side: f64| course(&model.moved(&fit.values, &(side * PART * direction)));
        let (above, below) = (moved(1.0), moved(-1.0));
        for ((variance, above), below) in variances.iter_mut().zip(above).zip(below) {
            for kind in [0, 1] {
                variance[kind] += ((above[kind] - below[kind]) / (2.0 * PART)).powi(2);
            }
        }
    }
    let points = amplitudes_m.iter().zip(own).zip(variances);
    let points = points.map(|((&amplitude_m, [log_omega, damping_ratio]), variance)| {
        let [of_frequency, of_ratio] = variance.map(|own| spread.quantile * own.sqrt());
        CurvePoint {
            amplitude_m,
            frequency_hz: log_omega.exp() / TAU,
            frequency_95: [-1.0, 1.0].map(|side| (log_omega + side * of_frequency).exp() / TAU),
            damping_ratio,
            damping_95: [-1.0, 1.0].map(|side| damping_ratio + side * of_ratio),
        }
    });
    let is_finite = |own: &CurvePoint| {
        let ends = own.frequency_95.iter().chain(&own.damping_95);
        ends.chain([&own.frequency_hz, &own.damping_ratio])
            .all(|number| number.is_finite())
    };
    points.filter(is_finite).collect()
}
