//! Partial derivatives: their values in simple cases, which variables they take in which mode, what is refused.

use crate::{
    c,
    equations::assert_close_at,
    importer::{Instance, Kind, vr},
    raw::{Raw, status_of},
    rows::{number, reference, rows},
};

#[test]
fn an_element_with_one_dof_has_the_derivatives_of_its_law() {
    // F_b = k r + c ṙ + k3 r³, U = k r²/2 + k3 r⁴/4, P = c ṙ² with k = 4e6, c = 8, k3 = 5e12
    let instance = Instance::stepping(Kind::Element, 1, &[("joint.k3_y", 5e12)]);
    let (y_a, y_b, v_a, v_b) = (3e-4, 1e-4, 0.2, 0.05);
    let motion = [vr::A_Y, vr::B_Y, vr::A_V, vr::B_V];
    c::ok(instance.set(&motion, &[y_a, y_b, v_a, v_b]));
    let (r, v): (f64, f64) = (y_a - y_b, v_a - v_b);
    let tangent = 4e6 + 3.0 * 5e12 * r * r;
    let spring = 4e6 * r + 5e12 * r.powi(3);
    let unknowns = [vr::A_F, vr::B_F, vr::JOINT_F, vr::ENERGY, vr::POWER];
    for (known, on_b, energy, power) in [
        (vr::A_Y, tangent, spring, 0.0),
        (vr::B_Y, -tangent, -spring, 0.0),
        (vr::A_V, 8.0, 0.0, 2.0 * 8.0 * v),
        (vr::B_V, -8.0, 0.0, -2.0 * 8.0 * v),
        (vr::K_YY, r, r * r / 2.0, 0.0),
        (vr::C_YY, v, 0.0, v * v),
        (vr::K3_Y, r.powi(3), r.powi(4) / 4.0, 0.0),
        (vr::TIME, 0.0, 0.0, 0.0),
    ] {
        let found = instance.directional(&unknowns, &[known], &[2.0]).unwrap();
        let expected = [-on_b, on_b, on_b, energy, power].map(|derivative| 2.0 * derivative);
        assert_close_at(known, &found, &expected, 1e-14);
    }
    // a known that is listed twice counts twice
    let twice = instance.directional(&[vr::B_F], &[vr::A_V, vr::A_V], &[1.0, 2.0]);
    assert_eq!(twice, Ok(vec![24.0]));
    assert_eq!(instance.directional(&[], &[], &[]), Ok(vec![]));
    assert_eq!(instance.adjoint(&[], &[], &[]), Ok(vec![]));
}

#[test]
fn the_adjoint_is_the_transpose() {
    for (kind, unknowns, knowns) in [
        (
            Kind::Element,
            (vr::A_F..=vr::POWER).collect::<Vec<_>>(),
            (vr::TIME..=vr::B_OMEGA).chain(vr::K_YY..=24).collect(),
        ),
        (
            Kind::Lap,
            (vr::A_Y..=vr::B_OMEGA)
                .chain(vr::JOINT_F..=vr::POWER)
                .collect(),
            (vr::TIME..=vr::B_M)
                .chain(vr::K_YY..=vr::STEP_SIZE_MAX)
                .collect::<Vec<_>>(),
        ),
    ] {
        let instance = Instance::new(kind, 2, &[("joint.k3_y", 5e12), ("joint.k3_theta", 1e6)]);
        let motion: Vec<u32> = (vr::A_Y..=vr::B_OMEGA).collect();
        let values = [2e-4, 1e-3, 0.1, -2.0, -1e-4, 3e-3, 0.3, 1.0];
        c::ok(instance.set(&motion, &values));
        instance.initialize(0.0, None);
        let columns: Vec<Vec<f64>> = knowns
            .iter()
            .map(|&known| instance.directional(&unknowns, &[known], &[1.0]).unwrap())
            .collect();
        assert!(
            columns
                .iter()
                .flatten()
                .filter(|&&entry| entry != 0.0)
                .count()
                > 40
        );
        for (row, &unknown) in unknowns.iter().enumerate() {
            let found = instance.adjoint(&[unknown], &knowns, &[1.0]).unwrap();
            let expected: Vec<f64> = columns.iter().map(|column| column[row]).collect();
            assert_eq!(found, expected, "{unknown}");
        }
        // whole products: seed · (J direction) = direction · (Jᵀ seed)
        let direction: Vec<f64> = (0..knowns.len()).map(|i| (i as f64).sin()).collect();
        let seed: Vec<f64> = (0..unknowns.len()).map(|i| (i as f64).cos()).collect();
        let forward = instance
            .directional(&unknowns, &knowns, &direction)
            .unwrap();
        let backward = instance.adjoint(&unknowns, &knowns, &seed).unwrap();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let size = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a * b).abs()).sum::<f64>();
        let difference = dot(&seed, &forward) - dot(&direction, &backward);
        assert!(difference.abs() < 1e-13 * size(&seed, &forward));
    }
}

