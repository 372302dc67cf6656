//! Events: where the importer lets inputs and parameters jump, and in Model Exchange where a joint that remembers has turned.

use super::Instance;
use crate::{
    interface::InterfaceType,
    mode::Mode,
    refusal::{Active, Refusal, Warning},
    version::Abi,
};

impl Instance {
    /// The importer of this instance for Co-Simulation handles events.
    pub(crate) fn use_event_mode(&mut self) {
        self.event_mode_used = true;
    }

    /// To an event, from Continuous-Time Mode or Step Mode.
    pub(crate) fn enter_event_mode(&mut self) -> Result<(), Refusal> {
        match self.interface_type() {
            // FMI 2.0 lets an event follow an event
            InterfaceType::ModelExchange => {
                self.require(match self.identity.abi {
                    Abi::Fmi2 => &[Mode::Event, Mode::ContinuousTime],
                    Abi::Fmi3 => &[Mode::ContinuousTime],
                })?;
                self.pass_event();
            }
            InterfaceType::CoSimulation => {
                self.require_event_mode()?;
                self.require(&[Mode::Step])?;
            }
        }
        self.mode = Mode::Event;
        Ok(())
    }

    /// Moves what the joint remembers on to the event, before anything jumps there. A motion that cannot be remembered stays
    /// without effect here: the end of a step tells.
    fn pass_event(&mut self) {
        let time_s = self.time_s();
        let is_new = self.mode == Mode::ContinuousTime;
        if is_new && self.model.commit(&mut self.values, time_s).is_ok() {
            self.model.pass_event(&mut self.values);
            self.outputs_stale = true;
        }
    }

    /// All that changes by itself has changed where the event was entered; this only tells whether the call is allowed.
    pub(crate) fn update_discrete_states(&self) -> Result<(), Refusal> {
        if self.interface_type() == InterfaceType::CoSimulation {
            self.require_event_mode()?;
        }
        self.require(&[Mode::Event])
    }

    /// From an event on to communication steps: parameters that were changed take effect.
    pub(crate) fn enter_step_mode(&mut self) -> Result<Option<Warning>, Refusal> {
        self.require_type(InterfaceType::CoSimulation)?;
        self.require_event_mode()?;
        self.require(&[Mode::Event])?;
        let active = self.use_parameters()?;
        self.mode = Mode::Step;
        Ok(Warning::of(active, None))
    }

    /// Takes parameters that were changed into use.
    pub(super) fn use_parameters(&mut self) -> Result<Option<Active>, Refusal> {
        if !self.parameters_changed {
            return Ok(None);
        }
        let active = self.prepare_model()?;
        self.parameters_changed = false;
        Ok(active)
    }

    fn require_event_mode(&self) -> Result<(), Refusal> {
        if self.event_mode_used {
            Ok(())
        } else {
            Err(Refusal::EventModeNotUsed)
        }
    }
}
