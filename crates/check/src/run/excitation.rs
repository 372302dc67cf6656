//! What the run does to the FMU: every DOF is moved or loaded, far enough for a cubic term to show, not so far that a
//! softening joint escapes.

use bolted_joint_dynamics::{DofKind, with_dofs};

use super::balance::Integral;
use super::names::References;
use super::script::Action;
use bolted_joint_export::Interface;
use bolted_joint_joint::JointFile;

/// Spans of the quadrature in a run.
const SPANS: usize = 200;
/// Displacement (m) and rotation (rad) of a linear joint: usual magnitudes, the scale does not matter.
const LINEAR_AMPLITUDE: [f64; 2] = [1e-5, 1e-4];
/// Largest displacement (m) and rotation (rad) of a cubic joint.
const LARGEST_AMPLITUDE: [f64; 2] = [1e-3, 1e-2];
/// What a joint without stiffness is loaded by, because it is usual: N, N·m.
const USUAL_LOAD: [f64; 2] = [1.0, 1e-2];
/// Amplitude of a cubic joint by √(k/|k3|), where the cubic load would be as large as the linear one.
const CUBIC_AMPLITUDE: f64 = 0.02;
/// Amplitude of a joint with terms of higher order, by that at which the first of them is as large as the linear one, and by
/// the escape amplitude: those of seventh order still show.
const HIGHER_AMPLITUDE: f64 = 0.1;
/// Period of a motion by c/k, so that the damper takes a fair part of the energy.
const PERIOD_BY_RELAXATION: f64 = 20.0;
/// Period (s) where the joint has no damping.
const UNDAMPED_PERIOD_S: f64 = 1e-2;

fn of_kind([translation, rotation]: [f64; 2], kind: DofKind) -> f64 {
    match kind {
        DofKind::Translation => translation,
        DofKind::Rotation => rotation,
    }
}

/// Steps and inputs of a run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Excitation {
    pub(super) interface: Interface,
    /// Length of a span, s.
    pub(super) span_s: f64,
    amplitude: Vec<f64>,
    load: Vec<f64>,
}

impl Excitation {
    /// For the joint in `file`, and the longest step of a lap.
    pub(super) fn of(file: &JointFile, interface: Interface, step_size_max_s: Option<f64>) -> Self {
        let amplitude = amplitude(file);
        let joint = &file.joint;
        let diagonal = |matrix: &[Vec<f64>], i: usize| {
            matrix
                .get(i)
                .and_then(|row| row.get(i))
                .copied()
                .unwrap_or(0.0)
        };
        let load = amplitude
            .iter()
            .enumerate()
            .map(|(i, amplitude)| {
                let stiffness = diagonal(&joint.stiffness, i).abs();
                if stiffness > 0.0 {
                    stiffness * amplitude
                } else {
                    of_kind(USUAL_LOAD, joint.dofs.row(i).kind)
                }
            })
            .collect();
        let (k, c) = (diagonal(&joint.stiffness, 0), diagonal(&joint.damping, 0));
        let period_s = if k > 0.0 && c > 0.0 {
            PERIOD_BY_RELAXATION * c / k
        } else {
            UNDAMPED_PERIOD_S
        };
        let span_s = match interface {
            Interface::Element => 5.0 * period_s / SPANS as f64,
            // the coarser run takes as many steps in a span as the rule has intervals
            Interface::Lap => Integral::SPAN as f64 * lap_step_s(file, step_size_max_s),
        };
        Self {
            interface,
            span_s,
            amplitude,
            load,
        }
    }

    /// The run with `steps` steps in a span, everything read after each.
    pub(super) fn actions(&self, references: &References, steps: usize) -> Vec<Action> {
        let step_s = self.span_s / steps as f64;
        let observed = references.observed();
        let mut actions = vec![self.start(references)];
        let get = || Action::Get {
            references: observed.clone(),
        };
        actions.push(get());
        for index in 0..self.step_count(steps) {
            let time_s = index as f64 * step_s;
            if self.interface == Interface::Lap && index % steps == 0 {
                actions.push(self.set_loads(references, index / steps));
            }
            actions.push(Action::Step {
                time_s,
                interval_s: step_s,
                tentative: false,
            });
            if self.interface == Interface::Element {
                actions.push(self.set_motion(references, (index + 1) as f64 * step_s));
            }
            actions.push(get());
        }
        actions
    }

    /// Communication steps of the run with `steps` steps in a span.
    pub(super) fn step_count(&self, steps: usize) -> usize {
        SPANS * steps
    }

