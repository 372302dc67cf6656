//! Backbone and damping curves, measured or taken from a free decay: frequency, damping ratio and force of phase resonance over
//! the amplitude.

use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

use bolted_joint_dynamics::law::Term;

use super::data::{RESPONSE, Use};
use super::dynamic_stiffness::RelativeMotion;
use super::model::{Model, ResponseUnknown, Values};
use super::study::Noise;
use super::table::NumberTable;
use crate::error::LapError;

/// Half-periods that a free decay is read over at a time.
const HALF_PERIODS: usize = 10;

/// A backbone with its damping curve.
#[derive(Clone, Debug, PartialEq)]
pub struct BackboneRun {
    /// Its name.
    pub name: String,
    /// Its file.
    pub path: PathBuf,
    /// What it is for.
    pub used_for: Use,
    /// Its points.
    pub lines: Vec<BackboneLine>,
}

/// One point of a backbone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BackboneLine {
    /// Amplitude of the relative displacement, m.
    pub amplitude_m: f64,
    /// Frequency, rad/s.
    pub omega: f64,
    /// Damping ratio, where it was measured.
    pub damping_ratio: Option<f64>,
    /// Force that holds the amplitude, N, where it was measured.
    pub force_n: Option<f64>,
}

impl BackboneLine {
    /// Numbers that it brings.
    pub(super) fn count(&self) -> usize {
        1 + usize::from(self.damping_ratio.is_some()) + usize::from(self.force_n.is_some())
    }

    /// Residuals in standard deviations with their derivatives by the model's unknowns.
    pub(super) fn residuals(
        &self,
        model: &Model,
        values: &Values,
        noise: &Noise,
    ) -> Vec<(f64, Vec<f64>)> {
        let z = RelativeMotion::fundamental(values).stiffness(self.amplitude_m, self.omega);
        // K = k/2 + k₁₂ + …, M = m/2, C = c/2 + c₁₂ + …
        let mass = 0.5 * values.mass;
        let stiffness = z.value.re + mass * self.omega * self.omega;
        let damping = z.value.im / self.omega;
        let parts = |unknown: &ResponseUnknown| match *unknown {
            ResponseUnknown::Mass => [0.0, 0.5, 0.0],
            ResponseUnknown::SupportStiffness => [0.5, 0.0, 0.0],
            ResponseUnknown::JointStiffness => [1.0, 0.0, 0.0],
            ResponseUnknown::SupportDamping => [0.0, 0.0, 0.5],
            ResponseUnknown::JointDamping => [0.0, 0.0, 1.0],
            ResponseUnknown::Term(term) => {
                let by = z.by_term[term.index()];
                [by.re, 0.0, by.im / self.omega]
            }
            ResponseUnknown::OtherModesReal | ResponseUnknown::OtherModesImaginary => [0.0; 3],
        };
        let row = |by: [f64; 3], weight: f64| {
            let rows = model.unknowns.iter().map(|unknown| {
                let [k, m, c] = parts(unknown);
                -weight * (by[0] * k + by[1] * m + by[2] * c)
            });
            rows.collect::<Vec<f64>>()
        };
        let mut residuals = Vec::new();
        // ω² = K/M
        let weight = noise.frequency.recip();
        let found = 0.5 * (stiffness / mass).ln();
        residuals.push((
            weight * (self.omega.ln() - found),
            row([0.5 / stiffness, -0.5 / mass, 0.0], weight),
        ));
        if let Some(ratio) = self.damping_ratio {
            // ζ = C/(2 M ω)
            let weight = noise.damping.recip();
            let found = (damping / (2.0 * mass * self.omega)).ln();
            residuals.push((
                weight * (ratio.ln() - found),
                row([0.0, -mass.recip(), damping.recip()], weight),
            ));
        }
        if let Some(force) = self.force_n {
            // F = C ω R/|d|
            let weight = noise.damping.recip();
            let load = model.relative_load().abs();
            let found = (damping * self.omega * self.amplitude_m / load).ln();
            residuals.push((
                weight * (force.ln() - found),
                row([0.0, 0.0, damping.recip()], weight),
            ));
        }
        residuals
    }
}

