//! Maximum likelihood on the rig by plain Gauss–Newton, with the assembly solved as one structure and derivatives by finite
//! differences: nothing of the program under test computes here.

use nalgebra::{Matrix2, Matrix6, Vector6, matrix};
use num_complex::Complex64;

use crate::rig::{FULL, Joint, LINES, assembled, first_bolt, receptance};

use super::measurement::{Measured, OMEGAS};

const ROUNDS: usize = 8;
/// Step of the differences, as a fraction of each unknown.
const STEP: f64 = 1e-5;

/// k_yy, k_yθ, k_θθ, c_yy, c_yθ, c_θθ of a joint.
pub(super) fn unknowns(joint: &Joint) -> Vector6<f64> {
    let (k, c) = (&joint.stiffness, &joint.damping);
    Vector6::new(
        k[(0, 0)],
        k[(0, 1)],
        k[(1, 1)],
        c[(0, 0)],
        c[(0, 1)],
        c[(1, 1)],
    )
}

fn joint(unknowns: &Vector6<f64>) -> Joint {
    let [k, kt, ktt, c, ct, ctt] = (*unknowns).into();
    Joint {
        stiffness: matrix![k, kt; kt, ktt],
        damping: matrix![c, ct; ct, ctt],
    }
}

/// What the likelihood says of measured functions.
pub(super) struct Fit {
    pub(super) unknowns: Vector6<f64>,
    /// Standard deviations where the variances are believed.
    pub(super) deviation: Vector6<f64>,
    pub(super) reduced_chi_squared: f64,
}

pub(super) fn fit(functions: &[Measured]) -> Fit {
    let mut unknowns = unknowns(&FULL);
    let size = unknowns;
    for _ in 0..ROUNDS {
        let (information, score, _) = sums(functions, &unknowns, &size);
        let step = information.cholesky().unwrap().solve(&score);
        unknowns += step.component_mul(&size);
    }
    let (information, _, chi_squared) = sums(functions, &unknowns, &size);
    let count: usize = functions.iter().map(|one| one.values.len()).sum();
    // cov = (2 Re Jᴴ Σ⁻¹ J)⁻¹ for complex circular errors
    let covariance = information.try_inverse().unwrap() * 0.5;
    Fit {
        unknowns,
        deviation: covariance.diagonal().map(f64::sqrt).component_mul(&size),
        reduced_chi_squared: chi_squared / (2 * count - 6) as f64,
    }
}

/// Re Jᴴ Σ⁻¹ J and Re Jᴴ Σ⁻¹ r by unknowns in units of `size`, and χ² = 2 Σ |r|²/σ².
fn sums(
    functions: &[Measured],
    unknowns: &Vector6<f64>,
    size: &Vector6<f64>,
) -> (Matrix6<f64>, Vector6<f64>, f64) {
    let (mut information, mut score, mut chi_squared) = (Matrix6::zeros(), Vector6::zeros(), 0.0);
    let motion = |unknowns: &Vector6<f64>, line: usize| {
        assembled(&[first_bolt(joint(unknowns))], OMEGAS[line])
    };
    for line in 0..LINES {
        let whole = motion(unknowns, line);
        let moved: [[Matrix2<Complex64>; 2]; 6] = std::array::from_fn(|i| {
            [STEP, -STEP].map(|step| {
                let mut moved = *unknowns;
                moved[i] += step * size[i];
                motion(&moved, line)
            })
        });
        for function in functions {
            let of = |motion: &Matrix2<Complex64>| {
                receptance(motion, function.response, function.reference)
            };
            let value = of(&whole);
            let weight = 1.0 / function.variance[line];
            let slope = moved
                .each_ref()
                .map(|[up, down]| (of(up) - of(down)) / (2.0 * STEP));
            let residual = function.values[line] - value;
            for i in 0..6 {
                score[i] += weight * (slope[i].conj() * residual).re;
                for j in 0..6 {
                    information[(i, j)] += weight * (slope[i].conj() * slope[j]).re;
                }
            }
            chi_squared += 2.0 * weight * residual.norm_sqr();
        }
    }
    (information, score, chi_squared)
}
