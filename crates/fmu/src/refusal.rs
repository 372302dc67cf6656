//! Why a call is refused or answered with a warning: what was found, what was expected, what to do.

mod message;
mod warning;

pub(crate) use warning::{Active, Limit, Reached, Warning};

use crate::{
    fmu_state::StateError,
    interface::{InterfaceType, Name, Role},
    mode::Mode,
    resources::ResourceError,
    version::Abi,
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
        name: Name,
        own: &'static str,
        asked: &'static str,
    },
    /// The variable must not be set, or not in this mode.
    NotSettable { name: Name, role: Role, mode: Mode },
    /// The variable is out of reach within a communication step.
    NotIntermediate { name: Name, reason: NotIntermediate },
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
    ValueNotFinite { name: Name, value: f64 },
    /// A calculated output is NaN or infinite.
    OutputNotFinite { name: Name, unit: Name, time_s: f64 },
    /// There is no joint at this preload; `time_s` where the simulation has come to it within a step.
    Preload {
        found_n_m: f64,
        first_n_m: f64,
        last_n_m: f64,
        time_s: Option<f64>,
    },
    /// A derivative with respect to time is asked of a variable that has none to give.
    NoOutputDerivative { name: Name, role: Role },
    /// A derivative with respect to time is given for a variable that is no input.
    NoInputDerivative { name: Name, role: Role },
    /// A derivative with respect to time has an order that is not offered.
    DerivativeOrder {
        name: Name,
        found: i32,
        highest: usize,
    },
    /// The derivatives of an input take it past what is finite within a step.
    InputNotFinite { name: Name, time_s: f64 },
    /// There are no partial derivatives in this mode.
    NoDerivatives { mode: Mode },
    /// The variable is no unknown that can be differentiated in this mode.
    NotUnknown { name: Name, role: Role, mode: Mode },
    /// The variable is no known that can be differentiated by.
    NotKnown { name: Name, role: Role },
    /// A seed is NaN or infinite.
    SeedNotFinite { name: Name, seed: f64 },
    /// A partial derivative overflows.
    DerivativeNotFinite { name: Name, time_s: f64 },
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
    /// An array of event indicators has the wrong length.
    IndicatorCount {
        argument: &'static str,
        found: usize,
        expected: usize,
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
        most: u32,
    },
    /// An inertia is not positive.
    Inertia { name: Name, unit: Name, found: f64 },
    /// A parameter is outside of the range of its law.
    OutsideLaw {
        name: String,
        found: f64,
        expected: String,
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
        unit: Name,
        relative: f64,
        amplitude: f64,
        time_s: f64,
    },
    /// A state is NaN or infinite.
    StateNotFinite { name: Name, time_s: f64 },
    /// The motion would grow beyond all bounds within a step.
    GrowsWithinStep { interval_s: f64, time_s: f64 },
    /// A step of which 4096 parts are too long for the joints of an assembly.
    TooLongForJoints { interval_s: f64, time_s: f64 },
    /// A log category that the model description does not define.
    UnknownCategory { found: String },
    /// An FMU state that this library did not make.
    ForeignState,
    /// An FMU state that cannot be taken up.
    State(StateError),
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
    /// The FMU's resources cannot be found or used.
    Resource(ResourceError),
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
            Self::ValueNotFinite { .. } | Self::OutputNotFinite { .. } | Self::Preload { .. } => {
                solver_at_work
            }
            _ => false,
        }
    }
}

impl From<ResourceError> for Refusal {
    fn from(error: ResourceError) -> Self {
        Self::Resource(error)
    }
}

impl From<StateError> for Refusal {
    fn from(error: StateError) -> Self {
        Self::State(error)
    }
}
