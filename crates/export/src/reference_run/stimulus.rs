//! Levels that excite every degree of freedom in its own way.

use std::f64::consts::TAU;

use bolted_joint_dynamics::{DofKind, JointLaw};
use bolted_joint_joint::DofSet;

/// Two tones sampled at the levels: frequency in cycles a level, share of the amplitude.
///
/// No two inputs have a tone in common, so that no output is zero or twice another by symmetry.
const TONES: [[(f64, f64); 2]; 4] = [
    [(0.170, 0.6), (0.410, 0.4)],
    [(0.190, 0.6), (0.380, 0.4)],
    [(0.130, 0.6), (0.350, 0.4)],
    [(0.210, 0.6), (0.290, 0.4)],
];

/// What the tones of each further two DOFs lie above those before them, cycles a level.
const FURTHER_TONES: f64 = 0.004;

/// Largest relative motion of a linear joint, m or rad: that of small vibration.
fn small_motion(kind: DofKind) -> f64 {
    match kind {
        DofKind::Translation => 1e-4,
        DofKind::Rotation => 1e-3,
    }
}

/// How much further a nonlinear joint is opened where its nonlinear load would not show otherwise.
const FURTHER: f64 = 10.0;

/// Part that the relative motion reaches of the amplitude at which the first nonlinear term is as large as the linear one: a
/// cubic load is its square of the linear one.
const PART_OF_NONLINEAR: f64 = 0.3;

/// Times that amplitude which a joint with memory is moved by: far enough that its sliders slip and stick again.
const TIMES_OF_MEMORY: f64 = 3.0;

/// Significant digits of a level.
const DIGITS: usize = 6;

/// Values of both sides, a then b, y before theta, from −1 to 1, and their derivatives by the level's number.
pub(in super::super) fn shape(dof: usize, on_b: bool, level: f64) -> (f64, f64) {
    let tones = TONES[2 * usize::from(on_b) + dof % 2];
    let above = FURTHER_TONES * (dof / 2) as f64;
    let mut value = (0.0, 0.0);
    for (frequency, share) in tones {
        let frequency = frequency + above;
        let (sin, cos) = (TAU * frequency * level).sin_cos();
        value.0 += share * sin;
        value.1 += share * TAU * frequency * cos;
    }
    value
}

/// Largest relative motion of each DOF in the run, m and rad.
pub(in super::super) fn relative_motion<const D: usize>(
    law: &JointLaw<D>,
    dofs: DofSet,
) -> [f64; D] {
    std::array::from_fn(|i| {
        let small_motion = small_motion(dofs.row(i).kind);
        let amplitude = law.nonlinear_amplitude()[i];
        if law.remembers(i) && amplitude.is_finite() && amplitude > 0.0 {
            return TIMES_OF_MEMORY * amplitude;
        }
        // |k3| x³ = p² K x at x = p √(K/|k3|), and likewise for the terms of higher order
        let nonlinear = PART_OF_NONLINEAR * amplitude;
        if law.linear.stiffness[i][i] > 0.0 && nonlinear.is_finite() && nonlinear > 0.0 {
            nonlinear.min(FURTHER * small_motion)
        } else {
            small_motion
        }
    })
}

/// `value` with so few digits that the files stay short; what is rounded is what is integrated.
pub(in super::super) fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}
