use super::*;
use bolted_joint_virtual_point::{Role, VirtualPoint, Weights};

use crate::samples::{chain, problem, problem_anew, unknowns};
use crate::side::Test;

/// Reference: central differences of the model's functions.
fn compare_with_differences(problem: &Problem) {
    let at = unknowns(problem).0;
    let assembled = Assembled::new(problem, &Unknowns(at.clone())).unwrap();
    let line = assembled.line(1).unwrap();
    let derivatives = assembled.derivatives(1, &line).unwrap();
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
fn derivatives_by_sensors_and_hits_anew_are_differences() {
    compare_with_differences(&problem_anew());
}

/// Reference: the same hits as impacts of their own, of a structure that moves as a rigid body.
#[test]
fn a_hit_that_is_elsewhere_in_the_assembly_is_an_impact_there() {
    let mut problem = problem_anew().smoothed().unwrap();
    let at = unknowns(&problem);
    let first = problem.joint_count() + problem.sides[0].parameters().len();
    let of_hits = problem.sides[0].parameters();
    let of_hits = of_hits
        .iter()
        .position(|one| one.test == Test::Assembly(Role::Impact))
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
