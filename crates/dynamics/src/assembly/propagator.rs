//! What an assembly's state becomes over a step of a given length: exactly, for loads and joint forces that are polynomials of
//! time.
//!
//! With y = (q, q̇), ẏ = A y + X w, w = (u, f), X = (0; B, −Sᵀ), and w(t) = w₀ + w₁ t + w₂ t²/2:
//!
//! y(h) = E y + hφ₁X w₀ + h²φ₂X w₁ + h³φ₃X w₂,  E = φ₀ = e^{hA},  φ_{k+1} = (φ_k − 1/k!)/(hA)
//!
//! All of them, and the integrals of the motion that the work of the forces takes, are blocks of one exponential, with no
//! inverse, so that motions of free bodies need no care.

use super::{exponential::exponential, matrix::Matrix, system::System};

/// Powers of time that the loads and joint forces of a step have: constant, linear, quadratic.
pub(super) const POWERS: usize = 3;

/// Blocks of the exponential for one length.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    /// E, 2n × 2n.
    pub(super) state: Matrix,
    /// hφ₁X, hφ₂X and hφ₃X, 2n × (m + d).
    pub(super) by: [Matrix; POWERS],
    /// What ∫ Rq dt takes of y, with R = (Bᵀ; S): (m + d) × 2n.
    pub(super) once: Matrix,
    /// What it takes of w₀, h w₁ and h² w₂.
    pub(super) once_by: [Matrix; POWERS],
    /// The same of the integral over the integral.
    pub(super) twice: Matrix,
    pub(super) twice_by: [Matrix; POWERS],
}

impl Blocks {
    /// Those for steps of `length_s` (s); `None` where they are not finite.
    pub(super) fn new(system: &System, length_s: f64) -> Option<Self> {
        let n = system.size;
        let forces = system.loads + system.laws.len();
        let scale = scale(system);
        // in (D q, q̇) all entries of A are frequencies, which keeps the digits
        let h = length_s;
        let mut whole = Matrix::zeros(2 * n + 5 * forces, 2 * n + 5 * forces);
        let [twice, once, y] = [0, forces, 2 * forces];
        let w = |power: usize| y + 2 * n + power * forces;
        for i in 0..n {
            whole[(y + i, y + n + i)] = h * scale[i];
            for j in 0..n {
                whole[(y + n + i, y + j)] = -h * system.stiffness[(i, j)] / scale[j];
                whole[(y + n + i, y + n + j)] = -h * system.damping[(i, j)];
            }
        }
        for p in 0..forces {
            // z̈ = R q
            whole[(twice + p, once + p)] = 1.0;
            for j in 0..n {
                let row = force_row(system, p, j);
                let sign = if p < system.loads { 1.0 } else { -1.0 };
                whole[(once + p, y + j)] = row / scale[j];
                whole[(y + n + j, w(0) + p)] = h * sign * row;
            }
            for power in 1..POWERS {
                whole[(w(power - 1) + p, w(power) + p)] = 1.0;
            }
        }
        let whole = exponential(&whole)?;
        // back to (q, q̇)
        let unit = |i: usize| if i < n { scale[i] } else { 1.0 };
        let of_state = |top: usize, rows: usize, unscaled: bool| {
            Matrix::from_fn(rows, 2 * n, |i, j| {
                let own = if unscaled { unit(i) } else { 1.0 };
                whole[(top + i, y + j)] * unit(j) / own
            })
        };
        let of_forces = |top: usize, rows: usize, power: usize, unscaled: bool| {
            Matrix::from_fn(rows, forces, |i, p| {
                let own = if unscaled { unit(i) } else { 1.0 };
                whole[(top + i, w(power) + p)] / own
            })
        };
        Some(Self {
            state: of_state(y, 2 * n, true),
            by: std::array::from_fn(|power| of_forces(y, 2 * n, power, true)),
            once: of_state(once, forces, false).times(h),
            once_by: std::array::from_fn(|power| of_forces(once, forces, power, false).times(h)),
            twice: of_state(twice, forces, false).times(h * h),
            twice_by: std::array::from_fn(|power| {
                of_forces(twice, forces, power, false).times(h * h)
            }),
        })
    }
}

/// Row of R = (Bᵀ; S) for a load or a joint force.
fn force_row(system: &System, force: usize, coordinate: usize) -> f64 {
    match force.checked_sub(system.loads) {
        None => system.load_rows[(force, coordinate)],
        Some(law) => system.rows[(law, coordinate)],
    }
}

/// D: the frequency of each coordinate, but at least the lowest that there is, rad/s.
fn scale(system: &System) -> Vec<f64> {
    let own = |i: usize| system.stiffness[(i, i)].max(0.0).sqrt();
    let positive = (0..system.size).map(own).filter(|&own| own > 0.0);
    let least = positive.fold(f64::INFINITY, f64::min);
    let least = if least.is_finite() { least } else { 1.0 };
    (0..system.size).map(|i| own(i).max(least)).collect()
}
