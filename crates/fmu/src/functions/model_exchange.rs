//! Model Exchange: time, states and their derivatives.

use super::{Fmi2Boolean, functions};
use crate::{
    abi::{
        arguments::{array, array_mut, output, outputs},
        handle::Fmi3Boolean,
    },
    instance::Instance,
    refusal::{Refusal, Warning},
};

functions! {
    /// Checks the states that a step of the importer's solver has led to, and moves on to them what the joint remembers.
    fmi2CompletedIntegratorStep(
        _no_set_fmu_state_prior: Fmi2Boolean, enter_event_mode: *mut Fmi2Boolean, terminate_simulation: *mut Fmi2Boolean,
    ) for EXCHANGE => |instance| complete_integrator_step(instance, [enter_event_mode, terminate_simulation]);

    /// Checks the states that a step of the importer's solver has led to, and moves on to them what the joint remembers.
    fmi3CompletedIntegratorStep(
        _no_set_fmu_state_prior: Fmi3Boolean, enter_event_mode: *mut Fmi3Boolean, terminate_simulation: *mut Fmi3Boolean,
    ) for EXCHANGE => |instance| complete_integrator_step(instance, [enter_event_mode, terminate_simulation]);

    /// Sets the time.
    fmi2SetTime, fmi3SetTime(time_s: f64) for EXCHANGE => |instance| instance.set_time(time_s);

    /// Sets all states, or none.
    fmi2SetContinuousStates, fmi3SetContinuousStates(states: *const f64, count: usize) for EXCHANGE =>
        |instance| instance.set_continuous_states(array(states, count, instance.words().states)?);

    /// Reads all states.
    fmi2GetContinuousStates, fmi3GetContinuousStates(states: *mut f64, count: usize) for EXCHANGE =>
        |instance| instance.continuous_states(array_mut(states, count, instance.words().states)?);

    /// Reads the derivatives of all states.
    fmi2GetDerivatives, fmi3GetContinuousStateDerivatives(derivatives: *mut f64, count: usize) for EXCHANGE =>
        |instance| instance.derivatives(array_mut(derivatives, count, "derivatives")?);

    /// Reads typical magnitudes of all states.
    fmi2GetNominalsOfContinuousStates, fmi3GetNominalsOfContinuousStates(nominals: *mut f64, count: usize) for EXCHANGE =>
        |instance| instance.nominals(array_mut(nominals, count, instance.words().nominals)?);

    /// Reads all event indicators.
    fmi2GetEventIndicators, fmi3GetEventIndicators(event_indicators: *mut f64, count: usize) for EXCHANGE =>
        |instance| {
            instance.check_indicator_count(count)?;
            instance.event_indicators(array_mut(event_indicators, count, "eventIndicators")?)
        };

    /// Number of event indicators.
    fmi3GetNumberOfEventIndicators(count: *mut usize) for EXCHANGE =>
        |instance| output(count, instance.words().indicator_count).map(|count| count.write(instance.indicator_count()));

    /// Number of continuous states.
    fmi3GetNumberOfContinuousStates(count: *mut usize) for EXCHANGE =>
        |instance| output(count, instance.words().state_count).map(|count| count.write(instance.state_count()));
}

/// # Safety
///
/// As for [`outputs`].
unsafe fn complete_integrator_step<B: From<bool>>(
    instance: &mut Instance,
    [enter_event_mode, terminate_simulation]: [*mut B; 2],
) -> Result<Option<Warning>, Refusal> {
    // SAFETY: the caller's promise
    let flags = unsafe {
        outputs([
            (enter_event_mode, "enterEventMode"),
            (terminate_simulation, "terminateSimulation"),
        ])
    }?;
    for flag in flags {
        flag.write(B::from(false));
    }
    instance.complete_integrator_step()
}
