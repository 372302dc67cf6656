//! The functions that an assembly with joints would have, and how they change with every unknown.

use bolted_joint_space::{Coupled, Dof, SpaceError};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::dyads::Group;
use crate::error::SpatialError;
use crate::patterns::{Patterns, Places};
use crate::problem::{Problem, Unknowns, block_diagonal};
use crate::side::Transformations;

/// The model at one set of unknowns.
pub(crate) struct Assembled<'p> {
    problem: &'p Problem,
    transformations: [Transformations; 2],
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
        let a = joints.solved_transposed(&by_loads)?;
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
        Ok(Line {
            functions,
            by_joint_loads: a,
            joint_motions: b,
            dynamic,
        })
    }

    /// L Y with L = I − a D S: what all rows do by the references of a side, whose hits are those of its own test. `left` is a D.
    fn by_loads_of(
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

    /// What changes of the unknowns do to the functions: of each joint that is sought, then of the sensors, of the impacts and of the
    /// assembly's impacts of each side, where their places may be wrong. [`Patterns`] says how the unknowns are made of them.
    pub(crate) fn dyads(&self, line: usize, at: &Line) -> Vec<Group> {
        let mut groups = at.dyads(self.problem);
        if self.problem.tolerances.is_none() {
            return groups;
        }
        // dY_C = L dY R, L = I − a D S, R = I − Sᵀ D b: each error of a set-up changes what the interface does alone, and of L and
        // R its rows and columns count
        let (left, right) = (
            &at.by_joint_loads * &at.dynamic,
            &at.dynamic * &at.joint_motions,
        );
        for (side, own) in self.transformations.iter().enumerate() {
            let sign = Complex64::from([-1.0, 1.0][side]);
            let first_column = [0, self.problem.skips()[1]][side];
            let functions = &self.problem.sides[side].lines[line];
            let q = functions.ncols();
            // loads across the interface for each column of the assembly, with those of hits that are elsewhere
            let mut right = &right * sign;
            if let Some(struck) = &own.struck {
                let mut own_right = right.columns_mut(first_column, q);
                own_right += struck;
            }
            let references = |factor: &DMatrix<Complex64>| {
                let mut all = factor.clone();
                for j in 0..q {
                    all[(j, first_column + j)] += 1.0;
                }
                all
            };
            // Y R: what the columns of this side come to, for each column of the assembly
            groups.push(Group {
                left: &left * sign,
                right: functions * references(&(&own.loads * &right)),
            });
            // L Y likewise
            let by_loads = self.by_loads_of(side, self.measured(line), &left);
            let of_hits = (!own.struck_changes.is_empty()).then(|| Group {
                left: &by_loads * &own.loads,
                right: references(&DMatrix::zeros(q, right.ncols())),
            });
            groups.push(Group {
                left: by_loads,
                right,
            });
            groups.extend(of_hits);
        }
        groups
    }

    /// What a mass at a side's end of the joint does to the observed functions: ω² Y_C,m u of its translations.
    pub(crate) fn by_mass(&self, side: usize, line: usize, at: &Line) -> DVector<Complex64> {
        let own = &self.transformations[side];
        let functions = self.measured(line);
        let by_loads = self.by_loads_of(side, functions, &(&at.by_joint_loads * &at.dynamic));
        let by_loads = by_loads * &own.loads;
        // the interface in the assembly: T_u Y R
        let sign = Complex64::from([-1.0, 1.0][side]);
        let first = [0, self.problem.skips()[1]][side];
        let loads = &at.dynamic * &at.joint_motions * sign;
        let alone = &own.motions * functions[side];
        let mut motions = &alone * &own.loads * loads;
        let mut by_own = motions.columns_mut(first, alone.ncols());
        by_own += &alone;
        if let Some(struck) = &own.struck {
            by_own += &alone * &own.loads * struck;
        }
        let inertia = Complex64::from(self.problem.omega(line).powi(2));
        let observed = self.problem.observed.iter();
        let of = observed.map(|one| {
            let [o, i] = one.at;
            let translations = Dof::ALL.iter().filter(|dof| !dof.is_rotation());
            let moved =
                translations.map(|dof| by_loads[(o, dof.index())] * motions[(dof.index(), i)]);
            inertia * moved.sum::<Complex64>()
        });
        DVector::from_iterator(self.problem.observed.len(), of)
    }

    /// How the transformations change with each error of the set-ups: in the order of [`Self::dyads`], from those of a's sensors on.
    pub(crate) fn changes(&self) -> impl Iterator<Item = &[DMatrix<Complex64>]> {
        let sides = self.transformations.iter();
        sides.flat_map(|own| {
            let of_hits = Some(&own.struck_changes[..]).filter(|own| !own.is_empty());
            let of_all = [&own.motions_changes[..], &own.loads_changes[..]];
            of_all.into_iter().chain(of_hits)
        })
    }

    /// Derivatives of the observed functions by each unknown: observed × unknowns.
    pub(crate) fn derivatives(&self, line: usize, at: &Line) -> DMatrix<Complex64> {
        let observed = &self.problem.observed;
        let mut derivatives = DMatrix::zeros(observed.len(), self.problem.count());
        let j_omega = Complex64::new(0.0, self.problem.omega(line));
        let groups = self.dyads(line, at);
        let patterns = Patterns::of(self.problem, Some(self));
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
        derivatives
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

#[cfg(test)]
mod tests {
    use super::*;
    use bolted_joint_virtual_point::{Role, VirtualPoint, Weights};

    use crate::samples::{chain, problem, problem_hit_anew, unknowns};
    use crate::side::Test;

    /// Reference: central differences of the model's functions.
    fn compare_with_differences(problem: &Problem) {
        let at = unknowns(problem).0;
        let assembled = Assembled::new(problem, &Unknowns(at.clone())).unwrap();
        let line = assembled.line(1).unwrap();
        let derivatives = assembled.derivatives(1, &line);
        let scale = line.functions.iter().map(|y| y.norm()).fold(0.0, f64::max);
        for unknown in 0..problem.count() {
            let step = match unknown < problem.joint_count() {
                true => 1e-4 * at[unknown].abs().max(1.0),
                false => 1e-6,
            };
            let [above, below] = [step, -step].map(|step| {
                let mut moved = at.clone();
                moved[unknown] += step;
                let assembled = Assembled::new(problem, &Unknowns(moved)).unwrap();
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

    #[test]
    fn derivatives_are_differences_by_every_unknown() {
        compare_with_differences(&problem());
    }

    #[test]
    fn derivatives_by_hits_anew_are_differences() {
        compare_with_differences(&problem_hit_anew());
    }

    /// Reference: the same hits as impacts of their own, of a structure that moves as a rigid body.
    #[test]
    fn a_hit_that_is_elsewhere_in_the_assembly_is_an_impact_there() {
        let mut problem = problem_hit_anew().smoothed().unwrap();
        let at = unknowns(&problem);
        let first = problem.joint_count() + problem.sides[0].parameters().len();
        let of_hits = problem.sides[0].parameters();
        let of_hits = of_hits
            .iter()
            .position(|one| one.test == Test::Assembly)
            .unwrap();
        let joint = Unknowns(at.0.rows(0, problem.joint_count()).into_owned());
        let mut with = Unknowns(DVector::zeros(problem.count()));
        with.0.rows_mut(0, joint.0.len()).copy_from(&joint.0);
        // the first impact of a moves, and turns by little
        let moved = [0.004, -0.002, 0.003, 0.0, 0.0, 0.0];
        with.0
            .rows_mut(problem.joint_count() + of_hits, 6)
            .copy_from_slice(&moved);
        assert!(first > problem.joint_count() + of_hits + 5);
        let anew = Assembled::new(&problem, &with).unwrap().line(1).unwrap();
        // what is measured there, without being one of the impacts that loads are made of
        let side = &mut problem.sides[0];
        let (placed, set_up) = side.points().unwrap();
        let errors = placed.parameters(Role::Impact).len();
        let mut errors = vec![0.0; errors];
        errors[..6].copy_from_slice(&moved);
        let channels = vec![0.0; placed.parameters(Role::Channel).len()];
        let all = [channels, errors].concat();
        let elsewhere = set_up.displaced(&all).unwrap();
        let row = elsewhere.impacts().matrix().row(0).map(Complex64::from);
        let loads = VirtualPoint::new(set_up.clone(), &Weights::Equal, &Weights::Equal);
        let loads = loads.unwrap().forces_of_loads().map(Complex64::from);
        for line in &mut side.lines {
            let more = &*line * &loads * row.transpose();
            *line = line.clone().insert_column(line.ncols(), Complex64::ZERO);
            let last = line.ncols() - 1;
            line.set_column(last, &more.column(0));
        }
        side.references.push(side.references[0]);
        let last = side.references.len() - 1;
        for one in &mut problem.observed {
            one.at[1] = match one.at[1] {
                0 => last,
                other if other >= last => other + 1,
                other => other,
            };
        }
        problem.tolerances = None;
        let expected = Assembled::new(&problem, &joint).unwrap().line(1).unwrap();
        for (function, expected) in anew.functions.iter().zip(&expected.functions) {
            assert!((function - expected).norm() < 1e-10 * expected.norm());
        }
    }

    #[test]
    fn derivatives_of_a_chain_are_differences_by_every_unknown() {
        compare_with_differences(&chain());
    }

    /// Reference: receptances coupled as a whole.
    #[test]
    fn observed_functions_are_those_of_the_whole() {
        for problem in [problem(), chain()] {
            let assembled = Assembled::new(&problem, &unknowns(&problem)).unwrap();
            let (line, whole) = (assembled.line(1).unwrap(), assembled.whole(1).unwrap());
            for (function, one) in line.functions.iter().zip(&problem.observed) {
                let expected = whole.receptance()[(one.at[0], one.at[1])];
                assert!((function - expected).norm() < 1e-12 * expected.norm());
            }
            let apart = (line.by_joint_loads - whole.by_joint_loads()).norm();
            assert!(apart < 1e-12 * whole.by_joint_loads().norm());
        }
    }
}
