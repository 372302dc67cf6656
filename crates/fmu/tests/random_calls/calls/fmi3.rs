//! The functions of FMI 3.0, each with the drawing of its arguments.

use std::{
    ffi::{CStr, c_void},
    ptr,
};

use super::{
    arrays::Arguments,
    choices::Choices,
    fmi3_abi as abi,
    host::{self, DISCARD, ERROR, Host, MODELS, OK, TOKEN},
    turn::{Function, Interface, Mode, Outcome, Rule, Subject, Told, Turn, Version},
};

use Mode::{ContinuousTime, Event, Initialization, Instantiated, Step, StepEvent, Terminated};

/// Modes in which a simulation is going on.
const RUNNING: &[Mode] = &[Step, StepEvent, Event, ContinuousTime];

macro_rules! table {
    ($($name:literal $rule:expr => $call:expr;)*) => {
        [$(Function { name: $name, rule: $rule, call: $call }),*]
    };
}

/// Getters and setters of a type that no variable has.
macro_rules! typed {
    ($function:ident, $zero:expr) => {
        |turn| {
            let instance = turn.instance();
            let references = turn.references(&[0, 1, 9, 13, 17]);
            let count = references.len();
            let references = turn.a.array(references);
            let values = turn.a.array(vec![$zero; count]);
            // SAFETY: the arrays have the lengths that are told, or lengths that no array has
            unsafe {
                abi::$function(
                    instance,
                    references.pointer(),
                    references.count(),
                    values.pointer(),
                    values.count(),
                )
            }
            .into()
        }
    };
}

/// Functions of clocks: value references and one or two arrays.
macro_rules! clocked {
    ($function:ident $(, $zero:expr)*) => {
        |turn| {
            let instance = turn.instance();
            let references = turn.references(&[0, 1, 9, 13, 17]);
            let count = references.len();
            let references = turn.a.array(references);
            // SAFETY: the arrays have the lengths that are told, or lengths that no array has
            unsafe {
                abi::$function(
                    instance,
                    references.pointer(),
                    references.count(),
                    $(turn.a.array(vec![$zero; count]).pointer()),*
                )
            }
            .into()
        }
    };
}

/// Functions of the instance alone; the mode after success.
macro_rules! plain {
    ($function:ident $(, $after:expr)?) => {
        |turn| {
            let instance = turn.instance();
            // SAFETY: the handle is the instance's, or refused
            let status = unsafe { abi::$function(instance) };
            $(if status < ERROR {
                let after: fn(&Subject) -> Mode = $after;
                turn.subject.mode = Some(after(turn.subject));
            })?
            status.into()
        }
    };
}

/// Reads numbers into an array with one element for each continuous state.
macro_rules! state_numbers {
    ($function:ident) => {
        |turn| {
            let instance = turn.instance();
            let count = turn.subject.model().states();
            let values = turn.a.array(vec![0.0; count]);
            // SAFETY: the array has the length that is told, or one that no array has
            let status = unsafe { abi::$function(instance, values.pointer(), values.count()) };
            Outcome {
                status: Some(status),
                values: values.content().to_vec(),
            }
        }
    };
}

