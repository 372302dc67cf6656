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
/// Change of every unknown, relative to its value or to 1/√(JᵀJ)_ii, below which the iteration has converged.
const TOLERANCE: f64 = 1e-10;
/// Gain that the full Gauss–Newton step promises, as a fraction of the cost, below which the iteration has converged.
const NEGLIGIBLE_GAIN: f64 = 1e-15;
/// The same where no damped step lowers the cost any more: rounding of the sum hides gains of this size.
const HIDDEN_GAIN: f64 = 1e-12;
/// Relative rounding of a computed receptance: residuals of this size are none.
const ROUNDING: f64 = 1e-13;
/// Smallest eigenvalue of JᵀJ, scaled to a unit diagonal, that counts as different from zero.
const SINGULAR: f64 = 1e-14;

/// The normal equations at one point: cost, Σ|H|²/σ² of the measured receptances, JᵀJ and Jᵀr.
struct Normal {
    cost: f64,
    signal: f64,
    matrix: DMatrix<f64>,
    gradient: DVector<f64>,
}

impl Normal {
    /// 1/√(JᵀJ)_ii: by how much each unknown changes the residual's norm by one.
    fn scale(&self) -> DVector<f64> {
        self.matrix
            .diagonal()
            .map(|entry| entry.max(f64::MIN_POSITIVE).sqrt().recip())
    }

    /// Solution of (JᵀJ + μ diag JᵀJ) δ = Jᵀ r, in columns of unit length.
    fn step(&self, damping: f64) -> Option<DVector<f64>> {
        let scale = self.scale();
        let mut system = scaled_by(&self.matrix, &scale);
        for i in 0..system.nrows() {
            system[(i, i)] += damping;
        }
        let gradient = self.gradient.component_mul(&scale);
        let factor = system.cholesky()?;
        Some(factor.solve(&gradient).component_mul(&scale))
    }

    /// The full step, damped only as far as a singular JᵀJ needs it.
    fn full_step(&self) -> Option<DVector<f64>> {
        self.step(1e-12)
    }

    /// Whether the full step would change nothing: no unknown moves, or the gain it promises is that fraction of the
    /// cost. A step that is short because it is damped proves nothing.
    fn is_settled(&self, unknowns: &DVector<f64>, negligible_gain: f64) -> bool {
        let Some(step) = self.full_step() else {
            return false;
        };
        // S(p) − S(p + δ) = δᵀ Jᵀ r in the linearised model
        let gain = step.dot(&self.gradient);
        gain <= negligible_gain * self.cost + ROUNDING * ROUNDING * self.signal
            || relative_change(unknowns, &(unknowns + step), &self.scale()) < TOLERANCE
    }

    /// (JᵀJ)⁻¹, or `None` where JᵀJ is singular to within rounding.
    fn inverse(&self) -> Option<DMatrix<f64>> {
        let scale = self.scale();
        let scaled = scaled_by(&self.matrix, &scale);
        let smallest = scaled.symmetric_eigenvalues().min();
        if smallest.is_nan() || smallest < SINGULAR {
            return None;
        }
        let factor = scaled.cholesky()?;
        Some(scaled_by(&factor.inverse(), &scale))
    }
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
        let (next, settled, scale) = levenberg_marquardt(lines, model, &variances, &unknowns)?;
        let moved = relative_change(&unknowns, &next, &scale);
        unknowns = next;
        variances = self::variances(lines, noise, &matrices(model, &unknowns))?;
        if moved < 100.0 * TOLERANCE {
            converged = settled;
            break;
        }
    }
    let normal = normal_equations(lines, model, &variances, &unknowns)?;
    // −2 ln L = 2 N ln(Σ|r|²/σ² / N) + 2 Σ ln σ² for N complex residuals
    let count = variances.len() as f64;
    let log_variances: f64 = variances.iter().map(|variance| variance.ln()).sum();
    Some(Estimate {
        joint: matrices(model, &unknowns),
        cost: normal.cost,
        misfit: 2.0 * (count * (normal.cost / count).ln() + log_variances),
        degrees_of_freedom: (2 * variances.len()).saturating_sub(model.unknowns()),
        unit_covariance: normal.inverse(),
        converged,
    })
}

