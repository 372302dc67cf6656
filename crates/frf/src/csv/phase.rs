//! Phases in radian that are degrees, and the other way round: a spreadsheet's column is soon given the wrong unit, and no phase is
//! impossible by itself.

use std::f64::consts::{PI, TAU};

use crate::TableProblem;

/// Phases that run on over several turns are not wrapped; beyond so many most of them are degrees.
const TURNS: f64 = 2.0;
/// Part by which rounding may lengthen a step of half a turn.
const ROUNDING: f64 = 1e-3;

/// Rows, and the largest magnitude over the smallest one, from which on a function has passed a resonance: its phase has turned by half
/// a turn there.
const FEWEST: usize = 10;
const RESONANT: f64 = 15.0;
/// Spread of phases in degrees that are none, if they are radians.
const SPREAD: f64 = 2.0;

/// What the phases of a column have been so far.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Phases {
    rows: usize,
    /// Rows with a phase of more than a turn.
    beyond: usize,
    /// The largest phase, and its line.
    largest: Option<(f64, usize)>,
    first: Option<f64>,
    before: Option<f64>,
    /// Whether one row is more than half a turn from the one before.
    has_leaps: bool,
    /// The smallest and the largest phase, and magnitude.
    phases: Option<[f64; 2]>,
    magnitudes: Option<[f64; 2]>,
}

/// A range that has this number in it, too.
fn widened(range: Option<[f64; 2]>, own: f64) -> Option<[f64; 2]> {
    let [low, high] = range.unwrap_or([own; 2]);
    Some([low.min(own), high.max(own)])
}

impl Phases {
    /// Takes in the phase of the next row, and what it is the phase of.
    pub(super) fn push(&mut self, phase: f64, magnitude: f64, line: usize) {
        if !phase.is_finite() {
            return;
        }
        self.phases = widened(self.phases, phase);
        if magnitude.is_finite() && magnitude > 0.0 {
            self.magnitudes = widened(self.magnitudes, magnitude);
        }
        self.rows += 1;
        self.beyond += usize::from(phase.abs() > TAU);
        if self
            .largest
            .is_none_or(|(largest, _)| phase.abs() > largest.abs())
        {
            self.largest = Some((phase, line));
        }
        self.first.get_or_insert(phase);
        let step = self.before.map_or(0.0, |before| phase - before);
        self.has_leaps |= step.abs() > PI * (1.0 + ROUNDING);
        self.before = Some(phase);
    }

    /// The line, and what is wrong, where these are degrees: most are beyond a turn and the largest beyond several, and they are no
    /// phase that was unwrapped, which begins within a turn and takes no step of more than half a one. `column` counts from 1.
    pub(super) fn degrees(&self, column: usize) -> Option<(usize, TableProblem)> {
        let (largest, line) = self.largest?;
        let is_unwrapped = !self.has_leaps && self.first.is_some_and(|first| first.abs() <= TAU);
        if 2 * self.beyond <= self.rows || largest.abs() <= TURNS * TAU || is_unwrapped {
            return None;
        }
        let (beyond, rows) = (self.beyond, self.rows);
        let problem = TableProblem::at(
            format_args!("column {column}"),
            format_args!("phases beyond ±2π in {beyond} of {rows} rows, up to {largest}"),
            "rad; they are probably degrees: state [deg] in place of [rad], or bring phases that run on over many turns within ±2π",
        );
        Some((line, problem))
    }
}

