//! Responses in time, by the Runge–Kutta steps of the FMU: stepped sine, sweep, dwell, free decay.

use std::f64::consts::TAU;

use bolted_joint_dynamics::{Eigenvalue, Lap, LapState, LapStepper, substeps};
use num_complex::Complex64;

use bolted_joint_harmonic::{Derivative, HarmonicLoads, Observed, Side};

use super::answer::{Answer, larger};
use super::periodic::{frequencies, unit_load};
use super::study::{LoadPlace, Span, Start, Times};

/// More Runge–Kutta steps than anyone waits for.
pub(super) const MOST_STEPS: f64 = 1e11;
/// What is left of the slowest mode when a stepped sine has settled.
const SETTLED: f64 = 1e-3;

/// Why a history ends early.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ended {
    /// Not finite any more at this time, s.
    Escaped(f64),
    /// A mode does not decay.
    Undamped,
    /// So many steps.
    TooMany(f64),
}

/// A load of amplitude `level` whose frequency moves from the first to the second over a duration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drive {
    pub(super) place: LoadPlace,
    pub(super) level: f64,
    pub(super) from_hz: f64,
    pub(super) to_hz: f64,
    pub(super) duration_s: f64,
}

impl Drive {
    /// 2π (f₀ t + ½ (f₁ − f₀) t²/T)
    fn phase(&self, time_s: f64) -> f64 {
        let turns = self.from_hz + 0.5 * (self.to_hz - self.from_hz) * time_s / self.duration_s;
        TAU * (turns * time_s).rem_euclid(1.0)
    }

    fn frequency_hz(&self, time_s: f64) -> f64 {
        self.from_hz + (self.to_hz - self.from_hz) * time_s / self.duration_s
    }
}

fn seen<const D: usize>(state: &LapState<D>, observed: Observed) -> [f64; 2] {
    let of = |motion: &bolted_joint_dynamics::Motion<D>, dof: usize| {
        [motion.displacement[dof], motion.velocity[dof]]
    };
    match observed {
        Observed::Relative(dof) => of(&state.a.relative_to(&state.b), dof),
        Observed::Body(Side::A, dof) => of(&state.a, dof),
        Observed::Body(Side::B, dof) => of(&state.b, dof),
    }
}

fn is_finite<const D: usize>(state: &LapState<D>) -> bool {
    [&state.a, &state.b]
        .iter()
        .flat_map(|motion| motion.displacement.iter().chain(&motion.velocity))
        .all(|value| value.is_finite())
}

/// The longest step: of the FMU, or so many in a period.
fn longest_step<const D: usize>(lap: &Lap<D>, steps: Option<f64>, frequency_hz: f64) -> f64 {
    let own = || {
        lap.spectrum()
            .and_then(|spectrum| spectrum.accurate_step_s())
    };
    steps
        .map(|steps| 1.0 / (steps * frequency_hz))
        .or_else(own)
        .unwrap_or(f64::INFINITY)
}

/// Rows of time and, of each motion, displacement and velocity; frequency and load before them if there is a load.
pub(super) fn history<const D: usize>(
    lap: &Lap<D>,
    start: &[Start],
    drive: Option<Drive>,
    times: Times,
    motions: &[Observed],
    progress: &dyn Fn(f64),
) -> Result<Answer<D>, Ended> {
    let stepper = LapStepper::new(lap);
    let mut state = LapState::REST;
    for start in start {
        let motion = match start.side {
            Side::A => &mut state.a,
            Side::B => &mut state.b,
        };
        let list = if start.is_velocity {
            &mut motion.velocity
        } else {
            &mut motion.displacement
        };
        list[start.dof] = start.value;
    }
    let fastest_hz = drive.map_or_else(
        || {
            lap.spectrum()
                .map_or(1.0, |spectrum| spectrum.largest_modulus() / TAU)
        },
        |drive| drive.from_hz.max(drive.to_hz),
    );
    let longest = longest_step(lap, times.steps_per_period, fastest_hz).min(times.interval_s);
    let count = (times.duration_s / times.interval_s).round().max(1.0);
    let Some(parts) = substeps(times.interval_s, longest) else {
        return Err(Ended::TooMany(times.duration_s / longest));
    };
    let steps = count * f64::from(parts.get());
    if steps > MOST_STEPS {
        return Err(Ended::TooMany(steps));
    }
    let step = times.interval_s / f64::from(parts.get());
    let unit = drive.map(|drive| (drive, unit_load::<D>(drive.place).scaled(drive.level)));
    let load_at = |time: f64| match &unit {
        // sin, so that the load begins at zero
        Some((drive, unit)) => unit.at_phase(drive.phase(time) - 0.25 * TAU),
        None => HarmonicLoads::NONE.constant,
    };
    let row = |time: f64, state: &LapState<D>| {
        let mut row = vec![time];
        if let Some((drive, _)) = &unit {
            let load = drive.level * drive.phase(time).sin();
            row.extend([drive.frequency_hz(time), load]);
        }
        for &observed in motions {
            row.extend(seen(state, observed));
        }
        row
    };
    let mut moment = stepper.begin(state);
    let mut rows = vec![row(0.0, &moment.state)];
    let mut largest = [0.0; D];
    larger(&mut largest, &moment.state);
    for n in 0..count as u64 {
        let begin = n as f64 * times.interval_s;
        let mut last = load_at(begin);
        for part in 0..parts.get() {
            let at = begin + f64::from(part) * step;
            let loads = [last, load_at(at + 0.5 * step), load_at(at + step)];
            stepper.step(&mut moment, &loads, step);
            larger(&mut largest, &moment.state);
            last = loads[2];
        }
        let time = (n + 1) as f64 * times.interval_s;
        if !is_finite(&moment.state) {
            return Err(Ended::Escaped(time));
        }
        rows.push(row(time, &moment.state));
        progress((n + 1) as f64 / count);
    }
    Ok(Answer { rows, largest })
}

