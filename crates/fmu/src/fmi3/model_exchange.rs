//! Model Exchange: modes, time, states and their derivatives.

use crate::{
    fmi3::{
        Boolean, Done, Opaque,
        arguments::{array, array_mut, output},
        call,
    },
    instance::Instance,
    logging::Status,
    refusal::Refusal,
};

/// Runs `body` on an instance for Model Exchange.
///
/// # Safety
///
/// As for [`call`].
unsafe fn call_exchange(
    function: &'static str,
    instance: Opaque,
    body: impl FnOnce(&mut Instance) -> Result<Done, Refusal>,
) -> Status {
    // SAFETY: the caller's promise
    unsafe {
        call(function, instance, |instance| {
            instance.require_model_exchange()?;
            body(instance)
        })
    }
}

/// From Event Mode to Continuous-Time Mode: changed parameters are checked and take effect.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3EnterContinuousTimeMode(instance: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi3EnterContinuousTimeMode", instance, |instance| {
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
unsafe extern "C" fn fmi3CompletedIntegratorStep(
    instance: Opaque,
    _no_set_fmu_state_prior_to_current_point: Boolean,
    enter_event_mode: *mut Boolean,
    terminate_simulation: *mut Boolean,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi3CompletedIntegratorStep", instance, |instance| {
            let enter_event_mode = output(enter_event_mode, "enterEventMode")?;
            let terminate_simulation = output(terminate_simulation, "terminateSimulation")?;
            enter_event_mode.write(0);
            terminate_simulation.write(0);
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
unsafe extern "C" fn fmi3SetTime(instance: Opaque, time: f64) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi3SetTime", instance, |instance| {
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
unsafe extern "C" fn fmi3SetContinuousStates(
    instance: Opaque,
    continuous_states: *const f64,
    count: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi3SetContinuousStates", instance, |instance| {
            instance.set_continuous_states(array(continuous_states, count, "continuousStates")?)?;
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
unsafe extern "C" fn fmi3GetContinuousStates(
    instance: Opaque,
    continuous_states: *mut f64,
    count: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi3GetContinuousStates", instance, |instance| {
            instance.continuous_states(array_mut(continuous_states, count, "continuousStates")?)?;
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
unsafe extern "C" fn fmi3GetContinuousStateDerivatives(
    instance: Opaque,
    derivatives: *mut f64,
    count: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi3GetContinuousStateDerivatives", instance, |instance| {
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
unsafe extern "C" fn fmi3GetNominalsOfContinuousStates(
    instance: Opaque,
    nominals: *mut f64,
    count: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi3GetNominalsOfContinuousStates", instance, |instance| {
            instance.nominals(array_mut(nominals, count, "nominals")?)?;
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
unsafe extern "C" fn fmi3GetEventIndicators(
    instance: Opaque,
    _event_indicators: *mut f64,
    count: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi3GetEventIndicators", instance, |_| match count {
            0 => Ok(Done::Silently),
            found => Err(Refusal::IndicatorCount {
                argument: "nEventIndicators",
                found,
            }),
        })
    }
}

/// Number of event indicators: none.
///
/// # Safety
///
/// `instance` as for every function; the other argument points to one value.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetNumberOfEventIndicators(instance: Opaque, count: *mut usize) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi3GetNumberOfEventIndicators", instance, |_| {
            output(count, "nEventIndicators")?.write(0);
            Ok(Done::Silently)
        })
    }
}

/// Number of continuous states.
///
/// # Safety
///
/// `instance` as for every function; the other argument points to one value.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetNumberOfContinuousStates(
    instance: Opaque,
    count: *mut usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_exchange("fmi3GetNumberOfContinuousStates", instance, |instance| {
            output(count, "nContinuousStates")?.write(instance.state_count());
            Ok(Done::Silently)
        })
    }
}
