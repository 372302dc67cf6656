//! Every function in every state: the tables of FMI 2.0, 3.2.3 and 4.2.4, and of FMI 3.0, 2.3, 3.2.1 and 4.2.1.

use std::{ffi::c_int, ptr};

use crate::{
    c,
    importer::{
        Folder, Instance, Kind, Make as _, Request,
        State::{self, Continuous, Event, Initialization, Instantiated, SetUp, Step, Terminated},
        start_text, vr,
    },
    raw::{
        BOTH, Fmi2, Fmi3, FmiVersion,
        Interface::{self, CoSimulation, ModelExchange},
        Raw, status_of,
    },
};

/// A function by its names in both versions, none where a version does not have it; a call of it; and the states in which
/// that is allowed, in both versions.
type Row = ([&'static str; 2], fn(Raw) -> c_int, [&'static [State]; 2]);

/// A row a line.
macro_rules! table {
    ($($two:literal, $three:literal => $call:expr, in $allowed:expr;)*) => {
        [$(([$two, $three], $call, $allowed)),*]
    };
}

const ALL: &[State] = State::ALL;
const FROM_INITIALIZATION: &[State] = &[Initialization, Event, Step, Continuous, Terminated];
const EVALUATED: &[State] = &[Initialization, Event, Continuous, Terminated];

fn enter(i: Raw) -> c_int {
    match i.version {
        Fmi2 => i.enter_set_up(),
        Fmi3 => i.enter_initialization(0.0, None),
    }
}

fn save_and_restore(i: Raw) -> c_int {
    let saved = i.save();
    let loaded = i.deserialize(&i.serialize(saved)).unwrap();
    let status = i.restore(loaded);
    i.free_state(saved);
    i.free_state(loaded);
    status
}

/// Calls that both interface types have.
const COMMON: [Row; 12] = table! {
    "fmi2SetupExperiment", "" => |i| i.set_up(0.0, None), in [&[Instantiated, SetUp], &[]];
    "fmi2EnterInitializationMode", "fmi3EnterInitializationMode" => enter, in [&[SetUp], &[Instantiated]];
    "fmi2ExitInitializationMode", "fmi3ExitInitializationMode" => Raw::exit_initialization, in [&[Initialization]; 2];
    "fmi2Terminate", "fmi3Terminate" => Raw::terminate, in [&[Step, Event, Continuous]; 2];
    "fmi2Reset", "fmi3Reset" => Raw::reset, in [ALL; 2];
    "fmi2GetReal", "fmi3GetFloat64" =>
        |i| status_of(i.try_get(&[vr::TIME, vr::A_Y, vr::JOINT_F, vr::K_YY, vr::A_F])), in [FROM_INITIALIZATION, ALL];
    "fmi2SetReal", "fmi3SetFloat64" =>
        |i| i.set(&[vr::A_F], &[1.0]), in [&[Instantiated, SetUp, Initialization, Step, Event, Continuous]; 2];
    "fmi2SetReal", "fmi3SetFloat64" =>
        |i| i.set(&[vr::A_F, vr::K_YY], &[1.0, 3e6]), in [&[Instantiated, SetUp, Initialization, Step, Event]; 2];
    "fmi2SetReal", "fmi3SetFloat64" =>
        |i| i.set(&[vr::A_Y], &[1e-5]),
        in [&[Instantiated, SetUp, Initialization, Continuous], &[Instantiated, Initialization, Event, Continuous]];
    "fmi2GetDirectionalDerivative", "fmi3GetDirectionalDerivative" =>
        |i| status_of(i.directional(&[vr::JOINT_F], &[vr::A_Y], &[1.0])), in [FROM_INITIALIZATION; 2];
    "fmi2SetFMUstate", "fmi3SetFMUState" => save_and_restore, in [ALL; 2];
    "fmi2SetDebugLogging", "fmi3SetDebugLogging" => |i| i.switch_logging(true, &[]), in [ALL; 2];
};

/// Calls of Co-Simulation alone.
const STEPPING: [Row; 5] = table! {
    "fmi2SetRealInputDerivatives", "" =>
        |i| i.set_input_derivatives(&[vr::A_F], &[1], &[2.0]), in [&[Instantiated, SetUp, Initialization, Step], &[]];
    "fmi2GetRealOutputDerivatives", "fmi3GetOutputDerivatives" =>
        |i| status_of(i.output_derivatives(&[vr::A_Y])), in [&[Step, Terminated]; 2];
    "fmi2DoStep", "fmi3DoStep" => |i| i.step(0.0, 1e-3), in [&[Step]; 2];
    "fmi2GetRealStatus", "" =>
        |i| status_of(i.status(c::fmi2GetRealStatus, c::LAST_SUCCESSFUL_TIME, f64::NAN)), in [&[Step, Terminated], &[]];
    "fmi2GetBooleanStatus", "" =>
        |i| status_of(i.status(c::fmi2GetBooleanStatus, c::TERMINATED, 7)), in [&[Step, Terminated], &[]];
};

