//! The functions that an assembly with a joint would have, and how they change with every unknown.

use nalgebra::{DMatrix, Matrix6};
use num_complex::Complex64;

use crate::error::SpatialError;
use crate::problem::{Problem, Unknowns};
use crate::side::{MOTIONS, Transformations};

/// The model at one set of unknowns.
pub(crate) struct Assembled<'p> {
    problem: &'p Problem,
    transformations: [Transformations; 2],
    stiffness: Matrix6<f64>,
    damping: Matrix6<f64>,
}

/// What the joint sees at one line, without a joint.
pub(crate) struct Reach {
    /// Y Sᵀ, a row for each response of a and of b.
    pub(crate) by_loads: DMatrix<Complex64>,
    /// S Y, a column for each reference.
    pub(crate) motions: DMatrix<Complex64>,
    /// H = S Y Sᵀ.
    pub(crate) seen: Matrix6<Complex64>,
}

/// The assembly at one line.
pub(crate) struct Line {
    /// The observed functions.
    pub(crate) functions: Vec<Complex64>,
    /// a = Y_C Sᵀ: motions by unit loads across the joint, a row for each response.
    pub(crate) by_joint_loads: DMatrix<Complex64>,
    /// b = S Y_C: relative motions in the joint by unit loads, a column for each reference.
    pub(crate) joint_motions: DMatrix<Complex64>,
    /// D = K + jωC.
    pub(crate) dynamic: Matrix6<Complex64>,
}

impl<'p> Assembled<'p> {
    pub(crate) fn new(problem: &'p Problem, unknowns: &Unknowns) -> Result<Self, SpatialError> {
        let [stiffness, damping] = problem.matrices(unknowns)?;
        let errors = problem.errors(unknowns);
        let of = |side: usize| {
            let transformations = problem.sides[side].transformations(&errors[side]);
            transformations.map_err(|source| SpatialError::of_side(side, source))
        };
        Ok(Self {
            problem,
            transformations: [of(0)?, of(1)?],
            stiffness,
            damping,
        })
    }

    /// D = K + jωC
    fn dynamic(&self, line: usize) -> Matrix6<Complex64> {
        let omega = self.problem.omega(line);
        Matrix6::from_fn(|i, j| {
            Complex64::new(self.stiffness[(i, j)], omega * self.damping[(i, j)])
        })
    }

    fn measured(&self, line: usize) -> [&DMatrix<Complex64>; 2] {
        self.problem.sides.each_ref().map(|side| &side.lines[line])
    }

    /// What the joint sees of the measured substructures.
    pub(crate) fn reach(&self, line: usize) -> Reach {
        self.reach_of(self.measured(line))
    }

    /// Likewise of substructures with these functions.
    fn reach_of(&self, functions: [&DMatrix<Complex64>; 2]) -> Reach {
        let [(a_loads, a_motions, a), (b_loads, b_motions, b)] = [0, 1].map(|side| {
            let Transformations { motions, loads, .. } = &self.transformations[side];
            let by_loads = functions[side] * loads;
            let seen = motions * &by_loads;
            (by_loads, motions * functions[side], seen)
        });
        let [rows, columns] = self.problem.skips();
        let mut by_loads = DMatrix::zeros(rows + b_loads.nrows(), MOTIONS);
        by_loads.rows_mut(0, rows).copy_from(&a_loads);
        by_loads
            .rows_mut(rows, b_loads.nrows())
            .copy_from(&-b_loads);
        let mut motions = DMatrix::zeros(MOTIONS, columns + b_motions.ncols());
        motions.columns_mut(0, columns).copy_from(&a_motions);
        motions
            .columns_mut(columns, b_motions.ncols())
            .copy_from(&-b_motions);
        Reach {
            by_loads,
            motions,
            seen: Matrix6::from_fn(|i, j| a[(i, j)] + b[(i, j)]),
        }
    }

    /// The assembly of the measured substructures.
    pub(crate) fn line(&self, line: usize) -> Result<Line, SpatialError> {
        self.line_of(line, self.measured(line))
    }

    /// The assembly of substructures with these functions: Y_C = Y − Y Sᵀ D b with b = (I + H D)⁻¹ S Y, a = Y Sᵀ (I + D H)⁻¹.
    pub(crate) fn line_of(
        &self,
        line: usize,
        functions: [&DMatrix<Complex64>; 2],
    ) -> Result<Line, SpatialError> {
        let Reach {
            by_loads,
            motions,
            seen,
        } = self.reach_of(functions);
        let dynamic = self.dynamic(line);
        // rotations as lengths: the equations are solved in numbers that are alike
        let scale = |i: usize| if i < 3 { 1.0 } else { self.problem.length_m };
        let h = Matrix6::from_fn(|i, j| seen[(i, j)] * scale(i) * scale(j));
        let d = Matrix6::from_fn(|i, j| dynamic[(i, j)] / (scale(i) * scale(j)));
        let unit = Matrix6::<Complex64>::identity();
        let mut b = motions;
        scale_rows(&mut b, scale);
        let mut a = by_loads.transpose();
        scale_rows(&mut a, scale);
        let is_solved = (unit + h * d).lu().solve_mut(&mut b)
            && (unit + d * h).transpose().lu().solve_mut(&mut a);
        if !is_solved || !a.iter().chain(b.iter()).all(|number| number.is_finite()) {
            return Err(bolted_joint_space::SpaceError::Resonance.into());
        }
        scale_rows(&mut a, |i| scale(i).recip());
        scale_rows(&mut b, |i| scale(i).recip());
        let loads: DMatrix<Complex64> = DMatrix::from_fn(MOTIONS, b.ncols(), |m, i| {
            (0..MOTIONS)
                .map(|n| dynamic[(m, n)] * b[(n, i)])
                .sum::<Complex64>()
        });
        let [rows, columns] = self.problem.skips();
        let observed = self.problem.observed.iter();
        let functions = observed
            .map(|one| {
                let [o, i] = one.at;
                let alone = match (o < rows, i < columns) {
                    (true, true) => functions[0][(o, i)],
                    (false, false) => functions[1][(o - rows, i - columns)],
                    _ => Complex64::default(),
                };
                (0..MOTIONS).fold(alone, |sum, m| sum - by_loads[(o, m)] * loads[(m, i)])
            })
            .collect();
        Ok(Line {
            functions,
            by_joint_loads: a.transpose(),
            joint_motions: b,
            dynamic,
        })
    }

