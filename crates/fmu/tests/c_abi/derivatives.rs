//! Partial derivatives: their values in simple cases, which variables they take in which mode, what is refused.

use crate::{
    c,
    importer::{Instance, Kind, vr},
    raw::{Raw, status_of},
};

#[test]
fn an_element_with_one_dof_has_the_derivatives_of_its_law() {
    // F_b = k r + c ṙ + k3 r³, U = k r²/2 + k3 r⁴/4, P = c ṙ² with k = 4e6, c = 8, k3 = 5e12
    let instance = Instance::stepping(Kind::Element, 1, &[("joint.k3_y", 5e12)]);
    let (y_a, y_b, v_a, v_b) = (3e-4, 1e-4, 0.2, 0.05);
    let motion = [vr::A_Y, vr::B_Y, vr::A_V, vr::B_V];
    assert_eq!(instance.set(&motion, &[y_a, y_b, v_a, v_b]), c::OK);
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
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() <= 1e-14 * expected.abs(),
                "{known}: {found} {expected}"
            );
        }
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
        assert_eq!(instance.set(&motion, &values), c::OK);
        assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        assert_eq!(instance.exit_initialization(), c::OK);
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
    assert_eq!(instance.set(&[vr::K_YY], &[3e6]), c::OK);
    assert_eq!(
        instance.directional(&[vr::JOINT_F], &[vr::A_Y], &[1.0]),
        Ok(vec![3e6])
    );
    assert_eq!(instance.step(0.0, 1e-3), c::OK);
    assert_eq!(
        instance.directional(&[vr::JOINT_F], &[vr::B_Y], &[1.0]),
        Ok(vec![-3e6])
    );
}

#[test]
fn the_mode_decides_what_is_unknown() {
    let mut instance = Instance::new(Kind::Lap, 2, &[]);
    for call in [Raw::directional, Raw::adjoint] {
        let message = instance.refused(|i| status_of(call(i, &[vr::JOINT_F], &[vr::A_Y], &[1.0])));
        assert!(
            message.contains("is not allowed in state Instantiated"),
            "{message}"
        );
    }
    assert_eq!(instance.enter_initialization(0.0, None), c::OK);
    for call in [Raw::directional, Raw::adjoint] {
        assert_eq!(
            call(instance.raw, &[vr::JOINT_F], &[vr::A_Y], &[1.0]),
            Ok(vec![4e6])
        );
        // a state is given in Initialization Mode
        let message = instance.refused(|i| status_of(call(i, &[vr::A_Y], &[vr::A_Y], &[1.0])));
        assert!(
            message.contains("variable a.y is a state and no unknown in state Initialization Mode"),
            "{message}"
        );
    }
    assert_eq!(instance.exit_initialization(), c::OK);
    assert_eq!(instance.terminate(), c::OK);
    assert_eq!(
        instance.directional(&[vr::JOINT_F], &[vr::A_Y], &[1.0]),
        Ok(vec![4e6])
    );
}

#[test]
fn wrong_arguments_are_refused() {
    let mut instance = Instance::stepping(Kind::Lap, 2, &[("joint.k3_y", 5e12)]);
    for call in [Raw::directional, Raw::adjoint] {
        for (unknown, known, seed, expected) in [
            (vr::NONE, vr::A_Y, 1.0, "value reference 52 does not exist"),
            (
                vr::JOINT_F,
                vr::NONE,
                1.0,
                "value reference 52 does not exist",
            ),
            (
                vr::A_F,
                vr::A_Y,
                1.0,
                "variable a.F is an input and no unknown in state Step Mode",
            ),
            (
                vr::K_YY,
                vr::A_Y,
                1.0,
                "variable joint.k_yy is a parameter and no unknown",
            ),
            (
                vr::JOINT_F,
                vr::ENERGY,
                1.0,
                "variable energy.stored is a calculated output and no known",
            ),
            (
                vr::JOINT_F,
                vr::A_Y,
                f64::NAN,
                "is NaN; expected a finite number",
            ),
            (
                vr::JOINT_F,
                vr::A_Y,
                f64::INFINITY,
                "is inf; expected a finite number",
            ),
            (
                vr::JOINT_F,
                vr::A_Y,
                f64::MAX,
                "overflows at t = 0 s with this seed",
            ),
        ] {
            let message = instance.refused(|i| status_of(call(i, &[unknown], &[known], &[seed])));
            assert!(message.contains(expected), "{message}");
        }
    }
    let message = instance.refused(|i| status_of(i.directional(&[vr::JOINT_F], &[vr::A_Y], &[])));
    assert!(
        message.contains("argument nSeed is 0, expected 1"),
        "{message}"
    );
    let message = instance.refused(|i| status_of(i.adjoint(&[vr::JOINT_F], &[vr::A_Y], &[1.0; 2])));
    assert!(
        message.contains("argument nSeed is 2, expected 1"),
        "{message}"
    );
}
