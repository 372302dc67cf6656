//! Functions that the FMU does not offer: an error, and a message that names the function.

use std::ptr::{null, null_mut};

use crate::{
    c,
    importer::{Instance, Kind},
};

#[test]
fn functions_that_are_not_provided_say_so() {
    macro_rules! check {
        ($($function:ident($($argument:expr),*);)*) => {$({
            let mut instance = Instance::stepping(Kind::Lap, 2, &[]);
            // SAFETY: the function refuses before it looks at its arguments
            let message = instance.refused(|i| unsafe { c::$function(i.handle $(, $argument)*) });
            let expected = concat!(stringify!($function), ": is not provided by this FMU: ");
            assert!(message.starts_with(expected), "{message}");
        })*};
    }
    check! {
        fmi3EnterConfigurationMode();
        fmi3ExitConfigurationMode();
        fmi3EvaluateDiscreteStates();
        fmi3EnterContinuousTimeMode();
        fmi3CompletedIntegratorStep(1, null_mut(), null_mut());
        fmi3SetTime(0.0);
        fmi3SetContinuousStates(null(), 0);
        fmi3GetContinuousStateDerivatives(null_mut(), 0);
        fmi3GetEventIndicators(null_mut(), 0);
        fmi3GetContinuousStates(null_mut(), 0);
        fmi3GetNominalsOfContinuousStates(null_mut(), 0);
        fmi3GetNumberOfEventIndicators(null_mut());
        fmi3GetNumberOfContinuousStates(null_mut());
        fmi3GetNumberOfVariableDependencies(0, null_mut());
        fmi3GetVariableDependencies(0, null_mut(), null_mut(), null_mut(), null_mut(), 0);
        fmi3ActivateModelPartition(0, 0.0);
        fmi3GetIntervalDecimal(null(), 0, null_mut(), null_mut());
        fmi3GetIntervalFraction(null(), 0, null_mut(), null_mut(), null_mut());
        fmi3GetShiftDecimal(null(), 0, null_mut());
        fmi3GetShiftFraction(null(), 0, null_mut(), null_mut());
        fmi3SetIntervalDecimal(null(), 0, null());
        fmi3SetIntervalFraction(null(), 0, null(), null());
        fmi3SetShiftDecimal(null(), 0, null());
        fmi3SetShiftFraction(null(), 0, null(), null());
    }
}
