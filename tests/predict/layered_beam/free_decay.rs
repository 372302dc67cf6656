//! The lap of the joint file, integrated in time as its FMU does, against the beam's mode.

use std::f64::consts::{PI, TAU};
use std::num::NonZeroU32;
use std::path::Path;

use bolted_joint::predict::layered_beam::{LayeredBeamStudy, Outcome};
use bolted_joint::study::StudyText;
use bolted_joint_dynamics::{LapIntegrator, LapLoads, LapState, Motion};

use bolted_joint_testing::close;

const STEPS_PER_PERIOD: u32 = 400;

fn outcome(text: &str) -> Outcome {
    LayeredBeamStudy::of(&StudyText::new(text, Path::new("decay.toml")))
        .unwrap()
        .run()
        .unwrap()
}

/// Upper turning points of body a, time and displacement, over some periods of a free decay in the beam's mode.
fn peaks(outcome: &Outcome, amplitude: f64, periods: u32) -> Vec<(f64, f64)> {
    let lap = outcome.joint_file.lap::<1>().unwrap();
    let mode = outcome
        .modes
        .iter()
        .find(|mode| mode.number == outcome.mode)
        .unwrap();
    let omega = TAU * mode.frequency_hz;
    let share =
        omega * omega * lap.a.inertia[0] / (lap.b.stiffness[0] - omega * omega * lap.b.inertia[0]);
    let at = |displacement: f64| Motion {
        displacement: [displacement],
        velocity: [0.0],
    };
    let mut state = LapState {
        a: at(amplitude),
        b: at(share * amplitude),
    };
    let loads = LapLoads { a: [0.0], b: [0.0] };
    let integrator = LapIntegrator::new(&lap);
    let step = 1.0 / mode.frequency_hz / f64::from(STEPS_PER_PERIOD);
    let mut found = vec![(0.0, amplitude)];
    for number in 1..=periods * STEPS_PER_PERIOD {
        let before = state;
        state = integrator.advance(&state, &loads, step, NonZeroU32::MIN);
        let (v0, v1) = (before.a.velocity[0], state.a.velocity[0]);
        if v0 > 0.0 && v1 <= 0.0 {
            // Hermite's cubic through both ends
            let part = v0 / (v0 - v1);
            let (x0, x1) = (before.a.displacement[0], state.a.displacement[0]);
            let p2 = part * part;
            let p3 = p2 * part;
            let peak = (1.0 - 3.0 * p2 + 2.0 * p3) * x0
                + (3.0 * p2 - 2.0 * p3) * x1
                + step * ((part - 2.0 * p2 + p3) * v0 + (p3 - p2) * v1);
            found.push(((f64::from(number - 1) + part) * step, peak));
        }
    }
    found
}

fn study(boundary: &str, mode: usize, joint: &str) -> String {
    include_str!("../../data/studies/decay.toml")
        .replace("fixed-free", boundary)
        .replace("mode = 1\n", &format!("mode = {mode}\n"))
        + joint
}

#[test]
fn a_linear_joint_decays_with_the_beams_frequency_and_damping() {
    for (boundary, mode) in [
        ("fixed-fixed", 1),
        ("fixed-pinned", 1),
        ("pinned-pinned", 2),
        ("fixed-free", 1),
        ("free-fixed", 1),
        ("free-free", 3),
    ] {
        let joint = "[joint]\ndamping = \"linear\"\namplitude = 2e-4";
        let found = outcome(&study(boundary, mode, joint));
        let peaks = peaks(&found, 2e-4, 20);
        let (first, last) = (peaks[1], peaks[19]);
        let decrement = (first.1 / last.1).ln() / 18.0;
        let ratio = decrement / (decrement * decrement + TAU * TAU).sqrt();
        close(ratio, 0.01, 2e-3);
        let damped_hz = 18.0 / (last.0 - first.0);
        let natural_hz = damped_hz / (1.0 - ratio * ratio).sqrt();
        let beam = found.modes.iter().find(|row| row.number == mode).unwrap();
        close(natural_hz, beam.frequency_hz, 1e-5);
    }
}

