//! How the assembly's functions change with its unknowns: with the joint, with errors of the set-up, and with a mass at the joint.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::{Assembled, Line};
use crate::dyads::Group;
use crate::error::SpatialError;
use crate::patterns::{Patterns, Places};

impl Assembled<'_> {
    /// L Y with L = I − a D S: what all rows do by the references of a side, whose hits are those of its own test. `left` is a D.
    pub(super) fn by_loads_of(
        &self,
        side: usize,
        functions: [&DMatrix<Complex64>; 2],
        left: &DMatrix<Complex64>,
    ) -> DMatrix<Complex64> {
        let sign = Complex64::from([-1.0, 1.0][side]);
        let first_row = [0, self.problem.skips()[0]][side];
        let mut by_rows = left * &self.transformations[side].motions * sign;
        for r in 0..functions[side].nrows() {
            by_rows[(first_row + r, r)] += 1.0;
        }
        by_rows * functions[side]
    }

    /// −D b, or D b on side b: loads on a side's interface for each column of the assembly, with those of hits that are elsewhere.
    fn loads_across(&self, side: usize, at: &Line) -> DMatrix<Complex64> {
        let sign = Complex64::from([-1.0, 1.0][side]);
        let mut loads = &at.dynamic * &at.joint_motions * sign;
        if let Some(struck) = &self.transformations[side].struck {
            let first = [0, self.problem.skips()[1]][side];
            let mut of_own = loads.columns_mut(first, struck.ncols());
            of_own += struck;
        }
        loads
    }

    /// With the unit references of a side in its own columns: the block R of that side.
    fn with_own(&self, side: usize, mut references: DMatrix<Complex64>) -> DMatrix<Complex64> {
        let first = [0, self.problem.skips()[1]][side];
        for j in 0..references.nrows() {
            references[(j, first + j)] += 1.0;
        }
        references
    }

    /// What changes of the unknowns do to the functions: of each joint that is sought, then of the sensors, of the impacts and of the
    /// assembly's impacts of each side, where their places may be wrong. [`Patterns`] says how the unknowns are made of them.
    pub(crate) fn dyads(&self, line: usize, at: &Line) -> Vec<Group> {
        let mut groups = at.dyads(self.problem);
        if self.problem.tolerances.is_none() {
            return groups;
        }
        // dY_C = L dY R, L = I − a D S, R = I − Sᵀ D b: each error of a set-up changes what the interface does alone, and of L and
        // R its rows and columns count
        let left = &at.by_joint_loads * &at.dynamic;
        for (side, own) in self.transformations.iter().enumerate() {
            let sign = Complex64::from([-1.0, 1.0][side]);
            let functions = self.measured(line)[side];
            let right = self.loads_across(side, at);
            // Y R: what the columns of this side come to, for each column of the assembly
            groups.push(Group {
                left: &left * sign,
                right: functions * self.with_own(side, &own.loads * &right),
            });
            // L Y likewise
            let by_loads = self.by_loads_of(side, self.measured(line), &left);
            let of_hits = self.problem.sides[side].hits_anew.map(|_| Group {
                left: &by_loads * &own.loads,
                right: self.with_own(side, DMatrix::zeros(functions.ncols(), right.ncols())),
            });
            groups.push(Group {
                left: by_loads,
                right,
            });
            groups.extend(of_hits);
        }
        groups
    }

    /// What a mass at a side's end of the joint does to the functions, rows × columns: ω² Y_C,m u of its translations.
    pub(crate) fn by_mass(&self, side: usize, line: usize, at: &Line) -> DMatrix<Complex64> {
        let own = &self.transformations[side];
        let functions = self.measured(line);
        let by_loads = self.by_loads_of(side, functions, &(&at.by_joint_loads * &at.dynamic));
        let by_loads = by_loads * &own.loads;
        // T_u Y R: what the interface does in the assembly
        let references = self.with_own(side, &own.loads * self.loads_across(side, at));
        let motions = &own.motions * functions[side] * references;
        let inertia = Complex64::from(self.problem.omega(line).powi(2));
        // translations come first
        by_loads.columns(0, 3) * motions.rows(0, 3) * inertia
    }

    /// How the transformations change with each error of the set-ups: in the order of [`Self::dyads`], from those of a's sensors on.
    pub(crate) fn changes(&self) -> Result<Vec<Vec<DMatrix<Complex64>>>, SpatialError> {
        let mut all = Vec::new();
        for (side, errors) in self.problem.sides.iter().zip(&self.errors) {
            let own = side.changes(errors)?;
            all.extend([own.motions, own.loads]);
            all.extend(own.struck);
        }
        Ok(all)
    }

    /// Derivatives of the observed functions by each unknown: observed × unknowns.
    pub(crate) fn derivatives(
        &self,
        line: usize,
        at: &Line,
    ) -> Result<DMatrix<Complex64>, SpatialError> {
        let observed = &self.problem.observed;
        let mut derivatives = DMatrix::zeros(observed.len(), self.problem.count());
        let j_omega = Complex64::new(0.0, self.problem.omega(line));
        let groups = self.dyads(line, at);
        let patterns = Patterns::of(self.problem, self)?;
        for (unknowns, pattern) in patterns.all() {
            for (row, one) in observed.iter().enumerate() {
                let sum = pattern.of(&groups, one.at);
                match unknowns {
                    // ∂Y_C = −a ∂D b
                    Places::OfJoint([stiffness, damping]) => {
                        derivatives[(row, stiffness)] = -sum;
                        derivatives[(row, damping)] = -j_omega * sum;
                    }
                    Places::OfSetUp(place) => derivatives[(row, place)] = sum,
                }
            }
        }
        Ok(derivatives)
    }
}