/// A start: a linear oscillator of the lowest point. Where nothing fixes the mass it is 1 kg, and named as not identified.
pub(super) fn start(model: &Model, lines: &[BackboneLine], known: &Values) -> Option<Values> {
    let lowest = lines
        .iter()
        .min_by(|a, b| a.amplitude_m.total_cmp(&b.amplitude_m))?;
    let damping_of_force = lowest
        .force_n
        .map(|force| force * model.relative_load().abs() / (lowest.omega * lowest.amplitude_m));
    let mass = match (
        model.unknowns.contains(&ResponseUnknown::Mass),
        damping_of_force,
        lowest.damping_ratio,
    ) {
        (false, _, _) => known.mass,
        (true, Some(damping), Some(ratio)) => damping / (ratio * lowest.omega),
        (true, _, _) => 1.0,
    };
    let damping = damping_of_force
        .or(lowest
            .damping_ratio
            .map(|ratio| ratio * mass * lowest.omega))
        .unwrap_or(1e-3 * mass * lowest.omega);
    let mut start = *known;
    start.mass = mass;
    if model.unknowns.contains(&ResponseUnknown::JointStiffness) {
        start.joint_stiffness =
            0.5 * (mass * lowest.omega * lowest.omega - known.support_stiffness);
    }
    if model.unknowns.contains(&ResponseUnknown::JointDamping) {
        start.joint_damping = damping - 0.5 * known.support_damping;
    }
    debug_assert!(Term::ALL.iter().all(|term| start.term(*term) == 0.0));
    Some(start)
}

/// Reads a backbone; `share` is that of the relative motion in what was measured.
pub(super) fn read_backbone(path: &Path, share: f64) -> Result<Vec<BackboneLine>, LapError> {
    let table = NumberTable::read(path)?;
    let (frequency, by) = table.required(&["frequency_hz", "omega_rad_per_s"], "")?;
    let (response, order) = table.required(&RESPONSE, "")?;
    let ratio = table.column(&["damping_ratio"]);
    let force = table.column(&["force_n"]);
    let mut lines = Vec::new();
    for (number, values) in table.rows() {
        let positive = |place: usize, what: &str| match values[place] {
            Some(value) if value > 0.0 => Ok(value),
            other => {
                let other = other.map_or("nothing".to_owned(), |value| value.to_string());
                let found = format!("a {what} of {other}");
                Err(table.problem(*number, found, "a value above zero"))
            }
        };
        let frequency = positive(frequency, "frequency")?;
        let omega = if by == 0 { TAU * frequency } else { frequency };
        let response = positive(response, "response")?;
        lines.push(BackboneLine {
            amplitude_m: response / omega.powi(order as i32) / share.abs(),
            omega,
            damping_ratio: ratio
                .map(|(place, _)| positive(place, "damping ratio"))
                .transpose()?,
            force_n: force
                .map(|(place, _)| positive(place, "force"))
                .transpose()?,
        });
    }
    if lines.is_empty() {
        return Err(table.problem(1, "no rows".to_owned(), "at least one"));
    }
    Ok(lines)
}

/// Reads a free decay of one mode and turns it into a backbone: frequencies from the zero crossings of ten half-periods, damping
/// from the peaks between them.
pub(super) fn read_decay(path: &Path, share: f64) -> Result<Vec<BackboneLine>, LapError> {
    let table = NumberTable::read(path)?;
    let (time, _) = table.required(&["time_s"], "")?;
    let (response, order) = table.required(&RESPONSE, "")?;
    let rows = table.rows().iter();
    let samples: Vec<(f64, f64)> = rows
        .filter_map(|(_, values)| Some((values[time]?, values[response]?)))
        .collect();
    if samples.windows(2).any(|pair| pair[1].0 <= pair[0].0) {
        let found = "times that do not ascend".to_owned();
        return Err(table.problem(1, found, "ascending times"));
    }
    let lines = of_decay(&samples, order as i32, share);
    if lines.len() < 2 {
        let count = lines.len();
        let found = format!("{count} stretch(es) of {HALF_PERIODS} half-periods in the decay");
        let expected = "at least two: a longer record of one mode decaying freely";
        return Err(table.problem(1, found, expected));
    }
    Ok(lines)
}