/// Calls at events; with FMI 3.0 in Co-Simulation, too, if the importer handles events.
const EVENTS: [Row; 2] = table! {
    "fmi2EnterEventMode", "fmi3EnterEventMode" => Raw::enter_event, in [&[Event, Continuous], &[Step, Continuous]];
    "fmi2NewDiscreteStates", "fmi3UpdateDiscreteStates" => Raw::update, in [&[Event]; 2];
};

/// What leads from an event to the next step of Co-Simulation.
const STEP_MODE: [Row; 1] = table! {
    "", "fmi3EnterStepMode" => Raw::enter_step, in [&[], &[Event]];
};

/// Calls of Model Exchange alone.
const EXCHANGE: [Row; 8] = table! {
    "fmi2EnterContinuousTimeMode", "fmi3EnterContinuousTimeMode" => Raw::enter_continuous, in [&[Event]; 2];
    "fmi2CompletedIntegratorStep", "fmi3CompletedIntegratorStep" => Raw::complete_step, in [&[Continuous]; 2];
    "fmi2SetTime", "fmi3SetTime" => |i| i.set_time(0.5), in [&[Continuous]; 2];
    "fmi2SetContinuousStates", "fmi3SetContinuousStates" => |i| i.set_states(&[0.0; 8]), in [&[Continuous]; 2];
    "fmi2GetEventIndicators", "fmi3GetEventIndicators" => |i| status_of(i.try_indicators(0)), in [EVALUATED, ALL];
    "fmi2GetContinuousStates", "fmi3GetContinuousStates" => |i| status_of(i.try_states(8)), in [EVALUATED; 2];
    "fmi2GetDerivatives", "fmi3GetContinuousStateDerivatives" =>
        |i| status_of(i.try_derivatives(8)), in [EVALUATED; 2];
    "fmi2GetNominalsOfContinuousStates", "fmi3GetNominalsOfContinuousStates" =>
        |i| status_of(i.try_nominals(8)), in [ALL, EVALUATED];
};

/// One of the state machines.
#[derive(Clone, Copy)]
struct Machine {
    version: FmiVersion,
    interface: Interface,
    /// Co-Simulation of FMI 3.0: whether the importer handles events.
    event_mode: bool,
}

const MACHINES: [Machine; 4] = [
    Machine::new(Fmi2, CoSimulation),
    Machine::new(Fmi2, ModelExchange),
    Machine::new(Fmi3, CoSimulation),
    Machine::new(Fmi3, ModelExchange),
];

impl Machine {
    const fn new(version: FmiVersion, interface: Interface) -> Self {
        Self {
            version,
            interface,
            event_mode: false,
        }
    }

    fn states(self) -> impl Iterator<Item = State> {
        ALL.iter().copied().filter(move |&state| {
            state.is_of(self.version, self.interface) || self.event_mode && state == Event
        })
    }

    fn instance(self) -> Instance {
        let folder = Folder::with_start(&start_text(Kind::Lap, 2, &[]));
        let request = Request {
            version: self.version,
            interface: self.interface,
            event_mode: self.event_mode,
            ..Request::of(&folder)
        };
        request.instantiate().unwrap()
    }

    fn instance_in(self, state: State) -> Instance {
        let mut instance = self.instance();
        instance.go_to(state);
        if self.event_mode && state == Step {
            c::ok(instance.enter_step());
        }
        instance
    }

    /// Name of the function, if this version has it, and the states in which the call is allowed.
    fn row(self, (names, _, allowed): &Row) -> Option<(&'static str, &'static [State])> {
        let place = usize::from(self.version == Fmi3);
        (!names[place].is_empty()).then_some((names[place], allowed[place]))
    }

    /// Makes each call in each state.
    fn check(self, calls: &[Row]) {
        for row in calls {
            let Some((function, allowed)) = self.row(row) else {
                continue;
            };
            let call = row.1;
            for state in self.states() {
                let mut instance = self.instance_in(state);
                // parameters are tuned at events, if the importer handles them
                let tunes = function == "fmi3SetFloat64" && allowed.contains(&Step);
                let is_at_event_only = tunes && !allowed.contains(&Continuous) && self.event_mode;
                if allowed.contains(&state) && !(is_at_event_only && state == Step) {
                    assert_eq!(call(instance.raw), c::OK, "{function} in {state:?}");
                } else {
                    // the instance stays where it is, so the same call is refused again in the same words
                    let message = instance.refused(call);
                    assert_eq!(instance.refused(call), message);
                    assert!(message.starts_with(&format!("{function}: ")), "{message}");
                    let place = format!("in state {}", state.name());
                    assert!(message.contains(&place), "{message} {place}");
                }
                // every state can be saved and restored
                let bytes = instance.state_bytes();
                let saved = instance.save();
                c::ok(instance.reset());
                c::ok(instance.restore(saved));
                assert_eq!(instance.state_bytes(), bytes);
                instance.free_state(saved);
            }
        }
    }
}

