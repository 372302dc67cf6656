//! The functions that an assembly with joints would have, and how they change with every unknown.

mod changes;
#[cfg(test)]
mod tests;

use bolted_joint_space::{Coupled, SpaceError};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::error::SpatialError;
use crate::problem::{Problem, Unknowns, block_diagonal};
use crate::transformations::Transformations;

/// The model at one set of unknowns.
pub(crate) struct Assembled<'p> {
    problem: &'p Problem,
    transformations: [Transformations; 2],
    /// Errors of the set-up of each side.
    errors: [Vec<f64>; 2],
    stiffness: DMatrix<f64>,
    damping: DMatrix<f64>,
}

/// What the joints see at one line, without any joint.
pub(crate) struct Reach {
    /// Y Sᵀ, a row for each response of a and of b.
    pub(crate) by_loads: DMatrix<Complex64>,
    /// S Y, a column for each reference.
    pub(crate) motions: DMatrix<Complex64>,
    /// H = S Y Sᵀ.
    pub(crate) seen: DMatrix<Complex64>,
}

/// The assembly at one line.
pub(crate) struct Line {
    /// The observed functions.
    pub(crate) functions: Vec<Complex64>,
    /// a = Y_C Sᵀ: motions by unit loads across the joints, a row for each response.
    pub(crate) by_joint_loads: DMatrix<Complex64>,
    /// b = S Y_C: relative motions in the joints by unit loads, a column for each reference.
    pub(crate) joint_motions: DMatrix<Complex64>,
    /// D = K + jωC of all joints.
    pub(crate) dynamic: DMatrix<Complex64>,
}

/// What an assembly without the joints that are sought has where they will be, at one line; those that are known are there.
pub(crate) struct Open {
    /// Y Sᵀ, a row for each response.
    pub(crate) by_loads: DMatrix<Complex64>,
    /// S Y, a column for each reference.
    pub(crate) motions: DMatrix<Complex64>,
    /// H = S Y Sᵀ: the receptance that the joints see.
    pub(crate) seen: DMatrix<Complex64>,
    /// The observed functions.
    pub(crate) functions: Vec<Complex64>,
}

impl<'p> Assembled<'p> {
    pub(crate) fn new(problem: &'p Problem, unknowns: &Unknowns) -> Result<Self, SpatialError> {
        let [stiffness, damping] = problem.matrices(unknowns)?;
        let errors = problem.errors(unknowns);
        let of = |side: usize| problem.sides[side].transformations(&errors[side]);
        Ok(Self {
            problem,
            transformations: [of(0)?, of(1)?],
            errors,
            stiffness,
            damping,
        })
    }

    /// The assembly without the joints that are sought.
    pub(crate) fn without_sought(problem: &'p Problem) -> Result<Self, SpatialError> {
        let none = Unknowns(DVector::zeros(problem.count()));
        let mut own = Self::new(problem, &none)?;
        [own.stiffness, own.damping] = problem.links.known();
        Ok(own)
    }

    /// D = K + jωC
    fn dynamic(&self, line: usize) -> DMatrix<Complex64> {
        let omega = self.problem.omega(line);
        self.stiffness
            .zip_map(&self.damping, |k, c| Complex64::new(k, omega * c))
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
        let all = self.problem.motions();
        let mut by_loads = DMatrix::zeros(rows + b_loads.nrows(), all);
        by_loads.rows_mut(0, rows).copy_from(&a_loads);
        by_loads
            .rows_mut(rows, b_loads.nrows())
            .copy_from(&-b_loads);
        let mut motions = DMatrix::zeros(all, columns + b_motions.ncols());
        motions.columns_mut(0, columns).copy_from(&a_motions);
        motions
            .columns_mut(columns, b_motions.ncols())
            .copy_from(&-b_motions);
        Reach {
            by_loads,
            motions,
            seen: a + b,
        }
    }

    /// The assembly of the measured substructures.
    pub(crate) fn line(&self, line: usize) -> Result<Line, SpatialError> {
        self.line_of(line, self.measured(line))
    }