/// All functions of the header but those that instantiate and free, which come by themselves.
pub(crate) static FUNCTIONS: [Function; 72] = table! {
    "fmi3GetVersion" Rule::Free => get_version;
    "fmi3SetDebugLogging" Rule::Always => set_debug_logging;
    "fmi3EnterInitializationMode" Rule::Exactly(&[Instantiated]) => enter_initialization;
    "fmi3ExitInitializationMode" Rule::Only(&[Initialization]) =>
        plain!(fmi3ExitInitializationMode, |subject| match (subject.interface, subject.event_mode) {
            (Interface::ModelExchange, _) => Event,
            (Interface::CoSimulation, true) => StepEvent,
            (Interface::CoSimulation, false) => Step,
        });
    "fmi3EnterEventMode" Rule::Only(&[Step, ContinuousTime]) =>
        plain!(fmi3EnterEventMode, |subject| match subject.interface {
            Interface::ModelExchange => Event,
            Interface::CoSimulation => StepEvent,
        });
    "fmi3Terminate" Rule::Exactly(RUNNING) => plain!(fmi3Terminate, |_| Terminated);
    "fmi3Reset" Rule::Always => reset;
    "fmi3GetFloat32" Rule::Free => typed!(fmi3GetFloat32, 0.0);
    "fmi3GetFloat64" Rule::Free => get_float64;
    "fmi3GetInt8" Rule::Free => typed!(fmi3GetInt8, 0);
    "fmi3GetUInt8" Rule::Free => typed!(fmi3GetUInt8, 0);
    "fmi3GetInt16" Rule::Free => typed!(fmi3GetInt16, 0);
    "fmi3GetUInt16" Rule::Free => typed!(fmi3GetUInt16, 0);
    "fmi3GetInt32" Rule::Free => typed!(fmi3GetInt32, 0);
    "fmi3GetUInt32" Rule::Free => typed!(fmi3GetUInt32, 0);
    "fmi3GetInt64" Rule::Free => typed!(fmi3GetInt64, 0);
    "fmi3GetUInt64" Rule::Free => typed!(fmi3GetUInt64, 0);
    "fmi3GetBoolean" Rule::Free => typed!(fmi3GetBoolean, 0);
    "fmi3GetString" Rule::Free => typed!(fmi3GetString, ptr::null());
    "fmi3GetBinary" Rule::Free => get_binary;
    "fmi3GetClock" Rule::Free => clocked!(fmi3GetClock, 0);
    "fmi3SetFloat32" Rule::Free => typed!(fmi3SetFloat32, 0.0);
    "fmi3SetFloat64" Rule::Exactly(&[Instantiated, Initialization, Step, StepEvent, Event, ContinuousTime]) => set_float64;
    "fmi3SetInt8" Rule::Free => typed!(fmi3SetInt8, 0);
    "fmi3SetUInt8" Rule::Free => typed!(fmi3SetUInt8, 0);
    "fmi3SetInt16" Rule::Free => typed!(fmi3SetInt16, 0);
    "fmi3SetUInt16" Rule::Free => typed!(fmi3SetUInt16, 0);
    "fmi3SetInt32" Rule::Free => typed!(fmi3SetInt32, 0);
    "fmi3SetUInt32" Rule::Free => typed!(fmi3SetUInt32, 0);
    "fmi3SetInt64" Rule::Free => typed!(fmi3SetInt64, 0);
    "fmi3SetUInt64" Rule::Free => typed!(fmi3SetUInt64, 0);
    "fmi3SetBoolean" Rule::Free => typed!(fmi3SetBoolean, 0);
    "fmi3SetString" Rule::Free => typed!(fmi3SetString, ptr::null());
    "fmi3SetBinary" Rule::Free => set_binary;
    "fmi3SetClock" Rule::Free => clocked!(fmi3SetClock, 0);
    "fmi3GetNumberOfVariableDependencies" Rule::Free => number_of_dependencies;
    "fmi3GetVariableDependencies" Rule::Free => dependencies;
    "fmi3GetFMUState" Rule::Always => get_state;
    "fmi3SetFMUState" Rule::Always => set_state;
    "fmi3FreeFMUState" Rule::Always => free_one_state;
    "fmi3SerializedFMUStateSize" Rule::Always => serialized_size;
    "fmi3SerializeFMUState" Rule::Always => serialize;
    "fmi3DeserializeFMUState" Rule::Always => deserialize;
    "fmi3GetDirectionalDerivative" Rule::Free => |turn| derivative(turn, abi::fmi3GetDirectionalDerivative, false);
    "fmi3GetAdjointDerivative" Rule::Free => |turn| derivative(turn, abi::fmi3GetAdjointDerivative, true);
    "fmi3EnterConfigurationMode" Rule::Only(&[]) => plain!(fmi3EnterConfigurationMode);
    "fmi3ExitConfigurationMode" Rule::Only(&[]) => plain!(fmi3ExitConfigurationMode);
    "fmi3GetIntervalDecimal" Rule::Free => clocked!(fmi3GetIntervalDecimal, 0.0, 0);
    "fmi3GetIntervalFraction" Rule::Free => clocked!(fmi3GetIntervalFraction, 0, 0, 0);
    "fmi3GetShiftDecimal" Rule::Free => clocked!(fmi3GetShiftDecimal, 0.0);
    "fmi3GetShiftFraction" Rule::Free => clocked!(fmi3GetShiftFraction, 0, 0);
    "fmi3SetIntervalDecimal" Rule::Free => clocked!(fmi3SetIntervalDecimal, 0.0);
    "fmi3SetIntervalFraction" Rule::Free => clocked!(fmi3SetIntervalFraction, 0, 0);
    "fmi3SetShiftDecimal" Rule::Free => clocked!(fmi3SetShiftDecimal, 0.0);
    "fmi3SetShiftFraction" Rule::Free => clocked!(fmi3SetShiftFraction, 0, 0);
    "fmi3EvaluateDiscreteStates" Rule::Free => plain!(fmi3EvaluateDiscreteStates);
    "fmi3UpdateDiscreteStates" Rule::Only(&[Event, StepEvent]) => update_discrete_states;
    "fmi3EnterContinuousTimeMode" Rule::Only(&[Event]) =>
        plain!(fmi3EnterContinuousTimeMode, |_| ContinuousTime);
    "fmi3CompletedIntegratorStep" Rule::Only(&[ContinuousTime]) => completed_integrator_step;
    "fmi3SetTime" Rule::Only(&[Event, ContinuousTime]) => set_time;
    "fmi3SetContinuousStates" Rule::Only(&[ContinuousTime, Event]) => set_continuous_states;
    "fmi3GetContinuousStateDerivatives" Rule::Free => state_numbers!(fmi3GetContinuousStateDerivatives);
    "fmi3GetEventIndicators" Rule::Free => event_indicators;
    "fmi3GetContinuousStates" Rule::Free => state_numbers!(fmi3GetContinuousStates);
    "fmi3GetNominalsOfContinuousStates" Rule::Free => state_numbers!(fmi3GetNominalsOfContinuousStates);
    "fmi3GetNumberOfEventIndicators" Rule::Free => |turn| number_of(turn, abi::fmi3GetNumberOfEventIndicators);
    "fmi3GetNumberOfContinuousStates" Rule::Free => |turn| number_of(turn, abi::fmi3GetNumberOfContinuousStates);
    "fmi3EnterStepMode" Rule::Only(&[StepEvent]) => plain!(fmi3EnterStepMode, |_| Step);
    "fmi3GetOutputDerivatives" Rule::Free => output_derivatives;
    "fmi3DoStep" Rule::Only(&[Step]) => do_step;
    "fmi3ActivateModelPartition" Rule::Only(&[]) => activate;
    "fmi3InstantiateScheduledExecution" Rule::Only(&[]) => scheduled_execution;
};

