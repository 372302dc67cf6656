//! A problem that tests share.

use bolted_joint_frf::{Direction, Dof, Sign};
use bolted_joint_space::{Axes, JointModel, Motions};
use bolted_joint_virtual_point::{Impact, Sensor, SetUp, Tolerance, Tolerances};
use nalgebra::{DMatrix, DVector, Vector3};
use num_complex::Complex64;

use crate::chain::joined;
use crate::links::{Link, Links, Numbers};
use crate::prior::Common;
use crate::problem::{Observed, Problem, Unknowns};
use crate::side::{Anew, Interface, Placed, Side};

/// Numbers that look random, from −1 to 1.
pub(crate) fn number(seed: &mut u32) -> f64 {
    *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    f64::from(*seed >> 8) / f64::from(1 << 23) - 1.0
}

fn vector(seed: &mut u32) -> Vector3<f64> {
    Vector3::from_fn(|_, _| number(seed))
}

/// A part with interfaces of three triaxial sensors and eight impacts each, which are not quite rigid, and one more response.
fn part(interfaces: usize, seed: &mut u32) -> Side {
    let dof = Dof::new(1, Direction::X, Sign::Plus);
    let placed = |n: usize, seed: &mut u32| {
        let sensors: Vec<Sensor> = (0..3)
            .map(|_| Sensor::triaxial(0.03 * vector(seed), &Axes::identity(), [1.0; 3]).unwrap())
            .collect();
        let impacts: Vec<Impact> = (0..8)
            .map(|_| Impact::new(0.03 * vector(seed), vector(seed).normalize(), 1.0).unwrap())
            .collect();
        Placed {
            name: "a".to_owned(),
            first: [9 * n, 8 * n],
            interface: Interface::Points(SetUp::new(&sensors, &impacts).unwrap()),
            seen: None,
            struck: None,
        }
    };
    let interfaces: Vec<Placed> = (0..interfaces).map(|n| placed(n, seed)).collect();
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
        noise: Vec::new(),
        interfaces,
        anew: Anew::default(),
    }
}

fn sample(sides: [Side; 2], lengths_m: &[f64], [rows, columns]: [&[usize]; 2]) -> Problem {
    let pairs = rows
        .iter()
        .flat_map(|&row| columns.iter().map(move |&column| [row, column]));
    let observed = pairs.map(|at| Observed::new(at, vec![Complex64::from(0.0); 2]));
    let link = |(n, &length_m): (usize, &f64)| Link {
        key: format!("joint[{n}]"),
        length_m,
        motions: Motions::ALL,
        is_placed: false,
        numbers: Numbers::Unknown(JointModel::Full.parametrisation().unwrap()),
    };
    Problem {
        observed: observed.collect(),
        sides,
        frequency_hz: vec![100.0, 130.0],
        links: Links(lengths_m.iter().enumerate().map(link).collect()),
        tolerances: Some(Tolerances::TYPICAL),
        wider: Vec::new(),
        common: Common::default(),
        balance: None,
    }
}

/// One joint, two lines, some functions between both sides, and a set-up with errors.
pub(crate) fn problem() -> Problem {
    let mut seed = 5;
    let sides = [part(1, &mut seed), part(1, &mut seed)];
    sample(sides, &[0.03], [&[0, 4, 9, 10, 14, 19], &[0, 7, 8, 15]])
}

/// The same, where sensors and hits of the assembly may be beside those of its parts.
pub(crate) fn problem_anew() -> Problem {
    problem().with_anew(Anew {
        sensors: Some(Tolerance::TYPICAL),
        hits: Some(Tolerance::TYPICAL),
    })
}

/// Two joints: three parts, of which the middle one, b, has both.
pub(crate) fn chain() -> Problem {
    let mut seed = 5;
    let [a, c] = [part(1, &mut seed), part(1, &mut seed)];
    let sides = [joined(vec![a, c]), part(2, &mut seed)];
    sample(
        sides,
        &[0.03, 0.02],
        [&[0, 4, 9, 12, 19, 22, 34, 38], &[0, 7, 9, 17, 29, 31]],
    )
}

/// Joints, and errors of the set-up of a hundredth.
pub(crate) fn unknowns(problem: &Problem) -> Unknowns {
    let mut seed = 9;
    let mut at = DVector::zeros(problem.count());
    for joint in problem.links.sought() {
        let count = joint.model.count();
        for (n, entry) in joint.model.entries().iter().enumerate() {
            let size =
                [entry.row, entry.column].map(|dof| if dof.is_rotation() { 0.03 } else { 1.0 });
            let own = match entry.row == entry.column {
                true => 1.0,
                false => 0.2 * number(&mut seed),
            };
            at[joint.first + n] = 2e6 * size[0] * size[1] * own;
            at[joint.first + count + n] = 300.0 * size[0] * size[1] * own;
        }
    }
    let joints = problem.joint_count();
    for error in &mut at.as_mut_slice()[joints..] {
        *error = 0.01 * number(&mut seed);
    }
    Unknowns(at)
}
