//! The functions of FMI 3.0: when they are allowed, and what they are called with.

use std::ptr;

use bolted_joint_importer::header::{DISCARD, ERROR, fmi3::*};

use super::{
    draws::*,
    host::{self, TOKEN},
    turn::{Function, Interface, Mode, Outcome, Rule, Subject, Turn, table, text_of},
};
use crate::raw::call;

use Mode::{ContinuousTime, Event, Initialization, Instantiated, Step, StepEvent, Terminated};

/// Modes in which a simulation is going on.
const RUNNING: &[Mode] = &[Step, StepEvent, Event, ContinuousTime];

/// Reads a number.
macro_rules! number_of {
    ($function:ident) => {
        |turn| {
            let i = turn.instance();
            let count = turn.a.output(0_usize);
            call!(@one i, $function(count.pointer())).into()
        }
    };
}

/// All functions of the header but those that instantiate and free, which come by themselves.
pub(crate) static FUNCTIONS: [Function; 72] = table! {
    "fmi3GetVersion" Rule::Free => |_| text_of(fmi3GetVersion, c"3.0");
    "fmi3SetDebugLogging" Rule::Always => set_debug_logging;
    "fmi3EnterInitializationMode" Rule::Exactly(&[Instantiated]) => set_time_span;
    "fmi3ExitInitializationMode" Rule::Only(&[Initialization]) =>
        plain!(fmi3ExitInitializationMode, after_initialization);
    "fmi3EnterEventMode" Rule::Only(&[Step, ContinuousTime]) =>
        plain!(fmi3EnterEventMode, |subject| match subject.interface {
            Interface::ModelExchange => Event,
            Interface::CoSimulation => StepEvent,
        });
    "fmi3Terminate" Rule::Exactly(RUNNING) => plain!(fmi3Terminate, |_| Terminated);
    "fmi3Reset" Rule::Always => reset;
    "fmi3GetFloat32" Rule::Free => arrays!(fmi3GetFloat32, values = 0.0; values);
    "fmi3GetFloat64" Rule::Free => get_values;
    "fmi3GetInt8" Rule::Free => arrays!(fmi3GetInt8, values = 0; values);
    "fmi3GetUInt8" Rule::Free => arrays!(fmi3GetUInt8, values = 0; values);
    "fmi3GetInt16" Rule::Free => arrays!(fmi3GetInt16, values = 0; values);
    "fmi3GetUInt16" Rule::Free => arrays!(fmi3GetUInt16, values = 0; values);
    "fmi3GetInt32" Rule::Free => arrays!(fmi3GetInt32, values = 0; values);
    "fmi3GetUInt32" Rule::Free => arrays!(fmi3GetUInt32, values = 0; values);
    "fmi3GetInt64" Rule::Free => arrays!(fmi3GetInt64, values = 0; values);
    "fmi3GetUInt64" Rule::Free => arrays!(fmi3GetUInt64, values = 0; values);
    "fmi3GetBoolean" Rule::Free => arrays!(fmi3GetBoolean, values = 0; values);
    "fmi3GetString" Rule::Free => arrays!(fmi3GetString, values = ptr::null(); values);
    "fmi3GetBinary" Rule::Free => arrays!(fmi3GetBinary, sizes = 0, values = ptr::null(); values);
    "fmi3GetClock" Rule::Free => arrays!(fmi3GetClock, values = 0);
    "fmi3SetFloat32" Rule::Free => arrays!(fmi3SetFloat32, values = 0.0; values);
    "fmi3SetFloat64" Rule::Exactly(&[Instantiated, Initialization, Step, StepEvent, Event, ContinuousTime]) => set_values;
    "fmi3SetInt8" Rule::Free => arrays!(fmi3SetInt8, values = 0; values);
    "fmi3SetUInt8" Rule::Free => arrays!(fmi3SetUInt8, values = 0; values);
    "fmi3SetInt16" Rule::Free => arrays!(fmi3SetInt16, values = 0; values);
    "fmi3SetUInt16" Rule::Free => arrays!(fmi3SetUInt16, values = 0; values);
    "fmi3SetInt32" Rule::Free => arrays!(fmi3SetInt32, values = 0; values);
    "fmi3SetUInt32" Rule::Free => arrays!(fmi3SetUInt32, values = 0; values);
    "fmi3SetInt64" Rule::Free => arrays!(fmi3SetInt64, values = 0; values);
    "fmi3SetUInt64" Rule::Free => arrays!(fmi3SetUInt64, values = 0; values);
    "fmi3SetBoolean" Rule::Free => arrays!(fmi3SetBoolean, values = 0; values);
    "fmi3SetString" Rule::Free => arrays!(fmi3SetString, values = ptr::null(); values);
    "fmi3SetBinary" Rule::Free => arrays!(fmi3SetBinary, sizes = 0, values = ptr::null(); values);
    "fmi3SetClock" Rule::Free => arrays!(fmi3SetClock, values = 0);
    "fmi3GetNumberOfVariableDependencies" Rule::Free => number_of_dependencies;
    "fmi3GetVariableDependencies" Rule::Free => dependencies;
    "fmi3GetFMUState" Rule::Always => get_state;
    "fmi3SetFMUState" Rule::Always => set_state;
    "fmi3FreeFMUState" Rule::Always => free_state;
    "fmi3SerializedFMUStateSize" Rule::Always => serialized_size;
    "fmi3SerializeFMUState" Rule::Always => serialize;
    "fmi3DeserializeFMUState" Rule::Always => deserialize;
    "fmi3GetDirectionalDerivative" Rule::Free => directional;
    "fmi3GetAdjointDerivative" Rule::Free => adjoint;
    "fmi3EnterConfigurationMode" Rule::Only(&[]) => plain!(fmi3EnterConfigurationMode);
    "fmi3ExitConfigurationMode" Rule::Only(&[]) => plain!(fmi3ExitConfigurationMode);
    "fmi3GetIntervalDecimal" Rule::Free => arrays!(fmi3GetIntervalDecimal, values = 0.0, others = 0);
    "fmi3GetIntervalFraction" Rule::Free => arrays!(fmi3GetIntervalFraction, values = 0, others = 0, more = 0);
    "fmi3GetShiftDecimal" Rule::Free => arrays!(fmi3GetShiftDecimal, values = 0.0);
    "fmi3GetShiftFraction" Rule::Free => arrays!(fmi3GetShiftFraction, values = 0, others = 0);
    "fmi3SetIntervalDecimal" Rule::Free => arrays!(fmi3SetIntervalDecimal, values = 0.0);
    "fmi3SetIntervalFraction" Rule::Free => arrays!(fmi3SetIntervalFraction, values = 0, others = 0);
    "fmi3SetShiftDecimal" Rule::Free => arrays!(fmi3SetShiftDecimal, values = 0.0);
    "fmi3SetShiftFraction" Rule::Free => arrays!(fmi3SetShiftFraction, values = 0, others = 0);
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
    "fmi3GetNumberOfEventIndicators" Rule::Free => number_of!(fmi3GetNumberOfEventIndicators);
    "fmi3GetNumberOfContinuousStates" Rule::Free => number_of!(fmi3GetNumberOfContinuousStates);
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

fn number_of_dependencies(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let reference = turn.a.choices.below(64) as u32;
    let count = turn.a.output(0_usize);
    call!(@one i, fmi3GetNumberOfVariableDependencies(reference, count.pointer())).into()
}

fn dependencies(turn: &mut Turn<'_, '_>) -> Outcome {
    const COUNT: usize = 8;
    let i = turn.instance();
    let reference = turn.a.choices.below(64) as u32;
    let of_dependent = turn.a.array([0_usize; COUNT]);
    let independents = turn.a.array([0_u32; COUNT]);
    let of_independents = turn.a.array([0_usize; COUNT]);
    let kinds = turn.a.array([0; COUNT]);
    call!(@one i, fmi3GetVariableDependencies(
        reference,
        of_dependent.pointer(),
        independents.pointer(),
        of_independents.pointer(),
        kinds.pointer(),
        COUNT
    ))
    .into()
}

fn update_discrete_states(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let flags: [_; 5] = std::array::from_fn(|_| turn.a.output(2_u8));
    let next = turn.a.output(0.0);
    let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|n| flags[n].pointer());
    let status = call!(@one i, fmi3UpdateDiscreteStates(a, b, c, d, e, next.pointer()));
    assert!(status >= DISCARD || flags.iter().all(|flag| flag.content()[0] <= 1));
    status.into()
}

fn activate(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let clock = turn.a.choices.below(64) as u32;
    let time = turn.a.number();
    call!(@one i, fmi3ActivateModelPartition(clock, time)).into()
}

fn scheduled_execution(turn: &mut Turn<'_, '_>) -> Outcome {
    let name = turn.a.text(c"joint");
    let token = turn.a.text(TOKEN);
    let resources = turn.a.text(host::resources(turn.subject.model));
    let (visible, logging) = (turn.a.flag(), turn.a.flag());
    let logs = turn.subject.logs;
    turn.reached = logs;
    // SAFETY: the strings are terminated or null; the host outlives the call
    let handle = unsafe {
        fmi3InstantiateScheduledExecution(
            name,
            token,
            resources,
            visible,
            logging,
            (&raw mut *turn.subject.host).cast(),
            logs.then_some(host::log_fmi3),
            None,
            None,
            None,
        )
    };
    assert!(handle.is_null());
    ERROR.into()
}