/// What makes sense next.
pub(crate) fn sensible(mode: Option<Mode>) -> &'static [&'static str] {
    match mode {
        Some(Instantiated) => &["fmi3EnterInitializationMode", "fmi3SetFloat64"],
        Some(Initialization) => &["fmi3ExitInitializationMode", "fmi3SetFloat64"],
        Some(Step) => &[
            "fmi3DoStep",
            "fmi3DoStep",
            "fmi3SetFloat64",
            "fmi3GetFloat64",
            "fmi3GetDirectionalDerivative",
        ],
        Some(StepEvent) => &[
            "fmi3UpdateDiscreteStates",
            "fmi3EnterStepMode",
            "fmi3SetFloat64",
        ],
        Some(Event) => &[
            "fmi3UpdateDiscreteStates",
            "fmi3EnterContinuousTimeMode",
            "fmi3SetFloat64",
        ],
        Some(ContinuousTime) => &[
            "fmi3SetTime",
            "fmi3SetContinuousStates",
            "fmi3GetContinuousStateDerivatives",
            "fmi3CompletedIntegratorStep",
        ],
        _ => &["fmi3Reset", "fmi3SetFMUState", "fmi3GetFloat64"],
    }
}

/// A new instance, or none where the arguments are wrong.
pub(crate) fn instantiate(choices: &mut Choices<'_>) -> (&'static str, Option<Subject>) {
    let mut a = Arguments::new(choices);
    let model = a.choices.below(MODELS.len());
    let exchange = a.choices.one_in(2);
    let mut host = Box::<Host>::default();
    let environment = (&raw mut *host).cast::<c_void>();
    let logs = !a.unusual(4);
    let log = logs.then_some(host::log_fmi3 as abi::LogMessage);
    let name = a.text(c"joint");
    let token = a.text(TOKEN);
    let resources = a.text(host::resources(model));
    let (visible, logging) = (a.flag(), a.flag());
    let (event_mode, early_return) = (a.unusual(2), a.unusual(2));
    let (interface, handle) = if exchange {
        // SAFETY: the strings are terminated or null, the host outlives the instance
        let handle = unsafe {
            abi::fmi3InstantiateModelExchange(
                name,
                token,
                resources,
                visible,
                logging,
                environment,
                log,
            )
        };
        (Interface::ModelExchange, handle)
    } else {
        let update = a.choices.one_in(2);
        let mut required = Vec::new();
        if update && a.choices.one_in(2) {
            // what the callback sets and reads
            host.references = (MODELS[model].inputs(), MODELS[model].outputs());
            required.extend(host.references.0);
            required.extend(host.references.1);
        }
        if a.wrong(8) {
            required.push(a.choices.below(64) as u32);
        }
        let required = a.array(required);
        let update = update.then_some(host::update_fmi3 as abi::IntermediateUpdate);
        // SAFETY: as above; the array has the length that is told, or one that no array has
        let handle = unsafe {
            abi::fmi3InstantiateCoSimulation(
                name,
                token,
                resources,
                visible,
                logging,
                u8::from(event_mode),
                u8::from(early_return),
                required.pointer(),
                required.count(),
                environment,
                log,
                update,
            )
        };
        (Interface::CoSimulation, handle)
    };
    let function = if exchange {
        "fmi3InstantiateModelExchange"
    } else {
        "fmi3InstantiateCoSimulation"
    };
    assert_eq!(host.faults, [""; 0], "{function}");
    if handle.is_null() {
        assert!(!a.right || event_mode, "{function}: {:?}", host.messages);
        let errors = host.messages.iter().filter(|(status, _)| *status >= ERROR);
        assert_eq!(
            errors.count(),
            usize::from(logs),
            "{function}: {:?}",
            host.messages
        );
        return (function, None);
    }
    host.instance = Some(handle);
    let subject = Subject {
        version: Version::Fmi3,
        interface,
        model,
        handle,
        host,
        logs,
        told: Told::from_the_start(logging != 0),
        event_mode: !exchange && event_mode,
        mode: Some(Instantiated),
        time_s: 0.0,
    };
    (function, Some(subject))
}

