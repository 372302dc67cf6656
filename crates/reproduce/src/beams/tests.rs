//! What is said about the differences of Tables 4.4 and 4.5.

use super::*;
use crate::draws::Draws;

fn values(joint: &JointMatrices) -> [f64; 6] {
    let (k, c) = (&joint.stiffness, &joint.damping);
    [
        (k, 0, 0),
        (k, 0, 1),
        (k, 1, 1),
        (c, 0, 0),
        (c, 0, 1),
        (c, 1, 1),
    ]
    .map(|(m, i, j)| m[(i, j)])
}

/// Largest error of the six values, as a fraction of each.
fn error(joint: &JointMatrices, exact: &JointMatrices) -> f64 {
    let pairs = values(joint).into_iter().zip(values(exact));
    pairs
        .map(|(value, exact)| (value / exact - 1.0).abs())
        .fold(0.0, f64::max)
}

#[test]
fn every_equation_is_exact_without_noise() {
    let case = Case::new(R_M).unwrap();
    for equation in [Equation::Rr, Equation::Rs, Equation::Ss] {
        let measured = case.measured(equation);
        let found = case.average(equation, &case.a, &case.b, &measured).unwrap();
        assert!(error(&found, &truth()) < 1e-4, "{equation:?} {found:?}");
    }
}

#[test]
fn rotations_estimated_on_both_sides_leave_the_equation_exact() {
    let case = Case::new(R_M).unwrap();
    let (a, assembly) = case.around_r().unwrap();
    let transformation = FiniteDifference::central(SPACING_M).transformation();
    let transposed = transformation.transpose();
    let estimated: Vec<Partition> = a
        .iter()
        .map(|part| Partition {
            joint: part.joint.clone(),
            joint_points: &part.joint_points * &transposed,
            points_joint: &transformation * &part.points_joint,
            points: &transformation * &part.points * &transposed,
        })
        .collect();
    let found = case
        .average(Equation::Rr, &estimated, &case.b, &differences(&assembly))
        .unwrap();
    assert!(error(&found, &truth()) < 1e-4, "{found:?}");
    // A's own receptances exact, those of the assembly by differences: couplings count as zero.
    let mixed = case.joint_with_estimated_rotations().unwrap();
    assert!(error(&mixed[0], &truth()) > 0.3, "{mixed:?}");
}

#[test]
fn the_rotational_stiffness_of_identification_2_depends_on_r() {
    // The same in NumPy: 722, 710, 636, 361.8 N·m/rad.
    for (r_m, reference) in [(0.05, 722.0), (0.1, 710.0), (0.15, 636.0), (0.2, 361.8)] {
        let case = Case::new(r_m).unwrap();
        let found = case.joint_with_estimated_rotations().unwrap();
        let found = found[0].stiffness[(1, 1)];
        assert!((found / reference - 1.0).abs() < 2e-3, "{r_m} {found}");
    }
}

#[test]
fn equation_3_19_depends_on_r_more_than_3_18() {
    let draws = Draws {
        count: 6,
        seed: 1,
        samples: Vec::new(),
    };
    let draws = Repetition {
        draws: &draws,
        progress: &|| (),
    };
    let noise = Pollution::Response {
        level: LEVEL,
        samples: 1 << 24,
    };
    let mean = |case: &Case, equation| {
        let joints = case.joints(draws, noise, equation).unwrap();
        joints
            .iter()
            .map(|joint| joint.stiffness[(1, 1)])
            .sum::<f64>()
            / 6.0
    };
    // NumPy, other draws: −736 and 653 N·m/rad.
    let by_rs = [0.05, 0.25].map(|r_m| mean(&Case::new(r_m).unwrap(), Equation::Rs));
    assert!((-760.0..-680.0).contains(&by_rs[0]), "{by_rs:?}");
    assert!((620.0..740.0).contains(&by_rs[1]), "{by_rs:?}");
    for r_m in [0.15, 0.2, 0.25, 0.28] {
        let by_rr = mean(&Case::new(r_m).unwrap(), Equation::Rr);
        assert!((by_rr / 1e3 - 1.0).abs() < 0.2, "{r_m} {by_rr}");
    }
}
