//! Model Exchange: modes, time, states and their derivatives.

use crate::{
    fmi2::{
        Boolean, Done, FALSE, Opaque,
        arguments::{array, array_mut, output},
        call_for,
    },
    instance::Instance,
    interface::InterfaceType,
    logging::Status,
    mode::Mode,
    refusal::Refusal,
};

/// `fmi2EventInfo`.
#[repr(C)]
struct EventInfo {
    new_discrete_states_needed: Boolean,
    terminate_simulation: Boolean,
    nominals_of_continuous_states_changed: Boolean,
    values_of_continuous_states_changed: Boolean,
    next_event_time_defined: Boolean,
    next_event_time: f64,
}

/// States in which the equations can be evaluated.
const EVALUATED: &[Mode] = &[
    Mode::Initialization,
    Mode::Event,
    Mode::ContinuousTime,
    Mode::Terminated,
];

/// Runs `body` on an instance for Model Exchange.
///
/// # Safety
///
/// As for [`crate::abi::call`].
unsafe fn call_exchange(
    function: &'static str,
    instance: Opaque,
    body: impl FnOnce(&mut Instance) -> Result<Done, Refusal>,
) -> Status {
    // SAFETY: the caller's promise
    unsafe { call_for(InterfaceType::ModelExchange, function, instance, body) }
}

/// From Continuous-Time Mode to Event Mode.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2EnterEventMode(instance: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi2EnterEventMode", instance, |instance| {
            instance.enter_event_mode()?;
            Ok(Done::Silently)
        })
    }
}

/// Tells that nothing changes by itself at an event.
///
/// # Safety
///
/// `instance` as for every function; `event_info` points to one value.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2NewDiscreteStates(instance: Opaque, event_info: *mut EventInfo) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi2NewDiscreteStates", instance, |instance| {
            let event_info = output(event_info, "fmi2eventInfo")?;
            instance.update_discrete_states()?;
            event_info.write(EventInfo {
                new_discrete_states_needed: FALSE,
                terminate_simulation: FALSE,
                nominals_of_continuous_states_changed: FALSE,
                values_of_continuous_states_changed: FALSE,
                next_event_time_defined: FALSE,
                next_event_time: 0.0,
            });
            Ok(Done::Silently)
        })
    }
}

/// From Event Mode to Continuous-Time Mode: changed parameters are checked and take effect.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2EnterContinuousTimeMode(instance: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi2EnterContinuousTimeMode", instance, |instance| {
            instance.enter_continuous_time_mode().map(Done::from)
        })
    }
}

/// Checks the states that a step of the importer's solver has led to; there are no events.
///
/// # Safety
///
/// `instance` as for every function; the two last arguments point to one value each.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2CompletedIntegratorStep(
    instance: Opaque,
    _no_set_fmu_state_prior_to_current_point: Boolean,
    enter_event_mode: *mut Boolean,
    terminate_simulation: *mut Boolean,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi2CompletedIntegratorStep", instance, |instance| {
            let enter_event_mode = output(enter_event_mode, "enterEventMode")?;
            let terminate_simulation = output(terminate_simulation, "terminateSimulation")?;
            enter_event_mode.write(FALSE);
            terminate_simulation.write(FALSE);
            instance.complete_integrator_step().map(Done::from)
        })
    }
}

/// Sets the time.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetTime(instance: Opaque, time: f64) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi2SetTime", instance, |instance| {
            instance.set_time(time)?;
            Ok(Done::Silently)
        })
    }
}

/// Sets all states, or none.
///
/// # Safety
///
/// `instance` as for every function; the array has the length that is told.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetContinuousStates(
    instance: Opaque,
    states: *const f64,
    count: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi2SetContinuousStates", instance, |instance| {
            instance.set_continuous_states(array(states, count, "x")?)?;
            Ok(Done::Silently)
        })
    }
}

/// Reads all states.
///
/// # Safety
///
/// `instance` as for every function; the array has the length that is told.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetContinuousStates(
    instance: Opaque,
    states: *mut f64,
    count: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi2GetContinuousStates", instance, |instance| {
            instance.continuous_states(array_mut(states, count, "x")?)?;
            Ok(Done::Silently)
        })
    }
}

/// Reads the derivatives of all states.
///
/// # Safety
///
/// `instance` as for every function; the array has the length that is told.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetDerivatives(
    instance: Opaque,
    derivatives: *mut f64,
    count: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi2GetDerivatives", instance, |instance| {
            instance.derivatives(array_mut(derivatives, count, "derivatives")?)?;
            Ok(Done::Silently)
        })
    }
}

/// Reads typical magnitudes of all states.
///
/// # Safety
///
/// `instance` as for every function; the array has the length that is told.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetNominalsOfContinuousStates(
    instance: Opaque,
    nominals: *mut f64,
    count: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi2GetNominalsOfContinuousStates", instance, |instance| {
            instance.nominals(array_mut(nominals, count, "x_nominal")?)?;
            Ok(Done::Silently)
        })
    }
}

/// Reads no event indicator: there are none.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetEventIndicators(
    instance: Opaque,
    _event_indicators: *mut f64,
    count: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi2GetEventIndicators", instance, |instance| {
            instance.require(EVALUATED)?;
            match count {
                0 => Ok(Done::Silently),
                found => Err(Refusal::IndicatorCount {
                    argument: "ni",
                    found,
                }),
            }
        })
    }
}