/// Frees an instance.
pub(crate) fn free(instance: *mut c_void) {
    // SAFETY: the instance lives and is not used again
    unsafe { abi::fmi3FreeInstance(instance) };
}

/// Frees a state.
pub(crate) fn free_state(instance: *mut c_void, mut state: *mut c_void) {
    // SAFETY: instance and state live; the state is not used again
    let status = unsafe { abi::fmi3FreeFMUState(instance, &raw mut state) };
    assert_eq!((status, state), (OK, ptr::null_mut()));
}

/// All that the instance remembers, serialised.
pub(crate) fn state_bytes(instance: *mut c_void) -> Vec<u8> {
    let (mut state, mut size) = (ptr::null_mut(), 0);
    // SAFETY: the instance lives, pointers are to locals and to a vector of the size that is told
    unsafe {
        assert_eq!(abi::fmi3GetFMUState(instance, &raw mut state), OK);
        assert_eq!(
            abi::fmi3SerializedFMUStateSize(instance, state, &raw mut size),
            OK
        );
        let mut bytes = vec![0_u8; size];
        assert_eq!(
            abi::fmi3SerializeFMUState(instance, state, bytes.as_mut_ptr(), size),
            OK
        );
        free_state(instance, state);
        bytes
    }
}

/// Time, and the displacements and velocities of all models here.
pub(crate) fn values(subject: &Subject) -> Vec<f64> {
    let references = [0_u32, 1, 3, 5, 7];
    let mut values = vec![f64::NAN; references.len()];
    // SAFETY: the instance lives, the arrays have the lengths that are told
    let status = unsafe {
        abi::fmi3GetFloat64(
            subject.handle,
            references.as_ptr(),
            references.len(),
            values.as_mut_ptr(),
            values.len(),
        )
    };
    assert_eq!(status, OK, "time, displacements and velocities can be read");
    values
}

fn get_version(_: &mut Turn<'_, '_>) -> Outcome {
    // SAFETY: returns a terminated string
    let version = unsafe { CStr::from_ptr(abi::fmi3GetVersion()) };
    assert_eq!(version, c"3.0");
    Outcome::NONE
}

fn set_debug_logging(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let drawn = turn.categories();
    let names: Vec<_> = drawn
        .iter()
        .map(|category| turn.a.text(category.name()))
        .collect();
    let names = turn.a.array(names);
    let on = turn.a.flag();
    // SAFETY: the array has the length that is told, or one that no array has; strings are terminated or null
    let status = unsafe { abi::fmi3SetDebugLogging(instance, on, names.count(), names.pointer()) };
    if status == OK && turn.reached {
        // of an array that is told too short, the rest does not count
        let told = &drawn[..names.count()];
        turn.subject.switch_logging(told, on != 0);
    }
    status.into()
}

fn enter_initialization(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let (tolerance_defined, stop_defined) = (turn.a.flag(), turn.a.flag());
    let tolerance = turn.a.choices.any_number();
    let start = turn.a.number();
    let stop = if turn.a.wrong(4) {
        turn.a.choices.any_number()
    } else {
        start + 1.0
    };
    // SAFETY: the handle is the instance's, or refused
    let status = unsafe {
        abi::fmi3EnterInitializationMode(
            instance,
            tolerance_defined,
            tolerance,
            start,
            stop_defined,
            stop,
        )
    };
    if status < ERROR {
        turn.subject.mode = Some(Initialization);
        turn.subject.time_s = start;
    }
    status.into()
}

