//! One instance of an FMU: all behaviour that the FMI functions offer, in safe Rust and independent of the FMI version.

mod derivatives;
mod events;
mod experiment;
mod intermediate;
mod model_exchange;
mod stepping;
mod time_derivatives;

pub(crate) use intermediate::Update;

use std::{mem::MaybeUninit, sync::Arc};

use crate::{
    abi::Abi,
    fmu_state::{Identity, Snapshot},
    input_course::InputCourse,
    interface::{InterfaceType, REFERENCE_COUNT, Role, Roles, Values, reference::TIME},
    mode::Mode,
    models::{self, Model},
    pace::Pace,
    refusal::{Active, Refusal},
    start_file::StartFile,
};

/// Roles whose values are calculated only when somebody asks.
const CALCULATED: Roles = Roles::of(&[Role::Output, Role::Derivative]);

/// Roles whose values are always there.
const AT_HAND: Roles = Roles::of(&[Role::Independent, Role::Parameter, Role::Input, Role::State]);

/// What may be set in every Step Mode.
const INPUTS: Roles = Roles::of(&[Role::Input]);

/// Parameters, after a change of which the model has to be prepared again.
const PARAMETERS: Roles = Roles::of(&[Role::Parameter]);

use intermediate::Access;

/// One instance of an FMU.
pub(crate) struct Instance {
    identity: Arc<Identity>,
    roles: [Roles; REFERENCE_COUNT],
    model: Box<dyn Model>,
    start: Values,
    values: Values,
    inputs: InputCourse,
    mode: Mode,
    stop_s: Option<f64>,
    pace: Pace,
    parameters_changed: bool,
    outputs_stale: bool,
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
        } = file;
        if token != expected {
            return Err(Refusal::Token {
                argument: abi.token_argument(),
                found: token.to_owned(),
                expected,
            });
        }
        Ok(Self {
            identity: Arc::new(Identity {
                variables,
                abi,
                interface_type,
                token: expected,
            }),
            roles: variables.roles(),
            model: models::model(variables),
            start: values,
            values,
            inputs: InputCourse::HELD,
            mode: Mode::Instantiated,
            stop_s: None,
            pace: Pace::NONE,
            parameters_changed: true,
            outputs_stale: true,
            event_mode_used: false,
            access: Access::NONE,
        })
    }

    /// State of the state machine.
    pub(crate) fn mode(&self) -> Mode {
        self.mode
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
    pub(crate) fn exit_initialization(&mut self) -> Result<Option<Active>, Refusal> {
        self.require(&[Mode::Initialization])?;
        let warning = self.prepare_model()?;
        self.parameters_changed = false;
        self.mode = match self.interface_type() {
            InterfaceType::CoSimulation if self.event_mode_used => Mode::Event,
            InterfaceType::CoSimulation => Mode::Step,
            InterfaceType::ModelExchange => Mode::Event,
        };
        Ok(warning)
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
        self.values = self.start;
        self.inputs = InputCourse::HELD;
        self.mode = Mode::Instantiated;
        self.stop_s = None;
        self.pace = Pace::NONE;
        self.parameters_changed = true;
        self.outputs_stale = true;
    }

    /// Reads the variables with these value references; `values` has the same length.
    pub(crate) fn get(
        &mut self,
        references: &[u32],
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), Refusal> {
        if self.mode == Mode::IntermediateUpdate {
            self.check_readable(references)?;
        }
        for (&reference, value) in references.iter().zip(values) {
            let (index, roles) = self.known(reference)?;
            if roles.intersects(CALCULATED) {
                self.calculate_outputs();
                if !self.values[index].is_finite() {
                    return Err(self.overflow(index));
                }
            }
            value.write(self.values[index]);
        }
        Ok(())
    }

    /// Reads variables between communication steps, if none has to be calculated; tells whether all were such.
    #[inline]
    pub(crate) fn get_between_steps(
        &self,
        references: &[u32],
        values: &mut [MaybeUninit<f64>],
    ) -> bool {
        if self.mode != Mode::Step {
            return false;
        }
        for (&reference, value) in references.iter().zip(values) {
            let index = reference as usize;
            match self.roles.get(index) {
                Some(roles) if roles.intersects(AT_HAND) => value.write(self.values[index]),
                _ => return false,
            };
        }
        true
    }

    /// Sets the variables with these value references, all or none; `values` has the same length.
    pub(crate) fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), Refusal> {
        let settable = self.mode.settable(self.identity.abi, self.event_mode_used);
        for (&reference, &value) in references.iter().zip(values) {
            let (index, roles) = self.known(reference)?;
            if !roles.intersects(settable) {
                return Err(self.not_settable(index));
            }
            if !value.is_finite() {
                return Err(Refusal::ValueNotFinite {
                    name: self.name(index),
                    value,
                });
            }
        }
        if self.mode == Mode::IntermediateUpdate {
            self.check_settable(references)?;
        }
        for (&reference, &value) in references.iter().zip(values) {
            let (index, roles) = self.known(reference)?;
            // importers that set every parameter before every step pay only for those that change
            self.parameters_changed |=
                roles.intersects(PARAMETERS) && self.values[index].to_bits() != value.to_bits();
            self.values[index] = value;
        }
        if self.inputs.is_past() {
            self.forget_inputs(references);
        }
        self.outputs_stale = true;
        Ok(())
    }

    /// Sets variables between communication steps, if they are inputs that are held and nothing is wrong; tells whether it
    /// was so, otherwise nothing is set.
    #[inline]
    pub(crate) fn set_between_steps(&mut self, references: &[u32], values: &[f64]) -> bool {
        if self.mode != Mode::Step || self.inputs.is_past() {
            return false;
        }
        for (&reference, value) in references.iter().zip(values) {
            let roles = self.roles.get(reference as usize);
            if !(roles.is_some_and(|roles| roles.intersects(INPUTS)) && value.is_finite()) {
                return false;
            }
        }
        for (&reference, &value) in references.iter().zip(values) {
            if let Some(input) = self.values.get_mut(reference as usize) {
                *input = value;
            }
        }
        self.outputs_stale = true;
        true
    }

    /// Everything that this instance has to remember.
    pub(crate) fn snapshot(&self) -> Snapshot {
        // what is calculated is no part of the state: it follows from the rest, and may not even be finite
        let values = std::array::from_fn(|index| {
            if self.roles[index].intersects(CALCULATED) {
                0.0
            } else {
                self.values[index]
            }
        });
        Snapshot {
            identity: Arc::clone(&self.identity),
            mode: self.mode,
            stop_s: self.stop_s,
            pace: self.pace,
            values,
            inputs: self.inputs,
        }
    }

    /// Goes on from a snapshot of this or another instance of the same FMU.
    pub(crate) fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Refusal> {
        if *snapshot.identity != *self.identity {
            return Err(Refusal::OtherFmu {
                found: snapshot.identity.to_string(),
                expected: self.identity.to_string(),
            });
        }
        self.mode = snapshot.mode;
        self.stop_s = snapshot.stop_s;
        self.pace = snapshot.pace;
        self.values = snapshot.values;
        self.inputs = snapshot.inputs;
        self.parameters_changed = true;
        self.outputs_stale = true;
        Ok(())
    }

    /// The snapshot that these bytes were written from.
    pub(crate) fn deserialize(&self, bytes: &[u8]) -> Result<Snapshot, Refusal> {
        Snapshot::deserialize(bytes, &self.identity)
    }

    /// Refuses access to variables under another type than their own.
    pub(crate) fn refuse_type(
        &self,
        references: &[u32],
        asked: &'static str,
    ) -> Result<(), Refusal> {
        match references.first() {
            None => Ok(()),
            Some(&reference) => {
                let (index, _) = self.known(reference)?;
                Err(Refusal::NotOfType {
                    name: self.name(index),
                    own: self.identity.abi.real(),
                    asked,
                })
            }
        }
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

    /// Index and role of a value reference that this FMU has.
    #[inline]
    fn known(&self, reference: u32) -> Result<(usize, Roles), Refusal> {
        let index = reference as usize;
        match self.roles.get(index) {
            Some(&roles) if roles != Roles::NONE => Ok((index, roles)),
            _ => Err(Refusal::UnknownReference { reference }),
        }
    }

    /// Brings outputs and derivatives up to date.
    #[inline]
    fn calculate_outputs(&mut self) {
        if self.outputs_stale {
            self.model.calculate_outputs(&mut self.values);
            self.outputs_stale = false;
        }
    }

    #[cold]
    fn prepare_model(&mut self) -> Result<Option<Active>, Refusal> {
        let interface_type = self.interface_type();
        self.model.prepare(&self.values, interface_type)
    }

    #[cold]
    fn overflow(&self, index: usize) -> Refusal {
        let variable = self.identity.variables.get(index);
        Refusal::OutputNotFinite {
            name: self.name(index),
            unit: variable.map_or("", |variable| variable.unit),
            time_s: self.time_s(),
        }
    }

    #[cold]
    fn not_settable(&self, index: usize) -> Refusal {
        Refusal::NotSettable {
            name: self.name(index),
            role: self.role(index),
            mode: self.mode,
        }
    }

    fn role(&self, index: usize) -> Role {
        let variable = self.identity.variables.get(index);
        variable.map_or(Role::Output, |variable| variable.role)
    }

    fn name(&self, index: usize) -> &'static str {
        self.identity.variables.name(index)
    }
}
