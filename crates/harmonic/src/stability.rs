//! Whether a periodic motion persists: Floquet's multipliers of a small deviation over one period.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, Schur};
use num_complex::Complex64;

use super::balance::HarmonicBalance;
use super::branches::Deviating;
use super::course::Course;
use super::deviation::{Deviation, Linearised, Tangent};
use super::{HarmonicError, Solution};

/// Runge–Kutta steps of one radian of the fastest motion: the phase of a multiplier is then exact to
/// 2π · (1/24)⁴/120 = 1.6·10⁻⁷ for each of its periods.
const STEPS_PER_RADIAN: f64 = 24.0;
/// Multipliers beyond one by no more than what the integration adds count as on the unit circle.
const ON_THE_CIRCLE: f64 = 1e-9;
/// Part of a step by which a moment at the end of a smooth part is taken from within.
const EDGE: f64 = 1e-6;
/// A lap that nothing holds drifts: two multipliers are 1, and rounding parts them by its root.
const DRIFTS: f64 = 1e-5;
/// Iterations for all eigenvalues of a small matrix.
const MOST_ITERATIONS: usize = 1000;

/// Floquet multipliers of a periodic motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Stability {
    /// By modulus, the largest first.
    pub multipliers: Vec<Complex64>,
}

impl Stability {
    /// Whether every small deviation dies out, or at least does not grow.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.multipliers
            .iter()
            .all(|multiplier| multiplier.norm() <= 1.0 + ON_THE_CIRCLE)
    }
}

/// A small deviation on its way through a period.
struct Column<const D: usize> {
    bodies: Deviation<D>,
    /// Of what each DOF remembers: see [`Deviating`].
    remembered: [Vec<f64>; D],
}

impl<const D: usize> HarmonicBalance<D> {
    /// Floquet multipliers of a solution: eigenvalues of what one period makes of small deviations, by RK4. What a joint
    /// remembers deviates too: the places of its latest turns, and loads that relax.
    ///
    /// # Errors
    /// [`HarmonicError::Multipliers`] if they are not finite.
    pub fn stability(&self, solution: &Solution<D>) -> Result<Stability, HarmonicError> {
        let refuse = || HarmonicError::Multipliers {
            frequency_hz: solution.frequency_hz(),
        };
        let omega = solution.at.omega;
        let fastest = self.fastest(solution);
        let steps = (TAU * STEPS_PER_RADIAN * (fastest / omega).max(1.0)).ceil();
        if steps.is_nan() || steps >= 1e7 {
            return Err(refuse());
        }
        let motion = Deviated::new(self, solution);
        let mut columns = motion.units();
        let mut from = 0.0;
        for (to, turn) in motion.stops() {
            motion.follow(&mut columns, [from, to], steps * (to - from) / TAU);
            if let Some((dof, turn)) = turn {
                for column in &mut columns {
                    column.turn(dof, turn, &motion);
                }
            }
            from = to;
        }
        let size = columns.len();
        let states: Vec<Vec<f64>> = columns.iter().map(|column| motion.end(column)).collect();
        let monodromy = DMatrix::from_fn(size, size, |row, column| states[column][row]);
        if monodromy.iter().any(|entry| !entry.is_finite()) {
            return Err(refuse());
        }
        let schur = Schur::try_new(monodromy, f64::EPSILON, MOST_ITERATIONS).ok_or_else(refuse)?;
        let mut multipliers: Vec<Complex64> = schur.complex_eigenvalues().iter().copied().collect();
        self.take_for_drifts(&mut multipliers);
        multipliers.sort_by(|one, other| other.norm().total_cmp(&one.norm()));
        Ok(Stability { multipliers })
    }

