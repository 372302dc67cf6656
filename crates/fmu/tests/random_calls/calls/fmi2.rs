//! The functions of FMI 2.0: when they are allowed, and what they are called with.

use std::{ffi::c_int, ptr};

use bolted_joint_importer::header::{DISCARD, fmi2::*};

use super::{
    draws::*,
    turn::{Function, Mode, Outcome, Rule, Subject, Turn, table, text_of},
};
use crate::raw::call;

use Mode::{ContinuousTime, Event, Initialization, Instantiated, SetUp, Step, Terminated};

/// Modes in which a simulation is going on.
const RUNNING: &[Mode] = &[Step, Event, ContinuousTime];

/// Asks for one of the kinds of status.
macro_rules! asked {
    ($function:ident, $zero:expr) => {
        |turn| {
            let i = turn.instance();
            let kind = turn.a.choices.below(6) as c_int - 1;
            let value = turn.a.output($zero);
            call!(@one i, $function(kind, value.pointer())).into()
        }
    };
}

/// All functions of the header but those that instantiate and free, which come by themselves.
pub(crate) static FUNCTIONS: [Function; 42] = table! {
    "fmi2GetTypesPlatform" Rule::Free => |_| text_of(fmi2GetTypesPlatform, c"default");
    "fmi2GetVersion" Rule::Free => |_| text_of(fmi2GetVersion, c"2.0");
    "fmi2SetDebugLogging" Rule::Always => set_debug_logging;
    "fmi2SetupExperiment" Rule::Only(&[Instantiated, SetUp]) => set_time_span;
    "fmi2EnterInitializationMode" Rule::Exactly(&[SetUp]) =>
        plain!(fmi2EnterInitializationMode, |_| Initialization);
    "fmi2ExitInitializationMode" Rule::Only(&[Initialization]) =>
        plain!(fmi2ExitInitializationMode, after_initialization);
    "fmi2Terminate" Rule::Exactly(RUNNING) => plain!(fmi2Terminate, |_| Terminated);
    "fmi2Reset" Rule::Always => reset;
    "fmi2GetReal" Rule::Free => get_values;
    "fmi2GetInteger" Rule::Free => arrays!(fmi2GetInteger, values = 0);
    "fmi2GetBoolean" Rule::Free => arrays!(fmi2GetBoolean, values = 0);
    "fmi2GetString" Rule::Free => arrays!(fmi2GetString, values = ptr::null());
    "fmi2SetReal" Rule::Exactly(&[Instantiated, SetUp, Initialization, Step, Event, ContinuousTime]) => set_values;
    "fmi2SetInteger" Rule::Free => arrays!(fmi2SetInteger, values = 0);
    "fmi2SetBoolean" Rule::Free => arrays!(fmi2SetBoolean, values = 0);
    "fmi2SetString" Rule::Free => arrays!(fmi2SetString, values = ptr::null());
    "fmi2GetFMUstate" Rule::Always => get_state;
    "fmi2SetFMUstate" Rule::Always => set_state;
    "fmi2FreeFMUstate" Rule::Always => free_state;
    "fmi2SerializedFMUstateSize" Rule::Always => serialized_size;
    "fmi2SerializeFMUstate" Rule::Always => serialize;
    "fmi2DeSerializeFMUstate" Rule::Always => deserialize;
    "fmi2GetDirectionalDerivative" Rule::Free => directional;
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

fn new_discrete_states(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let info = turn.a.output(EventInfo::default());
    call!(@one i, fmi2NewDiscreteStates(info.pointer())).into()
}

fn input_derivatives(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let references = turn.references(turn.subject.model().inputs());
    let orders = orders(turn, references.len());
    let values: Vec<f64> = references.iter().map(|_| turn.a.number()).collect();
    let references = turn.a.array(references);
    let orders = turn.a.array(orders);
    let values = turn.a.array(values);
    let (of, count) = (references.pointer(), references.count());
    let (o, v) = (orders.pointer(), values.pointer());
    call!(@one i, fmi2SetRealInputDerivatives(of, count, o, v)).into()
}
