//! What a refused call and a failed step leave behind.

use std::ptr;

use crate::{
    c,
    importer::{Kind, Make as _, vr},
    raw::{BOTH, Fmi2, Interface::CoSimulation, Raw, status_of},
};

#[test]
fn after_a_refused_call_the_simulation_goes_on() {
    for version in BOTH {
        // one instance makes every kind of mistake on its way, the other makes none
        let mut careless = version.instance(CoSimulation, Kind::Lap, 1, &[]);
        let careful = version.instance(CoSimulation, Kind::Lap, 1, &[]);
        careless.refused(|i| i.set(&[vr::K_YY, vr::A_F], &[1.0, f64::NAN]));
        careless.refused(|i| i.step(0.0, 1e-3));
        careless.refused(|i| i.enter_initialization(f64::NAN, None));
        careless.refused(|i| i.enter_initialization(1.0, Some(0.5)));
        for instance in [&careless, &careful] {
            c::ok(instance.enter_initialization(1.0, Some(2.0)));
        }
        // a parameter that cannot take effect is found when initialisation ends, and can still be mended there
        c::ok(careless.set(&[vr::A_MASS], &[0.0]));
        careless.refuses(Raw::exit_initialization, "parameter a.m is 0 kg");
        c::ok(careless.set(&[vr::A_MASS], &[2.0]));
        careless.refused(|i| i.enter_initialization(0.0, None));
        for instance in [&careless, &careful] {
            c::ok(instance.exit_initialization());
            c::ok(instance.set(&[vr::B_F], &[100.0]));
        }
        let mut t = 1.0;
        for _ in 0..20 {
            careless.refused(|i| i.step(t, -1e-3));
            careless.refused(|i| i.step(t + 1e-3, 1e-3));
            careless.refused(|i| i.step(t, 2.0));
            careless.refused(|i| i.set(&[vr::A_F, vr::A_Y], &[1.0, 1.0]));
            careless.refused(|i| status_of(i.try_get(&[vr::NONE])));
            careless.refused(|i| i.restore(ptr::null_mut()));
            careless.refused(|i| status_of(i.deserialize(&[0; 100])));
            careless.refused(Raw::enter_event);
            c::ok(careless.set(&[vr::STEP_SIZE_MAX], &[-1.0]));
            careless.refuses(|i| i.step(t, 1e-3), "step_size_max is -1 s");
            c::ok(careless.set(&[vr::STEP_SIZE_MAX], &[2e-5]));
            for instance in [&careless, &careful] {
                assert_eq!(instance.step_to(t, 1e-3), (c::OK, t + 1e-3));
            }
            t += 1e-3;
        }
        assert!(careful.get([vr::A_Y]) != [0.0]);
        assert_eq!(careless.state_bytes(), careful.state_bytes());
    }
}

#[test]
fn a_failed_step_ends_the_simulation_but_not_the_values() {
    const ALL: [u32; 5] = [vr::TIME, vr::A_Y, vr::B_Y, vr::B_F, vr::JOINT_F];
    // a softening joint that a load tears, and a load that no number can follow
    let softening = (
        [("joint.k3_y", -1e12)],
        1e8,
        "softening joint no longer holds",
    );
    let linear = ([("joint.k3_y", 0.0)], f64::MAX, "the motion diverges");
    for (version, (changes, load, expected)) in BOTH
        .into_iter()
        .flat_map(|version| [(version, softening), (version, linear)])
    {
        let mut instance = version.stepping(Kind::Lap, 1, &changes);
        let is_fmi2 = version == Fmi2;
        c::ok(instance.set(&[vr::B_F], &[100.0]));
        assert_eq!(instance.step_to(0.0, 1e-3), (c::OK, 1e-3));
        let saved = instance.save();
        c::ok(instance.set(&[vr::B_F], &[load]));
        let before = instance.get(ALL);
        // nothing of the step was done: fmi2Error, not fmi2Discard (FMI 2.0, 4.2.2)
        assert_eq!(instance.step_to(1e-3, 1e-3), (c::ERROR, 1e-3));
        let message = instance.message(c::ERROR);
        assert!(message.contains(expected), "{message}");
        assert!(!is_fmi2 || instance.has_terminated());
        // a smaller load comes too late, but what was reached can be read; FMI 2.0, 2.1.6: no fmi2Terminate after an error
        instance.refused_all(&[
            (
                "in state Terminated, only in Step Mode; reset the instance or restore a saved state",
                &|i| i.step(1e-3, 1e-3),
            ),
            ("in state Terminated", &|i| i.set(&[vr::B_F], &[100.0])),
            ("in state Terminated, only in Step Mode", &|i| i.terminate()),
        ]);
        assert_eq!(instance.get(ALL), before);
        // a saved state goes on, also with another input, as FMI 2.0, 4.2.2 proposes
        for load in [100.0, 50.0] {
            c::ok(instance.restore(saved));
            assert!(!is_fmi2 || !instance.has_terminated());
            c::ok(instance.set(&[vr::B_F], &[load]));
            assert_eq!(instance.step_to(1e-3, 1e-3), (c::OK, 2e-3));
        }
        instance.free_state(saved);
        // and a reset starts again
        c::ok(instance.set(&[vr::B_F], &[load]));
        assert_eq!(instance.step_to(2e-3, 1e-3), (c::ERROR, 2e-3));
        c::ok(instance.reset());
        instance.initialize(0.0, None);
        assert_eq!(instance.step_to(0.0, 1e-3), (c::OK, 1e-3));
        c::ok(instance.terminate());
        assert!(!is_fmi2 || instance.has_terminated());
    }
}
