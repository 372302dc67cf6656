//! Event Mode, in Model Exchange and, with FMI 3.0, in Co-Simulation. What changes by itself has done so where it is entered.

use super::{Fmi2Boolean, functions};
use crate::{
    abi::{
        arguments::{output, outputs},
        handle::Fmi3Boolean,
    },
    instance::Instance,
};

/// `fmi2EventInfo`.
#[repr(C)]
#[derive(Default)]
struct EventInfo {
    new_discrete_states_needed: Fmi2Boolean,
    terminate_simulation: Fmi2Boolean,
    nominals_of_continuous_states_changed: Fmi2Boolean,
    values_of_continuous_states_changed: Fmi2Boolean,
    next_event_time_defined: Fmi2Boolean,
    next_event_time: f64,
}

functions! {
    /// From Continuous-Time Mode to Event Mode.
    fmi2EnterEventMode() for EXCHANGE => Instance::enter_event_mode;

    /// From Continuous-Time Mode, or in Co-Simulation from Step Mode, to Event Mode.
    fmi3EnterEventMode() => Instance::enter_event_mode;

    /// Tells that nothing changes by itself any more.
    fmi2NewDiscreteStates(event_info: *mut EventInfo) for EXCHANGE => |instance| {
        let event_info = output(event_info, "fmi2eventInfo")?;
        instance.update_discrete_states()?;
        event_info.write(EventInfo::default());
        Ok(())
    };

    /// Tells that nothing changes by itself any more.
    fmi3UpdateDiscreteStates(
        discrete_states_need_update: *mut Fmi3Boolean,
        terminate_simulation: *mut Fmi3Boolean,
        nominals_of_continuous_states_changed: *mut Fmi3Boolean,
        values_of_continuous_states_changed: *mut Fmi3Boolean,
        next_event_time_defined: *mut Fmi3Boolean,
        next_event_time: *mut f64,
    ) => |instance| {
        let flags = outputs([
            (discrete_states_need_update, "discreteStatesNeedUpdate"),
            (terminate_simulation, "terminateSimulation"),
            (nominals_of_continuous_states_changed, "nominalsOfContinuousStatesChanged"),
            (values_of_continuous_states_changed, "valuesOfContinuousStatesChanged"),
            (next_event_time_defined, "nextEventTimeDefined"),
        ])?;
        let next_event_time = output(next_event_time, "nextEventTime")?;
        instance.update_discrete_states()?;
        for flag in flags { flag.write(0); }
        next_event_time.write(0.0);
        Ok(())
    };

    /// From Event Mode to Step Mode: changed parameters are checked and take effect.
    fmi3EnterStepMode() => Instance::enter_step_mode;

    /// From Event Mode to Continuous-Time Mode: changed parameters are checked and take effect.
    fmi2EnterContinuousTimeMode, fmi3EnterContinuousTimeMode() for EXCHANGE => Instance::enter_continuous_time_mode;
}