    /// Makes exact what follows from bodies that are free together on a DOF.
    fn take_for_drifts(&self, multipliers: &mut [Complex64]) {
        let is_free = |dof: &usize| {
            let bodies = [&self.lap.a, &self.lap.b].into_iter();
            bodies
                .flat_map(|body| [body.stiffness[*dof], body.damping[*dof]])
                .all(|support| support == 0.0)
        };
        let drifts = 2 * (0..D).filter(is_free).count();
        let one = Complex64::from(1.0);
        multipliers.sort_by(|a, b| (a - one).norm().total_cmp(&(b - one).norm()));
        let nearest = multipliers.iter_mut().take(drifts);
        nearest
            .filter(|multiplier| (**multiplier - one).norm() < DRIFTS)
            .for_each(|multiplier| *multiplier = one);
    }

    /// The course of a DOF.
    fn course<'a>(&'a self, solution: &'a Solution<D>, dof: usize) -> Course<'a> {
        let slots = self.harmonics.slots();
        let own = &solution.coefficients[dof * slots..(dof + 1) * slots];
        Course::new(&self.harmonics, own)
    }

    /// ∂f/∂r and ∂f/∂ṙ of the polynomials on each DOF at τ.
    fn tangents(&self, solution: &Solution<D>, phase: f64) -> [[f64; D]; 2] {
        let mut tangents = [[0.0; D]; 2];
        for dof in 0..D {
            let [r, rate] = self.course(solution, dof).motion(phase);
            let here = self.terms[dof].tangent(r, solution.at.omega * rate);
            tangents[0][dof] = here.stiffness;
            tangents[1][dof] = here.damping;
        }
        tangents
    }

    /// No motion is faster than this, rad/s: a bound of the eigenvalues by row sums, of the joint at its stiffest.
    fn fastest(&self, solution: &Solution<D>) -> f64 {
        let count = 4 * self.harmonics.highest() + 4;
        let tangents: Vec<[[f64; D]; 2]> = (0..count)
            .map(|n| self.tangents(solution, TAU * n as f64 / count as f64))
            .collect();
        let stiffest: [f64; D] = std::array::from_fn(|dof| {
            tangents
                .iter()
                .fold(0.0, |most: f64, at| most.max(at[0][dof].abs()))
        });
        let bodies = [&self.lap.a, &self.lap.b];
        let mut most: f64 = 0.0;
        for row in &bodies {
            for i in 0..D {
                let mut sum = row.stiffness[i].abs() / row.inertia[i];
                for column in &bodies {
                    for j in 0..D {
                        let mut entry = self.lap.joint.linear.stiffness[i][j].abs();
                        if i == j {
                            entry += stiffest[i];
                        }
                        sum += entry / (row.inertia[i] * column.inertia[j]).sqrt();
                    }
                }
                most = most.max(sum);
            }
        }
        most.sqrt()
    }
}

/// A periodic motion with what deviates from it.
struct Deviated<'a, const D: usize> {
    balance: &'a HarmonicBalance<D>,
    solution: &'a Solution<D>,
    equations: Linearised<'a, D>,
    on: [Option<Deviating<'a>>; D],
}

impl<'a, const D: usize> Deviated<'a, D> {
    fn new(balance: &'a HarmonicBalance<D>, solution: &'a Solution<D>) -> Self {
        let joint = &balance.lap.joint.linear;
        Self {
            balance,
            solution,
            equations: Linearised {
                bodies: [&balance.lap.a, &balance.lap.b],
                joint_stiffness: &joint.stiffness,
                joint_damping: &joint.damping,
                omega: solution.at.omega,
            },
            on: std::array::from_fn(|dof| {
                let laws = balance.slipping.as_ref()?.on(dof)?;
                laws.deviating(balance.course(solution, dof))
            }),
        }
    }

    /// Numbers that a DOF remembers from the period before.
    fn memories(&self, dof: usize) -> usize {
        self.on[dof].as_ref().map_or(0, Deviating::memories)
    }

