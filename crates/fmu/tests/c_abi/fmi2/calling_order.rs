//! Every function in every state: the tables of FMI 2.0, 3.2.3 and 4.2.4.

use std::{ffi::c_int, ptr};

use super::{
    c,
    importer::{
        Instance,
        State::{
            self, ContinuousTime, Event, Initialization, Instantiated, SetUp, Step, Terminated,
        },
        status_of,
    },
};
use crate::importer::{Kind, vr};

type Call = fn(&mut Instance) -> c_int;

fn get(i: &mut Instance) -> c_int {
    status_of(i.try_get(&[vr::TIME, vr::A_Y, vr::JOINT_F, vr::K_YY, vr::A_F]))
}

fn save_and_restore(i: &mut Instance) -> c_int {
    let saved = i.save();
    let bytes = i.serialize(saved);
    let loaded = i.deserialize(&bytes).unwrap();
    let status = i.restore(loaded);
    i.free_state(saved);
    i.free_state(loaded);
    status
}

fn switch_logging(i: &mut Instance) -> c_int {
    // SAFETY: the instance lives
    unsafe { c::fmi2SetDebugLogging(i.handle, 1, 0, ptr::null()) }
}

/// Calls that both interface types have, with the states in which they are allowed.
const COMMON: [(&str, Call, &[State]); 12] = [
    (
        "fmi2SetupExperiment",
        |i| i.set_up(0.0, None),
        &[Instantiated, SetUp],
    ),
    (
        "fmi2EnterInitializationMode",
        Instance::enter_initialization,
        &[SetUp],
    ),
    (
        "fmi2ExitInitializationMode",
        Instance::exit_initialization,
        &[Initialization],
    ),
    (
        "fmi2Terminate",
        Instance::terminate,
        &[Step, Event, ContinuousTime],
    ),
    ("fmi2Reset", Instance::reset, &ALL),
    (
        "fmi2GetReal",
        get,
        &[Initialization, Step, Event, ContinuousTime, Terminated],
    ),
    (
        "fmi2SetReal",
        |i| i.set(&[vr::A_F], &[1.0]),
        &[
            Instantiated,
            SetUp,
            Initialization,
            Step,
            Event,
            ContinuousTime,
        ],
    ),
    (
        "fmi2SetReal",
        |i| i.set(&[vr::K_YY], &[3e6]),
        &[Instantiated, SetUp, Initialization, Step, Event],
    ),
    (
        "fmi2SetReal",
        |i| i.set(&[vr::A_Y], &[1e-5]),
        &[Instantiated, SetUp, Initialization, ContinuousTime],
    ),
    (
        "fmi2GetDirectionalDerivative",
        |i| status_of(i.directional(&[vr::JOINT_F], &[vr::A_Y], &[1.0])),
        &[Initialization, Step, Event, ContinuousTime, Terminated],
    ),
    ("fmi2SetFMUstate", save_and_restore, &ALL),
    ("fmi2SetDebugLogging", switch_logging, &ALL),
];

const ALL: [State; 7] = [
    Instantiated,
    SetUp,
    Initialization,
    Step,
    Event,
    ContinuousTime,
    Terminated,
];

/// Calls of Co-Simulation alone.
const CO_SIMULATION: [(&str, Call, &[State]); 5] = [
    (
        "fmi2SetRealInputDerivatives",
        |i| i.set_input_derivatives(&[vr::A_F], &[1], &[2.0]),
        &[Instantiated, SetUp, Initialization, Step],
    ),
    (
        "fmi2GetRealOutputDerivatives",
        |i| status_of(i.output_derivatives(&[vr::A_Y], &[1])),
        &[Step, Terminated],
    ),
    ("fmi2DoStep", |i| i.step(0.0, 1e-3), &[Step]),
    (
        "fmi2GetRealStatus",
        |i| status_of(i.status(c::fmi2GetRealStatus, c::LAST_SUCCESSFUL_TIME, f64::NAN)),
        &[Step, Terminated],
    ),
    (
        "fmi2GetBooleanStatus",
        |i| status_of(i.status(c::fmi2GetBooleanStatus, c::TERMINATED, 7)),
        &[Step, Terminated],
    ),
];

/// Calls of Model Exchange alone.
const MODEL_EXCHANGE: [(&str, Call, &[State]); 10] = [
    (
        "fmi2EnterEventMode",
        Instance::enter_event,
        &[Event, ContinuousTime],
    ),
    (
        "fmi2NewDiscreteStates",
        Instance::new_discrete_states,
        &[Event],
    ),
    (
        "fmi2EnterContinuousTimeMode",
        Instance::enter_continuous_time,
        &[Event],
    ),
    (
        "fmi2CompletedIntegratorStep",
        Instance::complete_step,
        &[ContinuousTime],
    ),
    ("fmi2SetTime", |i| i.set_time(0.5), &[ContinuousTime]),
    (
        "fmi2SetContinuousStates",
        |i| i.set_states(&[0.0; 8]),
        &[ContinuousTime],
    ),
    (
        "fmi2GetEventIndicators",
        |i| status_of(i.read(c::fmi2GetEventIndicators, 0)),
        EVALUATED,
    ),
    (
        "fmi2GetContinuousStates",
        |i| status_of(i.read(c::fmi2GetContinuousStates, 8)),
        EVALUATED,
    ),
    (
        "fmi2GetDerivatives",
        |i| status_of(i.read(c::fmi2GetDerivatives, 8)),
        EVALUATED,
    ),
    (
        "fmi2GetNominalsOfContinuousStates",
        |i| status_of(i.read(c::fmi2GetNominalsOfContinuousStates, 8)),
        &ALL,
    ),
];