/// One point for each stretch of half-periods.
fn of_decay(samples: &[(f64, f64)], order: i32, share: f64) -> Vec<BackboneLine> {
    // Zero crossings by linear interpolation, and between them the peak of a parabola through the highest sample.
    let mut crossings: Vec<(usize, f64)> = Vec::new();
    for (i, pair) in samples.windows(2).enumerate() {
        let [(t0, y0), (t1, y1)] = [pair[0], pair[1]];
        if y0 != 0.0 && y0 * y1 <= 0.0 {
            crossings.push((i + 1, t0 + (t1 - t0) * y0 / (y0 - y1)));
        }
    }
    let peaks: Vec<(f64, f64)> = crossings
        .windows(2)
        .filter_map(|pair| {
            let between = pair[0].0..pair[1].0;
            let highest =
                between.max_by(|&a, &b| samples[a].1.abs().total_cmp(&samples[b].1.abs()))?;
            Some(vertex(samples, highest))
        })
        .collect();
    let mut lines = Vec::new();
    for (stretch, from) in peaks
        .chunks_exact(HALF_PERIODS + 1)
        .zip((0..).step_by(HALF_PERIODS + 1))
    {
        let crossings = &crossings[from..=from + HALF_PERIODS];
        let half_period = (crossings[HALF_PERIODS].1 - crossings[0].1) / HALF_PERIODS as f64;
        let omega = PI / half_period;
        // ln A falls by ζ ω t: the slope of a line through the logarithms of the peaks.
        let count = stretch.len() as f64;
        let mean_time = stretch.iter().map(|(time, _)| time).sum::<f64>() / count;
        let mean_log = stretch.iter().map(|(_, peak)| peak.ln()).sum::<f64>() / count;
        let (mut up, mut across) = (0.0, 0.0);
        for (time, peak) in stretch {
            up += (time - mean_time) * (peak.ln() - mean_log);
            across += (time - mean_time).powi(2);
        }
        let ratio = -up / across / omega;
        if ratio > 0.0 && mean_log.is_finite() {
            lines.push(BackboneLine {
                amplitude_m: mean_log.exp() / omega.powi(order) / share.abs(),
                omega,
                damping_ratio: Some(ratio),
                force_n: None,
            });
        }
    }
    lines
}

/// Time and size of the peak of a parabola through a sample and its neighbours.
fn vertex(samples: &[(f64, f64)], place: usize) -> (f64, f64) {
    let (time, value) = samples[place];
    let (Some(&(before, low)), Some(&(after, high))) = (
        place.checked_sub(1).and_then(|place| samples.get(place)),
        samples.get(place + 1),
    ) else {
        return (time, value.abs());
    };
    let (slope_before, slope_after) = (
        (value - low) / (time - before),
        (high - value) / (after - time),
    );
    let curvature = (slope_after - slope_before) / (0.5 * (after - before));
    if curvature == 0.0 {
        return (time, value.abs());
    }
    // The slope at the middles of both intervals is exact for a parabola.
    let slope = slope_before + curvature * 0.5 * (time - before);
    let shift = -slope / curvature;
    (time + shift, (value + 0.5 * slope * shift).abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = e^(−ζω₀t) cos ω_d t: its backbone is flat and its damping ratio known.
    #[test]
    fn a_linear_decay_has_its_frequency_and_damping() {
        let (ratio, omega_0) = (0.004, 510.0);
        let omega_d = omega_0 * f64::sqrt(1.0 - ratio * ratio);
        let samples: Vec<(f64, f64)> = (0..20_000)
            .map(|n| {
                let t = f64::from(n) * 1e-4;
                (t, 2e-4 * (-ratio * omega_0 * t).exp() * (omega_d * t).cos())
            })
            .collect();
        let lines = of_decay(&samples, 0, 1.0);
        assert!(lines.len() > 20);
        for line in &lines {
            assert!((line.omega / omega_d - 1.0).abs() < 1e-4, "{}", line.omega);
            let found = line.damping_ratio.unwrap();
            assert!((found / ratio - 1.0).abs() < 5e-3, "{found}");
        }
        assert!(
            lines
                .windows(2)
                .all(|pair| pair[1].amplitude_m < pair[0].amplitude_m)
        );
    }
}
