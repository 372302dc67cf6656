//! Which call is allowed in which state, and what a refused call and a failed step leave behind.

use std::ptr;

use crate::{
    c,
    importer::{Instance, Kind, vr},
};

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Instantiated,
    Initialization,
    Step,
    Terminated,
}

const STATES: [State; 4] = [
    State::Instantiated,
    State::Initialization,
    State::Step,
    State::Terminated,
];

fn instance_in(state: State) -> Instance {
    let mut instance = Instance::new(Kind::Lap, 2, &[]);
    if state != State::Instantiated {
        assert_eq!(instance.enter_initialization(0.0, None), c::OK);
    }
    if matches!(state, State::Step | State::Terminated) {
        assert_eq!(instance.exit_initialization(), c::OK);
    }
    if state == State::Terminated {
        assert_eq!(instance.terminate(), c::OK);
    }
    instance.take_log();
    instance
}

#[test]
fn calls_are_allowed_in_the_states_of_the_standard_only() {
    type Call = fn(&mut Instance) -> i32;
    let calls: [(&str, Call, &[State]); 8] = [
        (
            "fmi3EnterInitializationMode",
            |i| i.enter_initialization(0.0, None),
            &[State::Instantiated],
        ),
        (
            "fmi3ExitInitializationMode",
            Instance::exit_initialization,
            &[State::Initialization],
        ),
        ("fmi3DoStep", |i| i.step(0.0, 1e-3).0, &[State::Step]),
        ("fmi3Terminate", Instance::terminate, &[State::Step]),
        ("fmi3Reset", Instance::reset, &STATES),
        (
            "fmi3SetFloat64",
            |i| i.set(&[vr::A_F, vr::K_YY], &[1.0, 3e6]),
            &[State::Instantiated, State::Initialization, State::Step],
        ),
        (
            "fmi3SetFloat64",
            |i| i.set(&[vr::A_Y], &[1e-5]),
            &[State::Instantiated, State::Initialization],
        ),
        (
            "fmi3GetFloat64",
            |i| {
                i.try_get(&[vr::TIME, vr::A_Y, vr::JOINT_F])
                    .err()
                    .unwrap_or(c::OK)
            },
            &STATES,
        ),
    ];
    for (function, call, allowed) in calls {
        for state in STATES {
            let mut instance = instance_in(state);
            if allowed.contains(&state) {
                assert_eq!(call(&mut instance), c::OK, "{function} in {state:?}");
                continue;
            }
            // the instance stays where it is, so the same call is refused again in the same words
            let message = instance.refused(call);
            assert_eq!(instance.refused(call), message);
            let name = match state {
                State::Instantiated => "Instantiated",
                State::Initialization => "Initialization Mode",
                State::Step => "Step Mode",
                State::Terminated => "Terminated",
            };
            assert!(message.starts_with(&format!("{function}: ")), "{message}");
            assert!(message.contains(&format!("in state {name}")), "{message}");
        }
    }
}

#[test]
fn states_are_saved_and_restored_in_every_state() {
    for state in STATES {
        let mut instance = instance_in(state);
        let saved = instance.save();
        let bytes = instance.serialize(saved);
        // into another state and back
        assert_eq!(instance.reset(), c::OK);
        assert_eq!(instance.restore(saved), c::OK);
        let again = instance.save();
        assert_eq!(instance.serialize(again), bytes, "{state:?}");
        instance.free_state(saved);
        instance.free_state(again);
    }
}

