//! A problem that tests share.

use bolted_joint_frf::{Direction, Dof, Sign};
use bolted_joint_space::{Axes, JointModel};
use bolted_joint_virtual_point::{Impact, Sensor, SetUp, Tolerances};
use nalgebra::{DMatrix, DVector, Vector3};
use num_complex::Complex64;

use crate::problem::{Observed, Problem, Unknowns};
use crate::side::{Interface, Side};

/// Numbers that look random, from −1 to 1.
pub(crate) fn number(seed: &mut u32) -> f64 {
    *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    f64::from(*seed >> 8) / f64::from(1 << 23) - 1.0
}

fn vector(seed: &mut u32) -> Vector3<f64> {
    Vector3::from_fn(|_, _| number(seed))
}

/// A side with three triaxial sensors and eight impacts, whose interface is not quite rigid, and one more response.
fn side(seed: &mut u32) -> Side {
    let sensors: Vec<Sensor> = (0..3)
        .map(|_| Sensor::triaxial(0.03 * vector(seed), &Axes::identity(), [1.0; 3]).unwrap())
        .collect();
    let impacts: Vec<Impact> = (0..8)
        .map(|_| Impact::new(0.03 * vector(seed), vector(seed).normalize(), 1.0).unwrap())
        .collect();
    let dof = Dof::new(1, Direction::X, Sign::Plus);
    let lines = (0..2)
        .map(|_| {
            DMatrix::from_fn(10, 8, |_, _| {
                Complex64::new(number(seed), number(seed)) * 1e-7
            })
        })
        .collect();
    Side {
        responses: vec![dof; 10],
        references: vec![dof; 8],
        lines,
        interface: Interface::Points(SetUp::new(&sensors, &impacts).unwrap()),
    }
}

/// Two lines, some functions between both sides, and a set-up with errors.
pub(crate) fn problem() -> Problem {
    let mut seed = 5;
    let sides = [side(&mut seed), side(&mut seed)];
    let rows = [0, 4, 9, 10, 14, 19];
    let columns = [0, 7, 8, 15];
    let pairs = rows
        .iter()
        .flat_map(|&row| columns.map(|column| [row, column]));
    let observed = pairs.map(|at| Observed {
        at,
        values: vec![Complex64::from(0.0); 2],
    });
    Problem {
        observed: observed.collect(),
        sides,
        frequency_hz: vec![100.0, 130.0],
        model: JointModel::Full.parametrisation().unwrap(),
        length_m: 0.03,
        tolerances: Some(Tolerances::TYPICAL),
    }
}

/// A joint, and errors of the set-up of a hundredth.
pub(crate) fn unknowns(problem: &Problem) -> Unknowns {
    let mut seed = 9;
    let mut at = DVector::zeros(problem.count());
    let count = problem.model.count();
    for (n, entry) in problem.model.entries().iter().enumerate() {
        let size = [entry.row, entry.column].map(|dof| if dof.is_rotation() { 0.03 } else { 1.0 });
        let own = match entry.row == entry.column {
            true => 1.0,
            false => 0.2 * number(&mut seed),
        };
        at[n] = 2e6 * size[0] * size[1] * own;
        at[count + n] = 300.0 * size[0] * size[1] * own;
    }
    for error in &mut at.as_mut_slice()[2 * count..] {
        *error = 0.01 * number(&mut seed);
    }
    Unknowns(at)
}
