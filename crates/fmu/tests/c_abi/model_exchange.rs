//! Model Exchange: states and their derivatives, parameters, and what a step of the importer's solver is told.

use bolted_joint_importer::header::fmi3::*;

use crate::{
    c,
    equations::{assert_close, assert_close_at},
    importer::{Kind, Make as _, vr},
    raw::{BOTH, Fmi3, Raw, call, status_of},
};

#[test]
fn derivatives_are_those_of_the_equations_of_motion() {
    for version in BOTH {
        // m = 2, k = 8e5, c = 1 of both bodies; k12 = 4e6, c12 = 8, k3 = 5e12
        let instance = version.continuous(Kind::Lap, 1, &[("joint.k3_y", 5e12)]);
        let [ya, va, yb, vb]: [f64; 4] = [3e-4, 0.2, 1e-4, -0.1];
        c::ok(instance.set(&[vr::A_F, vr::B_F], &[30.0, -20.0]));
        c::ok(instance.set_states(&[ya, va, yb, vb]));
        assert_eq!(instance.states(4), [ya, va, yb, vb]);
        let joint = 4e6 * (ya - yb) + 8.0 * (va - vb) + 5e12 * (ya - yb).powi(3);
        let of_a = (30.0 - 8e5 * ya - va - joint) / 2.0;
        let of_b = (-20.0 - 8e5 * yb - vb + joint) / 2.0;
        let found = instance.derivatives(4);
        assert_close(&found, &[va, of_a, vb, of_b], 1e-13);
        assert_eq!(
            instance.get([vr::A_ACCELERATION, vr::B_ACCELERATION]),
            [found[1], found[3]]
        );
        assert_eq!(instance.try_nominals(4), Ok(vec![1e-4, 0.1, 1e-4, 0.1]));
        // a state can be set as a variable, too
        c::ok(instance.set(&[vr::B_V, vr::A_Y], &[7.0, 2e-4]));
        assert_eq!(instance.states(4), [2e-4, va, yb, 7.0]);
        assert_eq!(instance.derivatives(4)[2], 7.0);
        // with rotation: accelerations stand where the model structure has them
        let instance = version.continuous(Kind::Lap, 2, &[]);
        c::ok(instance.set_states(&[1e-4, 1e-3, 0.1, 1.0, 2e-4, 2e-3, 0.2, 2.0]));
        let accelerations = [
            vr::A_ACCELERATION,
            vr::A_ALPHA,
            vr::B_ACCELERATION,
            vr::B_ALPHA,
        ];
        let [a, alpha_a, b, alpha_b] = instance.get(accelerations);
        assert_eq!(
            instance.derivatives(8),
            [0.1, 1.0, a, alpha_a, 0.2, 2.0, b, alpha_b]
        );
        assert!([a, alpha_a, b, alpha_b].iter().all(|&value| value != 0.0));
    }
}

#[test]
fn the_jacobian_can_be_built_column_by_column() {
    for version in BOTH {
        // the example of FMI 2.0, 2.1.9: ∂ẋ/∂x of the linear lap, by hand
        let mut instance = version.continuous(Kind::Lap, 1, &[]);
        let accelerations = [vr::A_ACCELERATION, vr::B_ACCELERATION];
        let outputs = [vr::A_Y, vr::JOINT_F];
        c::ok(instance.set_states(&[1e-4, 0.1, -2e-4, 0.3]));
        c::ok(instance.set(&[vr::A_F], &[30.0]));
        let [of_a, _] = instance.get(accelerations);
        for (known, expected, joint) in [
            (vr::A_Y, [-4.8e6 / 2.0, 4e6 / 2.0], 4e6),
            (vr::B_Y, [4e6 / 2.0, -4.8e6 / 2.0], -4e6),
            (vr::A_V, [-9.0 / 2.0, 8.0 / 2.0], 8.0),
            (vr::B_V, [8.0 / 2.0, -9.0 / 2.0], -8.0),
            (vr::A_F, [0.5, 0.0], 0.0),
            (vr::B_F, [0.0, 0.5], 0.0),
            (vr::TIME, [0.0, 0.0], 0.0),
            (vr::K_YY, [-3e-4 / 2.0, 3e-4 / 2.0], 3e-4),
            (vr::A_MASS, [-of_a / 2.0, 0.0], 0.0),
        ] {
            let own = f64::from(u8::from(known == vr::A_Y));
            let of_outputs = instance.directional(&outputs, &[known], &[2.0]).unwrap();
            let found = instance
                .directional(&accelerations, &[known], &[1.0])
                .unwrap();
            let expected = [expected[0], expected[1], 2.0 * own, 2.0 * joint];
            // by what is not constant there is rounding
            let rounding = if [vr::K_YY, vr::A_MASS].contains(&known) {
                1e-14
            } else {
                0.0
            };
            assert_close_at(known, &[found, of_outputs].concat(), &expected, rounding);
        }
        // a linear combination; and the derivative of a displacement is the velocity, a state
        for (unknown, knowns, seed, expected) in [
            (
                vr::JOINT_F,
                [vr::A_Y, vr::B_V],
                [1e-4, 0.5],
                4e6 * 1e-4 - 8.0 * 0.5,
            ),
            (vr::A_V, [vr::A_V, vr::A_Y], [1.0, 5.0], 1.0),
        ] {
            let found = instance.directional(&[unknown], &knowns, &seed);
            assert_eq!(found, Ok(vec![expected]));
        }
        let slope =
            |i: Raw, unknown, known, seed| status_of(i.directional(&[unknown], &[known], &[seed]));
        instance.refused_all(&[
            ("a.F is an input and no unknown", &|i| {
                slope(i, vr::A_F, vr::A_Y, 1.0)
            }),
            (
                "power.dissipated is a calculated output and no known",
                &|i| slope(i, vr::JOINT_F, vr::POWER, 1.0),
            ),
            ("the seed of variable a.y is NaN", &|i| {
                slope(i, vr::JOINT_F, vr::A_Y, f64::NAN)
            }),
        ]);
    }
}