const EVALUATED: &[State] = &[Initialization, Event, ContinuousTime, Terminated];

fn check(fmu_type: c_int, states: &[State], calls: &[(&str, Call, &[State])]) {
    for (function, call, allowed) in calls {
        for &state in states {
            let mut instance = Instance::new(fmu_type, Kind::Lap, 2, &[]);
            instance.go_to(state);
            if allowed.contains(&state) {
                assert_eq!(call(&mut instance), c::OK, "{function} in {state:?}");
                continue;
            }
            // the instance stays where it is, so the same call is refused again in the same words
            let message = instance.refused(call);
            assert_eq!(instance.refused(call), message);
            assert!(message.starts_with(&format!("{function}: ")), "{message}");
            let place = format!("in state {}", state.name());
            assert!(message.contains(&place), "{message} {place}");
        }
    }
}

#[test]
fn calls_of_co_simulation() {
    check(c::CO_SIMULATION, &State::CO_SIMULATION, &COMMON);
    check(c::CO_SIMULATION, &State::CO_SIMULATION, &CO_SIMULATION);
}

#[test]
fn calls_of_model_exchange() {
    check(c::MODEL_EXCHANGE, &State::MODEL_EXCHANGE, &COMMON);
    check(c::MODEL_EXCHANGE, &State::MODEL_EXCHANGE, &MODEL_EXCHANGE);
}

#[test]
fn each_interface_type_has_its_own_functions() {
    for (fmu_type, states, calls, own, other) in [
        (
            c::CO_SIMULATION,
            State::CO_SIMULATION.as_slice(),
            MODEL_EXCHANGE.as_slice(),
            "Co-Simulation",
            "Model Exchange",
        ),
        (
            c::MODEL_EXCHANGE,
            &State::MODEL_EXCHANGE,
            &CO_SIMULATION,
            "Model Exchange",
            "Co-Simulation",
        ),
    ] {
        for (function, call, _) in calls {
            for &state in states {
                let mut instance = Instance::new(fmu_type, Kind::Lap, 2, &[]);
                instance.go_to(state);
                let message = instance.refused(call);
                let expected = format!(
                    "{function}: is not provided by this FMU: it belongs to {other}, the instance is for {own}"
                );
                assert_eq!(message, expected);
            }
        }
    }
}

#[test]
fn no_step_can_be_cancelled() {
    for state in State::CO_SIMULATION {
        let mut instance = Instance::new(c::CO_SIMULATION, Kind::Lap, 1, &[]);
        instance.go_to(state);
        let message = instance.refused(Instance::cancel_step);
        assert!(
            message.contains("a step is done when fmi2DoStep returns, there is none to cancel"),
            "{message}"
        );
    }
    let mut instance = Instance::continuous(Kind::Lap, 1, &[]);
    let message = instance.refused(Instance::cancel_step);
    assert!(message.contains("it belongs to Co-Simulation"), "{message}");
}

#[test]
fn what_is_never_pending_has_no_status() {
    for state in [Step, Terminated] {
        let mut instance = Instance::new(c::CO_SIMULATION, Kind::Lap, 1, &[]);
        instance.go_to(state);
        for kind in [
            c::DO_STEP_STATUS,
            c::PENDING_STATUS,
            c::LAST_SUCCESSFUL_TIME,
            c::TERMINATED,
            4,
            -1,
        ] {
            let mut calls: Vec<(&str, Call2<'_>)> = vec![
                (
                    "fmi2GetStatus",
                    Box::new(|i| status_of(i.status(c::fmi2GetStatus, kind, 7))),
                ),
                (
                    "fmi2GetIntegerStatus",
                    Box::new(|i| status_of(i.status(c::fmi2GetIntegerStatus, kind, 7))),
                ),
                (
                    "fmi2GetStringStatus",
                    Box::new(|i| status_of(i.status(c::fmi2GetStringStatus, kind, ptr::null()))),
                ),
            ];
            if kind != c::LAST_SUCCESSFUL_TIME {
                calls.push((
                    "fmi2GetRealStatus",
                    Box::new(|i| status_of(i.status(c::fmi2GetRealStatus, kind, 0.0))),
                ));
            }
            if kind != c::TERMINATED {
                calls.push((
                    "fmi2GetBooleanStatus",
                    Box::new(|i| status_of(i.status(c::fmi2GetBooleanStatus, kind, 7))),
                ));
            }
            for (function, call) in calls {
                assert_eq!(call(&mut instance), c::DISCARD);
                let message = instance.message(c::DISCARD);
                assert!(
                    message.starts_with(&format!("{function}: has no status of kind {kind};")),
                    "{message}"
                );
            }
        }
    }
}