fn reset(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    // SAFETY: the handle is the instance's, or refused
    let status = unsafe { abi::fmi3Reset(instance) };
    if status < ERROR {
        turn.subject.mode = Some(Instantiated);
        turn.subject.time_s = 0.0;
    }
    status.into()
}

fn get_float64(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let pool: Vec<u32> = (0..45).collect();
    let references = turn.references(&pool);
    let values = turn.a.array(vec![0.0; references.len()]);
    let references = turn.a.array(references);
    // SAFETY: the arrays have the lengths that are told, or lengths that no array has
    let status = unsafe {
        abi::fmi3GetFloat64(
            instance,
            references.pointer(),
            references.count(),
            values.pointer(),
            values.count(),
        )
    };
    Outcome {
        status: Some(status),
        values: values.content().to_vec(),
    }
}

fn set_float64(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let model = turn.subject.model();
    let mut references = turn.references(model.inputs());
    if references.is_empty() {
        // an empty list may be accepted in any mode
        references.push(model.inputs()[0]);
    }
    if turn.a.wild && turn.a.choices.one_in(4) {
        // a parameter or a start value
        turn.a.right = false;
        references.push(turn.a.choices.below(45) as u32);
    }
    let values: Vec<f64> = references.iter().map(|_| turn.a.number()).collect();
    let references = turn.a.array(references);
    let values = turn.a.array(values);
    // SAFETY: the arrays have the lengths that are told, or lengths that no array has
    unsafe {
        abi::fmi3SetFloat64(
            instance,
            references.pointer(),
            references.count(),
            values.pointer(),
            values.count(),
        )
    }
    .into()
}

fn get_binary(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let references = turn.references(&[0, 1, 9]);
    let count = references.len();
    let references = turn.a.array(references);
    let sizes = turn.a.array(vec![0_usize; count]);
    let values = turn.a.array(vec![ptr::null::<u8>(); count]);
    // SAFETY: the arrays have the lengths that are told, or lengths that no array has
    unsafe {
        abi::fmi3GetBinary(
            instance,
            references.pointer(),
            references.count(),
            sizes.pointer(),
            values.pointer(),
            values.count(),
        )
    }
    .into()
}

fn set_binary(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let references = turn.references(&[0, 1, 9]);
    let count = references.len();
    let references = turn.a.array(references);
    let sizes = turn.a.array(vec![0_usize; count]);
    let values = turn.a.array(vec![ptr::null::<u8>(); count]);
    // SAFETY: the arrays have the lengths that are told, or lengths that no array has
    unsafe {
        abi::fmi3SetBinary(
            instance,
            references.pointer(),
            references.count(),
            sizes.pointer(),
            values.pointer(),
            values.count(),
        )
    }
    .into()
}

fn number_of_dependencies(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let reference = turn.a.choices.below(64) as u32;
    let count = turn.a.output(0_usize);
    // SAFETY: the last argument points to one value, or is null
    unsafe { abi::fmi3GetNumberOfVariableDependencies(instance, reference, count.pointer()) }.into()
}

fn dependencies(turn: &mut Turn<'_, '_>) -> Outcome {
    const COUNT: usize = 8;
    let instance = turn.instance();
    let reference = turn.a.choices.below(64) as u32;
    let of_dependent = turn.a.array([0_usize; COUNT]);
    let independents = turn.a.array([0_u32; COUNT]);
    let of_independents = turn.a.array([0_usize; COUNT]);
    let kinds = turn.a.array([0; COUNT]);
    // SAFETY: the arrays have room for as many values as is told, or are refused
    unsafe {
        abi::fmi3GetVariableDependencies(
            instance,
            reference,
            of_dependent.pointer(),
            independents.pointer(),
            of_independents.pointer(),
            kinds.pointer(),
            COUNT,
        )
    }
    .into()
}

fn get_state(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    // a null pointer, or a state to write over
    let before = if turn.a.choices.one_in(3) {
        turn.state()
    } else {
        ptr::null_mut()
    };
    let variable = turn.a.output(before);
    // SAFETY: the variable holds null, a state, or memory that is none
    let status = unsafe { abi::fmi3GetFMUState(instance, variable.pointer()) };
    let state = variable.content()[0];
    if status < ERROR {
        turn.saved.retain(|saved| saved.handle != state);
        let (mode, time_s) = (turn.subject.mode, turn.subject.time_s);
        turn.keep(state, mode, time_s);
    } else {
        assert_eq!(state, before);
    }
    status.into()
}