#[test]
fn a_parameter_takes_effect_when_continuous_time_goes_on() {
    for version in BOTH {
        let mut instance = version.continuous(Kind::Lap, 1, &[]);
        c::ok(instance.enter_event());
        c::ok(instance.set(&[vr::A_MASS], &[-1.0]));
        instance.refuses(Raw::enter_continuous, "parameter a.m is -1 kg");
        c::ok(instance.set(&[vr::A_MASS, vr::B_C_Y], &[4.0, -1.0]));
        assert_eq!(instance.enter_continuous(), c::WARNING);
        c::ok(instance.set(&[vr::A_F], &[8.0]));
        assert_eq!(instance.derivatives(4), [0.0, 2.0, 0.0, 0.0]);
        // the longest Runge–Kutta step is none of the importer's business
        let instance = version.continuous(Kind::Lap, 1, &[("step_size_max", 1.0)]);
        c::ok(instance.complete_step());
    }
}

#[test]
fn a_softening_joint_that_gives_way_ends_the_simulation() {
    // escape at √((k + 2 k12)/(−2 k3)) = 2.0976 mm
    let mut instance = Fmi3.continuous(Kind::Lap, 1, &[("joint.k3_y", -1e12)]);
    c::ok(instance.set_states(&[2.0e-3, 0.0, 0.0, 0.0]));
    // past 80 % of it
    assert_eq!(instance.complete_step(), c::WARNING);
    c::ok(instance.complete_step());
    // a solver may try such states, but not accept them
    c::ok(instance.set_time(0.125));
    c::ok(instance.set_states(&[2.2e-3, 0.0, 0.0, 0.0]));
    assert!(
        instance
            .derivatives(4)
            .iter()
            .all(|value| value.is_finite())
    );
    assert_eq!(instance.complete_step(), c::ERROR);
    let message = instance.error();
    c::tells(
        &message,
        "fmi3CompletedIntegratorStep: a.y - b.y = ",
        "t = 0.125 s",
    );
    assert_eq!(instance.complete_step(), c::ERROR);
    assert!(instance.error().contains("in state Terminated"));
}

#[test]
fn an_element_has_no_states() {
    for (kind, dofs, expected) in [(Kind::Element, 2, 0), (Kind::Lap, 1, 4), (Kind::Lap, 2, 8)] {
        let instance = Fmi3.continuous(kind, dofs, &[]);
        let (mut states, mut indicators) = (99, 99);
        c::ok(call!(@one instance, fmi3GetNumberOfContinuousStates(&raw mut states)));
        c::ok(call!(@one instance, fmi3GetNumberOfEventIndicators(&raw mut indicators)));
        assert_eq!((states, indicators), (expected, 0));
        assert_eq!(instance.try_indicators(0), Ok(vec![]));
    }
    for version in BOTH {
        let element = version.continuous(Kind::Element, 1, &[]);
        c::ok(element.set(&[vr::A_Y], &[1e-4]));
        assert_eq!(element.get([vr::B_F]), [400.0]);
        assert_eq!(
            (element.set_states(&[]), element.complete_step()),
            (c::OK, c::OK)
        );
    }
}
