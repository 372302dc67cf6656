//! What the joint does, drawn: receptances of a lap, dynamic stiffness of an element, load over displacement of what is
//! not linear.

use bolted_joint_dynamics::{
    Dof, DofKind, JointLaw, Lap, Motion, Polynomial, law::Term, with_dofs,
};
use nalgebra::DMatrix;
use num_complex::Complex64;

use super::super::Interface;
use super::super::fmu::Mode;
use super::Page;
use bolted_joint_figures::html::number;
use bolted_joint_figures::{Line, LineFigure, Scale};
use bolted_joint_joint::JointFile;

/// Frequencies of a curve, spread evenly over the logarithmic axis, without those about the resonances.
const SAMPLES: usize = 300;
/// Frequencies about each resonance, in half-power bandwidths from it.
const ABOUT_RESONANCE: [f64; 11] = [-8.0, -4.0, -2.0, -1.0, -0.4, 0.0, 0.4, 1.0, 2.0, 4.0, 8.0];

/// Frequencies (Hz) shown of an element whose joint file states none.
const BAND_OF_ELEMENT_HZ: [f64; 2] = [1.0, 1000.0];

/// Loads are drawn up to this part of the displacement at which the first nonlinear term is as large as the linear one, where
/// a softening cubic joint has long turned over (at 0.58).
const PART_OF_NONLINEAR: f64 = 0.7;

/// Points of a load-displacement curve.
const LOAD_POINTS: i32 = 120;

