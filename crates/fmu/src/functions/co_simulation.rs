//! The communication step, with and without the importer's part in it.

use super::Fmi2Boolean;
use crate::{
    abi::{
        Done, Function, Opaque, Way,
        arguments::{Output, output, outputs},
        call, conclude, guarded,
        handle::{self, Fmi3Boolean, Handle, IntermediateUpdate},
        refuse_handle,
        shortcut::taken,
    },
    instance::{Instance, Update},
    logging::Status,
    refusal::{Refusal, Warning},
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
    current_s: f64,
    interval_s: f64,
    _no_set_fmu_state_prior: Fmi2Boolean,
) -> Status {
    const FUNCTION: Function = Function::new("fmi2DoStep", Way::PLAIN);
    let shortcut = |handle: &mut Handle| handle.instance.step_steadily(current_s, interval_s);
    // SAFETY: the importer's promise
    unsafe {
        if taken(FUNCTION.abi, instance, shortcut) {
            return Status::Ok;
        }
        call(FUNCTION, instance, |instance| {
            instance.step(current_s, interval_s)
        })
    }
}

/// What a communication step tells the importer beside its status.
#[derive(Clone, Copy)]
struct Results {
    early_return: Output<Fmi3Boolean>,
    last_successful_time: Output<f64>,
}

/// Advances the instance: to the end of the step, or to where the importer has asked for an early return; after an
/// error it is where it was.
///
/// # Safety
///
/// `instance` as for every function; the four last arguments point to one value each.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DoStep(
    instance: Opaque,
    current_s: f64,
    interval_s: f64,
    _no_set_fmu_state_prior: Fmi3Boolean,
    event_handling_needed: *mut Fmi3Boolean,
    terminate_simulation: *mut Fmi3Boolean,
    early_return: *mut Fmi3Boolean,
    last_successful_time: *mut f64,
) -> Status {
    let flags = [event_handling_needed, terminate_simulation, early_return];
    let shortcut = |handle: &mut Handle| {
        let is_steady = !event_handling_needed.is_null()
            && !terminate_simulation.is_null()
            && !early_return.is_null()
            && !last_successful_time.is_null()
            && last_successful_time.is_aligned()
            && handle.intermediate_update.is_none()
            && handle.instance.step_steadily(current_s, interval_s);
        if is_steady {
            for flag in flags {
                // SAFETY: not null; the rest is the importer's promise
                unsafe { flag.write(0) };
            }
            // SAFETY: not null and aligned; the rest is the importer's promise
            unsafe { last_successful_time.write(handle.instance.time_s()) };
        }
        is_steady
    };
    // SAFETY: the importer's promise
    unsafe {
        if taken(Abi::Fmi3, instance, shortcut) {
            return Status::Ok;
        }
        do_step(
            instance,
            [current_s, interval_s],
            flags,
            last_successful_time,
        )
    }
}

/// # Safety
///
/// As for [`fmi3DoStep`].
#[cold]
unsafe fn do_step(
    instance: Opaque,
    [current_s, interval_s]: [f64; 2],
    [event_handling_needed, terminate_simulation, early_return]: [*mut Fmi3Boolean; 3],
    last_successful_time: *mut f64,
) -> Status {
    let this = Function::new("fmi3DoStep", Way::PLAIN);
    // SAFETY: the importer's promise
    let Some(handle) = (unsafe { handle::from_c(Abi::Fmi3, instance) }) else {
        // SAFETY: the importer's promise
        return unsafe { refuse_handle(this, instance) };
    };
    // SAFETY: the importer's promise
    let results = || unsafe {
        let flags = outputs([
            (event_handling_needed, "eventHandlingNeeded"),
            (terminate_simulation, "terminateSimulation"),
            (early_return, "earlyReturn"),
        ])?;
        for flag in flags {
            flag.write(0);
        }
        let [.., early_return] = flags;
        Ok(Results {
            early_return,
            last_successful_time: output(last_successful_time, "lastSuccessfulTime")?,
        })
    };
    let results = match results() {
        Ok(results) => results,
        Err(refusal) => return conclude(this, handle, Err(refusal)),
    };
    results.last_successful_time.write(handle.instance.time_s());
    if let Some(update) = handle.intermediate_update {
        // SAFETY: the importer's promise; the reference to the instance is not used any more
        return unsafe { step_together(this, instance, update, [current_s, interval_s], results) };
    }
    match guarded(|| handle.instance.step(current_s, interval_s)) {
        Ok(warning) => {
            results.last_successful_time.write(handle.instance.time_s());
            match warning {
                None => Status::Ok,
                warning => conclude(this, handle, Ok(Done::from(warning))),
            }
        }
        Err(refusal) => conclude(this, handle, Err(refusal)),
    }
}

