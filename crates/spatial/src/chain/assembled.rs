//! The functions that an assembly with a joint would have, and how they change with every unknown.

use bolted_joint_space::{Coupled, Selection};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::chain::problem::{Problem, Unknowns, block_diagonal};
use crate::chain::side::{MOTIONS, Transformations};
use crate::error::SpatialError;

/// The model at one set of unknowns.
pub(crate) struct Assembled<'p> {
    problem: &'p Problem,
    transformations: [Transformations; 2],
    selections: [Selection; 2],
    stiffness: DMatrix<f64>,
    damping: DMatrix<f64>,
}

/// What an assembly without the joints that are sought has where they will be, at one line.
pub(crate) struct Open {
    /// Y Sᵀ: rows × motions.
    pub(crate) by_loads: DMatrix<Complex64>,
    /// S Y: motions × columns.
    pub(crate) motions: DMatrix<Complex64>,
    /// Y
    pub(crate) alone: DMatrix<Complex64>,
    /// H = S Y Sᵀ: the receptance that the joints see.
    pub(crate) seen: DMatrix<Complex64>,
}

/// Functions of the assembly at one line, and their derivatives by each unknown (observed × unknowns).
pub(crate) struct Line {
    pub(crate) functions: Vec<Complex64>,
    pub(crate) derivatives: DMatrix<Complex64>,
}

impl<'p> Assembled<'p> {
    pub(crate) fn new(problem: &'p Problem, unknowns: &Unknowns) -> Result<Self, SpatialError> {
        let [stiffness, damping] = problem.matrices(unknowns)?;
        let errors = problem.errors(unknowns);
        let of = |side: usize| problem.sides[side].transformations(&errors[side]);
        Ok(Self {
            problem,
            transformations: [of(0)?, of(1)?],
            selections: problem.selections()?,
            stiffness,
            damping,
        })
    }

    fn extended(&self, line: usize) -> [DMatrix<Complex64>; 2] {
        let sides = [0, 1];
        sides.map(|side| {
            let functions = &self.problem.sides[side].lines[line];
            self.transformations[side].extended(functions)
        })
    }

    fn coupled(
        &self,
        line: usize,
        extended: &[DMatrix<Complex64>; 2],
    ) -> Result<Coupled, SpatialError> {
        let [a, b] = extended;
        let receptances = block_diagonal([a, b]);
        let [motions, loads] = &self.selections;
        let dynamic = self.dynamic(line);
        Ok(Coupled::between(
            &receptances,
            [motions, loads],
            &dynamic,
            self.problem.length_m(),
        )?)
    }

    /// D = K + jωC of all joints
    fn dynamic(&self, line: usize) -> DMatrix<Complex64> {
        let omega = self.problem.omega(line);
        let parts = self.stiffness.zip_map(&self.damping, |k, c| (k, c));
        parts.map(|(k, c)| Complex64::new(k, omega * c))
    }

    /// The assembly without the joints that are sought; those that are known are there.
    pub(crate) fn open(problem: &'p Problem) -> Result<Self, SpatialError> {
        let none = Unknowns(DVector::zeros(problem.count()));
        let mut own = Self::new(problem, &none)?;
        [own.stiffness, own.damping] = problem.links.known();
        Ok(own)
    }

    /// What it has where the joints that are sought will be.
    pub(crate) fn at_joints(&self, line: usize) -> Result<Open, SpatialError> {
        let coupled = self.coupled(line, &self.extended(line))?;
        let alone = coupled.receptance().clone();
        let rows: Vec<usize> = (self.problem.links.sought().iter())
            .flat_map(|one| (0..MOTIONS).map(|dof| MOTIONS * one.number + dof))
            .collect();
        let of = |selection: &Selection| selection.matrix().select_rows(&rows).map(Complex64::from);
        let [s, t] = [&self.selections[0], &self.selections[1]].map(of);
        let by_loads = &alone * t.transpose();
        Ok(Open {
            motions: &s * &alone,
            seen: s * &by_loads,
            by_loads,
            alone,
        })
    }

    /// All functions of a line, and how the assembly moves in its joints.
    pub(crate) fn whole(&self, line: usize) -> Result<Coupled, SpatialError> {
        self.coupled(line, &self.extended(line))
    }

    /// The observed functions of a line.
    pub(crate) fn functions(&self, line: usize) -> Result<Vec<Complex64>, SpatialError> {
        let coupled = self.coupled(line, &self.extended(line))?;
        let observed = self.problem.observed.iter();
        Ok(observed
            .map(|one| coupled.receptance()[(one.at[0], one.at[1])])
            .collect())
    }