type Call2<'a> = Box<dyn Fn(&mut Instance) -> c_int + 'a>;

#[test]
fn a_reset_goes_back_to_before_the_experiment() {
    for (fmu_type, states) in [
        (c::CO_SIMULATION, State::CO_SIMULATION.as_slice()),
        (c::MODEL_EXCHANGE, &State::MODEL_EXCHANGE),
    ] {
        let fresh = Instance::new(fmu_type, Kind::Lap, 2, &[]).state_bytes();
        for &state in states {
            let mut instance = Instance::new(fmu_type, Kind::Lap, 2, &[]);
            assert_eq!(
                instance.set(&[vr::K_YY, vr::A_Y, vr::B_M], &[5e6, 1e-4, 2.0]),
                c::OK
            );
            instance.go_to(state);
            assert_eq!(instance.reset(), c::OK);
            assert!(instance.state_bytes() == fresh, "{state:?}");
            let message = instance.refused(Instance::enter_initialization);
            assert_eq!(
                message,
                "fmi2EnterInitializationMode: is not allowed in state Instantiated, only in Instantiated after \
                 fmi2SetupExperiment"
            );
        }
    }
}

#[test]
fn the_latest_experiment_counts() {
    let mut instance = Instance::new(c::CO_SIMULATION, Kind::Lap, 1, &[]);
    assert_eq!(instance.set_up(5.0, Some(6.0)), c::OK);
    for (start, stop, expected) in [
        (f64::NAN, None, "startTime is NaN"),
        (f64::NEG_INFINITY, None, "startTime is -inf"),
        (1.0, Some(0.5), "stopTime is 0.5"),
        (1.0, Some(f64::NAN), "stopTime is NaN"),
        (1.0, Some(f64::INFINITY), "stopTime is inf"),
    ] {
        let message = instance.refused(|i| i.set_up(start, stop));
        assert!(message.contains(expected), "{message}");
    }
    assert_eq!(instance.set_up(1.0, Some(1.5)), c::OK);
    assert_eq!(instance.enter_initialization(), c::OK);
    assert_eq!(instance.get([vr::TIME]), [1.0]);
    assert_eq!(instance.exit_initialization(), c::OK);
    assert_eq!(instance.step(1.0, 0.5), c::OK);
    let message = instance.refused(|i| i.step(1.5, 1e-3));
    assert!(message.contains("after stopTime = 1.5 s"), "{message}");
}

#[test]
fn null_foreign_and_freed_instances_are_refused() {
    let mut memory = [0_u64; 64];
    let foreign = memory.as_mut_ptr();
    // SAFETY: that is what the functions have to catch
    unsafe {
        for instance in [
            ptr::null_mut(),
            foreign.cast(),
            foreign.cast::<u8>().add(1).cast(),
        ] {
            assert_eq!(
                c::fmi2SetupExperiment(instance, 0, 0.0, 0.0, 0, 0.0),
                c::ERROR
            );
            assert_eq!(c::fmi2EnterInitializationMode(instance), c::ERROR);
            assert_eq!(c::fmi2ExitInitializationMode(instance), c::ERROR);
            assert_eq!(c::fmi2Terminate(instance), c::ERROR);
            assert_eq!(c::fmi2Reset(instance), c::ERROR);
            assert_eq!(
                c::fmi2SetDebugLogging(instance, 1, 0, ptr::null()),
                c::ERROR
            );
            assert_eq!(
                c::fmi2GetReal(instance, ptr::null(), 0, ptr::null_mut()),
                c::ERROR
            );
            assert_eq!(
                c::fmi2SetReal(instance, ptr::null(), 0, ptr::null()),
                c::ERROR
            );
            assert_eq!(c::fmi2DoStep(instance, 0.0, 1.0, 0), c::ERROR);
            assert_eq!(c::fmi2CancelStep(instance), c::ERROR);
            assert_eq!(c::fmi2GetStatus(instance, 0, ptr::null_mut()), c::ERROR);
            assert_eq!(c::fmi2EnterEventMode(instance), c::ERROR);
            assert_eq!(
                c::fmi2NewDiscreteStates(instance, ptr::null_mut()),
                c::ERROR
            );
            let mut state = ptr::null_mut();
            assert_eq!(c::fmi2GetFMUstate(instance, &raw mut state), c::ERROR);
            assert_eq!(c::fmi2FreeFMUstate(instance, &raw mut state), c::ERROR);
            c::fmi2FreeInstance(instance);
        }
    }
    assert_eq!(memory, [0; 64]);
}