/// Takes a communication step in which the importer takes part.
///
/// # Safety
///
/// `instance` is a living instance, to which no reference is alive.
#[cold]
unsafe fn step_together(
    this: Function,
    instance: Opaque,
    update: IntermediateUpdate,
    [current_s, interval_s]: [f64; 2],
    results: Results,
) -> Status {
    // SAFETY: the caller's promise
    let outcome = unsafe { take_turns(instance, update, [current_s, interval_s]) };
    // SAFETY: the callback cannot have freed the instance, and its references have ended
    let Some(handle) = (unsafe { handle::from_c(Abi::Fmi3, instance) }) else {
        return Status::Error;
    };
    results.last_successful_time.write(handle.instance.time_s());
    let outcome = outcome.map(|(early, warning)| {
        results.early_return.write(u8::from(early));
        Done::from(warning)
    });
    conclude(this, handle, outcome)
}

/// Goes from one call of the importer's callback to the next, to the end of the communication step; tells whether that
/// is early.
///
/// # Safety
///
/// As for [`step_together`].
unsafe fn take_turns(
    instance: Opaque,
    update: IntermediateUpdate,
    [current_s, interval_s]: [f64; 2],
) -> Result<(bool, Option<Warning>), Refusal> {
    let early_return_allowed = update.early_return_allowed;
    // SAFETY: the caller's promise
    let mut step = unsafe {
        with(instance, |instance| {
            instance.begin_step(current_s, interval_s, early_return_allowed)
        })
    }?;
    // SAFETY: the caller's promise; no reference to the instance is alive when the callback has the word
    unsafe {
        while let Some(next) = with(instance, |instance| instance.proceed(&mut step))? {
            let early_return_s = call_back(instance, update, next);
            with(instance, |instance| {
                instance.resume(&mut step, early_return_s)
            })?;
        }
        with(instance, |instance| Ok(instance.finish_step(&step)))
    }
}

/// Gives the word to the importer; returns the time at which it wants the step to end, if it does.
///
/// # Safety
///
/// As for [`step_together`].
unsafe fn call_back(instance: Opaque, update: IntermediateUpdate, next: Update) -> Option<f64> {
    let mut early_return_requested = 0;
    let mut early_return_time = next.time_s;
    // SAFETY: the caller's promise, and the importer's for its callback
    unsafe {
        set_inside_step(instance, true);
        (update.callback)(
            update.environment,
            next.time_s,
            u8::from(next.set_requested),
            u8::from(next.get_allowed),
            u8::from(next.step_finished),
            u8::from(update.early_return_allowed),
            &raw mut early_return_requested,
            &raw mut early_return_time,
        );
        set_inside_step(instance, false);
    }
    (early_return_requested != 0).then_some(early_return_time)
}

/// # Safety
///
/// As for [`step_together`].
unsafe fn set_inside_step(instance: Opaque, inside: bool) {
    // SAFETY: the caller's promise
    if let Some(handle) = unsafe { handle::from_c_inside(Abi::Fmi3, instance) } {
        handle.set_inside_step(inside);
    }
}

/// Runs `body` on the instance, with a reference that lives only as long.
///
/// # Safety
///
/// As for [`step_together`].
unsafe fn with<T>(
    instance: Opaque,
    body: impl FnOnce(&mut Instance) -> Result<T, Refusal>,
) -> Result<T, Refusal> {
    // SAFETY: the caller's promise
    let handle = unsafe { handle::from_c(Abi::Fmi3, instance) }.ok_or(Refusal::Internal)?;
    guarded(|| body(&mut handle.instance))
}