    /// One deviation of each state, of the bodies and of what is remembered.
    fn units(&self) -> Vec<Column<D>> {
        let at_rest = || Column {
            bodies: Deviation::NONE,
            remembered: std::array::from_fn(|dof| {
                vec![0.0; self.on[dof].as_ref().map_or(0, Deviating::inputs)]
            }),
        };
        let mut units = Vec::new();
        for state in 0..4 * D {
            units.push(Column {
                bodies: Deviation::unit(state),
                ..at_rest()
            });
        }
        for dof in 0..D {
            for memory in 0..self.memories(dof) {
                let mut unit = at_rest();
                unit.remembered[dof][memory] = 1.0;
                units.push(unit);
            }
        }
        units
    }

    /// τ up to which all is smooth, ascending to the end of the period, each with the DOF and the number of the turn there.
    fn stops(&self) -> Vec<(f64, Option<(usize, usize)>)> {
        let mut stops = vec![(TAU, None)];
        for (dof, on) in self.on.iter().enumerate() {
            let Some(on) = on else { continue };
            let turns = on.turns().iter().enumerate();
            stops.extend(turns.map(|(n, &turn)| (turn, Some((dof, n)))));
            stops.extend(on.corners().into_iter().map(|corner| (corner, None)));
        }
        // turns at the end of the period before the end
        stops.sort_by(|one, other| one.0.total_cmp(&other.0).then(other.1.cmp(&one.1)));
        stops
    }

    /// Moves the deviations on over a smooth part of the period, by about so many steps.
    fn follow(&self, columns: &mut [Column<D>], [from, to]: [f64; 2], steps: f64) {
        if to <= from {
            return;
        }
        let steps = steps.ceil().max(1.0);
        let step = (to - from) / steps;
        // from within, since the ends belong to other branches as well
        let inside = EDGE * step;
        let moment = |half: f64| {
            let phase = (from + 0.5 * half * step).clamp(from + inside, to - inside);
            Moment::of(self, phase)
        };
        let mut last = moment(0.0);
        for n in 0..steps as usize {
            let half = 2.0 * n as f64;
            let moments = [last, moment(half + 1.0), moment(half + 2.0)];
            for column in columns.iter_mut() {
                let tangents = moments.each_ref().map(|moment| moment.tangent(column));
                column.bodies = self.equations.step(&column.bodies, &tangents, step);
            }
            let [_, _, end] = moments;
            last = end;
        }
    }

    /// The states of a deviation at the end of the period.
    fn end(&self, column: &Column<D>) -> Vec<f64> {
        let mut states: Vec<f64> = (0..4 * D).map(|state| column.bodies.entry(state)).collect();
        for (on, remembered) in self.on.iter().zip(&column.remembered) {
            if let Some(on) = on {
                states.extend(on.after(remembered));
            }
        }
        states
    }
}

impl<const D: usize> Column<D> {
    /// Notes that a DOF turns, with its deviation there.
    fn turn(&mut self, dof: usize, turn: usize, motion: &Deviated<'_, D>) {
        if let Some(on) = &motion.on[dof] {
            self.remembered[dof][on.memories() + turn] = self.bodies.relative(dof);
        }
    }
}

/// The joint's changes at a moment.
struct Moment<const D: usize> {
    by_motion: [[f64; D]; 2],
    by_remembered: [Vec<f64>; D],
}

impl<const D: usize> Moment<D> {
    fn of(motion: &Deviated<'_, D>, phase: f64) -> Self {
        let mut by_motion = motion.balance.tangents(motion.solution, phase);
        let by_remembered = std::array::from_fn(|dof| {
            let Some(on) = &motion.on[dof] else {
                return Vec::new();
            };
            let (stiffness, by_remembered) = on.tangent(phase);
            by_motion[0][dof] += stiffness;
            by_remembered
        });
        Self {
            by_motion,
            by_remembered,
        }
    }

    /// What it does to a deviation.
    fn tangent(&self, column: &Column<D>) -> Tangent<D> {
        Tangent {
            by_motion: self.by_motion,
            remembered: std::array::from_fn(|dof| {
                let products = self.by_remembered[dof].iter().zip(&column.remembered[dof]);
                products.map(|(by, deviation)| by * deviation).sum()
            }),
        }
    }
}
