//! Weighted nonlinear least squares on the assembly's receptances, over all lines and entries at once.
//!
//! Residuals are (H^C_measured − H^C(K, C))/σ, real and imaginary part, with σ from the *computed* receptance: weights
//! from the measured one would favour lines on which noise happened to be small and bias the damping. The weights are
//! held while a Levenberg–Marquardt iteration with the exact Jacobian converges, then renewed, until nothing moves.

use nalgebra::{DMatrix, DVector};

use super::lines::Lines;
use super::model::{JointMatrices, JointModel};

/// Standard deviation of a measured receptance: σ² = (relative·|H|)² + floor².
///
/// σ is that of the complex error: the variances of its real and imaginary part add up to σ².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseLevel {
    /// Standard deviation as a fraction of |H|.
    pub relative: f64,
    /// Standard deviation that does not depend on |H|, in the receptance's unit (m/N).
    pub floor: f64,
}

impl NoiseLevel {
    fn variance(self, magnitude_squared: f64) -> f64 {
        self.relative * self.relative * magnitude_squared + self.floor * self.floor
    }
}

/// Where the estimator came to rest.
#[derive(Clone, Debug)]
pub(super) struct Estimate {
    /// The joint.
    pub(super) joint: JointMatrices,
    /// Σ|residual|² with the final weights.
    pub(super) cost: f64,
    /// −2 log-likelihood up to a constant, the common scale of the variances profiled out: it ranks estimates whose
    /// weights differ.
    pub(super) misfit: f64,
    /// Real residuals minus unknowns.
    pub(super) degrees_of_freedom: usize,
    /// (JᵀJ)⁻¹ with the final weights, in the order of the unknowns; `None` where JᵀJ is singular.
    pub(super) unit_covariance: Option<DMatrix<f64>>,
    /// Whether the iteration converged.
    pub(super) converged: bool,
}

const MAX_REWEIGHTINGS: usize = 20;
const MAX_ITERATIONS: usize = 100;
/// Relative change of every unknown, in units of its scale, below which the iteration has converged.
const TOLERANCE: f64 = 1e-10;

/// The normal equations at one point: cost, JᵀJ and Jᵀr.
struct Normal {
    cost: f64,
    matrix: DMatrix<f64>,
    gradient: DVector<f64>,
}

/// Estimates the unknowns of `model` from `start`; `None` if the start cannot be evaluated.
pub(super) fn estimate(
    lines: &Lines,
    model: JointModel,
    noise: NoiseLevel,
    start: &JointMatrices,
) -> Option<Estimate> {
    let mut unknowns = DVector::from_vec(start.unknowns(model));
    let mut converged = false;
    let mut variances = variances(lines, noise, &matrices(model, &unknowns))?;
    for _ in 0..MAX_REWEIGHTINGS {
        let (next, settled) = levenberg_marquardt(lines, model, &variances, &unknowns)?;
        let moved = relative_change(&unknowns, &next);
        unknowns = next;
        variances = self::variances(lines, noise, &matrices(model, &unknowns))?;
        if moved < 100.0 * TOLERANCE {
            converged = settled;
            break;
        }
    }
    let normal = normal_equations(lines, model, &variances, &unknowns)?;
    let scale = normal.matrix.diagonal().map(|entry| entry.sqrt().recip());
    let scaled = scaled_by(&normal.matrix, &scale);
    let unit_covariance = scaled
        .cholesky()
        .map(|factor| scaled_by(&factor.inverse(), &scale));
    // −2 ln L = N ln(Σ|r|²/σ² / N) + Σ ln σ² for N complex residuals
    let count = variances.len() as f64;
    let log_variances: f64 = variances.iter().map(|variance| variance.ln()).sum();
    Some(Estimate {
        joint: matrices(model, &unknowns),
        cost: normal.cost,
        misfit: count * (normal.cost / count).ln() + log_variances,
        degrees_of_freedom: (2 * variances.len()).saturating_sub(model.unknowns()),
        unit_covariance,
        converged,
    })
}

fn matrices(model: JointModel, unknowns: &DVector<f64>) -> JointMatrices {
    JointMatrices::from_unknowns(model, unknowns.as_slice())
}

/// Largest change of an unknown, relative to the larger of both.
fn relative_change(before: &DVector<f64>, after: &DVector<f64>) -> f64 {
    let pairs = before.iter().zip(after.iter());
    pairs.fold(0.0, |largest, (b, a)| {
        let size = b.abs().max(a.abs());
        if size > 0.0 {
            f64::max(largest, (a - b).abs() / size)
        } else {
            largest
        }
    })
}

