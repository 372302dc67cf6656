//! The communication step.

use crate::{
    abi::{handle::Handle, shortcut::taken},
    fmi2::{Boolean, Done, Opaque, call, call_for},
    interface::InterfaceType,
    logging::Status,
    refusal::Refusal,
    version::Abi,
};

/// Advances the instance; it reaches the end of the step, or stays where it was.
///
/// `fmi2Discard` would tell that a part of the step was done (FMI 2.0, 4.2.2). That never happens: a step that is not
/// done at all is answered with `fmi2Error`.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2DoStep(
    instance: Opaque,
    current_communication_point: f64,
    communication_step_size: f64,
    _no_set_fmu_state_prior_to_current_point: Boolean,
) -> Status {
    let (current_s, interval_s) = (current_communication_point, communication_step_size);
    let shortcut = |handle: &mut Handle| handle.instance.step_steadily(current_s, interval_s);
    // SAFETY: the importer's promise
    unsafe {
        if taken(Abi::Fmi2, instance, shortcut) {
            return Status::Ok;
        }
        call("fmi2DoStep", instance, |instance| {
            let warning = instance.step(current_s, interval_s)?;
            Ok(Done::from(warning))
        })
    }
}

/// Refuses: there is never a step under way that could be cancelled.
///
/// # Safety
///
/// `instance` as for every function.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2CancelStep(instance: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_for(
            InterfaceType::CoSimulation,
            "fmi2CancelStep",
            instance,
            |instance| {
                Err(Refusal::NoStepUnderWay {
                    mode: instance.mode(),
                })
            },
        )
    }
}
