//! The functions of FMI 2.0, each with the drawing of its arguments.

use std::{
    ffi::{CStr, c_char, c_int, c_void},
    mem, ptr,
};

use super::{
    arrays::Arguments,
    choices::Choices,
    fmi2_abi as abi,
    fmi3::damage,
    host::{self, DISCARD, ERROR, Host, MODELS, OK, TOKEN},
    turn::{Function, Interface, Mode, Outcome, Rule, Subject, Told, Turn, Version},
};

use Mode::{ContinuousTime, Event, Initialization, Instantiated, SetUp, Step, Terminated};

/// Modes in which a simulation is going on.
const RUNNING: &[Mode] = &[Step, Event, ContinuousTime];

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
            let values = turn.a.array(vec![$zero; references.len()]);
            let references = turn.a.array(references);
            // SAFETY: the arrays have the length that is told, or none has
            unsafe {
                abi::$function(
                    instance,
                    references.pointer(),
                    references.count(),
                    values.pointer(),
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
            $(if status < DISCARD {
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

/// Asks for one of the kinds of status.
macro_rules! asked {
    ($function:ident, $zero:expr) => {
        |turn| {
            let instance = turn.instance();
            let kind = turn.a.choices.below(6) as c_int - 1;
            let value = turn.a.output($zero);
            // SAFETY: the last argument points to one value, or is null
            unsafe { abi::$function(instance, kind, value.pointer()) }.into()
        }
    };
}

/// All functions of the header but those that instantiate and free, which come by themselves.
pub(crate) static FUNCTIONS: [Function; 42] = table! {
    "fmi2GetTypesPlatform" Rule::Free => |_| text_of(abi::fmi2GetTypesPlatform, c"default");
    "fmi2GetVersion" Rule::Free => |_| text_of(abi::fmi2GetVersion, c"2.0");
    "fmi2SetDebugLogging" Rule::Always => set_debug_logging;
    "fmi2SetupExperiment" Rule::Only(&[Instantiated, SetUp]) => setup_experiment;
    "fmi2EnterInitializationMode" Rule::Exactly(&[SetUp]) =>
        plain!(fmi2EnterInitializationMode, |_| Initialization);
    "fmi2ExitInitializationMode" Rule::Only(&[Initialization]) =>
        plain!(fmi2ExitInitializationMode, |subject| match subject.interface {
            Interface::ModelExchange => Event,
            Interface::CoSimulation => Step,
        });
    "fmi2Terminate" Rule::Exactly(RUNNING) => plain!(fmi2Terminate, |_| Terminated);
    "fmi2Reset" Rule::Always => plain!(fmi2Reset, |_| Instantiated);
    "fmi2GetReal" Rule::Free => get_real;
    "fmi2GetInteger" Rule::Free => typed!(fmi2GetInteger, 0);
    "fmi2GetBoolean" Rule::Free => typed!(fmi2GetBoolean, 0);
    "fmi2GetString" Rule::Free => typed!(fmi2GetString, ptr::null());
    "fmi2SetReal" Rule::Exactly(&[Instantiated, SetUp, Initialization, Step, Event, ContinuousTime]) => set_real;
    "fmi2SetInteger" Rule::Free => typed!(fmi2SetInteger, 0);
    "fmi2SetBoolean" Rule::Free => typed!(fmi2SetBoolean, 0);
    "fmi2SetString" Rule::Free => typed!(fmi2SetString, ptr::null());
    "fmi2GetFMUstate" Rule::Always => get_state;
    "fmi2SetFMUstate" Rule::Always => set_state;
    "fmi2FreeFMUstate" Rule::Always => free_one_state;
    "fmi2SerializedFMUstateSize" Rule::Always => serialized_size;
    "fmi2SerializeFMUstate" Rule::Always => serialize;
    "fmi2DeSerializeFMUstate" Rule::Always => deserialize;
    "fmi2GetDirectionalDerivative" Rule::Free => derivative;
    "fmi2EnterEventMode" Rule::Only(&[Event, ContinuousTime]) => plain!(fmi2EnterEventMode, |_| Event);
    "fmi2NewDiscreteStates" Rule::Only(&[Event]) => new_discrete_states;
    "fmi2EnterContinuousTimeMode" Rule::Only(&[Event]) =>
        plain!(fmi2EnterContinuousTimeMode, |_| ContinuousTime);
    "fmi2CompletedIntegratorStep" Rule::Only(&[ContinuousTime]) => completed_integrator_step;
    "fmi2SetTime" Rule::Only(&[Event, ContinuousTime]) => set_time;
    "fmi2SetContinuousStates" Rule::Only(&[ContinuousTime, Event]) => set_continuous_states;
    "fmi2GetDerivatives" Rule::Free => state_numbers!(fmi2GetDerivatives);
    "fmi2GetEventIndicators" Rule::Free => event_indicators;
    "fmi2GetContinuousStates" Rule::Free => state_numbers!(fmi2GetContinuousStates);
    "fmi2GetNominalsOfContinuousStates" Rule::Free => state_numbers!(fmi2GetNominalsOfContinuousStates);
    "fmi2SetRealInputDerivatives" Rule::Free => input_derivatives;
    "fmi2GetRealOutputDerivatives" Rule::Free => output_derivatives;
    "fmi2DoStep" Rule::Only(&[Step]) => do_step;
    "fmi2CancelStep" Rule::Only(&[]) => plain!(fmi2CancelStep);
    "fmi2GetStatus" Rule::Free => asked!(fmi2GetStatus, 0);
    "fmi2GetRealStatus" Rule::Free => asked!(fmi2GetRealStatus, 0.0);
    "fmi2GetIntegerStatus" Rule::Free => asked!(fmi2GetIntegerStatus, 0);
    "fmi2GetBooleanStatus" Rule::Free => asked!(fmi2GetBooleanStatus, 0);
    "fmi2GetStringStatus" Rule::Free => asked!(fmi2GetStringStatus, ptr::null());
};

/// What makes sense next.
pub(crate) fn sensible(mode: Option<Mode>) -> &'static [&'static str] {
    match mode {
        Some(Instantiated) => &["fmi2SetupExperiment", "fmi2SetReal"],
        Some(SetUp) => &["fmi2EnterInitializationMode", "fmi2SetReal"],
        Some(Initialization) => &["fmi2ExitInitializationMode", "fmi2SetReal"],
        Some(Step) => &[
            "fmi2DoStep",
            "fmi2DoStep",
            "fmi2SetReal",
            "fmi2SetRealInputDerivatives",
            "fmi2GetReal",
            "fmi2GetRealOutputDerivatives",
            "fmi2GetDirectionalDerivative",
        ],
        Some(Event) => &[
            "fmi2NewDiscreteStates",
            "fmi2EnterContinuousTimeMode",
            "fmi2SetReal",
        ],
        Some(ContinuousTime) => &[
            "fmi2SetTime",
            "fmi2SetContinuousStates",
            "fmi2GetDerivatives",
            "fmi2CompletedIntegratorStep",
        ],
        _ => &["fmi2Reset", "fmi2SetFMUstate", "fmi2GetReal"],
    }
}

/// `fmi2CallbackLogger` without its variable arguments, which the library never hands over.
unsafe extern "C" fn log(
    environment: *mut c_void,
    _name: *const c_char,
    status: c_int,
    category: *const c_char,
    text: *const c_char,
) {
    // SAFETY: the environment is the host of the instance, which outlives it
    unsafe { (*environment.cast::<Host>()).note(status, category, text) };
}

/// A new instance, or none where the arguments are wrong.
pub(crate) fn instantiate(choices: &mut Choices<'_>) -> (&'static str, Option<Subject>) {
    let mut a = Arguments::new(choices);
    let model = a.choices.below(MODELS.len());
    let exchange = a.choices.one_in(2);
    let mut host = Box::<Host>::default();
    let logs = !a.unusual(4);
    // the structure is only there during the call
    let callbacks = Box::new(abi::Callbacks {
        logger: logs.then(logger),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        environment: (&raw mut *host).cast(),
    });
    let none = !logs && a.unusual(2);
    let name = a.text(c"joint");
    let guid = a.text(TOKEN);
    let resources = a.text(host::resources(model));
    let kind = if a.wrong(8) {
        a.choices.pick(&[-1, 2, c_int::MAX])
    } else {
        c_int::from(!exchange)
    };
    let (visible, logging) = (c_int::from(a.flag()), c_int::from(a.flag()));
    // SAFETY: the strings are terminated or null, the host outlives the instance
    let handle = unsafe {
        abi::fmi2Instantiate(
            name,
            kind,
            guid,
            resources,
            if none {
                ptr::null()
            } else {
                &raw const *callbacks
            },
            visible,
            logging,
        )
    };
    drop(callbacks);
    let function = "fmi2Instantiate";
    assert_eq!(host.faults, [""; 0], "{function}");
    if handle.is_null() {
        assert!(!a.right, "{function}: {:?}", host.messages);
        let errors = host.messages.iter().filter(|(status, _)| *status >= ERROR);
        assert_eq!(
            errors.count(),
            usize::from(logs),
            "{function}: {:?}",
            host.messages
        );
        return (function, None);
    }
    let subject = Subject {
        version: Version::Fmi2,
        interface: if exchange {
            Interface::ModelExchange
        } else {
            Interface::CoSimulation
        },
        model,
        handle,
        host,
        logs,
        told: Told::from_the_start(logging != 0),
        event_mode: false,
        mode: Some(Instantiated),
        time_s: 0.0,
    };
    (function, Some(subject))
}

/// Frees an instance.
pub(crate) fn free(instance: *mut c_void) {
    // SAFETY: the instance lives and is not used again
    unsafe { abi::fmi2FreeInstance(instance) };
}

/// Frees a state.
pub(crate) fn free_state(instance: *mut c_void, mut state: *mut c_void) {
    // SAFETY: instance and state live; the state is not used again
    let status = unsafe { abi::fmi2FreeFMUstate(instance, &raw mut state) };
    assert_eq!((status, state), (OK, ptr::null_mut()));
}

/// All that the instance remembers, serialised.
pub(crate) fn state_bytes(instance: *mut c_void) -> Vec<u8> {
    let (mut state, mut size) = (ptr::null_mut(), 0);
    // SAFETY: the instance lives, pointers are to locals and to a vector of the size that is told
    unsafe {
        assert_eq!(abi::fmi2GetFMUstate(instance, &raw mut state), OK);
        assert_eq!(
            abi::fmi2SerializedFMUstateSize(instance, state, &raw mut size),
            OK
        );
        let mut bytes = vec![0_u8; size];
        assert_eq!(
            abi::fmi2SerializeFMUstate(instance, state, bytes.as_mut_ptr(), size),
            OK
        );
        free_state(instance, state);
        bytes
    }
}

/// Time, displacements and velocities, where they can be read.
pub(crate) fn values(subject: &Subject) -> Vec<f64> {
    if matches!(subject.mode, None | Some(Instantiated | SetUp)) {
        return Vec::new();
    }
    let references = [0_u32, 1, 3, 5, 7];
    let mut values = vec![f64::NAN; references.len()];
    // SAFETY: the instance lives, the arrays have the length that is told
    let status = unsafe {
        abi::fmi2GetReal(
            subject.handle,
            references.as_ptr(),
            references.len(),
            values.as_mut_ptr(),
        )
    };
    assert_eq!(status, OK, "time, displacements and velocities can be read");
    values
}

fn text_of(function: unsafe extern "C" fn() -> *const c_char, expected: &CStr) -> Outcome {
    // SAFETY: returns a terminated string
    assert_eq!(unsafe { CStr::from_ptr(function()) }, expected);
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
    let on = c_int::from(turn.a.flag());
    // SAFETY: the array has the length that is told, or one that no array has; strings are terminated or null
    let status = unsafe { abi::fmi2SetDebugLogging(instance, on, names.count(), names.pointer()) };
    if status == OK && turn.reached {
        // of an array that is told too short, the rest does not count
        let told = &drawn[..names.count()];
        turn.subject.switch_logging(told, on != 0);
    }
    status.into()
}

fn setup_experiment(turn: &mut Turn<'_, '_>) -> Outcome {
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
        abi::fmi2SetupExperiment(
            instance,
            c_int::from(tolerance_defined),
            tolerance,
            start,
            c_int::from(stop_defined),
            stop,
        )
    };
    if status < DISCARD {
        turn.subject.mode = Some(SetUp);
        turn.subject.time_s = start;
    }
    status.into()
}

fn get_real(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let pool: Vec<u32> = (0..45).collect();
    let references = turn.references(&pool);
    let values = turn.a.array(vec![0.0; references.len()]);
    let references = turn.a.array(references);
    // SAFETY: the arrays have the length that is told, or none has
    let status = unsafe {
        abi::fmi2GetReal(
            instance,
            references.pointer(),
            references.count(),
            values.pointer(),
        )
    };
    Outcome {
        status: Some(status),
        values: values.content().to_vec(),
    }
}

fn set_real(turn: &mut Turn<'_, '_>) -> Outcome {
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
    // SAFETY: the arrays have the length that is told, or none has
    unsafe {
        abi::fmi2SetReal(
            instance,
            references.pointer(),
            references.count(),
            values.pointer(),
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
    let status = unsafe { abi::fmi2GetFMUstate(instance, variable.pointer()) };
    let state = variable.content()[0];
    if status < DISCARD {
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
    let status = unsafe { abi::fmi2SetFMUstate(instance, state) };
    if status < DISCARD {
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
    let status = unsafe { abi::fmi2FreeFMUstate(instance, variable.pointer()) };
    if status < DISCARD && !variable.pointer().is_null() {
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
    unsafe { abi::fmi2SerializedFMUstateSize(instance, state, size.pointer()) }.into()
}

fn serialize(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let state = turn.state();
    let mut size = 0;
    if turn.a.right {
        // SAFETY: the subject's instance lives, the state is one of its own
        let status =
            unsafe { abi::fmi2SerializedFMUstateSize(turn.subject.handle, state, &raw mut size) };
        assert_eq!(status, OK);
    }
    let bytes = turn.a.array(vec![0_u8; size]);
    // SAFETY: the array has the length that is told, or one that no array has
    unsafe { abi::fmi2SerializeFMUstate(instance, state, bytes.pointer(), bytes.count()) }.into()
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
        abi::fmi2DeSerializeFMUstate(instance, bytes.pointer(), bytes.count(), variable.pointer())
    };
    let state = variable.content()[0];
    if status < DISCARD {
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

fn derivative(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let model = turn.subject.model();
    let unknowns = turn.references(model.outputs());
    let knowns = turn.references(model.inputs());
    let seed: Vec<f64> = knowns.iter().map(|_| turn.a.number()).collect();
    let sensitivity = turn.a.array(vec![0.0; unknowns.len()]);
    let unknowns = turn.a.array(unknowns);
    let knowns = turn.a.array(knowns);
    let seed = turn.a.array(seed);
    // SAFETY: the arrays have the lengths that are told, or lengths that no array has
    let status = unsafe {
        abi::fmi2GetDirectionalDerivative(
            instance,
            unknowns.pointer(),
            unknowns.count(),
            knowns.pointer(),
            knowns.count(),
            seed.pointer(),
            sensitivity.pointer(),
        )
    };
    Outcome {
        status: Some(status),
        values: sensitivity.content().to_vec(),
    }
}

fn new_discrete_states(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let info = turn.a.output(abi::EventInfo::default());
    // SAFETY: the argument points to one value, or is null
    unsafe { abi::fmi2NewDiscreteStates(instance, info.pointer()) }.into()
}

fn completed_integrator_step(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let flags: [_; 2] = std::array::from_fn(|_| turn.a.output(2 as c_int));
    let no_set = c_int::from(turn.a.flag());
    // SAFETY: the arguments point to one value each, or are null
    let status = unsafe {
        abi::fmi2CompletedIntegratorStep(instance, no_set, flags[0].pointer(), flags[1].pointer())
    };
    if status < DISCARD {
        assert!(flags.iter().all(|flag| flag.content()[0] <= 1));
    }
    status.into()
}

fn set_time(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let time = turn.subject.time_s + turn.step_size();
    // SAFETY: the handle is the instance's, or refused
    let status = unsafe { abi::fmi2SetTime(instance, time) };
    if status < DISCARD {
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
    unsafe { abi::fmi2SetContinuousStates(instance, states.pointer(), states.count()) }.into()
}

fn event_indicators(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let count = if turn.a.wrong(4) { 3 } else { 0 };
    let values = turn.a.array(vec![0.0; count]);
    // SAFETY: the array has the length that is told, or one that no array has
    unsafe { abi::fmi2GetEventIndicators(instance, values.pointer(), values.count()) }.into()
}

fn input_derivatives(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let references = turn.references(turn.subject.model().inputs());
    let orders = orders(turn, references.len());
    let values: Vec<f64> = references.iter().map(|_| turn.a.number()).collect();
    let references = turn.a.array(references);
    let orders = turn.a.array(orders);
    let values = turn.a.array(values);
    // SAFETY: the arrays have the length that is told, or none has
    unsafe {
        abi::fmi2SetRealInputDerivatives(
            instance,
            references.pointer(),
            references.count(),
            orders.pointer(),
            values.pointer(),
        )
    }
    .into()
}

fn output_derivatives(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let references = turn.references(turn.subject.model().outputs());
    let orders = orders(turn, references.len());
    let values = turn.a.array(vec![0.0; references.len()]);
    let references = turn.a.array(references);
    let orders = turn.a.array(orders);
    // SAFETY: the arrays have the length that is told, or none has
    let status = unsafe {
        abi::fmi2GetRealOutputDerivatives(
            instance,
            references.pointer(),
            references.count(),
            orders.pointer(),
            values.pointer(),
        )
    };
    Outcome {
        status: Some(status),
        values: values.content().to_vec(),
    }
}

/// Orders of derivatives: 1, of a wild call also others.
fn orders(turn: &mut Turn<'_, '_>, count: usize) -> Vec<c_int> {
    let mut order = |_| {
        if turn.a.wrong(6) {
            turn.a.choices.pick(&[0, -1, 2, c_int::MAX, c_int::MIN])
        } else {
            1
        }
    };
    (0..count).map(&mut order).collect()
}

fn do_step(turn: &mut Turn<'_, '_>) -> Outcome {
    let instance = turn.instance();
    let time = if turn.a.wrong(8) {
        turn.a.choices.any_number()
    } else {
        turn.subject.time_s
    };
    let size = turn.step_size();
    let no_set = c_int::from(turn.a.flag());
    // SAFETY: the handle is the instance's, or refused
    let status = unsafe { abi::fmi2DoStep(instance, time, size, no_set) };
    let mut values = Vec::new();
    if status < DISCARD {
        let mut reached = f64::NAN;
        let last_successful_time = 2;
        // SAFETY: the last argument points to one value
        let asked =
            unsafe { abi::fmi2GetRealStatus(instance, last_successful_time, &raw mut reached) };
        if asked < DISCARD {
            turn.subject.time_s = reached;
            values.push(reached);
        } else {
            turn.subject.time_s = time + size;
        }
    } else if turn.reached {
        turn.subject.mode = None;
    }
    Outcome {
        status: Some(status),
        values,
    }
}

/// Restores these bytes, if they are accepted, steps, and resets.
pub(crate) fn go_on_from(instance: *mut c_void, bytes: &[u8]) -> Vec<f64> {
    let mut state = ptr::null_mut();
    let references = [0_u32, 1, 3, 5, 7];
    let mut values = vec![0.0; references.len()];
    // SAFETY: the instance lives, the arrays have the lengths that are told, the other pointers are to locals
    unsafe {
        let status =
            abi::fmi2DeSerializeFMUstate(instance, bytes.as_ptr(), bytes.len(), &raw mut state);
        if status != OK {
            assert!(state.is_null());
            return Vec::new();
        }
        assert_eq!(abi::fmi2SetFMUstate(instance, state), OK);
        free_state(instance, state);
        for _ in 0..3 {
            let status = abi::fmi2GetReal(
                instance,
                references.as_ptr(),
                references.len(),
                values.as_mut_ptr(),
            );
            if status == OK {
                assert!(values.iter().all(|value| value.is_finite()), "{values:?}");
            }
            abi::fmi2DoStep(instance, values[0], 1e-4, 0);
            let (mut enter, mut end) = (0, 0);
            abi::fmi2CompletedIntegratorStep(instance, 0, &raw mut enter, &raw mut end);
        }
        assert_eq!(abi::fmi2Reset(instance), OK);
    }
    values
}

/// The log callback, in the type of the header.
fn logger() -> abi::Logger {
    // SAFETY: the fixed arguments of a variadic function are passed as those of another one
    unsafe {
        mem::transmute::<
            unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char),
            abi::Logger,
        >(log)
    }
}

/// An instance with right arguments, for a host that is the environment; or null.
pub(crate) fn open(
    interface: Interface,
    resources: &CStr,
    environment: *mut c_void,
) -> *mut c_void {
    let callbacks = abi::Callbacks {
        logger: Some(logger()),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        environment,
    };
    let kind = c_int::from(interface == Interface::CoSimulation);
    // SAFETY: the strings are terminated, the environment is a host that outlives the instance
    unsafe {
        abi::fmi2Instantiate(
            c"joint".as_ptr(),
            kind,
            TOKEN.as_ptr(),
            resources.as_ptr(),
            &raw const callbacks,
            0,
            0,
        )
    }
}

/// Initialises and takes some steps; parameters that no simulation can start from are refused.
pub(crate) fn simulate(subject: &Subject) {
    let i = subject.handle;
    // SAFETY: the instance lives, pointers are to locals
    unsafe {
        assert_eq!(abi::fmi2SetupExperiment(i, 0, 0.0, 0.0, 0, 0.0), OK);
        assert_eq!(abi::fmi2EnterInitializationMode(i), OK);
        if abi::fmi2ExitInitializationMode(i) >= DISCARD {
            return;
        }
        for step in 0..3 {
            if subject.interface == Interface::CoSimulation {
                abi::fmi2DoStep(i, f64::from(step) * 1e-5, 1e-5, 0);
            } else {
                abi::fmi2EnterContinuousTimeMode(i);
                let (mut enter, mut end) = (0, 0);
                abi::fmi2CompletedIntegratorStep(i, 0, &raw mut enter, &raw mut end);
            }
        }
        let (mut value, time) = (f64::NAN, 0);
        assert_eq!(abi::fmi2GetReal(i, &raw const time, 1, &raw mut value), OK);
        assert!(value.is_finite());
    }
}
