//! Functions that the FMU does not offer: they say so, and why.

use super::functions;
use crate::{abi::ValueReference, refusal::Refusal};

const DISCRETE_STATES: &str =
    "modelDescription.xml has no providesEvaluateDiscreteStates, there are no discrete states";
const CONFIGURATION: &str = "there are no structural parameters";
const DEPENDENCIES: &str =
    "modelDescription.xml has no providesPerElementDependencies; it lists all dependencies itself";
const CLOCKS: &str = "there are no clocks";

/// Defines functions that refuse with a reason, whatever their arguments.
macro_rules! not_provided {
    ($($name:ident($reason:expr; $($argument:ident: $type:ty),*);)*) => {
        functions! {$(
            #[doc = concat!("Not provided: `", stringify!($name), "` logs why and returns fmi3Error.")]
            $name($($argument: $type),*) => |_| Err::<(), _>(Refusal::NotProvided { reason: $reason });
        )*}
    };
}

not_provided! {
    // events and clocked partitions
    fmi3EvaluateDiscreteStates(DISCRETE_STATES;);
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

    // dependencies
    fmi3GetNumberOfVariableDependencies(DEPENDENCIES; _reference: ValueReference, _dependency_count: *mut usize);
    fmi3GetVariableDependencies(DEPENDENCIES;
        _dependent: ValueReference, _element_indices_of_dependent: *mut usize, _independents: *mut ValueReference,
        _element_indices_of_independents: *mut usize, _dependency_kinds: *mut i32, _dependency_count: usize);
}