/// Friction takes E_f a period and the amplitude falls in a straight line; the joint's terms stay within their stated error of
/// that, and lose what their equivalent damping says.
#[test]
fn damping_over_the_amplitude_decays_nearly_as_friction() {
    for (boundary, mode) in [("fixed-fixed", 1), ("fixed-free", 2)] {
        let found = outcome(&study(boundary, mode, ""));
        let worst = found.joint_damping_worst_error;
        assert!(worst > 0.2 && worst < 0.26, "{worst}");
        let peaks = peaks(&found, 3e-4, 40);
        let row = found
            .amplitudes
            .iter()
            .find(|row| row.mode == mode)
            .unwrap();
        let stiffness = 2.0 * row.stored_energy_j / row.amplitude_m.powi(2);
        let per_amplitude = row.dissipated_energy_j / row.amplitude_m;
        let mut compared = 0;
        for pair in peaks[1..].windows(2) {
            let (high, low) = (pair[0].1, pair[1].1);
            if low < 1e-4 {
                break;
            }
            let middle = 0.5 * (high + low);
            // ½ k (w₁² − w₂²)
            let lost = 0.5 * stiffness * (high * high - low * low);
            let by_friction = lost / (per_amplitude * middle) - 1.0;
            assert!(by_friction.abs() < worst + 0.01, "{by_friction}");
            let ratio = lost / (4.0 * PI * 0.5 * stiffness * middle * middle);
            let own = found.amplitudes.iter().filter(|row| row.mode == mode);
            let own: Vec<_> = own.collect();
            let after = own
                .partition_point(|row| row.amplitude_m < middle)
                .clamp(1, own.len() - 1);
            let (a, b) = (own[after - 1], own[after]);
            let part = (middle - a.amplitude_m) / (b.amplitude_m - a.amplitude_m);
            let (from, to) = (
                a.joint_damping_ratio.unwrap(),
                b.joint_damping_ratio.unwrap(),
            );
            close(ratio, from + part * (to - from), 0.01);
            compared += 1;
        }
        assert!(compared > 8, "{compared}");
    }
}

/// A force at the natural frequency with the size of the damper's gives a steady motion of that amplitude, 90° behind.
#[test]
fn at_resonance_the_force_holds_the_amplitude() {
    let found = outcome(&study("fixed-fixed", 1, ""));
    let lap = found.joint_file.lap::<1>().unwrap();
    let beam = &found.modes[0];
    let omega = TAU * beam.frequency_hz;
    let ratio = found
        .amplitudes
        .iter()
        .find(|row| row.amplitude_m > 1.99e-4)
        .unwrap();
    let (amplitude, ratio) = (ratio.amplitude_m, ratio.joint_damping_ratio.unwrap());
    // F = c ω w = 2 ζ k w
    let force = 2.0 * ratio * beam.stiffness_n_per_m * amplitude;
    let integrator = LapIntegrator::new(&lap);
    let step = 1.0 / beam.frequency_hz / f64::from(STEPS_PER_PERIOD);
    let mut state = LapState::<1>::REST;
    let mut sums = [0.0; 2];
    let periods = 400;
    for number in 0..periods * STEPS_PER_PERIOD {
        // the load in the middle of the step
        let phase = omega * (f64::from(number) + 0.5) * step;
        let loads = LapLoads {
            a: [force * phase.sin()],
            b: [0.0],
        };
        state = integrator.advance(&state, &loads, step, NonZeroU32::MIN);
        if number >= (periods - 1) * STEPS_PER_PERIOD {
            let (sin, cos) = (omega * f64::from(number + 1) * step).sin_cos();
            sums[0] += sin * state.a.displacement[0];
            sums[1] += cos * state.a.displacement[0];
        }
    }
    let [in_phase, quadrature] = sums.map(|sum| 2.0 * sum / f64::from(STEPS_PER_PERIOD));
    close(in_phase.hypot(quadrature), amplitude, 0.01);
    assert!(quadrature < 0.0 && in_phase.abs() < 0.05 * amplitude);
}