#[test]
fn after_a_refused_call_the_simulation_goes_on() {
    // one instance makes every kind of mistake on its way, the other makes none
    let mut careless = Instance::new(Kind::Lap, 1, &[]);
    let mut careful = Instance::new(Kind::Lap, 1, &[]);
    careless.refused(|i| i.set(&[vr::K_YY, vr::A_F], &[1.0, f64::NAN]));
    careless.refused(|i| i.step(0.0, 1e-3).0);
    careless.refused(|i| i.enter_initialization(f64::NAN, None));
    careless.refused(|i| i.enter_initialization(1.0, Some(0.5)));
    for instance in [&mut careless, &mut careful] {
        assert_eq!(instance.enter_initialization(1.0, Some(2.0)), c::OK);
    }
    // a parameter that cannot take effect is found when initialisation ends, and can still be mended there
    assert_eq!(careless.set(&[vr::A_MASS], &[0.0]), c::OK);
    let message = careless.refused(Instance::exit_initialization);
    assert!(message.contains("parameter a.m is 0 kg"), "{message}");
    assert_eq!(careless.set(&[vr::A_MASS], &[2.0]), c::OK);
    careless.refused(|i| i.enter_initialization(0.0, None));
    for instance in [&mut careless, &mut careful] {
        assert_eq!(instance.exit_initialization(), c::OK);
        assert_eq!(instance.set(&[vr::B_F], &[100.0]), c::OK);
    }
    let mut t = 1.0;
    for _ in 0..20 {
        careless.refused(|i| i.step(t, -1e-3).0);
        careless.refused(|i| i.step(t + 1e-3, 1e-3).0);
        careless.refused(|i| i.step(t, 2.0).0);
        careless.refused(|i| i.set(&[vr::A_F, vr::A_Y], &[1.0, 1.0]));
        careless.refused(|i| i.try_get(&[vr::NONE]).err().unwrap_or(c::OK));
        careless.refused(|i| i.restore(ptr::null_mut()));
        careless.refused(|i| i.deserialize(&[0; 100]).err().unwrap_or(c::OK));
        // SAFETY: the instance lives, the function refuses
        careless.refused(|i| unsafe { c::fmi3EnterEventMode(i.handle) });
        assert_eq!(careless.set(&[vr::STEP_SIZE_MAX], &[-1.0]), c::OK);
        let message = careless.refused(|i| i.step(t, 1e-3).0);
        assert!(message.contains("step_size_max is -1 s"), "{message}");
        assert_eq!(careless.set(&[vr::STEP_SIZE_MAX], &[2e-5]), c::OK);
        for instance in [&mut careless, &mut careful] {
            assert_eq!(instance.step(t, 1e-3), (c::OK, t + 1e-3));
        }
        t += 1e-3;
    }
    assert!(careful.get([vr::A_Y]) != [0.0]);
    assert_eq!(careless.state_bytes(), careful.state_bytes());
}

#[test]
fn a_failed_step_ends_the_simulation_but_not_the_values() {
    const ALL: [u32; 5] = [vr::TIME, vr::A_Y, vr::B_Y, vr::B_F, vr::JOINT_F];
    // a softening joint that a load tears, and a load that no number can follow
    for (changes, load) in [(&[("joint.k3_y", -1e12)][..], 1e8), (&[], f64::MAX)] {
        let mut instance = Instance::stepping(Kind::Lap, 1, changes);
        assert_eq!(instance.set(&[vr::B_F], &[100.0]), c::OK);
        assert_eq!(instance.step(0.0, 1e-3), (c::OK, 1e-3));
        let saved = instance.save();
        assert_eq!(instance.set(&[vr::B_F], &[load]), c::OK);
        let before = instance.get(ALL);
        assert_eq!(instance.step(1e-3, 1e-3), (c::ERROR, 1e-3));
        instance.take_log();
        // a smaller load comes too late, but what was reached can be read
        for call in [
            |i: &mut Instance| i.step(1e-3, 1e-3).0,
            |i: &mut Instance| i.set(&[vr::B_F], &[100.0]),
            Instance::terminate,
        ] {
            let message = instance.refused(call);
            assert!(message.contains("in state Terminated"), "{message}");
        }
        let message = instance.refused(|i| i.step(1e-3, 1e-3).0);
        assert!(
            message.contains("only in Step Mode; reset the instance or restore a saved state"),
            "{message}"
        );
        assert_eq!(instance.get(ALL), before);
        // a saved state goes on
        assert_eq!(instance.restore(saved), c::OK);
        assert_eq!(instance.step(1e-3, 1e-3), (c::OK, 2e-3));
        instance.free_state(saved);
        // and a reset starts again
        assert_eq!(instance.set(&[vr::B_F], &[load]), c::OK);
        assert_eq!(instance.step(2e-3, 1e-3), (c::ERROR, 2e-3));
        assert_eq!(instance.reset(), c::OK);
        assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        assert_eq!(instance.exit_initialization(), c::OK);
        assert_eq!(instance.step(0.0, 1e-3), (c::OK, 1e-3));
    }
}

