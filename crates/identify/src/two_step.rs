//! The update of the thesis: amplitudes only, first over the stiffnesses, then over the dampings (Tol 5.2.1.2).

use nalgebra::{DMatrix, DVector};

use bolted_joint_frf::structure::SingularAssembly;

use super::block::Block;
use super::kernel::Kernel;
use super::layout::{Layout, Place};
use super::lines::Lines;
use super::model::{JointMatrices, JointModel};
use super::noise::Noise;
use super::used::Chosen;

/// A step that would move no unknown by more than this part of itself ends an iteration.
const CONVERGED: f64 = 1e-9;
/// So many steps at most.
const STEPS: usize = 100;

/// What of the amplitudes is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Amplitudes {
    /// Σ (|H|² − |Ĥ|²)², as the thesis does it: the highest resonance outweighs all others.
    Squared,
    /// Σ (ln|H| − ln|Ĥ|)², in which every line counts the same.
    Logarithmic,
}

/// What the update found.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoStep {
    /// After the first step: the stiffnesses are updated, the dampings still those of the start.
    pub after_stiffness: JointMatrices,
    /// After the second step.
    pub joint: JointMatrices,
    /// Whether each step came to rest.
    pub converged: [bool; 2],
    /// The sum at the start and after each step, as a part of Σ |H|⁴ for squared amplitudes, of the number of values for
    /// logarithmic ones.
    pub objective: [f64; 3],
}

/// Minimises the sum over all lines and measured receptances without bounds, first over the stiffnesses of `start`, then
/// over its dampings. `start` holds the matrices of one bolt, or of several, block diagonal.
///
/// The thesis uses MATLAB's `fminunc`; this is Levenberg–Marquardt with exact derivatives on the same sum.
///
/// # Errors
/// [`SingularAssembly`] at an undamped resonance, or if the joint has more than eight DOFs.
pub fn update_in_two_steps(
    lines: &Lines,
    model: JointModel,
    start: &JointMatrices,
    amplitudes: Amplitudes,
) -> Result<TwoStep, SingularAssembly> {
    let problem = Problem::new(lines, model, amplitudes);
    let count = problem.entries.len();
    let stiffness: Vec<f64> = problem
        .entries
        .iter()
        .map(|place| start.stiffness[place.first()])
        .collect();
    let damping: Vec<f64> = problem
        .entries
        .iter()
        .map(|place| start.damping[place.first()])
        .collect();
    let mut unknowns = [stiffness, damping].concat();
    let first = problem.minimise(&mut unknowns, 0..count)?;
    let after_stiffness = problem.joint(&unknowns);
    let second = problem.minimise(&mut unknowns, count..2 * count)?;
    Ok(TwoStep {
        after_stiffness,
        joint: problem.joint(&unknowns),
        converged: [first.converged, second.converged],
        objective: [first.before, first.after, second.after].map(|sum| sum / problem.scale),
    })
}

struct Problem {
    block: Block,
    /// Unknown entries of the whole joint.
    entries: Vec<Place>,
    amplitudes: Amplitudes,
    /// What the sum is reported as a part of.
    scale: f64,
}

/// The sum of squares, and its normal equations over the unknowns of one step.
struct Normal {
    sum: f64,
    gradient: DVector<f64>,
    curvature: DMatrix<f64>,
}

struct Minimum {
    before: f64,
    after: f64,
    converged: bool,
}

impl Problem {
    fn new(lines: &Lines, model: JointModel, amplitudes: Amplitudes) -> Self {
        let block = Block::new(
            lines,
            0,
            &Chosen::of(0..lines.frequency_hz.len()),
            &Noise::none(),
        );
        let entries = Layout::of_different(model, block.dofs / model.dofs()).places();
        let scale = match amplitudes {
            Amplitudes::Squared => block.measured.iter().map(|h| h.norm_sqr().powi(2)).sum(),
            Amplitudes::Logarithmic => block.measured.len() as f64,
        };
        Self {
            block,
            entries,
            amplitudes,
            scale,
        }
    }

    fn joint(&self, unknowns: &[f64]) -> JointMatrices {
        let entries: Vec<_> = self.entries.iter().map(|place| place.first()).collect();
        JointMatrices::of_entries(self.block.dofs, &entries, unknowns)
    }