fn set_state(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let state = turn.state();
    // SAFETY: null, a state, or memory that is none
    let status = unsafe { abi::fmi3SetFMUState(instance, state) };
    if status < ERROR {
        let saved = turn.saved.iter().find(|saved| saved.handle == state);
        let saved = saved.expect("only what was saved is restored");
        turn.subject.mode = saved.mode;
        turn.subject.time_s = saved.time_s;
    }
    status.into()
}

fn free_one_state(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let state = turn.state();
    let variable = turn.a.output(state);
    // SAFETY: the variable holds null, a state that is not used again, or memory that is none
    let status = unsafe { abi::fmi3FreeFMUState(instance, variable.pointer()) };
    if status < ERROR && !variable.pointer().is_null() {
        assert_eq!(variable.content()[0], ptr::null_mut());
        turn.saved.retain(|saved| saved.handle != state);
    } else {
        assert_eq!(variable.content()[0], state);
    }
    status.into()
}

fn serialized_size(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let state = turn.state();
    let size = turn.a.output(0_usize);
    // SAFETY: null, a state, or memory that is none; the size is one value, or null
    unsafe { abi::fmi3SerializedFMUStateSize(instance, state, size.pointer()) }.into()
}

fn serialize(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let state = turn.state();
    let mut size = 0;
    if turn.a.right {
        // SAFETY: the subject's instance lives, the state is one of its own
        let status =
            unsafe { abi::fmi3SerializedFMUStateSize(turn.subject.handle, state, &raw mut size) };
        assert_eq!(status, OK);
    }
    let bytes = turn.a.array(vec![0_u8; size]);
    // SAFETY: the array has the length that is told, or one that no array has
    unsafe { abi::fmi3SerializeFMUState(instance, state, bytes.pointer(), bytes.count()) }.into()
}

fn deserialize(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let whole = state_bytes(turn.subject.handle);
    let mut bytes = whole.clone();
    if turn.a.wrong(3) {
        damage(&mut bytes, turn.a.choices);
    }
    let before = if turn.a.choices.one_in(3) {
        turn.state()
    } else {
        ptr::null_mut()
    };
    let bytes = turn.a.array(bytes);
    let variable = turn.a.output(before);
    // SAFETY: the array has the length that is told, or one that no array has; the variable holds null, a state, or
    // memory that is none
    let status = unsafe {
        abi::fmi3DeserializeFMUState(instance, bytes.pointer(), bytes.count(), variable.pointer())
    };
    let state = variable.content()[0];
    if status < ERROR {
        let told = bytes.content().get(..bytes.count());
        assert_eq!(told, Some(whole.as_slice()), "damaged bytes are accepted");
        turn.saved.retain(|saved| saved.handle != state);
        let (mode, time_s) = (turn.subject.mode, turn.subject.time_s);
        turn.keep(state, mode, time_s);
    } else {
        assert_eq!(state, before);
    }
    status.into()
}

/// Changes bytes, adds some, or takes some away.
pub(crate) fn damage(bytes: &mut Vec<u8>, choices: &mut Choices<'_>) {
    let position = choices.bits() as usize % bytes.len();
    match choices.below(4) {
        0 => bytes.truncate(position),
        1 => bytes.push(choices.below(256) as u8),
        2 => {
            let before = bytes.clone();
            bytes[position..].fill(choices.below(256) as u8);
            if *bytes == before {
                bytes[position] ^= 1;
            }
        }
        _ => bytes[position] ^= 1 << choices.below(8),
    }
}

fn derivative(turn: &mut Turn<'_, '_>, function: abi::PartialDerivative, adjoint: bool) -> Outcome {
    let instance = turn.instance();
    let model = turn.subject.model();
    let unknowns = turn.references(model.outputs());
    let knowns = turn.references(model.inputs());
    let (seeds, results) = if adjoint {
        (unknowns.len(), knowns.len())
    } else {
        (knowns.len(), unknowns.len())
    };
    let seed: Vec<f64> = (0..seeds).map(|_| turn.a.number()).collect();
    let unknowns = turn.a.array(unknowns);
    let knowns = turn.a.array(knowns);
    let seed = turn.a.array(seed);
    let sensitivity = turn.a.array(vec![0.0; results]);
    // SAFETY: the arrays have the lengths that are told, or lengths that no array has
    let status = unsafe {
        function(
            instance,
            unknowns.pointer(),
            unknowns.count(),
            knowns.pointer(),
            knowns.count(),
            seed.pointer(),
            seed.count(),
            sensitivity.pointer(),
            sensitivity.count(),
        )
    };
    Outcome {
        status: Some(status),
        values: sensitivity.content().to_vec(),
    }
}

