//! Event Mode in Co-Simulation: where it lies among the states, and what may be set where.

use std::ptr;

use crate::{
    c,
    importer::{Folder, Instance, Kind, Request, start_text, vr},
};

/// Instance for Co-Simulation whose importer handles events, in state Instantiated.
fn handling_events(kind: Kind, changes: &[(&str, f64)]) -> Instance {
    let folder = Folder::with_start(&start_text(kind, 1, changes));
    let request = Request {
        resources: folder.0.to_str(),
        event_mode: true,
        ..Request::default()
    };
    request.instantiate().unwrap()
}

fn enter_event(instance: &mut Instance) -> i32 {
    // SAFETY: the instance lives
    unsafe { c::fmi3EnterEventMode(instance.handle) }
}

fn enter_step(instance: &mut Instance) -> i32 {
    // SAFETY: the instance lives
    unsafe { c::fmi3EnterStepMode(instance.handle) }
}

/// Updates discrete states: there are none, so nothing may be said to have changed.
fn update(instance: &mut Instance) -> i32 {
    let mut flags = [true; 5];
    let [need, terminate, nominals, states, next] = flags.each_mut().map(ptr::from_mut);
    let mut time = f64::NAN;
    // SAFETY: the instance lives, the pointers are to locals
    let status = unsafe {
        c::fmi3UpdateDiscreteStates(
            instance.handle,
            need,
            terminate,
            nominals,
            states,
            next,
            &raw mut time,
        )
    };
    if status == c::OK {
        assert_eq!(flags, [false; 5]);
    }
    status
}

#[test]
fn calls_are_allowed_in_the_states_of_the_standard_only() {
    #[derive(Clone, Copy, Debug, PartialEq)]
    enum State {
        Instantiated,
        Initialization,
        Event,
        Step,
        Terminated,
    }
    use State::{Event, Initialization, Instantiated, Step, Terminated};
    const ALL: [State; 5] = [Instantiated, Initialization, Event, Step, Terminated];
    let instance_in = |state: State| {
        let mut instance = handling_events(Kind::Lap, &[]);
        if state != Instantiated {
            assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        }
        if matches!(state, Event | Step | Terminated) {
            assert_eq!(instance.exit_initialization(), c::OK);
        }
        if state == Step {
            assert_eq!(enter_step(&mut instance), c::OK);
        }
        if state == Terminated {
            assert_eq!(instance.terminate(), c::OK);
        }
        instance.take_log();
        instance
    };
    type Call = fn(&mut Instance) -> i32;
    let calls: [(&str, Call, &[State]); 12] = [
        (
            "fmi3EnterInitializationMode",
            |i| i.enter_initialization(0.0, None),
            &[Instantiated],
        ),
        (
            "fmi3ExitInitializationMode",
            Instance::exit_initialization,
            &[Initialization],
        ),
        ("fmi3EnterEventMode", enter_event, &[Step]),
        ("fmi3UpdateDiscreteStates", update, &[Event]),
        ("fmi3EnterStepMode", enter_step, &[Event]),
        ("fmi3DoStep", |i| i.step(0.0, 1e-3).0, &[Step]),
        ("fmi3Terminate", Instance::terminate, &[Event, Step]),
        (
            "fmi3SetFloat64",
            |i| i.set(&[vr::A_F], &[1.0]),
            &[Instantiated, Initialization, Event, Step],
        ),
        (
            "fmi3SetFloat64",
            |i| i.set(&[vr::K_YY], &[3e6]),
            &[Instantiated, Initialization, Event],
        ),
        (
            "fmi3SetFloat64",
            |i| i.set(&[vr::A_Y], &[1e-5]),
            &[Instantiated, Initialization, Event],
        ),
        (
            "fmi3GetOutputDerivatives",
            |i| i.output_derivatives(&[vr::A_Y]).err().unwrap_or(c::OK),
            &[Step, Terminated],
        ),
        (
            "fmi3GetDirectionalDerivative",
            |i| {
                let result = i.directional(&[vr::JOINT_F], &[vr::A_Y], &[1.0]);
                result.err().unwrap_or(c::OK)
            },
            &[Initialization, Event, Step, Terminated],
        ),
    ];
    for (function, call, allowed) in calls {
        for state in ALL {
            let mut instance = instance_in(state);
            if allowed.contains(&state) {
                assert_eq!(call(&mut instance), c::OK, "{function} in {state:?}");
            } else {
                let message = instance.refused(call);
                let name = match state {
                    Instantiated => "Instantiated",
                    Initialization => "Initialization Mode",
                    Event => "Event Mode",
                    Step => "Step Mode",
                    Terminated => "Terminated",
                };
                assert!(message.starts_with(&format!("{function}: ")), "{message}");
                assert!(message.contains(&format!("in state {name}")), "{message}");
            }
            // every state can be saved and restored
            let bytes = instance.state_bytes();
            let saved = instance.save();
            assert_eq!(instance.reset(), c::OK);
            assert_eq!(instance.restore(saved), c::OK);
            assert_eq!(instance.state_bytes(), bytes);
            instance.free_state(saved);
        }
    }
}