    /// Minimises over some of the unknowns, the others held.
    fn minimise(
        &self,
        unknowns: &mut Vec<f64>,
        moving: std::ops::Range<usize>,
    ) -> Result<Minimum, SingularAssembly> {
        let mut normal = self.normal(unknowns, &moving)?;
        let before = normal.sum;
        let mut damping = 1e-3;
        let mut converged = false;
        for _ in 0..STEPS {
            // Columns of unit length, so that the damping means the same to every unknown.
            let diagonal = normal.curvature.diagonal();
            let length = diagonal.map(|d| if d > 0.0 { d.sqrt() } else { 1.0 });
            let damped = DMatrix::from_fn(length.len(), length.len(), |i, j| {
                let extra = if i == j { damping } else { 0.0 };
                normal.curvature[(i, j)] / (length[i] * length[j]) + extra
            });
            let right = normal.gradient.component_div(&length);
            let Some(factor) = damped.cholesky() else {
                damping *= 10.0;
                continue;
            };
            let change = factor.solve(&right).component_div(&length);
            let mut trial = unknowns.clone();
            for (index, change) in moving.clone().zip(&change) {
                trial[index] += change;
            }
            let mut steps = moving.clone().zip(&change);
            let is_short =
                steps.all(|(index, step)| step.abs() <= CONVERGED * unknowns[index].abs());
            // Nothing left to gain: exact data, or an unknown that stays at zero.
            let gain = change.dot(&normal.gradient);
            let rest = is_short || gain <= 1e-12 * normal.sum + 1e-26 * self.scale;
            let candidate = self.normal(&trial, &moving)?;
            if candidate.sum <= normal.sum {
                *unknowns = trial;
                normal = candidate;
                damping = (damping / 10.0).max(1e-12);
            } else {
                damping *= 10.0;
            }
            if rest {
                converged = true;
                break;
            }
        }
        Ok(Minimum {
            before,
            after: normal.sum,
            converged,
        })
    }

    fn normal(
        &self,
        unknowns: &[f64],
        moving: &std::ops::Range<usize>,
    ) -> Result<Normal, SingularAssembly> {
        let count = self.entries.len();
        let is_damping = moving.start == count;
        let mut normal = Normal {
            sum: 0.0,
            gradient: DVector::zeros(count),
            curvature: DMatrix::zeros(count, count),
        };
        let mut slopes = vec![0.0; count];
        let mut kernel = Kernel::new(self.block.dofs);
        let block = &self.block;
        for (line, &omega) in block.omega.iter().enumerate() {
            let joint = (&self.entries[..], unknowns, omega);
            kernel
                .solve(block.free_at(line), block.transfer_at(line), joint)
                .ok_or(SingularAssembly)?;
            for (index, &entry) in block.entries.iter().enumerate() {
                let place = line * block.entries.len() + index;
                let measured = block.measured[place];
                let value = kernel.receptance(block.own[place], entry);
                let (residual, factor) = match self.amplitudes {
                    // ∂|Ĥ|²/∂p = 2 Re(Ĥ* ∂Ĥ/∂p)
                    Amplitudes::Squared => {
                        (measured.norm_sqr() - value.norm_sqr(), 2.0 * value.conj())
                    }
                    // ∂ ln|Ĥ|/∂p = Re(∂Ĥ/∂p / Ĥ)
                    Amplitudes::Logarithmic => (
                        0.5 * (measured.norm_sqr() / value.norm_sqr()).ln(),
                        value.inv(),
                    ),
                };
                if !residual.is_finite() {
                    continue;
                }
                for (slope, &unknown) in slopes.iter_mut().zip(&self.entries) {
                    let product = factor * kernel.by_stiffness(entry, unknown);
                    // ∂Ĥ/∂c = jω ∂Ĥ/∂k
                    *slope = if is_damping {
                        -omega * product.im
                    } else {
                        product.re
                    };
                }
                normal.sum += residual * residual;
                for i in 0..count {
                    normal.gradient[i] += slopes[i] * residual;
                    for j in 0..count {
                        normal.curvature[(i, j)] += slopes[i] * slopes[j];
                    }
                }
            }
        }
        Ok(normal)
    }
}