    /// The assembly of substructures with these functions: Y_C = Y − Y Sᵀ D b with b = (I + H D)⁻¹ S Y, a = Y Sᵀ (I + D H)⁻¹. What was
    /// struck anew, dR_f beside the hits of the substructures, is struck as by these with T_f dR_fᵀ of them more: Y_C (I + T_f dR_fᵀ).
    /// What is seen anew, dR_u beside their sensors, is seen as by these with dR_u T_u of them more: (I + dR_u T_u) Y_C.
    pub(crate) fn line_of(
        &self,
        line: usize,
        functions_of: [&DMatrix<Complex64>; 2],
    ) -> Result<Line, SpatialError> {
        let Reach {
            by_loads,
            motions,
            seen,
        } = self.reach_of(functions_of);
        let dynamic = self.dynamic(line);
        let joints = Joints::of(self.problem, &seen, &dynamic);
        let mut b = joints.solved(&motions)?;
        let mut a = joints.solved_transposed(&by_loads)?;
        let loads = &dynamic * &b;
        let [rows, columns] = self.problem.skips();
        let observed = self.problem.observed.iter();
        let mut functions: Vec<Complex64> = observed
            .map(|one| {
                let [o, i] = one.at;
                let alone = match (o < rows, i < columns) {
                    (true, true) => functions_of[0][(o, i)],
                    (false, false) => functions_of[1][(o - rows, i - columns)],
                    _ => Complex64::default(),
                };
                (0..loads.nrows()).fold(alone, |sum, m| sum - by_loads[(o, m)] * loads[(m, i)])
            })
            .collect();
        for (side, own) in self.transformations.iter().enumerate() {
            let Some(struck) = &own.struck else { continue };
            let first = [0, columns][side];
            let by_side = self.by_loads_of(side, functions_of, &(&a * &dynamic)) * &own.loads;
            for (one, function) in self.problem.observed.iter().zip(&mut functions) {
                let [o, i] = one.at;
                if let Some(i) = i.checked_sub(first).filter(|&i| i < struck.ncols()) {
                    *function += by_side.row(o).transpose().dot(&struck.column(i));
                }
            }
            let mut own_b = b.columns_mut(first, struck.ncols());
            let more = &own_b * &own.loads * struck;
            own_b += more;
        }
        for (side, own) in self.transformations.iter().enumerate() {
            let Some(seen) = &own.seen else { continue };
            let first = [0, rows][side];
            let loads = self.loads_across(side, &dynamic, &b);
            let motions = self.motions_of(side, functions_of, &loads);
            for (one, function) in self.problem.observed.iter().zip(&mut functions) {
                let [o, i] = one.at;
                if let Some(o) = o.checked_sub(first).filter(|&o| o < seen.nrows()) {
                    *function += seen.row(o).transpose().dot(&motions.column(i));
                }
            }
            let mut own_a = a.rows_mut(first, seen.nrows());
            let more = seen * &own.motions * &own_a;
            own_a += more;
        }
        Ok(Line {
            functions,
            by_joint_loads: a,
            joint_motions: b,
            dynamic,
        })
    }

    /// What the assembly has at the joints that are sought, with what this one has of joints.
    pub(crate) fn open(&self, line: usize) -> Result<Open, SpatialError> {
        let found = self.line(line)?;
        let seen = self.reach(line).seen;
        // S Y_C Sᵀ = (I + H D)⁻¹ H
        let seen = Joints::of(self.problem, &seen, &found.dynamic).solved(&seen)?;
        let sought = self.problem.links.sought();
        let own: Vec<usize> = sought.iter().flat_map(|one| one.motions()).collect();
        Ok(Open {
            by_loads: found.by_joint_loads.select_columns(&own),
            motions: found.joint_motions.select_rows(&own),
            seen: seen.select_rows(&own).select_columns(&own),
            functions: found.functions,
        })
    }

    /// All functions of a line, and how the assembly moves in its joints.
    pub(crate) fn whole(&self, line: usize) -> Result<Coupled, SpatialError> {
        let [a, b] = self.measured(line);
        let [motions, loads] = self.problem.selections(self.transformations.each_ref())?;
        Ok(Coupled::between(
            &block_diagonal([a, b]),
            [&motions, &loads],
            &self.dynamic(line),
            self.problem.links.length_m(),
        )?)
    }
}

/// I + H D, with rotations as lengths: the equations are solved in numbers that are alike.
struct Joints {
    scales: Vec<f64>,
    by_motions: DMatrix<Complex64>,
    by_loads: DMatrix<Complex64>,
}

impl Joints {
    fn of(problem: &Problem, seen: &DMatrix<Complex64>, dynamic: &DMatrix<Complex64>) -> Self {
        let scales = problem.links.scales();
        let count = scales.len();
        let of = |i: usize, j: usize| scales[i] * scales[j];
        let h = DMatrix::from_fn(count, count, |i, j| seen[(i, j)] * of(i, j));
        let d = DMatrix::from_fn(count, count, |i, j| dynamic[(i, j)] / of(i, j));
        let unit = DMatrix::<Complex64>::identity(count, count);
        Self {
            by_motions: &unit + &h * &d,
            by_loads: (unit + d * h).transpose(),
            scales,
        }
    }

    /// (I + H D)⁻¹ S Y
    fn solved(&self, right: &DMatrix<Complex64>) -> Result<DMatrix<Complex64>, SpaceError> {
        self.solution(&self.by_motions, right.clone())
    }

    /// Y Sᵀ (I + D H)⁻¹
    fn solved_transposed(
        &self,
        left: &DMatrix<Complex64>,
    ) -> Result<DMatrix<Complex64>, SpaceError> {
        Ok(self.solution(&self.by_loads, left.transpose())?.transpose())
    }

    fn solution(
        &self,
        matrix: &DMatrix<Complex64>,
        mut right: DMatrix<Complex64>,
    ) -> Result<DMatrix<Complex64>, SpaceError> {
        self.scale_rows(&mut right, |scale| scale);
        let is_solved = matrix.clone().lu().solve_mut(&mut right);
        if !is_solved || !right.iter().all(|number| number.is_finite()) {
            return Err(SpaceError::Resonance);
        }
        self.scale_rows(&mut right, f64::recip);
        Ok(right)
    }

    fn scale_rows(&self, matrix: &mut DMatrix<Complex64>, of: impl Fn(f64) -> f64) {
        for (mut row, &scale) in matrix.row_iter_mut().zip(&self.scales) {
            row *= Complex64::from(of(scale));
        }
    }
}
