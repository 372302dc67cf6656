//! Reading and setting variables, and the element's loads.

use std::ptr;

use crate::{
    c,
    importer::{Instance, Kind, vr},
};

/// Calls that must be refused before the instance is looked at twice, each on a fresh instance.
#[test]
fn bad_arguments_are_refused() {
    let references = [vr::A_Y, vr::B_Y];
    let mut values = [0.0; 2];
    let (r, v) = (references.as_ptr(), values.as_mut_ptr());
    let null_r = ptr::null::<u32>();
    let null_v = ptr::null_mut::<f64>();
    for (r, n, v, nv, expected) in [
        (r, 2, v, 1, "argument nValues is 1, expected 2"),
        (r, 1, v, 2, "argument nValues is 2, expected 1"),
        (r, 0, v, 1, "argument nValues is 1, expected 0"),
        (
            null_r,
            2,
            v,
            2,
            "argument valueReferences is a null pointer",
        ),
        (r, 2, null_v, 2, "argument values is a null pointer"),
        (
            r,
            usize::MAX,
            v,
            usize::MAX,
            "argument valueReferences does not point to an array",
        ),
        (
            r,
            usize::MAX / 6,
            v,
            usize::MAX / 6,
            "argument valueReferences does not point to an array",
        ),
    ] {
        for set in [false, true] {
            let mut instance = Instance::new(Kind::Lap, 2, &[]);
            // SAFETY: lengths that are too large are refused before anything is read
            let message = instance.refused(|i| unsafe {
                if set {
                    c::fmi3SetFloat64(i.handle, r, n, v, nv)
                } else {
                    c::fmi3GetFloat64(i.handle, r, n, v, nv)
                }
            });
            assert!(message.contains(expected), "{message}");
        }
    }
    let mut instance = Instance::new(Kind::Lap, 2, &[]);
    // SAFETY: the misaligned pointers stay inside the arrays
    unsafe {
        let odd = v.cast::<u8>().add(1).cast();
        assert_eq!(c::fmi3GetFloat64(instance.handle, r, 1, odd, 1), c::ERROR);
        assert!(
            instance
                .error()
                .contains("argument values does not point to an array")
        );
        // empty lists are fine, whatever the pointers
        assert_eq!(
            c::fmi3GetFloat64(instance.handle, null_r, 0, null_v, 0),
            c::OK
        );
        assert_eq!(
            c::fmi3SetFloat64(instance.handle, null_r, 0, null_v, 0),
            c::OK
        );
    }
}

#[test]
fn unknown_value_references_are_refused() {
    for (kind, dofs, unknown) in [
        (Kind::Lap, 2, vec![vr::NONE, 1000, u32::MAX]),
        (
            Kind::Lap,
            1,
            vec![vr::A_THETA, vr::A_M, vr::JOINT_M, vr::NONE],
        ),
        (Kind::Element, 2, vec![vr::A_MASS, vr::STEP_SIZE_MAX]),
        (Kind::Element, 1, vec![vr::B_OMEGA, vr::B_M, vr::A_MASS]),
    ] {
        for reference in unknown {
            let mut instance = Instance::new(kind, dofs, &[]);
            let message =
                instance.refused(|i| i.try_get(&[vr::A_Y, reference]).err().unwrap_or(c::OK));
            assert!(
                message.contains(&format!("value reference {reference} does not exist")),
                "{message}"
            );
            let message = instance.refused(|i| i.set(&[vr::K_YY, reference], &[1.0, 1.0]));
            assert!(message.contains("does not exist"), "{message}");
        }
    }
}

#[test]
fn setting_is_all_or_nothing() {
    for (reference, value, expected) in [
        (
            vr::TIME,
            1.0,
            "variable time is the independent variable and cannot be set in state Instantiated",
        ),
        (
            vr::JOINT_F,
            1.0,
            "variable joint.F is a calculated output and cannot be set",
        ),
        (vr::A_F, f64::NAN, "variable a.F cannot be set to NaN"),
        (vr::A_F, f64::INFINITY, "variable a.F cannot be set to inf"),
        (
            vr::A_F,
            f64::NEG_INFINITY,
            "variable a.F cannot be set to -inf",
        ),
        (vr::NONE, 1.0, "does not exist"),
    ] {
        let mut instance = Instance::new(Kind::Lap, 2, &[]);
        let all: Vec<u32> = (0..vr::NONE).collect();
        let before = instance.try_get(&all).unwrap();
        let message =
            instance.refused(|i| i.set(&[vr::B_F, vr::K_YY, reference], &[5.0, 6.0, value]));
        assert!(message.contains(expected), "{message}");
        assert_eq!(instance.try_get(&all).unwrap(), before);
    }
    // states are set before and in initialisation only
    let mut instance = Instance::stepping(Kind::Lap, 2, &[]);
    let message = instance.refused(|i| i.set(&[vr::A_F, vr::A_Y], &[5.0, 1e-3]));
    assert!(
        message.contains("variable a.y is a state and cannot be set in state Step Mode"),
        "{message}"
    );
    assert_eq!(instance.get([vr::A_F, vr::A_Y]), [0.0, 0.0]);
}