#[test]
fn calls_of_co_simulation() {
    for version in BOTH {
        let machine = Machine::new(version, CoSimulation);
        machine.check(&COMMON);
        machine.check(&STEPPING);
    }
}

#[test]
fn calls_of_co_simulation_with_events() {
    let machine = Machine {
        event_mode: true,
        ..Machine::new(Fmi3, CoSimulation)
    };
    machine.check(&COMMON);
    machine.check(&STEPPING);
    machine.check(&EVENTS);
    machine.check(&STEP_MODE);
}

#[test]
fn calls_of_model_exchange() {
    for version in BOTH {
        let machine = Machine::new(version, ModelExchange);
        machine.check(&COMMON);
        machine.check(&EVENTS);
        machine.check(&EXCHANGE);
    }
}

#[test]
fn each_interface_type_has_its_own_functions() {
    for machine in MACHINES {
        let (calls, own, other) = match machine.interface {
            CoSimulation => (EXCHANGE.as_slice(), "Co-Simulation", "Model Exchange"),
            ModelExchange => (STEPPING.as_slice(), "Model Exchange", "Co-Simulation"),
        };
        // with FMI 2.0 events belong to Model Exchange alone
        let events = match (machine.version, machine.interface) {
            (Fmi2, CoSimulation) => EVENTS.as_slice(),
            (Fmi3, ModelExchange) => &STEP_MODE,
            _ => &[],
        };
        for row in calls.iter().chain(events) {
            let Some((function, _)) = machine.row(row) else {
                continue;
            };
            for state in machine.states() {
                let message = machine.instance_in(state).refused(row.1);
                let expected = format!(
                    "{function}: is not provided by this FMU: it belongs to {other}, the instance is for {own}"
                );
                assert_eq!(message, expected);
            }
        }
    }
}

#[test]
fn a_reset_goes_back_to_before_the_experiment() {
    for machine in MACHINES {
        let fresh = machine.instance().state_bytes();
        for state in machine.states() {
            let mut instance = machine.instance();
            let references = [vr::K_YY, vr::A_Y, vr::B_M];
            c::ok(instance.set(&references, &[5e6, 1e-4, 2.0]));
            instance.go_to(state);
            c::ok(instance.reset());
            assert!(instance.state_bytes() == fresh, "{state:?}");
            if machine.version == Fmi2 {
                let message = instance.refused(Raw::enter_set_up);
                assert_eq!(
                    message,
                    "fmi2EnterInitializationMode: is not allowed in state Instantiated, only in Instantiated after \
                     fmi2SetupExperiment"
                );
            }
        }
    }
}

#[test]
fn reset_brings_the_start_values_back() {
    let instance = Instance::new(Kind::Lap, 2, &[]);
    let all: Vec<u32> = (0..vr::NONE).collect();
    let start = instance.try_get(&all).unwrap();
    c::ok(instance.set(&[vr::K_YY, vr::A_Y, vr::A_MASS], &[5e6, 1e-4, 3.0]));
    c::ok(instance.enter_initialization(2.0, Some(3.0)));
    c::ok(instance.set(&[vr::B_M, vr::B_OMEGA], &[1.0, 0.5]));
    c::ok(instance.exit_initialization());
    c::ok(instance.step(2.0, 1e-3));
    assert_ne!(instance.try_get(&all).unwrap(), start);
    c::ok(instance.reset());
    assert_eq!(instance.try_get(&all).unwrap(), start);
    // the stop time is forgotten, too
    instance.initialize(10.0, None);
    c::ok(instance.step(10.0, 1e-3));
}

#[test]
fn the_time_span_is_checked() {
    for version in BOTH {
        for (start, stop, expected) in [
            (f64::NAN, None, "startTime is NaN"),
            (f64::INFINITY, None, "startTime is inf"),
            (f64::NEG_INFINITY, None, "startTime is -inf"),
            (1.0, Some(0.5), "stopTime is 0.5"),
            (1.0, Some(f64::NAN), "stopTime is NaN"),
            (1.0, Some(f64::INFINITY), "stopTime is inf"),
        ] {
            let mut instance = version.instance(CoSimulation, Kind::Element, 1, &[]);
            instance.refuses(|i| i.enter_initialization(start, stop), expected);
        }
        let instance = version.instance(CoSimulation, Kind::Element, 1, &[]);
        c::ok(instance.enter_initialization(-1.5, Some(-1.5)));
        assert_eq!(instance.get([vr::TIME]), [-1.5]);
    }
}

