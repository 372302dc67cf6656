//! Time span, initialisation, termination and reset.

use crate::{
    fmi2::{Boolean, Done, Event, Opaque, call},
    logging::Status,
};

/// Sets the time span; the tolerance is not used, the step size is a parameter.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetupExperiment(
    instance: Opaque,
    _tolerance_defined: Boolean,
    _tolerance: f64,
    start_time: f64,
    stop_time_defined: Boolean,
    stop_time: f64,
) -> Status {
    let stop_s = (stop_time_defined != 0).then_some(stop_time);
    // SAFETY: the importer's promise
    unsafe {
        call("fmi2SetupExperiment", instance, |instance| {
            instance.set_up_experiment(start_time, stop_s)?;
            Ok(Done::Silently)
        })
    }
}

/// Starts initialisation, at the start time that was set before.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2EnterInitializationMode(instance: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi2EnterInitializationMode", instance, |instance| {
            instance.enter_initialization_of_experiment()?;
            Ok(Done::Event(Event::Initializing {
                start_s: instance.time_s(),
            }))
        })
    }
}

/// Ends initialisation: the parameters are checked and take effect.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2ExitInitializationMode(instance: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi2ExitInitializationMode", instance, |instance| {
            instance.exit_initialization().map(Done::from)
        })
    }
}

/// Ends the simulation.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2Terminate(instance: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi2Terminate", instance, |instance| {
            instance.terminate()?;
            Ok(Done::Event(Event::Terminated {
                time_s: instance.time_s(),
            }))
        })
    }
}

/// Back to the start values, in any state; the time span has to be set again.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2Reset(instance: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi2Reset", instance, |instance| {
            instance.reset();
            Ok(Done::Event(Event::Reset))
        })
    }
}