/// A stepped sine.
pub(super) struct SteppedSine<'a> {
    pub(super) span: Span,
    pub(super) lines: usize,
    pub(super) place: LoadPlace,
    pub(super) level: f64,
    pub(super) settle: Option<f64>,
    pub(super) steps_per_period: Option<f64>,
    pub(super) motions: &'a [Observed],
    pub(super) quantity: Derivative,
}

impl SteppedSine<'_> {
    /// Rows of frequency and, of each motion, amplitude and phase of the fundamental of the last period at that frequency. The
    /// motion goes on from one frequency to the next.
    pub(super) fn answer<const D: usize>(
        &self,
        lap: &Lap<D>,
        progress: &dyn Fn(f64),
    ) -> Result<Answer<D>, Ended> {
        let stepper = LapStepper::new(lap);
        let loads = unit_load::<D>(self.place).scaled(self.level);
        let slowest_s = match self.settle {
            Some(_) => 0.0,
            None => SETTLED.ln().abs() / slowest_decay(lap).ok_or(Ended::Undamped)?,
        };
        let mut moment = stepper.begin(LapState::REST);
        let (mut time, mut rows) = (0.0, Vec::with_capacity(self.lines));
        let mut largest = [0.0; D];
        for frequency_hz in frequencies(self.span, self.lines) {
            let period = 1.0 / frequency_hz;
            let longest = longest_step(lap, self.steps_per_period, frequency_hz);
            let steps = (period / longest * (1.0 - 1e-12)).ceil().max(8.0);
            let settle = self.settle.unwrap_or(slowest_s * frequency_hz).ceil();
            if settle * steps * self.lines as f64 > MOST_STEPS {
                return Err(Ended::TooMany(settle * steps * self.lines as f64));
            }
            let steps = steps as usize;
            let all: Vec<_> = (0..=2 * steps)
                .map(|half| loads.at_phase(TAU * half as f64 / (2 * steps) as f64))
                .collect();
            let mut sums = vec![Complex64::ZERO; self.motions.len()];
            for round in 0..=settle as u64 {
                let is_last = round == settle as u64;
                for n in 0..steps {
                    if is_last {
                        let turn = Complex64::cis(-TAU * n as f64 / steps as f64);
                        for (sum, &observed) in sums.iter_mut().zip(self.motions) {
                            *sum += seen(&moment.state, observed)[0] * turn;
                        }
                    }
                    let loads = [all[2 * n], all[2 * n + 1], all[2 * n + 2]];
                    stepper.step(&mut moment, &loads, period / steps as f64);
                    larger(&mut largest, &moment.state);
                }
                time += period;
                if !is_finite(&moment.state) {
                    return Err(Ended::Escaped(time));
                }
            }
            let turns = Complex64::new(0.0, TAU * frequency_hz).powi(self.quantity.order());
            let mut row = vec![frequency_hz];
            for sum in sums {
                // X = 2/N Σ x_n e^{−jωt_n}
                let amplitude = turns * sum * (2.0 / steps as f64);
                row.extend([amplitude.norm(), amplitude.arg().to_degrees()]);
            }
            rows.push(row);
            progress(rows.len() as f64 / self.lines as f64);
        }
        Ok(Answer { rows, largest })
    }
}

/// 1/s; `None` if a mode does not decay.
fn slowest_decay<const D: usize>(lap: &Lap<D>) -> Option<f64> {
    let spectrum = lap.spectrum()?;
    let decay = |eigenvalue: &Eigenvalue| -eigenvalue.real;
    let slowest = spectrum.eigenvalues().iter().map(decay);
    let slowest = slowest.fold(f64::INFINITY, f64::min);
    (slowest > 1e-9 * spectrum.largest_modulus()).then_some(slowest)
}