#[test]
fn a_state_is_its_own_known_between_steps() {
    let instance = Instance::stepping(Kind::Lap, 1, &[]);
    let states = [vr::A_Y, vr::A_V, vr::B_Y, vr::B_V];
    for (index, known) in states.into_iter().enumerate() {
        let mut expected = vec![0.0; 4];
        expected[index] = 1.0;
        assert_eq!(
            instance.directional(&states, &[known], &[1.0]),
            Ok(expected)
        );
    }
    // inputs act through the states, over a step: at the communication point nothing changes with them
    assert_eq!(
        instance.directional(&states, &[vr::A_F], &[1.0]),
        Ok(vec![0.0; 4])
    );
}

#[test]
fn parameters_count_as_they_are_set() {
    // also before the next step takes them into use, as for outputs
    let instance = Instance::stepping(Kind::Lap, 1, &[]);
    c::ok(instance.set(&[vr::K_YY], &[3e6]));
    assert_eq!(
        instance.directional(&[vr::JOINT_F], &[vr::A_Y], &[1.0]),
        Ok(vec![3e6])
    );
    c::ok(instance.step(0.0, 1e-3));
    assert_eq!(
        instance.directional(&[vr::JOINT_F], &[vr::B_Y], &[1.0]),
        Ok(vec![-3e6])
    );
}

#[test]
fn the_mode_decides_what_is_unknown() {
    let mut instance = Instance::new(Kind::Lap, 2, &[]);
    for call in [Raw::directional, Raw::adjoint] {
        instance.refuses(
            |i| status_of(call(i, &[vr::JOINT_F], &[vr::A_Y], &[1.0])),
            "is not allowed in state Instantiated",
        );
    }
    c::ok(instance.enter_initialization(0.0, None));
    for call in [Raw::directional, Raw::adjoint] {
        assert_eq!(
            call(instance.raw, &[vr::JOINT_F], &[vr::A_Y], &[1.0]),
            Ok(vec![4e6])
        );
        // a state is given in Initialization Mode
        instance.refuses(
            |i| status_of(call(i, &[vr::A_Y], &[vr::A_Y], &[1.0])),
            "variable a.y is a state and no unknown in state Initialization Mode",
        );
    }
    c::ok(instance.exit_initialization());
    c::ok(instance.terminate());
    assert_eq!(
        instance.directional(&[vr::JOINT_F], &[vr::A_Y], &[1.0]),
        Ok(vec![4e6])
    );
}

/// Unknown, known, seed, and why there is no derivative.
const WRONG: &str = "
    52         | a.y           | 1   | value reference 52 does not exist
    joint.F    | 52            | 1   | value reference 52 does not exist
    a.F        | a.y           | 1   | variable a.F is an input and no unknown in state Step Mode
    joint.k_yy | a.y           | 1   | variable joint.k_yy is a parameter and no unknown
    joint.F    | energy.stored | 1   | variable energy.stored is a calculated output and no known
    joint.F    | a.y           | NaN | is NaN; expected a finite number
    joint.F    | a.y           | inf | is inf; expected a finite number
    joint.F    | a.y           | 1.7976931348623157e308 | overflows at t = 0 s with this seed
";

#[test]
fn wrong_arguments_are_refused() {
    let mut instance = Instance::stepping(Kind::Lap, 2, &[("joint.k3_y", 5e12)]);
    for call in [Raw::directional, Raw::adjoint] {
        for [unknown, known, seed, expected] in rows(WRONG) {
            let [unknown, known] = [unknown, known].map(reference);
            instance.refuses(
                |i| status_of(call(i, &[unknown], &[known], &[number(seed)])),
                expected,
            );
        }
    }
    instance.refuses(
        |i| status_of(i.directional(&[vr::JOINT_F], &[vr::A_Y], &[])),
        "argument nSeed is 0, expected 1",
    );
    instance.refuses(
        |i| status_of(i.adjoint(&[vr::JOINT_F], &[vr::A_Y], &[1.0; 2])),
        "argument nSeed is 2, expected 1",
    );
}
