//! The lap of the joint file, integrated in time as its FMU does, against the beam's mode.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use bolted_joint::predict::layered_beam::{LayeredBeamStudy, Outcome};
use bolted_joint::study::StudyText;
use bolted_joint_dynamics::{LapLoads, LapState, LapStepper, Motion};

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
    let stepper = LapStepper::new(&lap);
    let mut moment = stepper.begin(LapState {
        a: at(amplitude),
        b: at(share * amplitude),
    });
    let loads = LapLoads { a: [0.0], b: [0.0] };
    let step = 1.0 / mode.frequency_hz / f64::from(STEPS_PER_PERIOD);
    let mut found = vec![(0.0, amplitude)];
    for number in 1..=periods * STEPS_PER_PERIOD {
        let before = moment.state;
        stepper.step(&mut moment, &[loads; 3], step);
        let state = &moment.state;
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

/// Friction takes E_f a period and the amplitude falls in a straight line, but for what sticks.
#[test]
fn dry_friction_decays_in_a_straight_line() {
    for (boundary, mode) in [("fixed-fixed", 1), ("fixed-free", 2)] {
        let found = outcome(&study(boundary, mode, ""));
        let worst = found.joint_damping_worst_error;
        close(worst, 1e-3, 1e-12);
        let peaks = peaks(&found, 3e-4, 40);
        let own = found.amplitudes.iter().filter(|row| row.mode == mode);
        let rows: Vec<_> = own.collect();
        for row in &rows {
            let joint = row.joint_damping_ratio.unwrap();
            // the mount's part is that of the largest amplitude
            close(joint, row.damping_ratio, worst + 1e-3);
        }
        let row = rows[0];
        let stiffness = 2.0 * row.stored_energy_j / row.amplitude_m.powi(2);
        let per_amplitude = row.dissipated_energy_j / row.amplitude_m;
        let mut compared = 0;
        for pair in peaks[1..].windows(2) {
            let (high, low) = (pair[0].1, pair[1].1);
            if low < 1e-4 {
                break;
            }
            // ½ k (w₁² − w₂²) = E_f at the mean amplitude
            let expected = per_amplitude / stiffness;
            close(high - low, expected, 5e-3);
            compared += 1;
        }
        assert!(compared > 8, "{compared}");
    }
}

/// Dry friction has the same load at every amplitude: at resonance a force of that size holds each that it begins with.
#[test]
fn at_resonance_the_force_of_friction_holds_any_amplitude() {
    let found = outcome(&study("fixed-fixed", 1, ""));
    let lap = found.joint_file.lap::<1>().unwrap();
    let beam = &found.modes[0];
    let slider = lap.joint.on[0].jenkins();
    let share = {
        let omega = TAU * beam.frequency_hz;
        omega * omega * lap.a.inertia[0] / (lap.b.stiffness[0] - omega * omega * lap.b.inertia[0])
    };
    for amplitude in [1.2e-4, 2.8e-4] {
        let r = (1.0 - share) * amplitude;
        // (k/π)(θ_s − ½ sin 2θ_s) beside the lap's stiffness
        let angle = (1.0 - 2.0 * slider.slip_force / (slider.stiffness * r)).acos();
        let secant = slider.stiffness / PI * (angle - 0.5 * (2.0 * angle).sin());
        let omega = TAU * beam.frequency_hz * (1.0 + secant / beam.stiffness_n_per_m).sqrt();
        let slips = 1.0 - slider.slip_force / (slider.stiffness * r);
        let mount = lap.b.damping[0] * share * share * omega * amplitude;
        let force = 4.0 / PI * slider.slip_force * slips + mount;
        let stepper = LapStepper::new(&lap);
        let step = TAU / omega / f64::from(STEPS_PER_PERIOD);
        let at = |displacement: f64| Motion {
            displacement: [displacement],
            velocity: [0.0],
        };
        let mut moment = stepper.begin(LapState {
            a: at(-amplitude),
            b: at(-share * amplitude),
        });
        let mut sums = [0.0; 2];
        let periods = 60;
        for number in 0..periods * STEPS_PER_PERIOD {
            let loads = [0.0, 0.5, 1.0].map(|part| LapLoads {
                a: [force * (omega * (f64::from(number) + part) * step).sin()],
                b: [0.0],
            });
            stepper.step(&mut moment, &loads, step);
            if number >= (periods - 1) * STEPS_PER_PERIOD {
                let (sin, cos) = (omega * f64::from(number + 1) * step).sin_cos();
                sums[0] += sin * moment.state.a.displacement[0];
                sums[1] += cos * moment.state.a.displacement[0];
            }
        }
        let [in_phase, quadrature] = sums.map(|sum| 2.0 * sum / f64::from(STEPS_PER_PERIOD));
        close(in_phase.hypot(quadrature), amplitude, 0.01);
        assert!(quadrature < 0.0 && in_phase.abs() < 0.05 * amplitude);
    }
}