    /// Derivatives of the observed functions by each unknown: observed × unknowns.
    pub(crate) fn derivatives(&self, line: usize, at: &Line) -> DMatrix<Complex64> {
        let observed = &self.problem.observed;
        let mut derivatives = DMatrix::zeros(observed.len(), self.problem.count());
        let j_omega = Complex64::new(0.0, self.problem.omega(line));
        let (a, b) = (&at.by_joint_loads, &at.joint_motions);
        let count = self.problem.model.count();
        for (n, basis) in self.problem.model.bases().iter().enumerate() {
            // ∂Y_C = −a ∂D b
            let left = a * basis.map(Complex64::from);
            for (row, one) in observed.iter().enumerate() {
                let [o, i] = one.at;
                let sum: Complex64 = (0..MOTIONS).map(|m| left[(o, m)] * b[(m, i)]).sum();
                derivatives[(row, n)] = -sum;
                derivatives[(row, count + n)] = -j_omega * sum;
            }
        }
        if self.problem.tolerances.is_some() {
            self.by_errors(line, at, &mut derivatives);
        }
        derivatives
    }

    /// dY_C = L dY R, L = I − a D S, R = I − Sᵀ D b, for each error of a set-up, which changes what the interface does alone: of
    /// L and R its rows and columns count.
    fn by_errors(&self, line: usize, at: &Line, derivatives: &mut DMatrix<Complex64>) {
        let (a, b) = (&at.by_joint_loads, &at.joint_motions);
        let (left, right) = (a * at.dynamic, at.dynamic * b);
        let observed = &self.problem.observed;
        let mut column = self.problem.joint_count();
        let (mut first_row, mut first_column) = (0, 0);
        for (side, own) in self.transformations.iter().enumerate() {
            let sign = Complex64::from(if side == 0 { -1.0 } else { 1.0 });
            let functions = &self.problem.sides[side].lines[line];
            let (p, q) = functions.shape();
            // Y R: what the columns of this side come to, for each column of the assembly
            let mut by_columns = &own.loads * &right * sign;
            for j in 0..q {
                by_columns[(j, first_column + j)] += 1.0;
            }
            let y_r = functions * by_columns;
            for change in &own.motions_changes {
                let moved = change * &y_r;
                for (row, one) in observed.iter().enumerate() {
                    let [o, i] = one.at;
                    let sum: Complex64 = (0..MOTIONS).map(|m| left[(o, m)] * moved[(m, i)]).sum();
                    derivatives[(row, column)] = sign * sum;
                }
                column += 1;
            }
            // L Y likewise
            let mut by_rows = &left * &own.motions * sign;
            for r in 0..p {
                by_rows[(first_row + r, r)] += 1.0;
            }
            let l_y = by_rows * functions;
            for change in &own.loads_changes {
                let loaded = &l_y * change;
                for (row, one) in observed.iter().enumerate() {
                    let [o, i] = one.at;
                    let sum: Complex64 = (0..MOTIONS).map(|m| loaded[(o, m)] * right[(m, i)]).sum();
                    derivatives[(row, column)] = sign * sum;
                }
                column += 1;
            }
            first_row += p;
            first_column += q;
        }
    }
}

fn scale_rows(matrix: &mut DMatrix<Complex64>, scale: impl Fn(usize) -> f64) {
    for (i, mut row) in matrix.row_iter_mut().enumerate() {
        row *= Complex64::from(scale(i));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{problem, unknowns};

    /// Reference: central differences of the model's functions.
    #[test]
    fn derivatives_are_differences_by_every_unknown() {
        let problem = problem();
        let at = unknowns(&problem).0;
        let count = problem.model.count();
        let assembled = Assembled::new(&problem, &Unknowns(at.clone())).unwrap();
        let line = assembled.line(1).unwrap();
        let derivatives = assembled.derivatives(1, &line);
        let scale = line.functions.iter().map(|y| y.norm()).fold(0.0, f64::max);
        for unknown in 0..problem.count() {
            let step = match unknown < 2 * count {
                true => 1e-4 * at[unknown].abs().max(1.0),
                false => 1e-6,
            };
            let [above, below] = [step, -step].map(|step| {
                let mut moved = at.clone();
                moved[unknown] += step;
                let assembled = Assembled::new(&problem, &Unknowns(moved)).unwrap();
                assembled.line(1).unwrap().functions
            });
            let size = derivatives
                .column(unknown)
                .iter()
                .map(|d| d.norm())
                .fold(0.0, f64::max);
            for (row, (above, below)) in above.iter().zip(&below).enumerate() {
                let difference = (above - below) / (2.0 * step);
                let error = (difference - derivatives[(row, unknown)]).norm();
                assert!(
                    error <= 1e-6 * size + 1e-10 * scale / step,
                    "{unknown} {row}: {difference} {}",
                    derivatives[(row, unknown)]
                );
            }
        }
    }
}
