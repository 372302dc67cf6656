//! The communication step.

use crate::{
    fmi3::{Boolean, Done, Opaque, arguments::output, call},
    logging::Status,
};

/// Advances the instance; it reaches the end of the step, or stays where it was.
///
/// # Safety
///
/// `instance` as for every function; the four last arguments point to one value each.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DoStep(
    instance: Opaque,
    current_communication_point: f64,
    communication_step_size: f64,
    _no_set_fmu_state_prior_to_current_point: Boolean,
    event_handling_needed: *mut Boolean,
    terminate_simulation: *mut Boolean,
    early_return: *mut Boolean,
    last_successful_time: *mut f64,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi3DoStep", instance, |instance| {
            let event_handling_needed = output(event_handling_needed, "eventHandlingNeeded")?;
            let terminate_simulation = output(terminate_simulation, "terminateSimulation")?;
            let early_return = output(early_return, "earlyReturn")?;
            let last_successful_time = output(last_successful_time, "lastSuccessfulTime")?;
            event_handling_needed.write(0);
            terminate_simulation.write(0);
            early_return.write(0);
            last_successful_time.write(instance.time_s());
            let warning = instance.step(current_communication_point, communication_step_size)?;
            last_successful_time.write(instance.time_s());
            Ok(Done::from(warning))
        })
    }
}