    /// The observed functions of a line with their derivatives.
    pub(crate) fn line(&self, line: usize) -> Result<Line, SpatialError> {
        let extended = self.extended(line);
        let coupled = self.coupled(line, &extended)?;
        let observed = &self.problem.observed;
        let functions = observed
            .iter()
            .map(|one| coupled.receptance()[(one.at[0], one.at[1])])
            .collect();
        let mut derivatives = DMatrix::zeros(observed.len(), self.problem.count());
        let j_omega = Complex64::new(0.0, self.problem.omega(line));
        let (a, b) = (coupled.by_joint_loads(), coupled.joint_motions());
        for joint in self.problem.links.sought() {
            let (at, first, count) = (MOTIONS * joint.number, joint.first, joint.model.count());
            let own = a.columns(at, MOTIONS);
            for (n, basis) in joint.model.bases().iter().enumerate() {
                // ∂Y_C = −a ∂D b
                let left = own * basis.map(Complex64::from);
                for (row, one) in observed.iter().enumerate() {
                    let [o, i] = one.at;
                    let sum: Complex64 = (0..MOTIONS).map(|m| left[(o, m)] * b[(at + m, i)]).sum();
                    derivatives[(row, first + n)] = -sum;
                    derivatives[(row, first + count + n)] = -j_omega * sum;
                }
            }
        }
        if self.problem.tolerances.is_some() {
            self.by_errors(line, &extended, &coupled, &mut derivatives);
        }
        Ok(Line {
            functions,
            derivatives,
        })
    }

    /// dY_C = L dY R, L = I − a D S, R = I − Sᵀ D b, for each error of a set-up, which changes the interface's rows and columns
    /// of Y alone.
    fn by_errors(
        &self,
        line: usize,
        extended: &[DMatrix<Complex64>; 2],
        coupled: &Coupled,
        derivatives: &mut DMatrix<Complex64>,
    ) {
        let dynamic = self.dynamic(line);
        let [a, b] = [coupled.by_joint_loads(), coupled.joint_motions()];
        let (a_d, d_b) = (a * &dynamic, &dynamic * b);
        let observed = &self.problem.observed;
        let motions = self.problem.motions();
        let mut column = self.problem.joint_count();
        let (mut first_row, mut first_column) = (0, 0);
        for (side, (own, all)) in self.transformations.iter().zip(extended).enumerate() {
            let sign = if side == 0 { 1.0 } else { -1.0 };
            let (p, q) = (all.nrows() - motions, all.ncols() - motions);
            // L to the interface's rows of this side, and to all of its rows: −a D S there, beside the identity
            let left = |o: usize, m: usize| {
                let unit = if o == first_row + p + m { 1.0 } else { 0.0 };
                Complex64::from(unit) - a_d[(o, m)] * sign
            };
            let right = |m: usize, i: usize| {
                let unit = if i == first_column + q + m { 1.0 } else { 0.0 };
                Complex64::from(unit) - d_b[(m, i)] * sign
            };
            let functions = &self.problem.sides[side].lines[line];
            // Y R: what the columns of this side come to, for each column of the assembly
            let by_columns = DMatrix::from_fn(q, d_b.ncols(), |j, i| {
                let unit = if i == first_column + j { 1.0 } else { 0.0 };
                let loads: Complex64 = (0..motions).map(|m| own.loads[(j, m)] * right(m, i)).sum();
                loads + unit
            });
            let y_r = functions * by_columns;
            for change in &own.motions_changes {
                let moved = change * &y_r;
                for (row, one) in observed.iter().enumerate() {
                    let [o, i] = one.at;
                    derivatives[(row, column)] =
                        (0..motions).map(|m| left(o, m) * moved[(m, i)]).sum();
                }
                column += 1;
            }
            // L Y likewise
            let by_rows = DMatrix::from_fn(a_d.nrows(), p, |o, r| {
                let unit = if o == first_row + r { 1.0 } else { 0.0 };
                let motions: Complex64 =
                    (0..motions).map(|m| left(o, m) * own.motions[(m, r)]).sum();
                motions + unit
            });
            let l_y = by_rows * functions;
            for change in &own.loads_changes {
                let loaded = &l_y * change;
                for (row, one) in observed.iter().enumerate() {
                    let [o, i] = one.at;
                    derivatives[(row, column)] =
                        (0..motions).map(|m| loaded[(o, m)] * right(m, i)).sum();
                }
                column += 1;
            }
            first_row += all.nrows();
            first_column += all.ncols();
        }
    }
}

#[cfg(test)]
mod tests {
    use bolted_joint_frf::{Direction, Dof, Sign};
    use bolted_joint_space::{Axes, JointModel};
    use bolted_joint_virtual_point::{Impact, Sensor, SetUp, Tolerances};
    use nalgebra::Vector3;

    use super::*;
    use crate::chain::links::{Link, Links, Numbers};
    use crate::chain::part::joined;
    use crate::chain::problem::Observed;
    use crate::chain::side::{Interface, Placed, Side};

    /// Numbers that look random, from −1 to 1.
    fn number(seed: &mut u32) -> f64 {
        *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(*seed >> 8) / f64::from(1 << 23) - 1.0
    }