fn matrices(model: JointModel, unknowns: &DVector<f64>) -> JointMatrices {
    JointMatrices::from_unknowns(model, unknowns.as_slice())
}

/// Largest change of an unknown, relative to the larger of its values and its `scale`: one that is zero but for rounding
/// does not count as moving.
fn relative_change(before: &DVector<f64>, after: &DVector<f64>, scale: &DVector<f64>) -> f64 {
    let triples = before.iter().zip(after.iter()).zip(scale.iter());
    triples.fold(0.0, |largest, ((b, a), scale)| {
        f64::max(largest, (a - b).abs() / b.abs().max(a.abs()).max(*scale))
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
        signal: 0.0,
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
            normal.signal += weight * lines.assembly[line][place].norm_sqr();
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

/// Minimises the cost with fixed weights: where, whether it converged, and the scale of the unknowns there.
fn levenberg_marquardt(
    lines: &Lines,
    model: JointModel,
    variances: &[f64],
    start: &DVector<f64>,
) -> Option<(DVector<f64>, bool, DVector<f64>)> {
    let mut unknowns = start.clone();
    let mut normal = normal_equations(lines, model, variances, &unknowns)?;
    let mut damping = 1e-3;
    for _ in 0..MAX_ITERATIONS {
        if normal.is_settled(&unknowns, NEGLIGIBLE_GAIN) {
            return Some((unknowns, true, normal.scale()));
        }
        let trial = normal.step(damping).map(|step| &unknowns + step);
        let improved = trial
            .as_ref()
            .and_then(|trial| normal_equations(lines, model, variances, trial))
            .filter(|next| next.cost <= normal.cost);
        if let (Some(trial), Some(next)) = (trial, improved) {
            unknowns = trial;
            normal = next;
            damping = (damping * 0.1).max(1e-15);
        } else {
            damping *= 10.0;
            if damping > 1e12 {
                break;
            }
        }
    }
    let settled = normal.is_settled(&unknowns, HIDDEN_GAIN);
    Some((unknowns, settled, normal.scale()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{dmatrix, dvector};

    fn normal(matrix: DMatrix<f64>, gradient: DVector<f64>) -> Normal {
        Normal {
            cost: 1.0,
            signal: 1.0,
            matrix,
            gradient,
        }
    }

    #[test]
    fn a_step_that_is_short_only_because_it_is_damped_is_not_the_end() {
        let normal = normal(dmatrix![4.0, 0.0; 0.0, 1e-4], dvector![0.4, 0.0]);
        let unknowns = dvector![1.0, 1.0];
        let damped = normal.step(1e12).unwrap();
        assert!(relative_change(&unknowns, &(&unknowns + damped), &normal.scale()) < TOLERANCE);
        assert!(!normal.is_settled(&unknowns, HIDDEN_GAIN));
    }

    #[test]
    fn an_unknown_that_is_zero_but_for_rounding_does_not_move() {
        let normal = normal(dmatrix![4.0, 0.0; 0.0, 1.0], dvector![4e-12, -1e-15]);
        assert!(normal.is_settled(&dvector![1.0, 1e-15], 0.0));
    }

    #[test]
    fn dependent_columns_have_no_inverse() {
        let dependent = normal(dmatrix![4.0, 2e3; 2e3, 1e6], dvector![0.0, 0.0]);
        assert_eq!(dependent.inverse(), None);
        let independent = normal(dmatrix![4.0, 0.0; 0.0, 1e6], dvector![0.0, 0.0]);
        let inverse = independent.inverse().unwrap();
        assert!((inverse - dmatrix![0.25, 0.0; 0.0, 1e-6]).amax() < 1e-16);
    }
}
