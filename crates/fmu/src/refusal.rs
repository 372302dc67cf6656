//! Why a call is refused or answered with a warning: what was found, what was expected, what to do.

use std::fmt;

use crate::{
    abi::Abi,
    fmu_state::Damage,
    interface::{InterfaceType, Role},
    mode::Mode,
    models::SUBSTEPS_MAX,
    resources::ResourceError,
    start_file::StartFileError,
};

/// Reason for an error status.
///
/// After most of them the instance is exactly as it was before the call, its mode included, so that the importer may
/// mend the call and go on; [`Refusal::ends_the_simulation`] tells the others.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Refusal {
    /// The call is not allowed in this mode.
    WrongMode {
        found: Mode,
        expected: &'static [Mode],
    },
    /// The function belongs to another FMI version.
    OtherAbi { found: Abi, expected: Abi },
    /// The importer's callback calls what is not allowed within a communication step.
    InsideStep,
    /// The importer handles events though it has said that it does not.
    EventModeNotUsed,
    /// The function belongs to another interface type.
    OtherInterfaceType {
        found: InterfaceType,
        expected: InterfaceType,
    },
    /// No variable has this value reference.
    UnknownReference { reference: u32 },
    /// The variable exists, but not in this type.
    NotOfType {
        name: &'static str,
        own: &'static str,
        asked: &'static str,
    },
    /// The variable must not be set, or not in this mode.
    NotSettable {
        name: &'static str,
        role: Role,
        mode: Mode,
    },
    /// The variable is out of reach within a communication step.
    NotIntermediate {
        name: &'static str,
        reason: NotIntermediate,
    },
    /// The importer asks for an early return that it was not offered.
    EarlyReturnNotAllowed,
    /// The importer asks for an early return outside of the step.
    EarlyReturnTime {
        found_s: f64,
        start_s: f64,
        end_s: f64,
    },
    /// Variables are required within communication steps, but there is no callback.
    NoIntermediateUpdate,
    /// A value to set is NaN or infinite.
    ValueNotFinite { name: &'static str, value: f64 },
    /// A calculated output is NaN or infinite.
    OutputNotFinite {
        name: &'static str,
        unit: &'static str,
        time_s: f64,
    },
    /// A derivative with respect to time is asked of a variable that has none to give.
    NoOutputDerivative { name: &'static str, role: Role },
    /// A derivative with respect to time is given for a variable that is no input.
    NoInputDerivative { name: &'static str, role: Role },
    /// A derivative with respect to time has an order that is not offered.
    DerivativeOrder {
        name: &'static str,
        found: i32,
        highest: usize,
    },
    /// The derivatives of an input take it past what is finite within a step.
    InputNotFinite { name: &'static str, time_s: f64 },
    /// There are no partial derivatives in this mode.
    NoDerivatives { mode: Mode },
    /// The variable is no unknown that can be differentiated in this mode.
    NotUnknown {
        name: &'static str,
        role: Role,
        mode: Mode,
    },
    /// The variable is no known that can be differentiated by.
    NotKnown { name: &'static str, role: Role },
    /// A seed is NaN or infinite.
    SeedNotFinite { name: &'static str, seed: f64 },
    /// A partial derivative overflows.
    DerivativeNotFinite { name: &'static str, time_s: f64 },
    /// A pointer argument is null.
    NullPointer { argument: &'static str },
    /// A pointer argument is not aligned, or the array behind it cannot exist.
    BadArray { argument: &'static str },
    /// A string argument is not UTF-8.
    NotUtf8 { argument: &'static str },
    /// A string argument is empty.
    Empty { argument: &'static str },
    /// Arrays that belong together differ in length.
    Count {
        argument: &'static str,
        found: usize,
        expected: usize,
    },
    /// An array of states has the wrong length.
    StateCount {
        argument: &'static str,
        found: usize,
        expected: usize,
    },
    /// Event indicators are asked for.
    IndicatorCount {
        argument: &'static str,
        found: usize,
    },
    /// The memory for a serialised FMU state has the wrong size, in bytes.
    Size { found: usize, expected: usize },
    /// The start time is NaN or infinite.
    StartTime { found_s: f64 },
    /// The stop time is not a number after the start time.
    StopTime { start_s: f64, found_s: f64 },
    /// The time is NaN or infinite.
    Time { found_s: f64 },
    /// The communication step is not positive and finite.
    StepSize { found_s: f64 },
    /// The communication step is too small to change the time.
    StepVanishes { current_s: f64, interval_s: f64 },
    /// The importer's time is not the FMU's.
    CommunicationPoint { found_s: f64, expected_s: f64 },
    /// The step would pass the stop time.
    PastStop { end_s: f64, stop_s: f64 },
    /// The communication step needs more Runge–Kutta steps than anyone can wait for.
    TooManySubsteps {
        interval_s: f64,
        step_size_max_s: f64,
    },
    /// An inertia is not positive.
    Inertia {
        name: &'static str,
        unit: &'static str,
        found: f64,
    },
    /// A parameter that the dynamics cannot use.
    NotUsable,
    /// The longest Runge–Kutta step is not positive.
    StepSizeMax { found_s: f64 },
    /// Runge–Kutta steps of this length would diverge.
    UnstableStep { step_s: f64, advised_s: f64 },
    /// The relative displacement is past the point where a softening joint holds.
    Escape {
        a: &'static str,
        b: &'static str,
        unit: &'static str,
        relative: f64,
        amplitude: f64,
        time_s: f64,
    },
    /// A state is NaN or infinite.
    StateNotFinite { name: &'static str, time_s: f64 },
    /// A log category that the model description does not define.
    UnknownCategory { found: String },
    /// An FMU state that this library did not make.
    ForeignState,
    /// An FMU state of another FMU.
    OtherFmu { found: String, expected: String },
    /// Serialised bytes that are no FMU state.
    Damaged(Damage),
    /// The importer's token is not that of the FMU's resources.
    Token {
        argument: &'static str,
        found: String,
        expected: String,
    },
    /// An instance is asked for that is neither for Model Exchange nor for Co-Simulation.
    FmuType { found: i32 },
    /// A communication step shall be cancelled, but none is under way.
    NoStepUnderWay { mode: Mode },
    /// A status of the communication step that cannot be told.
    NoStatus { kind: i32 },
    /// A function or an option that this FMU does not offer.
    NotProvided { reason: &'static str },
    /// The FMU's resources cannot be found.
    Resource(ResourceError),
    /// The start-value file cannot be used.
    StartFile(StartFileError),
    /// A defect of the library itself.
    Internal,
}

/// Why a variable is out of reach within a communication step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NotIntermediate {
    /// The model description does not offer it.
    NotOffered,
    /// It was not among those that the importer said it would use.
    NotRequired,
    /// The callback was not told that it may read.
    NoGet,
    /// The callback was not asked to set inputs.
    NoSet,
}

impl fmt::Display for NotIntermediate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotOffered => "has no intermediateUpdate in modelDescription.xml",
            Self::NotRequired => {
                "cannot be accessed within a communication step: it is not among the requiredIntermediateVariables"
            }
            Self::NoGet => "cannot be read now: intermediateVariableGetAllowed is fmi3False",
            Self::NoSet => "cannot be set now: intermediateVariableSetRequested is fmi3False",
        })
    }
}

impl Refusal {
    /// Whether there is nothing to go on from: the motion diverged during a step, or the library itself failed.
    ///
    /// The instance is then Terminated, with the values of the last communication point; a restored state or a reset
    /// brings it back. FMI 3.0, 2.3.1 has an FMU terminate after any error. Where the call alone was wrong, this
    /// library goes on: an importer that stops nevertheless loses nothing.
    pub(crate) const fn ends_the_simulation(&self) -> bool {
        matches!(
            self,
            Self::Escape { .. } | Self::StateNotFinite { .. } | Self::Internal
        )
    }

    /// Whether FMI 2.0 answers this with `fmi2Discard` (2.1.3, 4.2.3): a status that there is not; and, if the importer's
    /// solver is at work, numbers that are not finite, for which a shorter step may help.
    pub(crate) const fn is_discarded(&self, solver_at_work: bool) -> bool {
        match self {
            Self::NoStatus { .. } => true,
            Self::ValueNotFinite { .. } | Self::OutputNotFinite { .. } => solver_at_work,
            _ => false,
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WrongMode { found, expected } => {
                write!(f, "is not allowed in state {found}, only in ")?;
                for (index, mode) in expected.iter().enumerate() {
                    let separator = if index == 0 { "" } else { " or " };
                    write!(f, "{separator}{mode}")?;
                }
                if *found == Mode::Terminated {
                    f.write_str("; reset the instance or restore a saved state to continue")?;
                }
                Ok(())
            }
            Self::OtherAbi { found, expected } => write!(
                f,
                "belongs to {}, but the instance was made by the functions of {}; use only one of them",
                expected.name(),
                found.name()
            ),
            Self::InsideStep => f.write_str(
                "is not allowed in state Intermediate Update Mode, only when the communication step has ended",
            ),
            Self::EventModeNotUsed => f.write_str(
                "is not allowed: the instance was made with eventModeUsed = fmi3False",
            ),
            Self::OtherInterfaceType { found, expected } => write!(
                f,
                "is not provided by this FMU: it belongs to {}, the instance is for {}",
                expected.name(),
                found.name()
            ),
            Self::UnknownReference { reference } => write!(
                f,
                "value reference {reference} does not exist; take it from modelDescription.xml"
            ),
            Self::NotOfType { name, own, asked } => write!(
                f,
                "variable {name} is of type {own}, not {asked}; use the {own} function"
            ),
            Self::NotSettable { name, role, mode } => {
                write!(f, "variable {name} is {role} and cannot be set in state {mode}")?;
                match (role, mode) {
                    (Role::Parameter, Mode::Step | Mode::ContinuousTime) => {
                        f.write_str("; enter Event Mode first")
                    }
                    _ => Ok(()),
                }
            }
            Self::NotIntermediate { name, reason } => {
                write!(f, "variable {name} {reason}")
            }
            Self::EarlyReturnNotAllowed => f.write_str(
                "earlyReturnRequested was set by the callback though canReturnEarly was fmi3False: the instance was \
                 made with earlyReturnAllowed = fmi3False",
            ),
            Self::EarlyReturnTime { found_s, start_s, end_s } => write!(
                f,
                "earlyReturnTime is {found_s} s, expected a time within the step from {start_s} s to {end_s} s"
            ),
            Self::NoIntermediateUpdate => f.write_str(
                "requiredIntermediateVariables is not empty, but the callback intermediateUpdate is a null pointer",
            ),
            Self::ValueNotFinite { name, value } => {
                write!(f, "variable {name} cannot be set to {value}; expected a finite number")
            }
            Self::OutputNotFinite { name, unit, time_s } => write!(
                f,
                "variable {name} overflows at t = {time_s} s: its inputs and parameters give no finite number in {unit}"
            ),
            Self::NoOutputDerivative { name, role } => write!(
                f,
                "variable {name} is {role} and no output; ask for the derivative of an output"
            ),
            Self::NoInputDerivative { name, role } => write!(
                f,
                "variable {name} is {role} and no input; derivatives can be given for inputs alone"
            ),
            Self::DerivativeOrder { name, found, highest: 1 } => write!(
                f,
                "the order of the derivative of variable {name} is {found}, expected 1"
            ),
            Self::DerivativeOrder { name, found, highest } => write!(
                f,
                "the order of the derivative of variable {name} is {found}, expected 1 to {highest}"
            ),
            Self::InputNotFinite { name, time_s } => write!(
                f,
                "input {name} overflows before t = {time_s} s with the derivatives that were given; give others or \
                 take a shorter step"
            ),
            Self::NoDerivatives { mode } => write!(
                f,
                "is not allowed in state {mode}; partial derivatives are there from Initialization Mode on, at \
                 communication points"
            ),
            Self::NotUnknown { name, role, mode } => write!(
                f,
                "variable {name} is {role} and no unknown in state {mode}; ask for the derivative of an output"
            ),
            Self::NotKnown { name, role } => write!(
                f,
                "variable {name} is {role} and no known; differentiate by inputs, states and parameters"
            ),
            Self::SeedNotFinite { name, seed } => {
                write!(f, "the seed of variable {name} is {seed}; expected a finite number")
            }
            Self::DerivativeNotFinite { name, time_s } => write!(
                f,
                "the derivative for variable {name} overflows at t = {time_s} s with this seed"
            ),
            Self::NullPointer { argument } => write!(f, "argument {argument} is a null pointer"),
            Self::BadArray { argument } => {
                write!(f, "argument {argument} does not point to an array of that type and length")
            }
            Self::NotUtf8 { argument } => write!(f, "argument {argument} is not UTF-8"),
            Self::Empty { argument } => write!(f, "argument {argument} is an empty string"),
            Self::Count { argument, found, expected } => write!(
                f,
                "argument {argument} is {found}, expected {expected}: every variable is a scalar"
            ),
            Self::StateCount { argument, found, expected } => write!(
                f,
                "argument {argument} is {found}, expected {expected}, the number of continuous states"
            ),
            Self::IndicatorCount { argument, found } => write!(
                f,
                "argument {argument} is {found}, expected 0: there are no event indicators"
            ),
            Self::Size { found, expected } => write!(
                f,
                "argument size is {found}, but the serialised FMU state has {expected} bytes"
            ),
            Self::StartTime { found_s } => write!(f, "startTime is {found_s}, expected a finite number"),
            Self::StopTime { start_s, found_s } => write!(
                f,
                "stopTime is {found_s}, expected a finite number not before startTime = {start_s} s"
            ),
            Self::Time { found_s } => write!(f, "time is {found_s}, expected a finite number"),
            Self::StepSize { found_s } => write!(
                f,
                "communicationStepSize is {found_s}, expected a finite number greater than zero"
            ),
            Self::StepVanishes { current_s, interval_s } => write!(
                f,
                "communicationStepSize = {interval_s} s is lost to rounding at t = {current_s} s; take a longer step"
            ),
            Self::CommunicationPoint { found_s, expected_s } => write!(
                f,
                "currentCommunicationPoint is {found_s} s, but the FMU is at t = {expected_s} s"
            ),
            Self::PastStop { end_s, stop_s } => write!(
                f,
                "the step would end at t = {end_s} s, after stopTime = {stop_s} s"
            ),
            Self::TooManySubsteps { interval_s, step_size_max_s } => write!(
                f,
                "a communication step of {interval_s} s with step_size_max = {step_size_max_s} s takes more than \
                 {SUBSTEPS_MAX} Runge-Kutta steps; shorten the one or raise the other"
            ),
            Self::Inertia { name, unit, found } => write!(
                f,
                "parameter {name} is {found} {unit}, expected a number greater than zero"
            ),
            Self::NotUsable => f.write_str(
                "the parameters give no equations of motion that can be integrated; bring their magnitudes closer together",
            ),
            Self::StepSizeMax { found_s } => write!(
                f,
                "parameter step_size_max is {found_s} s, expected a number greater than zero"
            ),
            Self::UnstableStep { step_s, advised_s } => write!(
                f,
                "Runge-Kutta steps of step_size_max = {step_s} s diverge with these parameters; set step_size_max to \
                 {advised_s:e} s or less"
            ),
            Self::Escape { a, b, unit, relative, amplitude, time_s } => write!(
                f,
                "{a} - {b} = {relative:e} {unit} at t = {time_s} s is past {amplitude:e} {unit}, where the softening \
                 joint no longer holds and the motion diverges; reduce the load or check the cubic stiffness"
            ),
            Self::StateNotFinite { name, time_s } => write!(
                f,
                "state {name} is no finite number at t = {time_s} s: the motion diverges; check loads, parameters and \
                 step_size_max"
            ),
            Self::UnknownCategory { found } => write!(
                f,
                "log category \"{found}\" does not exist; take it from <LogCategories> in modelDescription.xml"
            ),
            Self::ForeignState => f.write_str("argument FMUState was not made by this library, or is already freed"),
            Self::OtherFmu { found, expected } => write!(
                f,
                "the FMU state is that of \"{found}\", but this is \"{expected}\"; states fit only the FMU that they come from"
            ),
            Self::Damaged(damage) => write!(f, "the serialised FMU state cannot be used: {damage}"),
            Self::Token { argument, found, expected } => write!(
                f,
                "{argument} is \"{found}\", but the FMU's resources have \"{expected}\"; \
                 pass the token of the same FMU's modelDescription.xml"
            ),
            Self::FmuType { found } => write!(
                f,
                "fmuType is {found}, expected 0 (fmi2ModelExchange) or 1 (fmi2CoSimulation)"
            ),
            Self::NoStepUnderWay { mode } => write!(
                f,
                "is not allowed in state {mode}: a step is done when fmi2DoStep returns, there is none to cancel"
            ),
            Self::NoStatus { kind } => write!(
                f,
                "has no status of kind {kind}; no step is ever pending, so that there are fmi2LastSuccessfulTime (of \
                 type Real) and fmi2Terminated (of type Boolean) only"
            ),
            Self::NotProvided { reason } => write!(f, "is not provided by this FMU: {reason}"),
            Self::Resource(error) => error.fmt(f),
            Self::StartFile(error) => error.fmt(f),
            Self::Internal => f.write_str("failed by a defect in the FMU's library; please report it"),
        }
    }
}

impl From<StartFileError> for Refusal {
    fn from(error: StartFileError) -> Self {
        Self::StartFile(error)
    }
}

impl From<ResourceError> for Refusal {
    fn from(error: ResourceError) -> Self {
        Self::Resource(error)
    }
}

impl From<Damage> for Refusal {
    fn from(damage: Damage) -> Self {
        Self::Damaged(damage)
    }
}

/// Reason for a warning status: the call did its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Active {
    /// The joint's stiffness matrix is not positive semidefinite.
    pub(crate) joint_stiffness: bool,
    /// The joint's damping matrix is not positive semidefinite.
    pub(crate) joint_damping: bool,
    /// A support has negative stiffness or damping.
    pub(crate) supports: bool,
}

impl Active {
    /// The warning, if there is anything to warn of.
    pub(crate) fn warning(self) -> Option<Self> {
        (self.joint_stiffness || self.joint_damping || self.supports).then_some(self)
    }
}

impl fmt::Display for Active {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [
            (
                self.joint_stiffness,
                "the joint's stiffness matrix is not positive semidefinite",
            ),
            (
                self.joint_damping,
                "the joint's damping matrix is not positive semidefinite",
            ),
            (self.supports, "a support has negative stiffness or damping"),
        ];
        let mut separator = "";
        for (_, part) in parts.iter().filter(|(present, _)| *present) {
            write!(f, "{separator}{part}")?;
            separator = ", ";
        }
        f.write_str(": the model is active and can feed energy into the simulation")
    }
}