#[test]
fn an_importer_that_does_not_handle_events_has_no_event_mode() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    for call in [enter_event, enter_step, update] {
        let message = instance.refused(call);
        assert!(
            message.contains("the instance was made with eventModeUsed = fmi3False"),
            "{message}"
        );
    }
    // it tunes parameters between steps
    assert_eq!(instance.set(&[vr::K_YY], &[3e6]), c::OK);
}

#[test]
fn parameters_are_tuned_at_events() {
    let mut instance = handling_events(Kind::Lap, &[]);
    assert_eq!(instance.enter_initialization(0.0, None), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
    assert_eq!(update(&mut instance), c::OK);
    assert_eq!(enter_step(&mut instance), c::OK);
    let message = instance.refused(|i| i.set(&[vr::A_MASS], &[3.0]));
    assert!(message.contains("enter Event Mode first"), "{message}");
    assert_eq!(enter_event(&mut instance), c::OK);
    // checked when they take effect; until then they can be mended
    assert_eq!(instance.set(&[vr::A_MASS], &[-3.0]), c::OK);
    let message = instance.refused(enter_step);
    assert!(
        message.starts_with("fmi3EnterStepMode: ") && message.contains("parameter a.m is -3 kg"),
        "{message}"
    );
    assert_eq!(instance.set(&[vr::A_MASS], &[3.0]), c::OK);
    assert_eq!(enter_step(&mut instance), c::OK);
    assert_eq!(enter_event(&mut instance), c::OK);
    assert_eq!(instance.set(&[vr::B_C_Y], &[-0.5]), c::OK);
    assert_eq!(enter_step(&mut instance), c::WARNING);
    assert_eq!(instance.step(0.0, 1e-3), (c::OK, 1e-3));
}

#[test]
fn events_change_nothing_by_themselves() {
    // the same loads and parameters, set at events or between steps: the same numbers to the last bit
    let run = |events: bool| {
        let mut instance = if events {
            handling_events(Kind::Lap, &[("joint.k3_y", 1e12)])
        } else {
            Instance::new(Kind::Lap, 1, &[("joint.k3_y", 1e12)])
        };
        assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        assert_eq!(instance.exit_initialization(), c::OK);
        let mut found = Vec::new();
        for n in 0..50 {
            if events {
                if n > 0 {
                    assert_eq!(enter_event(&mut instance), c::OK);
                }
                assert_eq!(update(&mut instance), c::OK);
            }
            let load = 100.0 * f64::from(n).sin();
            let stiffness = 4e6 + 1e3 * f64::from(n);
            assert_eq!(
                instance.set(&[vr::A_F, vr::K_YY], &[load, stiffness]),
                c::OK
            );
            if events {
                assert_eq!(enter_step(&mut instance), c::OK);
            }
            let t = 1e-3 * f64::from(n);
            assert_eq!(instance.step(t, 1e-3).0, c::OK);
            found.push(
                instance
                    .get([vr::A_Y, vr::B_V, vr::JOINT_F])
                    .map(f64::to_bits),
            );
        }
        found
    };
    assert_eq!(run(true), run(false));
}
