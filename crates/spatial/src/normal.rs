//! The normal equations of weighted least squares with priors, gathered line by line.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::assembled::{Assembled, Line};
use crate::dyads::{Lines, add_below, descent, side_by_side, squares};
use crate::error::SpatialError;
use crate::few::Few;
use crate::parallel::over_lines;
use crate::patterns::Patterns;
use crate::problem::{Problem, Unknowns};
use crate::side::MOTIONS;
use crate::sums::{Slopes, Sums};

/// Weighted squares and what they say of a step.
pub(crate) struct Normal {
    /// 2 Re Jᴴ Σ⁻¹ J and the priors.
    pub(crate) information: DMatrix<f64>,
    /// Half of the steepest descent.
    pub(crate) descent: DVector<f64>,
    /// 2 Σ |e|²/σ² and the priors'.
    pub(crate) cost: f64,
}

/// Deviations of the observed functions over all lines: E|ε|² = σ².
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
                let deviation = deviation * one.uneven(line);
                sum += 2.0 * (one.values[line] - function).norm_sqr() / (deviation * deviation);
            }
        }
        Ok::<f64, SpatialError>(sum)
    })?;
    Ok(squares_of_errors(problem, unknowns) + sums.iter().sum::<f64>())
}

/// ηᵀ P η of the errors of the set-up: about as many as there are, or fewer, where the budget holds.
pub(crate) fn squares_of_errors(problem: &Problem, unknowns: &Unknowns) -> f64 {
    problem.prior().squares(unknowns)
}

/// The squares of the errors of the set-up join the others.
pub(crate) fn add_priors(problem: &Problem, unknowns: &Unknowns, normal: &mut Normal) {
    problem.prior().add_to(unknowns, normal);
}

/// Part of a step to either side at which second differences are taken.
const ASIDE: f64 = 0.1;

/// −2 Re Jᴴ Σ⁻¹ f″, with f″ the second derivative of the functions along a step: what bends a way that goes on as the functions do.
pub(crate) fn bend(
    problem: &Problem,
    unknowns: &Unknowns,
    step: &DVector<f64>,
    deviations: &Deviations,
) -> Result<DVector<f64>, SpatialError> {
    let here = Assembled::new(problem, unknowns)?;
    let aside = |part: f64| problem.after(unknowns, &(step * part));
    let (behind, ahead) = (aside(-ASIDE), aside(ASIDE));
    let [behind, ahead] = [
        Assembled::new(problem, &behind)?,
        Assembled::new(problem, &ahead)?,
    ];
    let grids = Lines::of(problem, deviations);
    let patterns = Patterns::of(problem, &here)?;
    let parts = over_lines(problem.frequency_hz.len(), |lines| {
        let mut slopes = Slopes::default();
        for line in lines {
            let found = here.line(line)?;
            let [behind, ahead] = [behind.line(line)?, ahead.line(line)?];
            let (rows, columns) = (found.by_joint_loads.nrows(), found.joint_motions.ncols());
            let mut bent = DMatrix::zeros(rows, columns);
            for (n, one) in problem.observed.iter().enumerate() {
                let second = behind.functions[n] + ahead.functions[n] - 2.0 * found.functions[n];
                bent[(one.at[0], one.at[1])] = -second / (ASIDE * ASIDE);
            }
            let groups = here.dyads(line, &found);
            slopes.add_line(
                problem.omega(line),
                MOTIONS * MOTIONS * problem.links.sought().len(),
                &descent(&grids.at(line), &groups, &bent),
            );
        }
        Ok::<Slopes, SpatialError>(slopes)
    })?;
    let mut sums = Slopes::default();
    parts.iter().for_each(|part| sums.add(part));
    Ok(patterns.descent(problem.count(), &sums))
}