fn update_discrete_states(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let flags: [_; 5] = std::array::from_fn(|_| turn.a.output(2_u8));
    let next = turn.a.output(0.0);
    // SAFETY: the arguments point to one value each, or are null
    let status = unsafe {
        abi::fmi3UpdateDiscreteStates(
            instance,
            flags[0].pointer(),
            flags[1].pointer(),
            flags[2].pointer(),
            flags[3].pointer(),
            flags[4].pointer(),
            next.pointer(),
        )
    };
    if status < ERROR {
        assert!(flags.iter().all(|flag| flag.content()[0] <= 1));
    }
    status.into()
}

fn completed_integrator_step(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let flags: [_; 2] = std::array::from_fn(|_| turn.a.output(2_u8));
    let no_set = turn.a.flag();
    // SAFETY: the arguments point to one value each, or are null
    let status = unsafe {
        abi::fmi3CompletedIntegratorStep(instance, no_set, flags[0].pointer(), flags[1].pointer())
    };
    if status < ERROR {
        assert!(flags.iter().all(|flag| flag.content()[0] <= 1));
    }
    status.into()
}

fn set_time(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let time = turn.subject.time_s + turn.step_size();
    // SAFETY: the handle is the instance's, or refused
    let status = unsafe { abi::fmi3SetTime(instance, time) };
    if status < ERROR {
        turn.subject.time_s = time;
    }
    status.into()
}

fn set_continuous_states(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let count = turn.subject.model().states();
    let scale = turn.a.choices.pick(&[1e-6, 1e-4, 1e-2, 1.0]);
    let states: Vec<f64> = (0..count).map(|_| scale * turn.a.number()).collect();
    let states = turn.a.array(states);
    // SAFETY: the array has the length that is told, or one that no array has
    unsafe { abi::fmi3SetContinuousStates(instance, states.pointer(), states.count()) }.into()
}

fn event_indicators(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let count = if turn.a.wrong(4) { 3 } else { 0 };
    let values = turn.a.array(vec![0.0; count]);
    // SAFETY: the array has the length that is told, or one that no array has
    unsafe { abi::fmi3GetEventIndicators(instance, values.pointer(), values.count()) }.into()
}

fn number_of(
    turn: &mut Turn<'_, '_>,
    function: unsafe extern "C" fn(*mut c_void, *mut usize) -> i32,
) -> Outcome {
    let instance = turn.instance();
    let count = turn.a.output(0_usize);
    // SAFETY: the argument points to one value, or is null
    unsafe { function(instance, count.pointer()) }.into()
}

fn output_derivatives(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let references = turn.references(turn.subject.model().outputs());
    let count = references.len();
    let orders = (0..count).map(|_| {
        if turn.a.wrong(6) {
            turn.a.choices.pick(&[0, -1, 2, i32::MAX, i32::MIN])
        } else {
            1
        }
    });
    let orders: Vec<i32> = orders.collect();
    let references = turn.a.array(references);
    let orders = turn.a.array(orders);
    let values = turn.a.array(vec![0.0; count]);
    // SAFETY: the arrays have the lengths that are told, or lengths that no array has
    let status = unsafe {
        abi::fmi3GetOutputDerivatives(
            instance,
            references.pointer(),
            references.count(),
            orders.pointer(),
            values.pointer(),
            values.count(),
        )
    };
    Outcome {
        status: Some(status),
        values: values.content().to_vec(),
    }
}

fn do_step(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let time = if turn.a.wrong(8) {
        turn.a.choices.any_number()
    } else {
        turn.subject.time_s
    };
    let size = turn.step_size();
    let no_set = turn.a.flag();
    let flags: [_; 3] = std::array::from_fn(|_| turn.a.output(2_u8));
    let last = turn.a.output(f64::NAN);
    // SAFETY: the arguments point to one value each, or are null
    let status = unsafe {
        abi::fmi3DoStep(
            instance,
            time,
            size,
            no_set,
            flags[0].pointer(),
            flags[1].pointer(),
            flags[2].pointer(),
            last.pointer(),
        )
    };
    let mut values = Vec::new();
    if status < ERROR {
        assert!(flags.iter().all(|flag| flag.content()[0] <= 1));
        let [last] = last.content() else {
            unreachable!("one value");
        };
        turn.subject.time_s = *last;
        values.push(*last);
    } else if turn.reached {
        turn.subject.mode = None;
    }
    Outcome {
        status: Some(status),
        values,
    }
}

