//! Event Mode, in Model Exchange and in Co-Simulation.

use crate::{
    fmi3::{Boolean, Done, Opaque, arguments::output, call},
    logging::Status,
};

/// From Continuous-Time Mode, or in Co-Simulation from Step Mode, to Event Mode.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3EnterEventMode(instance: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi3EnterEventMode", instance, |instance| {
            instance.enter_event_mode()?;
            Ok(Done::Silently)
        })
    }
}

/// Tells that nothing changes by itself at an event.
///
/// # Safety
///
/// `instance` as for every function; the other arguments point to one value each.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3UpdateDiscreteStates(
    instance: Opaque,
    discrete_states_need_update: *mut Boolean,
    terminate_simulation: *mut Boolean,
    nominals_of_continuous_states_changed: *mut Boolean,
    values_of_continuous_states_changed: *mut Boolean,
    next_event_time_defined: *mut Boolean,
    next_event_time: *mut f64,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi3UpdateDiscreteStates", instance, |instance| {
            let flags = [
                output(discrete_states_need_update, "discreteStatesNeedUpdate")?,
                output(terminate_simulation, "terminateSimulation")?,
                output(
                    nominals_of_continuous_states_changed,
                    "nominalsOfContinuousStatesChanged",
                )?,
                output(
                    values_of_continuous_states_changed,
                    "valuesOfContinuousStatesChanged",
                )?,
                output(next_event_time_defined, "nextEventTimeDefined")?,
            ];
            let next_event_time = output(next_event_time, "nextEventTime")?;
            instance.update_discrete_states()?;
            for flag in flags {
                flag.write(0);
            }
            next_event_time.write(0.0);
            Ok(Done::Silently)
        })
    }
}

/// From Event Mode to Step Mode: changed parameters are checked and take effect.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3EnterStepMode(instance: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi3EnterStepMode", instance, |instance| {
            instance.enter_step_mode().map(Done::from)
        })
    }
}