impl Normal {
    pub(crate) fn of(
        problem: &Problem,
        unknowns: &Unknowns,
        deviations: &Deviations,
    ) -> Result<Self, SpatialError> {
        let assembled = Assembled::new(problem, unknowns)?;
        let grids = Lines::of(problem, deviations);
        let patterns = Patterns::of(problem, &assembled)?;
        let parts = over_lines(problem.frequency_hz.len(), |lines| {
            of_lines(problem, &assembled, &grids, lines)
        })?;
        let mut parts = parts.into_iter();
        let mut sums = parts.next().unwrap_or_default();
        parts.for_each(|part| sums.add(&part));
        let mut normal = patterns.normal(problem.count(), sums);
        add_priors(problem, unknowns, &mut normal);
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

/// Sums over dyads and lines; the unknowns follow from them once for all lines.
fn of_lines(
    problem: &Problem,
    assembled: &Assembled<'_>,
    grids: &Lines<'_>,
    lines: Range<usize>,
) -> Result<Sums, SpatialError> {
    let of_joints = MOTIONS * MOTIONS * problem.links.sought().len();
    let mut sums = Sums::default();
    let mut few = None;
    // memory of this size takes long to get for every line
    let mut below = DMatrix::default();
    for line in lines {
        let found = assembled.line(line)?;
        let errors = residuals(problem, line, &found);
        let groups = assembled.dyads(line, &found);
        let (grid, omega) = (&*grids.at(line), problem.omega(line));
        let (count, placed) = side_by_side(&groups);
        if sums.flat.is_empty() {
            sums = Sums::zeros(of_joints, count);
            few = Few::of(grid, count);
        }
        match &mut few {
            Some(few) => few.add_line(omega, grid, &groups, &mut sums),
            None => {
                below.resize_mut(count, count, Complex64::ZERO);
                below.fill(Complex64::ZERO);
                add_below(grid, &placed, &mut below);
                sums.add_line(omega, &below);
            }
        }
        let slopes = descent(grid, &groups, &errors);
        sums.slopes.add_line(omega, of_joints, &slopes);
        sums.squares += 2.0 * squares(grid, &errors);
    }
    if let Some(mut few) = few {
        few.sum_up(&mut sums);
    }
    Ok(sums)
}

/// Measured less computed functions, rows × columns, 0 where nothing was measured.
pub(crate) fn residuals(problem: &Problem, line: usize, found: &Line) -> DMatrix<Complex64> {
    let mut errors = DMatrix::zeros(found.by_joint_loads.nrows(), found.joint_motions.ncols());
    for (one, function) in problem.observed.iter().zip(&found.functions) {
        errors[(one.at[0], one.at[1])] = one.values[line] - function;
    }
    errors
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{chain, problem, problem_anew};

    /// The sums of dyads against the table of derivatives.
    fn compare(mut problem: Problem) {
        let mut seed = 4;
        for one in &mut problem.observed {
            for value in &mut one.values {
                *value = 1e-7 * Complex64::new(crate::samples::number(&mut seed), 0.3);
            }
        }
        let at = crate::samples::unknowns(&problem);
        let deviations: Vec<f64> = (0..problem.observed.len())
            .map(|n| 1e-9 * (1.0 + n as f64))
            .collect();
        let found = Normal::of(&problem, &at, &deviations).unwrap();
        let assembled = Assembled::new(&problem, &at).unwrap();
        let count = problem.count();
        let mut expected = Normal::zeros(count);
        for line in 0..problem.frequency_hz.len() {
            let own = assembled.line(line).unwrap();
            let derivatives = assembled.derivatives(line, &own).unwrap();
            for (row, one) in problem.observed.iter().enumerate() {
                let weight = 2.0 / (deviations[row] * deviations[row]);
                let error = one.values[line] - own.functions[row];
                expected.cost += weight * error.norm_sqr();
                for i in 0..count {
                    let own = weight * derivatives[(row, i)].conj();
                    expected.descent[i] += (own * error).re;
                    for j in 0..count {
                        expected.information[(i, j)] += (own * derivatives[(row, j)]).re;
                    }
                }
            }
        }
        let errors = at.0.as_slice()[problem.joint_count()..].to_vec();
        let deviations_of_errors = problem.own_deviations();
        for (n, (error, deviation)) in errors.into_iter().zip(deviations_of_errors).enumerate() {
            let place = problem.joint_count() + n;
            let weight = 1.0 / (deviation * deviation);
            expected.information[(place, place)] += weight;
            expected.descent[place] -= weight * error;
            expected.cost += weight * error * error;
        }
        assert!((found.cost - expected.cost).abs() < 1e-12 * expected.cost);
        let again = cost(&problem, &at, &deviations).unwrap();
        assert!((again - expected.cost).abs() < 1e-12 * expected.cost);
        for i in 0..count {
            let scale = |n: usize| expected.information[(n, n)].sqrt();
            for j in 0..count {
                let difference = found.information[(i, j)] - expected.information[(i, j)];
                assert!(difference.abs() < 1e-10 * scale(i) * scale(j), "{i} {j}");
            }
            let difference = found.descent[i] - expected.descent[i];
            assert!(
                difference.abs() < 1e-10 * scale(i) * expected.cost.sqrt(),
                "{i}"
            );
        }
    }

    #[test]
    fn dyads_sum_up_to_the_normal_equations_of_the_table() {
        compare(problem());
        compare(chain());
        compare(problem_anew());
    }
}
