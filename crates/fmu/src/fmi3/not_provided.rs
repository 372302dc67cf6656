//! Functions that the FMU does not offer: they say so, and why.

use crate::{
    fmi3::{Boolean, Opaque, ValueReference, call},
    logging::Status,
    refusal::Refusal,
};

const EVENT_MODE: &str = "modelDescription.xml has no hasEventMode, the model has no events";
const MODEL_EXCHANGE: &str = "it belongs to Model Exchange, the instance is for Co-Simulation";
const CONFIGURATION: &str = "there are no structural parameters";
const OUTPUT_DERIVATIVES: &str = "modelDescription.xml has no maxOutputDerivativeOrder";
const DEPENDENCIES: &str =
    "modelDescription.xml has no providesPerElementDependencies; it lists all dependencies itself";
const CLOCKS: &str = "there are no clocks";

/// Defines functions that refuse with a reason.
macro_rules! not_provided {
    ($($function:ident($reason:expr; $($argument:ident: $type:ty),*);)*) => {$(
        #[doc = concat!("Not provided: `", stringify!($function), "` logs why and returns fmi3Error.")]
        ///
        /// # Safety
        ///
        /// `instance` as for every function; nothing else is looked at.
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $function(instance: Opaque, $($argument: $type),*) -> Status {
            $(let _ = $argument;)*
            // SAFETY: the importer's promise
            unsafe {
                call(stringify!($function), instance, |_| {
                    Err(Refusal::NotProvided { reason: $reason })
                })
            }
        }
    )*};
}

not_provided! {
    // events and clocked partitions
    fmi3EnterEventMode(EVENT_MODE;);
    fmi3EnterStepMode(EVENT_MODE;);
    fmi3EvaluateDiscreteStates(EVENT_MODE;);
    fmi3UpdateDiscreteStates(EVENT_MODE;
        _discrete_states_need_update: *mut Boolean, _terminate_simulation: *mut Boolean,
        _nominals_of_continuous_states_changed: *mut Boolean, _values_of_continuous_states_changed: *mut Boolean,
        _next_event_time_defined: *mut Boolean, _next_event_time: *mut f64);
    fmi3ActivateModelPartition(CLOCKS; _clock_reference: ValueReference, _activation_time: f64);

    // clocks
    fmi3GetIntervalDecimal(CLOCKS; _references: *const ValueReference, _count: usize, _intervals: *mut f64, _qualifiers: *mut i32);
    fmi3GetIntervalFraction(CLOCKS; _references: *const ValueReference, _count: usize, _counters: *mut u64, _resolutions: *mut u64, _qualifiers: *mut i32);
    fmi3GetShiftDecimal(CLOCKS; _references: *const ValueReference, _count: usize, _shifts: *mut f64);
    fmi3GetShiftFraction(CLOCKS; _references: *const ValueReference, _count: usize, _counters: *mut u64, _resolutions: *mut u64);
    fmi3SetIntervalDecimal(CLOCKS; _references: *const ValueReference, _count: usize, _intervals: *const f64);
    fmi3SetIntervalFraction(CLOCKS; _references: *const ValueReference, _count: usize, _counters: *const u64, _resolutions: *const u64);
    fmi3SetShiftDecimal(CLOCKS; _references: *const ValueReference, _count: usize, _shifts: *const f64);
    fmi3SetShiftFraction(CLOCKS; _references: *const ValueReference, _count: usize, _counters: *const u64, _resolutions: *const u64);

    // structural parameters
    fmi3EnterConfigurationMode(CONFIGURATION;);
    fmi3ExitConfigurationMode(CONFIGURATION;);

    // dependencies and derivatives of outputs with respect to time
    fmi3GetNumberOfVariableDependencies(DEPENDENCIES; _reference: ValueReference, _dependency_count: *mut usize);
    fmi3GetVariableDependencies(DEPENDENCIES;
        _dependent: ValueReference, _element_indices_of_dependent: *mut usize, _independents: *mut ValueReference,
        _element_indices_of_independents: *mut usize, _dependency_kinds: *mut i32, _dependency_count: usize);
    fmi3GetOutputDerivatives(OUTPUT_DERIVATIVES;
        _references: *const ValueReference, _count: usize, _orders: *const i32, _values: *mut f64, _value_count: usize);

    // Model Exchange
    fmi3EnterContinuousTimeMode(MODEL_EXCHANGE;);
    fmi3CompletedIntegratorStep(MODEL_EXCHANGE;
        _no_set_fmu_state_prior_to_current_point: Boolean, _enter_event_mode: *mut Boolean,
        _terminate_simulation: *mut Boolean);
    fmi3SetTime(MODEL_EXCHANGE; _time: f64);
    fmi3SetContinuousStates(MODEL_EXCHANGE; _states: *const f64, _count: usize);
    fmi3GetContinuousStateDerivatives(MODEL_EXCHANGE; _derivatives: *mut f64, _count: usize);
    fmi3GetEventIndicators(MODEL_EXCHANGE; _indicators: *mut f64, _count: usize);
    fmi3GetContinuousStates(MODEL_EXCHANGE; _states: *mut f64, _count: usize);
    fmi3GetNominalsOfContinuousStates(MODEL_EXCHANGE; _nominals: *mut f64, _count: usize);
    fmi3GetNumberOfEventIndicators(MODEL_EXCHANGE; _count: *mut usize);
    fmi3GetNumberOfContinuousStates(MODEL_EXCHANGE; _count: *mut usize);
}
