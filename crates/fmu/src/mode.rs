//! The state machines of FMI for Model Exchange and for Co-Simulation (FMI 3.0, 2.3, 3.2.1, 4.2.1).

use std::fmt;

use crate::{
    interface::{InterfaceType, Role, Roles},
    version::Abi,
};

/// State of the state machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mode {
    /// After instantiation or reset.
    Instantiated,
    /// FMI 2.0: still instantiated, and the time span is known.
    SetUp,
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
        const INNER: Roles = Roles::of(&[Role::InnerState]);
        match self {
            Self::Instantiated | Self::SetUp | Self::Initialization => ALL,
            Self::Step if event_mode_used => INPUT,
            Self::Step => TUNABLE,
            Self::IntermediateUpdate => INPUT,
            // only FMI 3.0 lets states be set at an event
            Self::Event => match abi {
                Abi::Fmi2 => TUNABLE,
                Abi::Fmi3 => ALL.with(INNER),
            },
            Self::ContinuousTime => Roles::of(&[Role::Input, Role::State]).with(INNER),
            Self::Terminated => Roles::NONE,
        }
    }

    /// Whether an instance of this FMI version and interface type can be saved in this mode.
    pub(crate) const fn belongs_to(self, abi: Abi, interface_type: InterfaceType) -> bool {
        match self {
            Self::Instantiated | Self::Initialization | Self::Terminated => true,
            Self::SetUp => matches!(abi, Abi::Fmi2),
            Self::Event => {
                matches!(abi, Abi::Fmi3) || matches!(interface_type, InterfaceType::ModelExchange)
            }
            Self::Step => matches!(interface_type, InterfaceType::CoSimulation),
            Self::IntermediateUpdate => false,
            Self::ContinuousTime => matches!(interface_type, InterfaceType::ModelExchange),
        }
    }

    /// Roles of the variables that partial derivatives are of, and with respect to, in this mode; `None` where there
    /// are no derivatives (FMI 3.0, 2.2.12 for the unknowns, 2.4.8 for the knowns).
    pub(crate) const fn unknowns_and_knowns(self) -> Option<(Roles, Roles)> {
        const INITIALLY: Roles =
            Roles::of(&[Role::Independent, Role::Parameter, Role::Input, Role::State]);
        const KNOWN: Roles = INITIALLY.with(Roles::of(&[Role::InnerState]));
        match self {
            // within a communication step there are none: they belong to communication points
            Self::Instantiated | Self::SetUp | Self::IntermediateUpdate => None,
            // the initial unknowns: what is calculated; a state is given there
            Self::Initialization => Some((
                Roles::of(&[
                    Role::Output,
                    Role::InnerState,
                    Role::Derivative,
                    Role::CalculatedParameter,
                ]),
                INITIALLY,
            )),
            // outputs, among them the states, and derivatives of states
            Self::Step | Self::Event | Self::ContinuousTime | Self::Terminated => Some((
                Roles::of(&[
                    Role::State,
                    Role::InnerState,
                    Role::Output,
                    Role::Derivative,
                    Role::Indicator,
                ]),
                KNOWN,
            )),
        }
    }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Instantiated => "Instantiated",
            Self::SetUp => "Instantiated after fmi2SetupExperiment",
            Self::Initialization => "Initialization Mode",
            Self::Step => "Step Mode",
            Self::IntermediateUpdate => "Intermediate Update Mode",
            Self::Event => "Event Mode",
            Self::ContinuousTime => "Continuous-Time Mode",
            Self::Terminated => "Terminated",
        })
    }
}