    /// A new instance: the element where its path begins, the lap off its rest.
    pub(super) fn start(&self, references: &References) -> Action {
        let (displacements, velocities) = match self.interface {
            Interface::Element => self.path(0.0),
            Interface::Lap => {
                let apart = [1.0, -0.5];
                let displacements = apart
                    .iter()
                    .flat_map(|side| self.amplitude.iter().map(move |amplitude| side * amplitude))
                    .collect();
                (displacements, vec![0.0; references.velocities.len()])
            }
        };
        Action::Start {
            references: moved(references),
            values: [displacements, velocities].concat(),
        }
    }

    /// Loads held over the span with this index.
    pub(super) fn set_loads(&self, references: &References, span: usize) -> Action {
        Action::Set {
            references: references.loads.clone(),
            values: self.loads(span),
        }
    }

    /// Loads held over the span with this index, N and N·m, on a then on b.
    pub(super) fn loads(&self, span: usize) -> Vec<f64> {
        // F = A sin²(πs) sin(2πps + φ) at the middle of the span, another p and φ for each
        let s = (span as f64 + 0.5) / SPANS as f64;
        let window = (std::f64::consts::PI * s).sin().powi(2);
        let both_sides = self.load.iter().chain(&self.load);
        both_sides
            .enumerate()
            .map(|(i, amplitude)| {
                let phase = std::f64::consts::TAU * (1.0 + 0.5 * i as f64) * s + 0.7 * i as f64;
                amplitude * window * phase.sin()
            })
            .collect()
    }

    /// Moves both sides of the element to where they are at `time_s`.
    pub(super) fn set_motion(&self, references: &References, time_s: f64) -> Action {
        let (displacements, velocities) = self.path(time_s);
        Action::Set {
            references: moved(references),
            values: [displacements, velocities].concat(),
        }
    }

    /// Displacements and velocities of a, then of b, on their paths.
    fn path(&self, time_s: f64) -> (Vec<f64>, Vec<f64>) {
        let duration_s = SPANS as f64 * self.span_s;
        let both_sides = self.amplitude.iter().chain(&self.amplitude);
        both_sides
            .enumerate()
            .map(|(i, amplitude)| {
                // x = A sin(ωt + φ), another ω and φ for each, and no whole number of periods
                let omega = std::f64::consts::TAU * (3.3 + 0.9 * i as f64) / duration_s;
                let phase = omega * time_s + 0.4 + 0.7 * i as f64;
                (amplitude * phase.sin(), amplitude * omega * phase.cos())
            })
            .unzip()
    }
}

/// References of displacements, then of velocities.
pub(super) fn moved(references: &References) -> Vec<u32> {
    [
        references.displacements.clone(),
        references.velocities.clone(),
    ]
    .concat()
}

/// How far each DOF is moved: m, rad.
fn amplitude(file: &JointFile) -> Vec<f64> {
    let dofs = file.joint.dofs;
    let (escape, nonlinear) = with_dofs!(dofs.size(), D => {
        (
            file.lap::<D>().map(|lap| lap.escape_amplitude().to_vec()),
            file.joint.law::<D>().map(|law| law.nonlinear_amplitude().to_vec()),
        )
    });
    let escape = escape.unwrap_or_default();
    let nonlinear = nonlinear.unwrap_or_default();
    let part = if file.joint.has_terms_of_higher_order() {
        HIGHER_AMPLITUDE
    } else {
        CUBIC_AMPLITUDE
    };
    dofs.rows()
        .enumerate()
        .map(|(i, dof)| {
            let nonlinear = nonlinear.get(i).copied().unwrap_or(f64::INFINITY);
            // zero of a polynomial without a spring beside it
            let by_terms = if nonlinear > 0.0 && nonlinear.is_finite() {
                (part * nonlinear).min(of_kind(LARGEST_AMPLITUDE, dof.kind))
            } else {
                of_kind(LINEAR_AMPLITUDE, dof.kind)
            };
            let escape = escape.get(i).copied().flatten();
            escape.map_or(by_terms, |escape| by_terms.min(part * escape))
        })
        .collect()
}

/// A step that follows the lap's fastest mode and is a single Runge–Kutta step.
fn lap_step_s(file: &JointFile, step_size_max_s: Option<f64>) -> f64 {
    let accurate_s = with_dofs!(file.joint.dofs.size(), D => {
        file.lap::<D>().ok().and_then(|lap| lap.spectrum()?.accurate_step_s())
    });
    let longest = step_size_max_s.unwrap_or(f64::INFINITY);
    let step_s = accurate_s.unwrap_or(f64::INFINITY).min(longest);
    if step_s.is_finite() && step_s > 0.0 {
        step_s
    } else {
        UNDAMPED_PERIOD_S / SPANS as f64
    }
}
