//! Initialisation, termination and reset.

use crate::{
    fmi3::{Boolean, Done, Event, Opaque, call},
    logging::Status,
};

/// Starts initialisation; the tolerance is not used, the step size is a parameter.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3EnterInitializationMode(
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
        call("fmi3EnterInitializationMode", instance, |instance| {
            instance.enter_initialization(start_time, stop_s)?;
            Ok(Done::Event(Event::Initializing {
                start_s: start_time,
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
unsafe extern "C" fn fmi3ExitInitializationMode(instance: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi3ExitInitializationMode", instance, |instance| {
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
unsafe extern "C" fn fmi3Terminate(instance: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi3Terminate", instance, |instance| {
            instance.terminate()?;
            Ok(Done::Event(Event::Terminated {
                time_s: instance.time_s(),
            }))
        })
    }
}

/// Back to the start values, in any state.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3Reset(instance: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi3Reset", instance, |instance| {
            instance.reset();
            Ok(Done::Event(Event::Reset))
        })
    }
}
