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

    /// P L Y with P = I + dR_u T_u: likewise as the assembly's sensors see it, where they are elsewhere.
    fn by_loads_seen(
        &self,
        side: usize,
        functions: [&DMatrix<Complex64>; 2],
        left: &DMatrix<Complex64>,
    ) -> DMatrix<Complex64> {
        let mut all = self.by_loads_of(side, functions, left);
        let own = &self.transformations[side];
        if let Some(seen) = &own.seen {
            let first = [0, self.problem.skips()[0]][side];
            let mut rows = all.rows_mut(first, seen.nrows());
            rows += seen * (&own.motions * functions[side]);
        }
        all
    }

    /// −D b, or D b on side b: loads on a side's interface for each column of the assembly, with those of hits that are elsewhere.
    pub(super) fn loads_across(
        &self,
        side: usize,
        dynamic: &DMatrix<Complex64>,
        joint_motions: &DMatrix<Complex64>,
    ) -> DMatrix<Complex64> {
        let sign = Complex64::from([-1.0, 1.0][side]);
        let mut loads = dynamic * joint_motions * sign;
        if let Some(struck) = &self.transformations[side].struck {
            let first = [0, self.problem.skips()[1]][side];
            let mut of_own = loads.columns_mut(first, struck.ncols());
            of_own += struck;
        }
        loads
    }

    /// T_u Y R: how a side's interface moves in the assembly, for each column; `loads` are those across it.
    pub(super) fn motions_of(
        &self,
        side: usize,
        functions: [&DMatrix<Complex64>; 2],
        loads: &DMatrix<Complex64>,
    ) -> DMatrix<Complex64> {
        let own = &self.transformations[side];
        let references = self.with_own(side, &own.loads * loads);
        &own.motions * functions[side] * references
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
    /// assembly's sensors and impacts of each side, where their places may be wrong. [`Patterns`] says how the unknowns are made of them.
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
            let right = self.loads_across(side, &at.dynamic, &at.joint_motions);
            let references = self.with_own(side, &own.loads * &right);
            // Y R: what the columns of this side come to, for each column of the assembly
            let in_assembly = functions * references;
            let mut by_motions = &left * sign;
            let first = [0, self.problem.skips()[0]][side];
            if let Some(seen) = &own.seen {
                let mut rows = by_motions.rows_mut(first, seen.nrows());
                rows += seen;
            }
            let of_sensors = self.problem.sides[side].anew.sensors.map(|_| Group {
                left: DMatrix::from_fn(left.nrows(), functions.nrows(), |i, j| {
                    Complex64::from(if i == first + j { 1.0 } else { 0.0 })
                }),
                right: &own.motions * &in_assembly,
            });
            groups.push(Group {
                left: by_motions,
                right: in_assembly,
            });
            // L Y likewise
            let by_loads = self.by_loads_seen(side, self.measured(line), &left);
            let of_hits = self.problem.sides[side].anew.hits.map(|_| Group {
                left: &by_loads * &own.loads,
                right: self.with_own(side, DMatrix::zeros(functions.ncols(), right.ncols())),
            });
            groups.push(Group {
                left: by_loads,
                right,
            });
            groups.extend(of_sensors);
            groups.extend(of_hits);
        }
        groups
    }

    /// What a mass at a side's end of the joint does to the functions, rows × columns: ω² Y_C,m u of its translations.
    pub(crate) fn by_mass(&self, side: usize, line: usize, at: &Line) -> DMatrix<Complex64> {
        let own = &self.transformations[side];
        let functions = self.measured(line);
        let left = &at.by_joint_loads * &at.dynamic;
        let by_loads = self.by_loads_seen(side, functions, &left) * &own.loads;
        let loads = self.loads_across(side, &at.dynamic, &at.joint_motions);
        let motions = self.motions_of(side, functions, &loads);
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
            all.extend(own.seen);
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