    fn vector(seed: &mut u32) -> Vector3<f64> {
        Vector3::from_fn(|_, _| number(seed))
    }

    /// A part with interfaces of three triaxial sensors and eight impacts each, which are not quite rigid, and one more response.
    fn part(interfaces: usize, seed: &mut u32) -> Side {
        let dof = Dof::new(1, Direction::X, Sign::Plus);
        let set_ups = (0..interfaces).map(|n| {
            let sensors: Vec<Sensor> = (0..3)
                .map(|_| {
                    Sensor::triaxial(0.03 * vector(seed), &Axes::identity(), [1.0; 3]).unwrap()
                })
                .collect();
            let impacts: Vec<Impact> = (0..8)
                .map(|_| Impact::new(0.03 * vector(seed), vector(seed).normalize(), 1.0).unwrap())
                .collect();
            Placed {
                name: "a".to_owned(),
                first: [9 * n, 8 * n],
                interface: Interface::Points(SetUp::new(&sensors, &impacts).unwrap()),
            }
        });
        let interfaces: Vec<Placed> = set_ups.collect();
        let [rows, columns] = [9, 8].map(|each| each * interfaces.len());
        let lines = (0..2)
            .map(|_| {
                DMatrix::from_fn(rows + 1, columns, |_, _| {
                    Complex64::new(number(seed), number(seed)) * 1e-7
                })
            })
            .collect();
        Side {
            responses: vec![dof; rows + 1],
            references: vec![dof; columns],
            lines,
            interfaces,
        }
    }

    /// Three parts; the middle one, b, has both joints.
    fn problem() -> Problem {
        let mut seed = 5;
        let [a, c] = [part(1, &mut seed), part(1, &mut seed)];
        let sides = [joined(vec![a, c]), part(2, &mut seed)];
        // sensors, impacts and motions of every part
        let rows = [0, 4, 9, 12, 19, 22, 34, 40, 52, 60];
        let columns = [0, 7, 9, 17, 29, 40];
        let pairs = rows
            .iter()
            .flat_map(|&row| columns.map(|column| [row, column]));
        let observed = pairs.map(|at| Observed {
            at,
            values: vec![Complex64::from(0.0); 2],
        });
        let link = |key: &str, length_m: f64| Link {
            key: key.to_owned(),
            length_m,
            numbers: Numbers::Unknown(JointModel::Full.parametrisation().unwrap()),
        };
        Problem {
            observed: observed.collect(),
            sides,
            frequency_hz: vec![100.0, 130.0],
            links: Links(vec![link("joint[0]", 0.03), link("joint[1]", 0.02)]),
            tolerances: Some(Tolerances::TYPICAL),
        }
    }

    /// Reference: central differences of the model's functions.
    #[test]
    fn derivatives_are_differences_by_every_unknown() {
        let problem = problem();
        let mut seed = 9;
        let mut at = DVector::zeros(problem.count());
        for joint in problem.links.sought() {
            let count = joint.model.count();
            for (n, entry) in joint.model.entries().iter().enumerate() {
                let size =
                    [entry.row, entry.column].map(|dof| if dof.is_rotation() { 0.03 } else { 1.0 });
                let own = if entry.row == entry.column {
                    1.0
                } else {
                    0.2 * number(&mut seed)
                };
                at[joint.first + n] = 2e6 * size[0] * size[1] * own;
                at[joint.first + count + n] = 300.0 * size[0] * size[1] * own;
            }
        }
        let joints = problem.joint_count();
        for error in &mut at.as_mut_slice()[joints..] {
            *error = 0.01 * number(&mut seed);
        }
        let line = Assembled::new(&problem, &Unknowns(at.clone()))
            .unwrap()
            .line(1)
            .unwrap();
        let scale = line.functions.iter().map(|y| y.norm()).fold(0.0, f64::max);
        for unknown in 0..problem.count() {
            let step = match unknown < joints {
                true => 1e-4 * at[unknown].abs().max(1.0),
                false => 1e-6,
            };
            let [above, below] = [step, -step].map(|step| {
                let mut moved = at.clone();
                moved[unknown] += step;
                let assembled = Assembled::new(&problem, &Unknowns(moved)).unwrap();
                assembled.functions(1).unwrap()
            });
            let size = line
                .derivatives
                .column(unknown)
                .iter()
                .map(|d| d.norm())
                .fold(0.0, f64::max);
            for (row, (above, below)) in above.iter().zip(&below).enumerate() {
                let difference = (above - below) / (2.0 * step);
                let error = (difference - line.derivatives[(row, unknown)]).norm();
                assert!(
                    error <= 1e-6 * size + 1e-10 * scale / step,
                    "{unknown} {row}: {difference} {}",
                    line.derivatives[(row, unknown)]
                );
            }
        }
    }
}
