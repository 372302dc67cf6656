//! Time span, initialisation, termination and reset.

use super::{Fmi2Boolean, functions};
use crate::{
    abi::{Event, handle::Fmi3Boolean},
    instance::Instance,
};

functions! {
    /// Sets the time span; the tolerance is not used, the step size is a parameter.
    fmi2SetupExperiment(
        _tolerance_defined: Fmi2Boolean, _tolerance: f64, start_s: f64, stop_defined: Fmi2Boolean, stop_s: f64,
    ) => |instance| instance.set_up_experiment(start_s, (stop_defined != 0).then_some(stop_s));

    /// Starts initialisation, at the start time that was set before.
    fmi2EnterInitializationMode() => |instance| {
        instance.enter_initialization_of_experiment()?;
        Ok(initializing(instance))
    };

    /// Starts initialisation; the tolerance is not used, the step size is a parameter.
    fmi3EnterInitializationMode(
        _tolerance_defined: Fmi3Boolean, _tolerance: f64, start_s: f64, stop_defined: Fmi3Boolean, stop_s: f64,
    ) => |instance| {
        instance.enter_initialization(start_s, (stop_defined != 0).then_some(stop_s))?;
        Ok(initializing(instance))
    };

    /// Ends initialisation: the parameters are checked and take effect.
    fmi2ExitInitializationMode, fmi3ExitInitializationMode() => Instance::exit_initialization;

    /// Ends the simulation.
    fmi2Terminate, fmi3Terminate() => |instance| {
        instance.terminate()?;
        Ok(Event::Terminated { time_s: instance.time_s() })
    };

    /// Back to the start values, in any state; with FMI 2.0 the time span has to be set again.
    fmi2Reset, fmi3Reset() => |instance| {
        instance.reset();
        Ok(Event::Reset)
    };
}

fn initializing(instance: &Instance) -> Event {
    Event::Initializing {
        start_s: instance.time_s(),
    }
}
