//! Reading and setting variables, and the element's loads.

use crate::{
    c,
    equations::assert_close,
    importer::{Instance, Kind, Make as _, State, vr},
    raw::{BOTH, Interface::CoSimulation, status_of},
};

#[test]
fn unknown_value_references_are_refused() {
    for version in BOTH {
        for (kind, dofs, unknown) in [
            (Kind::Lap, 2, vec![vr::NONE, 1000, 1 << 31, u32::MAX]),
            (
                Kind::Lap,
                1,
                vec![vr::A_THETA, vr::A_M, vr::JOINT_M, vr::NONE],
            ),
            (Kind::Element, 2, vec![vr::A_MASS, vr::STEP_SIZE_MAX]),
            (Kind::Element, 1, vec![vr::B_OMEGA, vr::B_M, vr::A_MASS]),
        ] {
            let mut instance = version.instance(CoSimulation, kind, dofs, &[]);
            instance.go_to(State::Initialization);
            for reference in unknown {
                let expected = format!("value reference {reference} does not exist");
                instance.refused_all(&[
                    (&expected, &|i| status_of(i.try_get(&[vr::A_Y, reference]))),
                    (&expected, &|i| i.set(&[vr::K_YY, reference], &[1.0, 1.0])),
                ]);
            }
        }
    }
}

#[test]
fn the_last_of_repeated_references_counts() {
    let instance = Instance::new(Kind::Lap, 1, &[]);
    c::ok(instance.set(&[vr::A_F, vr::A_F], &[1.0, 2.0]));
    assert_eq!(instance.get([vr::A_F, vr::A_F, vr::TIME]), [2.0, 2.0, 0.0]);
}

#[test]
fn the_element_gives_loads_from_motion_at_once() {
    // b.F = K r + C ṙ + k3 r³ by hand, with K = [4e6 1e4; 1e4 2e3], C = [8 0.5; 0.5 0.25], k3 = [1e12, 1e6]
    let cubic = [("joint.k3_y", 1e12), ("joint.k3_theta", 1e6)];
    let instance = Instance::stepping(Kind::Element, 2, &cubic);
    c::ok(instance.set(&vr::MOTION, &[3e-4, 2e-2, 0.5, 2.0, 2e-4, 1e-2, 0.25, -2.0]));
    // r = (1e-4, 1e-2), ṙ = (0.25, 4)
    let force = 4e6 * 1e-4 + 1e4 * 1e-2 + 8.0 * 0.25 + 0.5 * 4.0 + 1e12 * 1e-12;
    let moment = 1e4 * 1e-4 + 2e3 * 1e-2 + 0.5 * 0.25 + 0.25 * 4.0 + 1e6 * 1e-6;
    let energy =
        0.5 * (4e6 * 1e-8 + 2.0 * 1e4 * 1e-6 + 2e3 * 1e-4) + 0.25 * (1e12 * 1e-16 + 1e6 * 1e-8);
    let power = 8.0 * 0.0625 + 2.0 * 0.5 * 0.25 * 4.0 + 0.25 * 16.0;
    let outputs = [
        vr::A_F,
        vr::A_M,
        vr::B_F,
        vr::B_M,
        vr::JOINT_F,
        vr::JOINT_M,
        vr::ENERGY,
        vr::POWER,
    ];
    let found = instance.get(outputs);
    let expected = [-force, -moment, force, moment, force, moment, energy, power];
    assert_close(&found, &expected, 1e-12);
    // a tuned parameter shows at once
    c::ok(instance.set(&[vr::K_YY], &[8e6]));
    let [tuned] = instance.get([vr::B_F]);
    assert!((tuned - force - 400.0).abs() < 1e-9, "{tuned}");
    // a step changes the time only
    assert_eq!(instance.step_to(0.0, 0.1), (c::OK, 0.1));
    assert_eq!(
        instance.get([vr::B_F, vr::TIME, vr::A_Y]),
        [tuned, 0.1, 3e-4]
    );
}

#[test]
fn outputs_that_overflow_are_refused_by_name() {
    for version in BOTH {
        let mut instance = version.stepping(Kind::Element, 1, &[("joint.k3_y", 1.0)]);
        c::ok(instance.set(&[vr::A_Y], &[1e200]));
        assert_eq!(instance.get([vr::A_Y, vr::POWER]), [1e200, 0.0]);
        let message = instance.refused(|i| status_of(i.try_get(&[vr::A_Y, vr::B_F])));
        let told = message.split_once("variable b.F overflows at t = 0 s");
        assert!(
            told.is_some_and(|(_, rest)| rest.contains("in N")),
            "{message}"
        );
        // the inputs are still the importer's to change
        c::ok(instance.set(&[vr::A_Y], &[1e-4]));
        let [load] = instance.get([vr::B_F]);
        assert!((load - 400.0).abs() < 1e-9, "{load}");
    }
}

#[test]
fn an_element_at_rest_has_no_negative_zeros() {
    let instance = Instance::stepping(Kind::Element, 2, &[]);
    let loads = instance.get([vr::A_F, vr::A_M, vr::B_F, vr::B_M, vr::JOINT_F, vr::JOINT_M]);
    assert_eq!(loads.map(f64::to_bits), [0; 6]);
}