#[test]
fn the_latest_experiment_counts() {
    let mut instance = Fmi2.instance(CoSimulation, Kind::Lap, 1, &[]);
    c::ok(instance.set_up(5.0, Some(6.0)));
    // nothing of what is refused
    instance.refused(|i| i.set_up(1.0, Some(0.5)));
    c::ok(instance.set_up(1.0, Some(1.5)));
    c::ok(instance.enter_set_up());
    assert_eq!(instance.get([vr::TIME]), [1.0]);
    c::ok(instance.exit_initialization());
    c::ok(instance.step(1.0, 0.5));
    instance.refuses(|i| i.step(1.5, 1e-3), "after stopTime = 1.5 s");
}

#[test]
fn null_foreign_and_freed_instances_are_refused() {
    let mut memory = [0_u64; 64];
    let foreign = memory.as_mut_ptr();
    let odd = foreign.wrapping_byte_add(1);
    for handle in [ptr::null_mut(), foreign.cast(), odd.cast()] {
        for version in BOTH {
            let i = Raw { version, handle };
            let mut state = ptr::null_mut();
            for status in [
                i.enter_initialization(0.0, None),
                i.exit_initialization(),
                i.terminate(),
                i.reset(),
                i.switch_logging(true, &[]),
                status_of(i.try_get(&[])),
                i.set(&[], &[]),
                i.enter_event(),
                i.update(),
                i.save_in(&mut state),
            ] {
                assert_eq!(status, c::ERROR);
            }
            i.free();
        }
        let fmi2 = Raw {
            version: Fmi2,
            handle,
        };
        assert_eq!(fmi2.enter_set_up(), c::ERROR);
        assert_eq!(fmi2.step(0.0, 1.0), c::ERROR);
        let mut state = ptr::null_mut();
        // SAFETY: that is what the functions have to catch
        unsafe {
            assert_eq!(c::fmi2CancelStep(handle), c::ERROR);
            assert_eq!(c::fmi2GetStatus(handle, 0, ptr::null_mut()), c::ERROR);
            assert_eq!(c::fmi2NewDiscreteStates(handle, ptr::null_mut()), c::ERROR);
            assert_eq!(c::fmi2FreeFMUstate(handle, &raw mut state), c::ERROR);
            assert_eq!(c::fmi3FreeFMUState(handle, &raw mut state), c::ERROR);
        }
    }
    assert_eq!(memory, [0; 64]);
}

#[test]
fn no_step_can_be_cancelled() {
    // SAFETY: the instance lives
    let cancel = |i: Raw| unsafe { c::fmi2CancelStep(i.handle) };
    let machine = Machine::new(Fmi2, CoSimulation);
    for state in machine.states() {
        let message = machine.instance_in(state).refused(cancel);
        c::tells(
            &message,
            "",
            "a step is done when fmi2DoStep returns, there is none to cancel",
        );
    }
    let message = Fmi2.continuous(Kind::Lap, 1, &[]).refused(cancel);
    assert!(message.contains("it belongs to Co-Simulation"), "{message}");
}

#[test]
fn what_is_never_pending_has_no_status() {
    type Ask = fn(Raw, c_int) -> c_int;
    // a function, and the one kind of status that it tells, if any
    let functions: [(&str, Option<c_int>, Ask); 5] = [
        ("fmi2GetStatus", None, |i, kind| {
            status_of(i.status(c::fmi2GetStatus, kind, 7))
        }),
        ("fmi2GetIntegerStatus", None, |i, kind| {
            status_of(i.status(c::fmi2GetIntegerStatus, kind, 7))
        }),
        ("fmi2GetStringStatus", None, |i, kind| {
            status_of(i.status(c::fmi2GetStringStatus, kind, ptr::null()))
        }),
        (
            "fmi2GetRealStatus",
            Some(c::LAST_SUCCESSFUL_TIME),
            |i, kind| status_of(i.status(c::fmi2GetRealStatus, kind, 0.0)),
        ),
        ("fmi2GetBooleanStatus", Some(c::TERMINATED), |i, kind| {
            status_of(i.status(c::fmi2GetBooleanStatus, kind, 7))
        }),
    ];
    let kinds = [
        c::DO_STEP_STATUS,
        c::PENDING_STATUS,
        c::LAST_SUCCESSFUL_TIME,
        c::TERMINATED,
        4,
        -1,
    ];
    for state in [Step, Terminated] {
        let mut instance = Machine::new(Fmi2, CoSimulation).instance_in(state);
        for (function, told, ask) in functions {
            for kind in kinds.into_iter().filter(|kind| Some(*kind) != told) {
                assert_eq!(ask(instance.raw, kind), c::DISCARD);
                let message = instance.message(c::DISCARD);
                let expected = format!("{function}: has no status of kind {kind};");
                assert!(message.starts_with(&expected), "{message}");
            }
        }
    }
}