#[test]
fn the_last_of_repeated_references_counts() {
    let mut instance = Instance::new(Kind::Lap, 1, &[]);
    assert_eq!(instance.set(&[vr::A_F, vr::A_F], &[1.0, 2.0]), c::OK);
    assert_eq!(instance.get([vr::A_F, vr::A_F, vr::TIME]), [2.0, 2.0, 0.0]);
}

#[test]
fn other_types_are_refused_and_empty_lists_accepted() {
    let reference = [vr::A_Y];
    let r = reference.as_ptr();
    let mut instance = Instance::new(Kind::Element, 1, &[]);
    let before = instance.state_bytes();
    let i = instance.handle;
    // SAFETY: nothing is read or written, the variable is refused first
    unsafe {
        for (status, asked) in [
            (c::fmi3GetInt32(i, r, 1, ptr::null_mut(), 1), "Int32"),
            (c::fmi3SetBoolean(i, r, 1, ptr::null(), 1), "Boolean"),
            (c::fmi3GetString(i, r, 1, ptr::null_mut(), 1), "String"),
            (
                c::fmi3GetBinary(i, r, 1, ptr::null_mut(), ptr::null_mut(), 1),
                "Binary",
            ),
            (c::fmi3GetClock(i, r, 1, ptr::null_mut()), "Clock"),
        ]
        .into_iter()
        .zip(instance.take_log())
        .map(|((status, asked), message)| (status, (asked, message.text)))
        {
            assert_eq!(status, c::ERROR);
            let (asked, message) = asked;
            let expected = format!("variable a.y is of type Float64, not {asked};");
            assert!(message.contains(&expected), "{message}");
        }
        assert_eq!(instance.state_bytes(), before);

        let mut empty = Instance::new(Kind::Element, 1, &[]);
        assert_eq!(
            c::fmi3GetInt32(empty.handle, ptr::null(), 0, ptr::null_mut(), 0),
            c::OK
        );
        assert_eq!(
            c::fmi3GetClock(empty.handle, ptr::null(), 0, ptr::null_mut()),
            c::OK
        );
        assert!(empty.take_log().is_empty());
    }
}

#[test]
fn the_element_gives_loads_from_motion_at_once() {
    // b.F = K r + C ṙ + k3 r³ by hand, with K = [4e6 1e4; 1e4 2e3], C = [8 0.5; 0.5 0.25], k3 = [1e12, 1e6]
    let cubic = [("joint.k3_y", 1e12), ("joint.k3_theta", 1e6)];
    let mut instance = Instance::stepping(Kind::Element, 2, &cubic);
    let motion = [
        vr::A_Y,
        vr::A_THETA,
        vr::A_V,
        vr::A_OMEGA,
        vr::B_Y,
        vr::B_THETA,
        vr::B_V,
        vr::B_OMEGA,
    ];
    assert_eq!(
        instance.set(&motion, &[3e-4, 2e-2, 0.5, 2.0, 2e-4, 1e-2, 0.25, -2.0]),
        c::OK
    );
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
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() < 1e-12 * expected.abs(),
            "{found} {expected}"
        );
    }
    // a tuned parameter shows at once
    assert_eq!(instance.set(&[vr::K_YY], &[8e6]), c::OK);
    let [tuned] = instance.get([vr::B_F]);
    assert!((tuned - force - 400.0).abs() < 1e-9, "{tuned}");
    // a step changes the time only
    assert_eq!(instance.step(0.0, 0.1), (c::OK, 0.1));
    assert_eq!(
        instance.get([vr::B_F, vr::TIME, vr::A_Y]),
        [tuned, 0.1, 3e-4]
    );
}

#[test]
fn outputs_that_overflow_are_refused_by_name() {
    let mut instance = Instance::stepping(Kind::Element, 1, &[("joint.k3_y", 1.0)]);
    assert_eq!(instance.set(&[vr::A_Y], &[1e200]), c::OK);
    assert_eq!(instance.get([vr::A_Y, vr::POWER]), [1e200, 0.0]);
    let message = instance.refused(|i| i.try_get(&[vr::A_Y, vr::B_F]).err().unwrap_or(c::OK));
    assert!(
        message.contains("variable b.F overflows at t = 0 s") && message.contains("in N"),
        "{message}"
    );
    // the inputs are still the importer's to change
    assert_eq!(instance.set(&[vr::A_Y], &[1e-4]), c::OK);
    let [load] = instance.get([vr::B_F]);
    assert!((load - 400.0).abs() < 1e-9, "{load}");
}

#[test]
fn an_element_at_rest_has_no_negative_zeros() {
    let mut instance = Instance::stepping(Kind::Element, 2, &[]);
    let loads = instance.get([vr::A_F, vr::A_M, vr::B_F, vr::B_M, vr::JOINT_F, vr::JOINT_M]);
    assert_eq!(loads.map(f64::to_bits), [0; 6]);
}