fn activate(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let clock = turn.a.choices.below(64) as u32;
    let time = turn.a.number();
    // SAFETY: the handle is the instance's, or refused
    unsafe { abi::fmi3ActivateModelPartition(instance, clock, time) }.into()
}

fn scheduled_execution(turn: &mut Turn<'_, '_>) -> Outcome {
    let name = turn.a.text(c"joint");
    let token = turn.a.text(TOKEN);
    let resources = turn.a.text(host::resources(turn.subject.model));
    let (visible, logging) = (turn.a.flag(), turn.a.flag());
    turn.reached = turn.subject.logs;
    // SAFETY: the strings are terminated or null; the host outlives the call
    let handle = unsafe {
        abi::fmi3InstantiateScheduledExecution(
            name,
            token,
            resources,
            visible,
            logging,
            (&raw mut *turn.subject.host).cast(),
            turn.subject
                .logs
                .then_some(host::log_fmi3 as abi::LogMessage),
            None,
            None,
            None,
        )
    };
    assert!(handle.is_null());
    ERROR.into()
}

/// Restores these bytes, if they are accepted, steps, and resets.
pub(crate) fn go_on_from(instance: *mut c_void, bytes: &[u8]) -> Vec<f64> {
    let mut state = ptr::null_mut();
    let references = [0_u32, 1, 3, 5, 7];
    let mut values = vec![0.0; references.len()];
    // SAFETY: the instance lives, the arrays have the lengths that are told, the other pointers are to locals
    unsafe {
        let status =
            abi::fmi3DeserializeFMUState(instance, bytes.as_ptr(), bytes.len(), &raw mut state);
        if status != OK {
            assert!(state.is_null());
            return Vec::new();
        }
        assert_eq!(abi::fmi3SetFMUState(instance, state), OK);
        free_state(instance, state);
        for _ in 0..3 {
            let status = abi::fmi3GetFloat64(
                instance,
                references.as_ptr(),
                references.len(),
                values.as_mut_ptr(),
                values.len(),
            );
            if status == OK {
                assert!(values.iter().all(|value| value.is_finite()), "{values:?}");
            }
            let (mut event, mut terminate, mut early, mut last) = (0, 0, 0, 0.0);
            abi::fmi3DoStep(
                instance,
                values[0],
                1e-4,
                0,
                &raw mut event,
                &raw mut terminate,
                &raw mut early,
                &raw mut last,
            );
            let (mut enter, mut end) = (0, 0);
            abi::fmi3CompletedIntegratorStep(instance, 0, &raw mut enter, &raw mut end);
        }
        assert_eq!(abi::fmi3Reset(instance), OK);
    }
    values
}

/// An instance with right arguments, for a host that is the environment; or null.
pub(crate) fn open(
    interface: Interface,
    resources: &CStr,
    environment: *mut c_void,
) -> *mut c_void {
    let (name, token, path) = (c"joint".as_ptr(), TOKEN.as_ptr(), resources.as_ptr());
    let log = Some(host::log_fmi3 as abi::LogMessage);
    // SAFETY: the strings are terminated, the environment is a host that outlives the instance
    unsafe {
        match interface {
            Interface::ModelExchange => {
                abi::fmi3InstantiateModelExchange(name, token, path, 0, 0, environment, log)
            }
            Interface::CoSimulation => abi::fmi3InstantiateCoSimulation(
                name,
                token,
                path,
                0,
                0,
                0,
                0,
                ptr::null(),
                0,
                environment,
                log,
                None,
            ),
        }
    }
}

/// Initialises and takes some steps; parameters that no simulation can start from are refused.
pub(crate) fn simulate(subject: &Subject) {
    let i = subject.handle;
    // SAFETY: the instance lives, pointers are to locals
    unsafe {
        assert_eq!(abi::fmi3EnterInitializationMode(i, 0, 0.0, 0.0, 0, 0.0), OK);
        if abi::fmi3ExitInitializationMode(i) >= DISCARD {
            return;
        }
        let mut last = 0.0;
        for _ in 0..3 {
            if subject.interface == Interface::CoSimulation {
                let (mut event, mut terminate, mut early) = (0, 0, 0);
                abi::fmi3DoStep(
                    i,
                    last,
                    1e-5,
                    0,
                    &raw mut event,
                    &raw mut terminate,
                    &raw mut early,
                    &raw mut last,
                );
            } else {
                abi::fmi3EnterContinuousTimeMode(i);
                let (mut enter, mut end) = (0, 0);
                abi::fmi3CompletedIntegratorStep(i, 0, &raw mut enter, &raw mut end);
            }
        }
    }
    assert!(values(subject).iter().all(|value| value.is_finite()));
}