/// D A D with the diagonal D.
fn scaled_by(matrix: &DMatrix<f64>, diagonal: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        diagonal[i] * matrix[(i, j)] * diagonal[j]
    })
}

/// σ² of each measured entry at each line, from the computed receptances.
fn variances(lines: &Lines, noise: NoiseLevel, joint: &JointMatrices) -> Option<Vec<f64>> {
    let computed = lines.regenerated(joint).ok()?;
    let mut variances = Vec::with_capacity(computed.len() * lines.measured.len());
    for assembly in &computed {
        for &place in &lines.measured {
            let variance = noise.variance(assembly[place].norm_sqr());
            if !(variance.is_finite() && variance > 0.0) {
                return None;
            }
            variances.push(variance);
        }
    }
    Some(variances)
}

fn normal_equations(
    lines: &Lines,
    model: JointModel,
    variances: &[f64],
    unknowns: &DVector<f64>,
) -> Option<Normal> {
    let joint = matrices(model, unknowns);
    let entries = model.entries();
    let size = model.unknowns();
    let mut normal = Normal {
        cost: 0.0,
        matrix: DMatrix::zeros(size, size),
        gradient: DVector::zeros(size),
    };
    let mut variances = variances.iter();
    let mut row = vec![num_complex::Complex64::default(); size];
    for (line, frequency_hz) in lines.frequency_hz.iter().enumerate() {
        let omega = std::f64::consts::TAU * frequency_hz;
        let linearised = lines.linearised(line, &joint)?;
        for &place in &lines.measured {
            let weight = 1.0 / variances.next()?;
            let residual = lines.assembly[line][place] - linearised.assembly[place];
            for (index, &entry) in entries.iter().enumerate() {
                // ∂K*/∂k = E_ij, ∂K*/∂c = jω E_ij
                let by_stiffness = linearised.sensitivity(place, entry);
                row[index] = by_stiffness;
                row[entries.len() + index] = num_complex::Complex64::new(0.0, omega) * by_stiffness;
            }
            normal.cost += weight * residual.norm_sqr();
            for i in 0..size {
                normal.gradient[i] += weight * (row[i].conj() * residual).re;
                for j in 0..=i {
                    normal.matrix[(i, j)] += weight * (row[i].conj() * row[j]).re;
                }
            }
        }
    }
    normal.matrix.fill_upper_triangle_with_lower_triangle();
    normal.cost.is_finite().then_some(normal)
}

/// Minimises the cost with fixed weights; the flag tells whether it converged.
fn levenberg_marquardt(
    lines: &Lines,
    model: JointModel,
    variances: &[f64],
    start: &DVector<f64>,
) -> Option<(DVector<f64>, bool)> {
    let mut unknowns = start.clone();
    let mut normal = normal_equations(lines, model, variances, &unknowns)?;
    let mut damping = 1e-3;
    for _ in 0..MAX_ITERATIONS {
        // (JᵀJ + μ diag JᵀJ) δ = Jᵀ r, solved in columns of unit length
        let scale = normal
            .matrix
            .diagonal()
            .map(|entry| entry.max(f64::MIN_POSITIVE).sqrt().recip());
        let mut system = scaled_by(&normal.matrix, &scale);
        for i in 0..system.nrows() {
            system[(i, i)] += damping;
        }
        let gradient = normal.gradient.component_mul(&scale);
        let step = system
            .cholesky()
            .map(|factor| factor.solve(&gradient).component_mul(&scale));
        let trial = step.as_ref().map(|step| &unknowns + step);
        let improved = trial
            .as_ref()
            .and_then(|trial| normal_equations(lines, model, variances, trial))
            .filter(|next| next.cost <= normal.cost);
        match (trial, improved) {
            (Some(trial), Some(next)) => {
                let moved = relative_change(&unknowns, &trial);
                let gained = normal.cost - next.cost;
                unknowns = trial;
                normal = next;
                damping = (damping * 0.1).max(1e-15);
                if moved < TOLERANCE || gained <= 1e-15 * normal.cost {
                    return Some((unknowns, true));
                }
            }
            _ => {
                let settled = step.is_some_and(|step| {
                    relative_change(&unknowns, &(&unknowns + step)) < TOLERANCE
                });
                if settled {
                    return Some((unknowns, true));
                }
                damping *= 10.0;
                if damping > 1e12 {
                    return Some((unknowns, false));
                }
            }
        }
    }
    Some((unknowns, false))
}
