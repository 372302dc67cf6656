//! The normal equations of weighted least squares with priors, gathered line by line.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::assembled::{Assembled, Line};
use crate::dyads::{Grid, Group, descent, information};
use crate::error::SpatialError;
use crate::links::Sought;
use crate::parallel::over_lines;
use crate::problem::{Problem, Unknowns};

/// Weighted squares and what they say of a step.
pub(crate) struct Normal {
    /// 2 Re Jᴴ Σ⁻¹ J and the priors.
    pub(crate) information: DMatrix<f64>,
    /// Half of the steepest descent.
    pub(crate) descent: DVector<f64>,
    /// 2 Σ |e|²/σ² and the priors'.
    pub(crate) cost: f64,
}

/// Deviations of the observed functions: E|ε|² = σ².
pub(crate) type Deviations = Vec<f64>;

/// 2 Σ |e|²/σ² and the priors'.
pub(crate) fn cost(
    problem: &Problem,
    unknowns: &Unknowns,
    deviations: &Deviations,
) -> Result<f64, SpatialError> {
    let assembled = Assembled::new(problem, unknowns)?;
    let sums = over_lines(problem.frequency_hz.len(), |lines| {
        let mut sum = 0.0;
        for line in lines {
            let found = assembled.line(line)?;
            let all = problem.observed.iter().zip(found.functions);
            for ((one, function), deviation) in all.zip(deviations) {
                sum += 2.0 * (one.values[line] - function).norm_sqr() / (deviation * deviation);
            }
        }
        Ok::<f64, SpatialError>(sum)
    })?;
    Ok(squares_of_errors(problem, unknowns) + sums.iter().sum::<f64>())
}

/// Σ (η/σ)² of the errors of the set-up: about as many as there are, or fewer, where the budget holds.
pub(crate) fn squares_of_errors(problem: &Problem, unknowns: &Unknowns) -> f64 {
    priors(problem, unknowns)
        .map(|[error, deviation]| (error / deviation).powi(2))
        .sum()
}

/// Each error of the set-up with its deviation.
fn priors(problem: &Problem, unknowns: &Unknowns) -> impl Iterator<Item = [f64; 2]> {
    let errors = unknowns.0.as_slice()[problem.joint_count()..].to_vec();
    let deviations = problem.error_deviations();
    errors.into_iter().zip(deviations).map(<[f64; 2]>::from)
}

impl Normal {
    pub(crate) fn of(
        problem: &Problem,
        unknowns: &Unknowns,
        deviations: &Deviations,
    ) -> Result<Self, SpatialError> {
        let assembled = Assembled::new(problem, unknowns)?;
        let grid = Grid::new(problem.weights(deviations));
        let patterns = Patterns::of(problem);
        let parts = over_lines(problem.frequency_hz.len(), |lines| {
            match problem.error_count() {
                0 => of_joint(problem, &assembled, &grid, &patterns, deviations, lines),
                _ => of_all(problem, &assembled, deviations, lines),
            }
        })?;
        let mut normal = Self::zeros(problem.count());
        for part in &parts {
            normal.add(part);
        }
        for (n, [error, deviation]) in priors(problem, unknowns).enumerate() {
            let place = problem.joint_count() + n;
            let weight = 1.0 / (deviation * deviation);
            normal.information[(place, place)] += weight;
            normal.descent[place] -= weight * error;
            normal.cost += weight * error * error;
        }
        Ok(normal)
    }

    pub(crate) fn zeros(count: usize) -> Self {
        Self {
            information: DMatrix::zeros(count, count),
            descent: DVector::zeros(count),
            cost: 0.0,
        }
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.information += &other.information;
        self.descent += &other.descent;
        self.cost += other.cost;
    }
}

