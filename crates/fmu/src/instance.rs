//! One instance of an FMU: all behaviour that the FMI functions offer, in safe Rust and independent of the FMI version.

mod derivatives;
mod events;
mod experiment;
mod intermediate;
mod model_exchange;
mod saved_states;
mod stepping;
mod time_derivatives;
mod variables;

pub(crate) use intermediate::Update;

use std::sync::Arc;

use crate::{
    fmu_state::Identity,
    input_course::InputCourse,
    interface::{InterfaceType, Roles, Values, reference::TIME},
    mode::Mode,
    models::{self, Model},
    pace::Pace,
    refusal::{Active, Refusal, Warning},
    start_file::StartFile,
    values::{Inner, StartValues},
    version::{Abi, Words},
};
use intermediate::Access;

/// One instance of an FMU.
pub(crate) struct Instance {
    identity: Arc<Identity>,
    roles: Box<[Roles]>,
    model: Box<dyn Model>,
    start: StartValues,
    values: Values,
    inputs: InputCourse,
    mode: Mode,
    stop_s: Option<f64>,
    pace: Pace,
    parameters_changed: bool,
    outputs_stale: bool,
    /// Whether energies and powers are, though other outputs may not be.
    energies_stale: bool,
    /// Whether that can be: few ask for them.
    has_some_apart: bool,
    event_mode_used: bool,
    access: Access,
}

impl Instance {
    /// Instance of the FMU with these start values, if `token` is its token.
    pub(crate) fn new(
        file: StartFile,
        token: &str,
        abi: Abi,
        interface_type: InterfaceType,
    ) -> Result<Self, Refusal> {
        let StartFile {
            variables,
            token: expected,
            values,
            equations,
        } = file;
        if token != expected {
            return Err(Refusal::Token {
                argument: abi.words().token,
                found: token.to_owned(),
                expected,
            });
        }
        let mut values = values;
        values.set_inner(Inner::of(interface_type));
        Ok(Self {
            roles: variables.roles(),
            model: models::model(equations),
            inputs: InputCourse::held(variables.listed_inputs()),
            has_some_apart: variables.has_some_apart(),
            identity: Arc::new(Identity {
                variables,
                abi,
                interface_type,
                token: expected,
            }),
            start: StartValues::of(&values),
            values,
            mode: Mode::Instantiated,
            stop_s: None,
            pace: Pace::NONE,
            parameters_changed: true,
            outputs_stale: true,
            energies_stale: true,
            event_mode_used: false,
            access: Access::NONE,
        })
    }

    /// State of the state machine.
    pub(crate) fn mode(&self) -> Mode {
        self.mode
    }

    /// The words of the version that the instance is used through.
    #[inline]
    pub(crate) fn words(&self) -> &'static Words {
        self.identity.abi.words()
    }

    /// Current time, s.
    pub(crate) fn time_s(&self) -> f64 {
        self.values[TIME]
    }

    /// Starts initialisation at `start_s`, for a simulation until `stop_s` where the importer knows that.
    pub(crate) fn enter_initialization(
        &mut self,
        start_s: f64,
        stop_s: Option<f64>,
    ) -> Result<(), Refusal> {
        self.require(&[Mode::Instantiated])?;
        self.set_time_span(start_s, stop_s)?;
        self.mode = Mode::Initialization;
        Ok(())
    }

    fn set_time_span(&mut self, start_s: f64, stop_s: Option<f64>) -> Result<(), Refusal> {
        if !start_s.is_finite() {
            return Err(Refusal::StartTime { found_s: start_s });
        }
        if let Some(found_s) = stop_s
            && !(found_s.is_finite() && found_s >= start_s)
        {
            return Err(Refusal::StopTime { start_s, found_s });
        }
        self.values[TIME] = start_s;
        self.stop_s = stop_s;
        Ok(())
    }

    /// Ends initialisation: the parameters take effect. If they cannot, the importer may still set others.
    pub(crate) fn exit_initialization(&mut self) -> Result<Option<Warning>, Refusal> {
        self.require(&[Mode::Initialization])?;
        let active = self.prepare_model()?;
        self.parameters_changed = false;
        self.model.begin(&mut self.values);
        self.outputs_stale = true;
        self.mode = match self.interface_type() {
            InterfaceType::CoSimulation if self.event_mode_used => Mode::Event,
            InterfaceType::CoSimulation => Mode::Step,
            InterfaceType::ModelExchange => Mode::Event,
        };
        Ok(Warning::of(active, None))
    }

    /// Ends the simulation.
    pub(crate) fn terminate(&mut self) -> Result<(), Refusal> {
        self.require(match self.interface_type() {
            InterfaceType::CoSimulation if self.event_mode_used => &[Mode::Step, Mode::Event],
            InterfaceType::CoSimulation => &[Mode::Step],
            InterfaceType::ModelExchange => &[Mode::Event, Mode::ContinuousTime],
        })?;
        self.mode = Mode::Terminated;
        Ok(())
    }

    /// After a failure the simulation must not go on, but values stay readable and earlier states can be restored.
    pub(crate) fn fail(&mut self) {
        self.mode = Mode::Terminated;
    }

    /// Back to where the instance was after instantiation.
    pub(crate) fn reset(&mut self) {
        self.start.restore(&mut self.values);
        self.inputs.hold();
        self.mode = Mode::Instantiated;
        self.stop_s = None;
        self.pace = Pace::NONE;
        self.parameters_changed = true;
        self.outputs_stale = true;
        self.model.reset();
    }

    /// Who integrates.
    pub(crate) fn interface_type(&self) -> InterfaceType {
        self.identity.interface_type
    }

    /// Refuses functions of another interface type than the instance's.
    pub(crate) fn require_type(&self, expected: InterfaceType) -> Result<(), Refusal> {
        let found = self.interface_type();
        if found == expected {
            Ok(())
        } else {
            Err(Refusal::OtherInterfaceType { found, expected })
        }
    }

    /// Refuses calls in other modes.
    #[inline]
    pub(crate) fn require(&self, expected: &'static [Mode]) -> Result<(), Refusal> {
        if expected.contains(&self.mode) {
            Ok(())
        } else {
            Err(Refusal::WrongMode {
                found: self.mode,
                expected,
            })
        }
    }

    #[cold]
    fn prepare_model(&mut self) -> Result<Option<Active>, Refusal> {
        let interface_type = self.interface_type();
        self.model.prepare(&self.values, interface_type)
    }
}
