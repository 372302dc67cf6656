//! The time span of FMI 2.0, which the importer tells before it starts initialisation.

use super::Instance;
use crate::{mode::Mode, refusal::Refusal};

impl Instance {
    /// Sets the time span of the simulation: from `start_s` until `stop_s` where the importer knows that. A later call
    /// takes the place of an earlier one.
    pub(crate) fn set_up_experiment(
        &mut self,
        start_s: f64,
        stop_s: Option<f64>,
    ) -> Result<(), Refusal> {
        self.require(&[Mode::Instantiated, Mode::SetUp])?;
        self.set_time_span(start_s, stop_s)?;
        self.mode = Mode::SetUp;
        Ok(())
    }

    /// Starts initialisation of the experiment that was set up.
    pub(crate) fn enter_initialization_of_experiment(&mut self) -> Result<(), Refusal> {
        self.require(&[Mode::SetUp])?;
        self.mode = Mode::Initialization;
        Ok(())
    }
}