/// The joint alone: its derivatives are dyads of assembled relative motions.
fn of_joint(
    problem: &Problem,
    assembled: &Assembled<'_>,
    grid: &Grid,
    patterns: &Patterns,
    deviations: &Deviations,
    lines: Range<usize>,
) -> Result<Normal, SpatialError> {
    let mut normal = Normal::zeros(problem.count());
    for line in lines {
        let found = assembled.line(line)?;
        let errors = residuals(problem, line, &found);
        let all = problem.observed.iter().zip(&found.functions);
        for ((one, function), deviation) in all.zip(deviations) {
            normal.cost += 2.0 * (one.values[line] - function).norm_sqr() / (deviation * deviation);
        }
        let groups = found.dyads(problem);
        // ∂Y_C = −a ∂D b
        let products = patterns.products(&information(grid, &groups));
        let slopes = patterns.slopes(&descent(grid, &groups, &errors));
        normal.add_line(problem.omega(line), patterns, &products, &slopes);
    }
    Ok(normal)
}

impl Normal {
    /// The information and descent of a line, by Jᴴ Σ⁻¹ J and Jᴴ Σ⁻¹ e of −J_k = a ∂K/∂k b: C's derivatives are jω times K's.
    pub(crate) fn add_line(
        &mut self,
        omega: f64,
        patterns: &Patterns,
        products: &DMatrix<Complex64>,
        slopes: &DVector<Complex64>,
    ) {
        let places = &patterns.unknowns;
        for (k, &[stiffness, damping]) in places.iter().enumerate() {
            for (l, &[other, of_other]) in places.iter().enumerate() {
                let product = 2.0 * products[(k, l)];
                self.information[(stiffness, other)] += product.re;
                self.information[(stiffness, of_other)] -= omega * product.im;
                self.information[(damping, other)] += omega * product.im;
                self.information[(damping, of_other)] += omega * omega * product.re;
            }
            let slope = 2.0 * slopes[k];
            self.descent[stiffness] -= slope.re;
            self.descent[damping] -= omega * slope.im;
        }
    }
}

/// Joint and errors of the set-up, by the table of derivatives.
fn of_all(
    problem: &Problem,
    assembled: &Assembled<'_>,
    deviations: &Deviations,
    lines: Range<usize>,
) -> Result<Normal, SpatialError> {
    let (rows, count) = (problem.observed.len(), problem.count());
    let mut normal = Normal::zeros(count);
    let mut real = DMatrix::zeros(2 * rows, count);
    let mut errors = DVector::zeros(2 * rows);
    for line in lines {
        let found = assembled.line(line)?;
        let derivatives = assembled.derivatives(line, &found);
        for (row, one) in problem.observed.iter().enumerate() {
            // E (Re ε)² = σ²/2
            let weight = std::f64::consts::SQRT_2 / deviations[row];
            let error = one.values[line] - found.functions[row];
            errors[2 * row] = weight * error.re;
            errors[2 * row + 1] = weight * error.im;
            for column in 0..count {
                let derivative = derivatives[(row, column)];
                real[(2 * row, column)] = weight * derivative.re;
                real[(2 * row + 1, column)] = weight * derivative.im;
            }
        }
        // transposed first: the product of matrices as they lie is the fast one
        normal.information.gemm(1.0, &real.transpose(), &real, 1.0);
        normal.descent.gemv_tr(1.0, &real, &errors, 1.0);
        normal.cost += errors.norm_squared();
    }
    Ok(normal)
}

impl Line {
    /// a and b, the dyads of every change of the joints that are sought.
    pub(crate) fn dyads(&self, problem: &Problem) -> Vec<Group> {
        let of = |joint: &Sought<'_>| Group {
            left: self
                .by_joint_loads
                .columns_range(joint.motions())
                .into_owned(),
            right: self.joint_motions.rows_range(joint.motions()).into_owned(),
        };
        problem.links.sought().iter().map(of).collect()
    }
}

/// Measured less computed functions, rows × columns, 0 where nothing was measured.
pub(crate) fn residuals(problem: &Problem, line: usize, found: &Line) -> DMatrix<Complex64> {
    let mut errors = DMatrix::zeros(found.by_joint_loads.nrows(), found.joint_motions.ncols());
    for (one, function) in problem.observed.iter().zip(&found.functions) {
        errors[(one.at[0], one.at[1])] = one.values[line] - function;
    }
    errors
}