impl Phases {
    /// The line, and what is wrong, where phases in degrees are radians: within ±π, spread over degrees, of a function that passes
    /// resonances, where it turns by half a turn. `column` counts from 1.
    pub(super) fn radians(&self, column: usize) -> Option<(usize, TableProblem)> {
        let ([low, high], [least, most]) = (self.phases?, self.magnitudes?);
        let (_, line) = self.largest?;
        let is_within = low.abs().max(high.abs()) <= PI * (1.0 + ROUNDING);
        if self.rows < FEWEST || !is_within || high - low < SPREAD || most < RESONANT * least {
            return None;
        }
        let problem = TableProblem::at(
            format_args!("column {column}"),
            format_args!("phases from {low} to {high}° of a function that passes resonances"),
            "degrees, which turn by 180 there; they are probably radians: state [rad] in place of [deg]",
        );
        Some((line, problem))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex64;

    /// Phases of a free beam's accelerance with five resonances, measured with a delay, at lines that are this far apart, Hz.
    fn phases(apart_hz: f64, delay_s: f64) -> Vec<f64> {
        let lines = (1..).map(|line| apart_hz * f64::from(line));
        let hz = lines.take_while(|hz| *hz < 2000.0);
        let value = |hz: f64| {
            let modes = [150.0, 410.0, 800.0, 1300.0, 1900.0];
            let own = |mode: f64| {
                Complex64::new(mode * mode - hz * hz, 0.01 * mode * hz).inv() * (-hz * hz)
            };
            let sum: Complex64 = modes.into_iter().map(own).sum();
            sum * Complex64::from_polar(1.0, -TAU * hz * delay_s)
        };
        hz.map(|hz| value(hz).arg()).collect()
    }

    fn unwrapped(phases: &[f64]) -> Vec<f64> {
        let mut turns = 0.0;
        let mut before = phases[0];
        let own = phases.iter().map(|&phase| {
            turns -= TAU * ((phase - before) / TAU).round();
            before = phase;
            phase + turns
        });
        own.collect()
    }

    fn are_degrees(phases: impl IntoIterator<Item = f64>) -> bool {
        let mut all = Phases::default();
        (2..)
            .zip(phases)
            .for_each(|(line, phase)| all.push(phase, 1.0, line));
        all.degrees(3).is_some()
    }

    #[test]
    fn radians_are_told_from_degrees_of_a_function_that_passes_resonances() {
        // the amplitudes are those of one mode; a structure far from any, measured with a small delay, has such phases
        let magnitude = |n: usize| 1.0 / ((1.0 - (n as f64 / 20.0).powi(2)).abs() + 0.01);
        let are_radians = |phases: &[f64], is_flat: bool| {
            let mut all = Phases::default();
            for (n, phase) in phases.iter().enumerate() {
                all.push(*phase, if is_flat { 1.0 } else { magnitude(n) }, n);
            }
            all.radians(3).is_some()
        };
        let wrapped = phases(25.0, 0.0);
        let degrees: Vec<f64> = wrapped.iter().map(|own| own.to_degrees()).collect();
        assert!(are_radians(&wrapped, false));
        assert!(!are_radians(&wrapped, true));
        assert!(!are_radians(&degrees, false));
    }

    #[test]
    fn degrees_are_told_from_phases_that_run_on_over_many_turns() {
        for apart_hz in [0.25, 1.0, 5.0] {
            for delay_s in [0.0, 1e-3, 2e-2] {
                let wrapped = phases(apart_hz, delay_s);
                let unwrapped = unwrapped(&wrapped);
                assert!(!are_degrees(wrapped.iter().copied()));
                assert!(
                    !are_degrees(unwrapped.iter().copied()),
                    "{apart_hz} {delay_s}"
                );
                let of = |all: &[f64]| are_degrees(all.iter().map(|own| own.to_degrees()));
                assert!(of(&wrapped) && of(&unwrapped), "{apart_hz} {delay_s}");
            }
        }
    }

    #[test]
    fn the_message_names_the_column_and_the_line_of_the_largest() {
        let mut all = Phases::default();
        for (line, phase) in [(2, -170.0), (3, f64::NAN), (4, 179.5), (5, 10.0)] {
            all.push(phase, 1.0, line);
        }
        let (line, problem) = all.degrees(3).unwrap();
        assert_eq!(line, 4);
        let expected = "column 3: found phases beyond ±2π in 3 of 3 rows, up to 179.5, expected rad; they are probably degrees";
        assert!(problem.to_string().starts_with(expected), "{problem}");
    }
}