/// Axes of the figures for one kind of DOF.
struct Axes {
    motion_unit: (&'static str, f64),
    motion: &'static str,
    load: &'static str,
    /// Relative motion (m, rad) beyond which no bolted joint goes.
    longest: f64,
    receptance: &'static str,
    stiffness: &'static str,
}

impl Axes {
    const fn of(kind: DofKind) -> Self {
        match kind {
            DofKind::Translation => Self {
                motion_unit: ("mm", 1e3),
                motion: "relative displacement, mm",
                load: "force, N",
                longest: 1e-2,
                receptance: "receptance, m/N",
                stiffness: "N/m",
            },
            DofKind::Rotation => Self {
                motion_unit: ("mrad", 1e3),
                motion: "relative rotation, mrad",
                load: "moment, N·m",
                longest: 1.0,
                receptance: "receptance, rad/(N·m)",
                stiffness: "N·m/rad",
            },
        }
    }
}

pub(super) fn section(page: &Page<'_>) -> String {
    let modes = page.lap.map_or(&[][..], |facts| facts.modes.as_slice());
    let figures =
        with_dofs!(page.file.joint.dofs.size(), D => sized::<D>(page.file, page.interface, modes));
    let figures: String = figures
        .into_iter()
        .filter_map(|(figure, caption)| {
            let svg = figure
                .to_svg()?
                .replace(" xmlns=\"http://www.w3.org/2000/svg\"", "");
            Some(format!(
                "<figure>\n{svg}<figcaption>{caption}</figcaption>\n</figure>\n"
            ))
        })
        .collect();
    if figures.is_empty() {
        return String::new();
    }
    format!("<h2>Behaviour</h2>\n{figures}")
}

/// What a joint does by itself, with captions in HTML: its dynamic stiffness, and its static load where that is not linear. None
/// where the joint file does not give the equations, as that of a joint over the preload.
#[must_use]
pub fn joint_curves(file: &JointFile) -> Vec<(LineFigure<'static>, String)> {
    with_dofs!(file.joint.dofs.size(), D => sized::<D>(file, Interface::Element, &[]))
}

/// Figures with their captions; none where the joint file does not give the equations.
fn sized<const D: usize>(
    file: &JointFile,
    interface: Interface,
    modes: &[Mode],
) -> Vec<(LineFigure<'static>, String)> {
    let Ok(law) = file.joint.law::<D>() else {
        return Vec::new();
    };
    let mut figures = match interface {
        Interface::Lap => file
            .lap::<D>()
            .map(|lap| receptances(&lap, file, modes))
            .unwrap_or_default(),
        Interface::Element => dynamic_stiffness(&law, file),
    };
    let dofs = file.joint.dofs.rows().enumerate();
    figures.extend(dofs.filter_map(|(i, dof)| load_curve(&law, i, dof)));
    figures
}

/// |H(ω)| of both bodies by a load on body a, for each DOF.
fn receptances<const D: usize>(
    lap: &Lap<D>,
    file: &JointFile,
    modes: &[Mode],
) -> Vec<(LineFigure<'static>, String)> {
    let (Some(first), Some(last)) = (modes.first(), modes.last()) else {
        return Vec::new();
    };
    let mut frequencies = spread(0.3 * first.frequency_hz, 3.0 * last.frequency_hz);
    for mode in modes {
        // Half-power bandwidth: 2ζf.
        let bandwidth = 2.0 * mode.damping_ratio.abs().max(1e-6) * mode.frequency_hz;
        frequencies.extend(ABOUT_RESONANCE.map(|at| mode.frequency_hz + at * bandwidth));
    }
    frequencies.retain(|frequency| *frequency > 0.0);
    frequencies.sort_by(f64::total_cmp);
    let solved: Vec<(f64, Option<DMatrix<Complex64>>)> = frequencies
        .into_iter()
        .map(|frequency| (frequency, impedance(lap, frequency).try_inverse()))
        .collect();
    file.joint
        .dofs
        .rows()
        .enumerate()
        .map(|(i, dof)| {
            let line = |side: &str, row: usize| {
                let name = format!("{} of body {side}", dof.symbol);
                let points = solved.iter().map(|(frequency, receptance)| {
                    let value = receptance.as_ref().map_or(f64::NAN, |h| h[(row, i)].norm());
                    (*frequency, value)
                });
                Line::curve(&name, points)
            };
            let figure = LineFigure {
                title: "Receptances of both bodies over frequency",
                across: ("frequency, Hz", Scale::Logarithmic),
                up: (Axes::of(dof.kind).receptance, Scale::Logarithmic),
                lines: vec![line("a", i), line("b", D + i)],
            };
            let caption = format!(
                "Magnitude of the receptances <i>{motion}</i>/<i>{load}</i><sub>a</sub> of both bodies, about rest.",
                motion = dof.symbol,
                load = dof.load,
            );
            (figure, caption)
        })
        .collect()
}

/// Z(ω) = K − ω²M + jωC of the whole lap, DOFs of a before those of b.
fn impedance<const D: usize>(lap: &Lap<D>, frequency_hz: f64) -> DMatrix<Complex64> {
    let omega = std::f64::consts::TAU * frequency_hz;
    let mut impedance = DMatrix::zeros(2 * D, 2 * D);
    for i in 0..D {
        for j in 0..D {
            let linear = &lap.joint.linear;
            let joint = Complex64::new(linear.stiffness[i][j], omega * linear.damping[i][j]);
            impedance[(i, j)] += joint;
            impedance[(D + i, D + j)] += joint;
            impedance[(i, D + j)] -= joint;
            impedance[(D + i, j)] -= joint;
        }
        for (first, body) in [(0, &lap.a), (D, &lap.b)] {
            let support = body.stiffness[i] - omega * omega * body.inertia[i];
            impedance[(first + i, first + i)] += Complex64::new(support, omega * body.damping[i]);
        }
    }
    impedance
}

/// |K + jωC| of each DOF, each with the elastic and the viscous part that make it up.
fn dynamic_stiffness<const D: usize>(
    law: &JointLaw<D>,
    file: &JointFile,
) -> Vec<(LineFigure<'static>, String)> {
    let band = file
        .validity
        .as_ref()
        .map_or(BAND_OF_ELEMENT_HZ, |validity| validity.frequency_hz);
    let frequencies = spread(band[0].max(1e-3 * band[1]), band[1]);
    file.joint
        .dofs
        .rows()
        .enumerate()
        .map(|(i, dof)| {
            let (stiffness, damping) = (law.linear.stiffness[i][i], law.linear.damping[i][i]);
            let line = |name: &str, value: &dyn Fn(f64) -> f64| {
                let at = |&frequency| (frequency, value(std::f64::consts::TAU * frequency));
                Line::curve(name, frequencies.iter().map(at))
            };
            let figure = LineFigure {
                title: "Dynamic stiffness of the joint over frequency",
                across: ("frequency, Hz", Scale::Logarithmic),
                up: (Axes::of(dof.kind).stiffness, Scale::Logarithmic),
                lines: vec![
                    line("|K + jωC|", &|omega| stiffness.hypot(omega * damping)),
                    line("K", &|_| stiffness.abs()),
                    line("ωC", &|omega| omega * damping.abs()),
                ],
            };
            let caption = format!(
                "Dynamic stiffness of the joint against the relative motion <i>{motion}</i> alone, and its elastic and viscous \
                 parts; their ratio, the loss factor, is {loss} at {from} Hz and {at_end} at {to} Hz.",
                motion = dof.symbol,
                loss = loss_factor(stiffness, damping, band[0]),
                from = number(band[0]),
                at_end = loss_factor(stiffness, damping, band[1]),
                to = number(band[1]),
            );
            (figure, caption)
        })
        .collect()
}

/// η = ωC/K
fn loss_factor(stiffness: f64, damping: f64, frequency_hz: f64) -> String {
    let ratio = std::f64::consts::TAU * frequency_hz * damping / stiffness;
    if ratio.is_finite() {
        let rounded = format!("{ratio:.1e}").parse().unwrap_or(ratio);
        number(rounded)
    } else {
        "infinite".to_owned()
    }
}

/// Static load over one relative displacement; `None` for a DOF that is linear as far as a bolted joint moves.
fn load_curve<const D: usize>(
    law: &JointLaw<D>,
    i: usize,
    dof: &Dof,
) -> Option<(LineFigure<'static>, String)> {
    let stiffness = law.linear.stiffness[i][i];
    // only the springs: damping has no part in a static load
    let mut springs = *law;
    springs.on = law
        .on
        .map(|laws| laws.with_only(|parameter| parameter.acts_on.stored_energy));
    // |kₙ| xⁿ = K x at x = (K/|kₙ|)^(1/(n−1))
    let equal = springs.nonlinear_amplitude()[i];
    let reach = PART_OF_NONLINEAR * equal;
    let axes = Axes::of(dof.kind);
    if !(reach > 0.0 && reach <= axes.longest) {
        return None;
    }
    let (unit, per_si) = axes.motion_unit;
    let line = |name: &str, load: &dyn Fn(f64) -> f64| {
        let points = (-LOAD_POINTS / 2..=LOAD_POINTS / 2).map(|k| {
            let x = reach * f64::from(k) / f64::from(LOAD_POINTS / 2);
            (per_si * x, load(x))
        });
        Line::curve(name, points)
    };
    let load = |x: f64| {
        let mut relative = Motion::REST;
        relative.displacement[i] = x;
        springs.load_on_b(&relative)[i]
    };
    let cubic = Polynomial::cubic(springs.on[i].polynomial().coefficient(Term::CUBIC));
    let is_cubic = springs.on[i] == cubic.into();
    let name = if is_cubic {
        "with cubic term"
    } else {
        "with nonlinear terms"
    };
    let figure = LineFigure {
        title: "Static load of the joint over its relative displacement",
        across: (axes.motion, Scale::Linear),
        up: (axes.load, Scale::Linear),
        lines: vec![line(name, &load), line("linear part", &|x| stiffness * x)],
    };
    let motion = dof.symbol;
    let part = if is_cubic {
        format!(
            "The cubic part is 1 % of the linear one at {small} {unit}, 10 % at {large} {unit}.",
            small = number(three_digits(per_si * equal * 0.1)),
            large = number(three_digits(per_si * equal * 0.1_f64.sqrt())),
        )
    } else {
        format!(
            "The first of its nonlinear terms is as large as the linear one at {} {unit}.",
            number(three_digits(per_si * equal))
        )
    };
    let caption =
        format!("Static load of the joint over the relative motion <i>{motion}</i>. {part}");
    Some((figure, caption))
}

fn three_digits(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// Frequencies (Hz) evenly spread over a logarithmic axis.
fn spread(from: f64, to: f64) -> Vec<f64> {
    let steps = (SAMPLES - 1) as f64;
    (0..SAMPLES)
        .map(|k| from * (to / from).powf(k as f64 / steps))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bolted_joint_dynamics::{Body, Linear};

    #[test]
    fn the_impedance_is_that_of_two_oscillators() {
        // Pirdayr, Ex.03, symmetric: in-phase receptance 1/(k − ω²m + jωc), out of phase with k + 2 k12.
        let body = Body {
            inertia: [2.35],
            stiffness: [10.56e5],
            damping: [1.39],
        };
        let lap = Lap {
            joint: Linear {
                stiffness: [[4.56e6]],
                damping: [[0.54]],
            }
            .into(),
            a: body,
            b: body,
        };
        for frequency in [10.0, 106.7, 200.0, 331.0] {
            let omega = std::f64::consts::TAU * frequency;
            let mode = |stiffness: f64, damping: f64| {
                1.0 / Complex64::new(stiffness - omega * omega * 2.35, omega * damping)
            };
            let in_phase = mode(10.56e5, 1.39);
            let out_of_phase = mode(10.56e5 + 2.0 * 4.56e6, 1.39 + 2.0 * 0.54);
            let found = impedance(&lap, frequency).try_inverse().unwrap();
            for (row, expected) in [
                (0, 0.5 * (in_phase + out_of_phase)),
                (1, 0.5 * (in_phase - out_of_phase)),
            ] {
                let error = (found[(row, 0)] - expected).norm() / expected.norm();
                assert!(error < 1e-12, "{frequency} Hz: {error}");
            }
        }
    }
}