/// ∂K/∂k of each unknown, as places and factors of its joint's 36 entries.
pub(crate) struct Patterns {
    entries: Vec<Vec<(usize, f64)>>,
    /// Where the unknown of stiffness and that of damping stand.
    unknowns: Vec<[usize; 2]>,
}

impl Patterns {
    pub(crate) fn of(problem: &Problem) -> Self {
        let (mut entries, mut unknowns) = (Vec::new(), Vec::new());
        for (number, joint) in problem.links.sought().iter().enumerate() {
            let count = joint.model.count();
            for (n, basis) in joint.model.bases().iter().enumerate() {
                let own = (0..36)
                    .map(|place| (36 * number + place, basis[(place / 6, place % 6)]))
                    .filter(|(_, factor)| *factor != 0.0);
                entries.push(own.collect());
                unknowns.push([joint.first + n, joint.first + count + n]);
            }
        }
        Self { entries, unknowns }
    }

    /// Eᵀ M E of sums over the 36 entries.
    pub(crate) fn products(&self, sums: &DMatrix<Complex64>) -> DMatrix<Complex64> {
        let half = self.columns(sums);
        DMatrix::from_fn(self.entries.len(), self.entries.len(), |k, l| {
            let own = self.entries[k].iter();
            own.map(|(place, factor)| *factor * half[(*place, l)]).sum()
        })
    }

    /// M E.
    pub(crate) fn columns(&self, sums: &DMatrix<Complex64>) -> DMatrix<Complex64> {
        DMatrix::from_fn(sums.nrows(), self.entries.len(), |row, l| {
            let own = self.entries[l].iter();
            own.map(|(place, factor)| *factor * sums[(row, *place)])
                .sum()
        })
    }

    /// Eᵀ v.
    pub(crate) fn slopes(&self, sums: &DVector<Complex64>) -> DVector<Complex64> {
        let of = |entries: &Vec<(usize, f64)>| {
            let own = entries.iter();
            own.map(|(place, factor)| *factor * sums[*place]).sum()
        };
        DVector::from_iterator(self.entries.len(), self.entries.iter().map(of))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{chain, problem};

    /// The sums of dyads against the table of derivatives.
    #[test]
    fn dyads_sum_up_to_the_normal_equations_of_the_table() {
        compare(problem());
        compare(chain());
    }

    fn compare(mut problem: Problem) {
        let mut seed = 4;
        for one in &mut problem.observed {
            for value in &mut one.values {
                *value = 1e-7 * Complex64::new(crate::samples::number(&mut seed), 0.3);
            }
        }
        let at = crate::samples::unknowns(&problem);
        let errors = problem.errors(&at);
        let deviations: Vec<f64> = (0..problem.observed.len())
            .map(|n| 1e-9 * (1.0 + n as f64))
            .collect();
        let all = Normal::of(&problem, &at, &deviations).unwrap();
        let exact = problem.displaced(&at).unwrap();
        assert!(errors.iter().flatten().any(|error| *error != 0.0));
        let count = problem.joint_count();
        let own = Unknowns(at.0.rows(0, count).into_owned());
        let joint = Normal::of(&exact, &own, &deviations).unwrap();
        let priors = squares_of_errors(&problem, &at);
        assert!((joint.cost + priors - all.cost).abs() < 1e-9 * all.cost);
        assert!((cost(&exact, &own, &deviations).unwrap() - joint.cost).abs() < 1e-12 * joint.cost);
        for i in 0..count {
            let scale = |n: usize| all.information[(n, n)].sqrt();
            for j in 0..count {
                let difference = joint.information[(i, j)] - all.information[(i, j)];
                assert!(difference.abs() < 1e-9 * scale(i) * scale(j), "{i} {j}");
            }
            let difference = joint.descent[i] - all.descent[i];
            assert!(difference.abs() < 1e-9 * scale(i) * all.cost.sqrt(), "{i}");
        }
    }
}
