//! The normal equations of all lines in marginal form: the structures' receptances are eliminated line by line.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::experiment::Structure;
use super::line::{Labelled, Point, Task, Terms, variance};

/// What one line adds.
pub(crate) struct Share {
    /// 2 Re Σ Aᴴ S⁻¹ A
    pub(crate) information: DMatrix<f64>,
    /// 2 Re Σ Aᴴ S⁻¹ r
    pub(crate) gradient: DVector<f64>,
    /// 2 rᴴ S⁻¹ r: twice, as a variance is that of a complex error.
    pub(crate) cost: f64,
}

/// What residuals of the assemblies scatter by beside their own noise.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Scatter<'s> {
    /// Factor of each assembly's standard deviation; 1 where none is given.
    pub(crate) inflation: &'s [f64],
    /// Whether the square of what the structures' noise does counts, too: of the difference of two assemblies nothing else of that
    /// noise is left, y/(1 + ε) = y (1 − ε + ε² …), as long as the receptances stay what was measured.
    pub(crate) keeps_second_order: bool,
}

/// A line whose covariance S = Σ_C + J Σ_H Jᴴ is factorised.
pub(crate) struct Whitened<'l> {
    terms: &'l Terms,
    factor: nalgebra::Cholesky<Complex64, nalgebra::Dyn>,
}

impl<'l> Whitened<'l> {
    /// `measure` says what the assemblies' residuals scatter by beside their own noise.
    pub(crate) fn of(
        task: &Task<'_>,
        line: usize,
        terms: &'l Terms,
        measure: &Scatter<'_>,
    ) -> Option<Self> {
        let mut scaled = terms.by_labelled.clone();
        for (mut column, variance) in scaled.column_iter_mut().zip(&terms.labelled_variance) {
            column *= Complex64::from(*variance);
        }
        let mut covariance = scaled * terms.by_labelled.adjoint();
        let assemblies = task.experiment.assemblies.iter().enumerate();
        let entries = assemblies.flat_map(|(number, assembly)| {
            let entries = assembly.functions.entries.iter();
            entries.map(move |entry| (number, entry))
        });
        for (e, (number, entry)) in entries.enumerate() {
            if measure.keeps_second_order {
                let first_order = covariance[(e, e)].re / terms.magnitude[e];
                covariance[(e, e)] += first_order * first_order;
            }
            let inflation = measure.inflation.get(number).map_or(1.0, |of| of * of);
            covariance[(e, e)] += inflation * variance(entry, line);
        }
        Some(Self {
            terms,
            factor: covariance.cholesky()?,
        })
    }

    /// 2 rᴴ S⁻¹ r of another residual.
    pub(crate) fn cost_of(&self, mut residual: DVector<Complex64>) -> f64 {
        let lower = self.factor.l_dirty();
        lower.solve_lower_triangular_mut(&mut residual);
        2.0 * residual.norm_squared()
    }

    pub(crate) fn share(&self) -> Share {
        let lower = self.factor.l_dirty();
        let mut rows = self.terms.rows.clone();
        lower.solve_lower_triangular_mut(&mut rows);
        let mut residual = self.terms.residual.clone();
        lower.solve_lower_triangular_mut(&mut residual);
        let (columns, size) = (in_pairs(rows.as_slice()), rows.ncols());
        let residual = in_pairs(residual.as_slice());
        let of = |column: usize| {
            let length = residual.len();
            &columns[column * length..(column + 1) * length]
        };
        let mut information = DMatrix::zeros(size, size);
        for i in 0..size {
            for j in 0..=i {
                let product = 2.0 * dot(of(i), of(j));
                information[(i, j)] = product;
                information[(j, i)] = product;
            }
        }
        Share {
            information,
            gradient: DVector::from_fn(size, |i, _| 2.0 * dot(of(i), &residual)),
            cost: 2.0 * dot(&residual, &residual),
        }
    }

    /// The receptances that go with a step of unknowns and causes: h₀ + Σ_H Jᴴ S⁻¹ (r − A δ), h₀ moving with the causes.
    pub(crate) fn followed(&self, unknowns: usize, step: &DVector<f64>) -> Labelled {
        let rest = &self.terms.residual - &self.terms.rows * step.map(Complex64::from);
        let solved = self.factor.solve(&rest);
        let pulled = self.terms.by_labelled.adjoint() * solved;
        let mut index = 0;
        [0, 1].map(|side| {
            let mut labelled = self.terms.measured[side].clone();
            for (number, by) in self.terms.measured_by_cause[side].iter().enumerate() {
                if let Some(by) = by {
                    labelled
                        .iter_mut()
                        .zip(by)
                        .for_each(|(value, by)| *value += by * step[unknowns + number]);
                }
            }
            for value in &mut labelled {
                *value += pulled[index] * self.terms.labelled_variance[index];
                index += 1;
            }
            labelled
        })
    }
}

/// Real parts with the imaginary parts behind them: of vectors in this form Re(aᴴ b) is aᵀ b.
fn in_pairs(values: &[Complex64]) -> Vec<f64> {
    values
        .iter()
        .flat_map(|value| [value.re, value.im])
        .collect()
}

/// aᵀ b, in sums side by side that the processor takes at once.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    const SIDE_BY_SIDE: usize = 4;
    let mut sums = [0.0; SIDE_BY_SIDE];
    let (a, b) = (a.chunks_exact(SIDE_BY_SIDE), b.chunks_exact(SIDE_BY_SIDE));
    let rest = a.remainder().iter().zip(b.remainder());
    let rest: f64 = rest.map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// The structures' receptances as measured, without the causes.
pub(crate) fn as_measured(task: &Task<'_>, line: usize, point: &Point) -> Labelled {
    [super::cause::Side::A, super::cause::Side::B].map(|side| match task.experiment.side(side) {
        Structure::Measured(measured) => {
            let raw = measured.functions.at(line);
            let unloaded = task.unloaded(side, line, point, &raw);
            task.without_causes(side, line, point, &unloaded)
        }
        _ => Vec::new(),
    })
}