#[test]
fn reset_brings_the_start_values_back() {
    let mut instance = Instance::new(Kind::Lap, 2, &[]);
    let all: Vec<u32> = (0..vr::NONE).collect();
    let start = instance.try_get(&all).unwrap();
    assert_eq!(
        instance.set(&[vr::K_YY, vr::A_Y, vr::A_MASS], &[5e6, 1e-4, 3.0]),
        c::OK
    );
    assert_eq!(instance.enter_initialization(2.0, Some(3.0)), c::OK);
    assert_eq!(instance.set(&[vr::B_M, vr::B_OMEGA], &[1.0, 0.5]), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
    assert_eq!(instance.step(2.0, 1e-3).0, c::OK);
    assert_ne!(instance.try_get(&all).unwrap(), start);
    assert_eq!(instance.reset(), c::OK);
    assert_eq!(instance.try_get(&all).unwrap(), start);
    // the stop time is forgotten, too
    assert_eq!(instance.enter_initialization(10.0, None), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
    assert_eq!(instance.step(10.0, 1e-3).0, c::OK);
}

#[test]
fn the_time_span_is_checked() {
    for (start, stop, expected) in [
        (f64::NAN, None, "startTime is NaN"),
        (f64::INFINITY, None, "startTime is inf"),
        (1.0, Some(0.5), "stopTime is 0.5"),
        (1.0, Some(f64::NAN), "stopTime is NaN"),
        (1.0, Some(f64::INFINITY), "stopTime is inf"),
    ] {
        let mut instance = Instance::new(Kind::Element, 1, &[]);
        let message = instance.refused(|i| i.enter_initialization(start, stop));
        assert!(message.contains(expected), "{message}");
    }
    let mut instance = Instance::new(Kind::Element, 1, &[]);
    assert_eq!(instance.enter_initialization(-1.5, Some(-1.5)), c::OK);
    assert_eq!(instance.get([vr::TIME]), [-1.5]);
}

#[test]
fn null_instances_are_refused() {
    let null = ptr::null_mut();
    // SAFETY: a null instance is what the functions have to catch
    unsafe {
        assert_eq!(
            c::fmi3EnterInitializationMode(null, false, 0.0, 0.0, false, 0.0),
            c::ERROR
        );
        assert_eq!(c::fmi3ExitInitializationMode(null), c::ERROR);
        assert_eq!(c::fmi3Terminate(null), c::ERROR);
        assert_eq!(c::fmi3Reset(null), c::ERROR);
        assert_eq!(
            c::fmi3GetFloat64(null, ptr::null(), 0, ptr::null_mut(), 0),
            c::ERROR
        );
        assert_eq!(c::fmi3SetDebugLogging(null, true, 0, ptr::null()), c::ERROR);
        assert_eq!(c::fmi3EnterEventMode(null), c::ERROR);
        let mut state = ptr::null_mut();
        assert_eq!(c::fmi3GetFMUState(null, &raw mut state), c::ERROR);
        assert_eq!(c::fmi3FreeFMUState(null, &raw mut state), c::ERROR);
        c::fmi3FreeInstance(null);
        // memory that is no instance
        let mut memory = [0_u64; 64];
        let foreign = memory.as_mut_ptr().cast();
        assert_eq!(c::fmi3Reset(foreign), c::ERROR);
        c::fmi3FreeInstance(foreign);
        // a pointer that is not even aligned
        assert_eq!(
            c::fmi3Reset(memory.as_mut_ptr().cast::<u8>().add(1).cast()),
            c::ERROR
        );
    }
}

#[test]
fn instances_work_side_by_side_in_threads() {
    let run = |force: f64| {
        let mut instance = Instance::stepping(Kind::Lap, 2, &[]);
        assert_eq!(instance.set(&[vr::B_F], &[force]), c::OK);
        let mut t = 0.0;
        for _ in 0..500 {
            assert_eq!(instance.step(t, 1e-4).0, c::OK);
            t += 1e-4;
        }
        instance
            .try_get(&[vr::A_Y, vr::B_Y, vr::B_THETA, vr::ENERGY])
            .unwrap()
    };
    let alone: Vec<Vec<f64>> = (0..8).map(|n| run(f64::from(n))).collect();
    let together: Vec<Vec<f64>> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8)
            .map(|n| scope.spawn(move || run(f64::from(n))))
            .collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap())
            .collect()
    });
    assert_eq!(alone, together);
}
