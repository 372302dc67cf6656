//! The state machines of FMI for Model Exchange and for Co-Simulation (FMI 3.0, 2.3, 3.2.1, 4.2.1).

use std::fmt;

use crate::{
    abi::Abi,
    interface::{InterfaceType, Role, Roles},
};

/// State of the state machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mode {
    /// After instantiation or reset.
    Instantiated,
    /// Between entering and leaving initialisation.
    Initialization,
    /// Co-Simulation: between communication steps.
    Step,
    /// Co-Simulation: within a communication step, while the importer's callback has the word.
    IntermediateUpdate,
    /// At an event, where parameters and inputs may jump: in Model Exchange, and in Co-Simulation if the importer
    /// handles events.
    Event,
    /// Model Exchange: between events, while the importer integrates.
    ContinuousTime,
    /// After termination, and after a failed simulation: values can still be read.
    Terminated,
}

impl Mode {
    /// Roles of the variables that the importer may set in this mode; whether it handles events decides where
    /// parameters are tuned (FMI 3.0, 2.4.7.4).
    #[inline]
    pub(crate) const fn settable(self, abi: Abi, event_mode_used: bool) -> Roles {
        const ALL: Roles = Roles::of(&[Role::Parameter, Role::Input, Role::State]);
        const TUNABLE: Roles = Roles::of(&[Role::Parameter, Role::Input]);
        const INPUT: Roles = Roles::of(&[Role::Input]);
        match self {
            Self::Instantiated | Self::Initialization => ALL,
            Self::Step if event_mode_used => INPUT,
            Self::Step => TUNABLE,
            Self::IntermediateUpdate => INPUT,
            // FMI 3.0 lets states be set one by one, too; FMI 2.0 has fmi2SetContinuousStates alone for that
            Self::Event => match abi {
                Abi::Fmi2 => TUNABLE,
                Abi::Fmi3 => ALL,
            },
            Self::ContinuousTime => match abi {
                Abi::Fmi2 => INPUT,
                Abi::Fmi3 => Roles::of(&[Role::Input, Role::State]),
            },
            Self::Terminated => Roles::NONE,
        }
    }

    /// Whether an instance of this interface type can be saved in this mode.
    pub(crate) const fn belongs_to(self, interface_type: InterfaceType) -> bool {
        match self {
            Self::Instantiated | Self::Initialization | Self::Event | Self::Terminated => true,
            Self::Step => matches!(interface_type, InterfaceType::CoSimulation),
            Self::IntermediateUpdate => false,
            Self::ContinuousTime => matches!(interface_type, InterfaceType::ModelExchange),
        }
    }

    /// Roles of the variables that partial derivatives are of, and with respect to, in this mode; `None` where there
    /// are no derivatives (FMI 3.0, 2.2.12 for the unknowns, 2.4.8 for the knowns).
    pub(crate) const fn unknowns_and_knowns(self) -> Option<(Roles, Roles)> {
        const KNOWN: Roles =
            Roles::of(&[Role::Independent, Role::Parameter, Role::Input, Role::State]);
        match self {
            // within a communication step there are none: they belong to communication points
            Self::Instantiated | Self::IntermediateUpdate => None,
            // the initial unknowns: what is calculated; a state is given there
            Self::Initialization => Some((Roles::of(&[Role::Output, Role::Derivative]), KNOWN)),
            // outputs, among them the states, and derivatives of states
            Self::Step | Self::Event | Self::ContinuousTime | Self::Terminated => Some((
                Roles::of(&[Role::State, Role::Output, Role::Derivative]),
                KNOWN,
            )),
        }
    }

    /// Number in a serialised FMU state.
    pub(crate) const fn number(self) -> u8 {
        match self {
            Self::Instantiated => 0,
            Self::Initialization => 1,
            Self::Step => 2,
            Self::Terminated => 3,
            Self::Event => 4,
            Self::ContinuousTime => 5,
            Self::IntermediateUpdate => 6,
        }
    }

    /// Inverse of [`Mode::number`].
    pub(crate) const fn from_number(number: u8) -> Option<Self> {
        match number {
            0 => Some(Self::Instantiated),
            1 => Some(Self::Initialization),
            2 => Some(Self::Step),
            3 => Some(Self::Terminated),
            4 => Some(Self::Event),
            5 => Some(Self::ContinuousTime),
            _ => None,
        }
    }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Instantiated => "Instantiated",
            Self::Initialization => "Initialization Mode",
            Self::Step => "Step Mode",
            Self::IntermediateUpdate => "Intermediate Update Mode",
            Self::Event => "Event Mode",
            Self::ContinuousTime => "Continuous-Time Mode",
            Self::Terminated => "Terminated",
        })
    }
}
