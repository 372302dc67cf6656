//! The update of the thesis: squared amplitudes, first over the stiffnesses, then over the dampings (Tol 5.2.1.2).

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use crate::structure::CouplingError;

use super::lines::Lines;
use super::model::{JointMatrices, JointModel};
use super::sensitivity::{Linearised, bolt_place};

/// A step that would move no unknown by more than this part of itself ends an iteration.
const CONVERGED: f64 = 1e-9;
/// So many steps at most.
const STEPS: usize = 200;

/// What the update found.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoStep {
    /// After the first step: the stiffnesses are updated, the dampings still those of the start.
    pub after_stiffness: JointMatrices,
    /// After the second step.
    pub joint: JointMatrices,
    /// Whether each step came to rest.
    pub converged: [bool; 2],
    /// Sum of the squared differences of squared amplitudes at the start and after each step, as a part of the sum of
    /// the measured amplitudes' fourth powers.
    pub objective: [f64; 3],
}

#[derive(Clone, Copy)]
enum Step {
    Stiffness,
    Damping,
}

/// Minimises Σ (|H^C|² − |Ĥ^C|²)² over all lines and measured receptances without bounds, first over the stiffnesses of
/// `start`, then over its dampings. `start` holds the matrices of one bolt, or of several, block diagonal.
///
/// The thesis uses MATLAB's `fminunc`; this is Levenberg–Marquardt with exact derivatives on the same sum.
///
/// # Errors
/// [`CouplingError::Singular`] at an undamped resonance.
pub fn update_in_two_steps(
    lines: &Lines,
    model: JointModel,
    start: &JointMatrices,
) -> Result<TwoStep, CouplingError> {
    let problem = Problem::new(lines, model, start.stiffness.nrows() / model.dofs());
    let (after_stiffness, stiffness_converged, [before, between]) =
        problem.minimise(start, Step::Stiffness)?;
    let (joint, damping_converged, [_, after]) =
        problem.minimise(&after_stiffness, Step::Damping)?;
    Ok(TwoStep {
        after_stiffness,
        joint,
        converged: [stiffness_converged, damping_converged],
        objective: [before, between, after].map(|sum| sum / problem.fourth_powers),
    })
}

struct Problem<'a> {
    lines: &'a Lines,
    /// Measured receptances.
    places: Vec<(usize, usize)>,
    /// Unknown entries of the whole joint.
    entries: Vec<(usize, usize)>,
    /// Σ |H^C|⁴.
    fourth_powers: f64,
}

/// The sum of squares, and its normal equations.
struct Normal {
    sum: f64,
    gradient: DVector<f64>,
    curvature: DMatrix<f64>,
}

impl<'a> Problem<'a> {
    fn new(lines: &'a Lines, model: JointModel, bolts: usize) -> Self {
        let places = lines.independent();
        let entries = (0..bolts)
            .flat_map(|bolt| {
                let place = move |&entry| bolt_place(model, bolt, entry);
                model.entries().iter().map(place)
            })
            .collect();
        let fourth_powers = lines
            .assembly
            .iter()
            .flat_map(|matrix| places.iter().map(|&place| matrix[place].norm_sqr().powi(2)))
            .sum();
        Self {
            lines,
            places,
            entries,
            fourth_powers,
        }
    }

    fn minimise(
        &self,
        start: &JointMatrices,
        step: Step,
    ) -> Result<(JointMatrices, bool, [f64; 2]), CouplingError> {
        let mut joint = start.clone();
        let mut normal = self.normal(&joint, step)?;
        let first = normal.sum;
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            // Columns of unit length, so that the damping means the same to every unknown.
            let scale = normal
                .curvature
                .diagonal()
                .map(|d| if d > 0.0 { d.sqrt() } else { 1.0 });
            let scaled = DMatrix::from_fn(scale.len(), scale.len(), |i, j| {
                let damped = if i == j { damping } else { 0.0 };
                normal.curvature[(i, j)] / (scale[i] * scale[j]) + damped
            });
            let right = normal.gradient.component_div(&scale);
            let Some(factor) = scaled.cholesky() else {
                damping *= 10.0;
                continue;
            };
            let change = factor.solve(&right).component_div(&scale);
            let trial = self.moved(&joint, step, &change);
            let rest = self.entries.iter().zip(&change).all(|(&(i, j), change)| {
                let matrix = step.matrix(&joint);
                let size = matrix[(i, j)]
                    .abs()
                    .max((matrix[(i, i)] * matrix[(j, j)]).abs().sqrt());
                change.abs() <= CONVERGED * size
            });
            // Nothing left to gain: exact data, or an unknown that stays at zero.
            let gain = change.dot(&normal.gradient);
            let rest = rest || gain <= 1e-14 * normal.sum + 1e-28 * self.fourth_powers;
            let candidate = self.normal(&trial, step)?;
            if candidate.sum <= normal.sum {
                joint = trial;
                normal = candidate;
                damping = (damping / 10.0).max(1e-12);
                if rest && damping < 1e-2 {
                    return Ok((joint, true, [first, normal.sum]));
                }
            } else if rest {
                // Rounding: no step this short can be told from none.
                return Ok((joint, true, [first, normal.sum]));
            } else {
                damping *= 10.0;
            }
        }
        Ok((joint, false, [first, normal.sum]))
    }

    fn moved(&self, joint: &JointMatrices, step: Step, change: &DVector<f64>) -> JointMatrices {
        let mut moved = joint.clone();
        let matrix = match step {
            Step::Stiffness => &mut moved.stiffness,
            Step::Damping => &mut moved.damping,
        };
        for (&(i, j), change) in self.entries.iter().zip(change) {
            matrix[(i, j)] += change;
            if i != j {
                matrix[(j, i)] += change;
            }
        }
        moved
    }

    fn normal(&self, joint: &JointMatrices, step: Step) -> Result<Normal, CouplingError> {
        let size = self.entries.len();
        let mut normal = Normal {
            sum: 0.0,
            gradient: DVector::zeros(size),
            curvature: DMatrix::zeros(size, size),
        };
        let mut slopes = vec![0.0; size];
        for line in 0..self.lines.frequency_hz.len() {
            let linearised = Linearised::new(self.lines, line, joint)?;
            let omega = TAU * self.lines.frequency_hz[line];
            for &place in &self.places {
                let value = linearised.assembly[place];
                let residual = self.lines.assembly[line][place].norm_sqr() - value.norm_sqr();
                for (slope, &entry) in slopes.iter_mut().zip(&self.entries) {
                    // ∂|Ĥ|²/∂p = 2 Re(Ĥ* ∂Ĥ/∂p),  ∂Ĥ/∂c = jω ∂Ĥ/∂k
                    let product = value.conj() * linearised.by_stiffness(place, entry);
                    *slope = 2.0
                        * match step {
                            Step::Stiffness => product.re,
                            Step::Damping => -omega * product.im,
                        };
                }
                normal.sum += residual * residual;
                for i in 0..size {
                    normal.gradient[i] += slopes[i] * residual;
                    for j in 0..size {
                        normal.curvature[(i, j)] += slopes[i] * slopes[j];
                    }
                }
            }
        }
        Ok(normal)
    }
}

impl Step {
    fn matrix(self, joint: &JointMatrices) -> &DMatrix<f64> {
        match self {
            Self::Stiffness => &joint.stiffness,
            Self::Damping => &joint.damping,
        }
    }
}
