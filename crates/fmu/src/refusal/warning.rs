//! Why a call that did its work is answered with a warning.

use std::fmt;

/// Reason for a warning status: the call did its work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Warning {
    /// The parameters that were taken into use make the model active.
    Active(Active),
    /// The motion has reached an amplitude that the user should know of.
    Reached(Reached),
    /// Both.
    ActiveAndReached(Active, Reached),
}

impl Warning {
    /// Both reasons, as far as there are any.
    pub(crate) fn of(active: Option<Active>, reached: Option<Reached>) -> Option<Self> {
        match (active, reached) {
            (None, None) => None,
            (Some(active), None) => Some(Self::Active(active)),
            (None, Some(reached)) => Some(Self::Reached(reached)),
            (Some(active), Some(reached)) => Some(Self::ActiveAndReached(active, reached)),
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Active(active) => active.fmt(f),
            Self::Reached(reached) => reached.fmt(f),
            Self::ActiveAndReached(active, reached) => write!(f, "{active}; {reached}"),
        }
    }
}

/// The parameters make the model active.
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
    /// The warning, if there is anything to warn of: stiffness and damping of the joint, and the supports.
    pub(crate) fn of([joint_stiffness, joint_damping]: [bool; 2], supports: bool) -> Option<Self> {
        (joint_stiffness || joint_damping || supports).then_some(Self {
            joint_stiffness,
            joint_damping,
            supports,
        })
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

/// The relative motion has reached an amplitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reached {
    /// What is beyond it.
    pub(crate) limit: Limit,
    /// Names of the displacements of both sides.
    pub(crate) a: &'static str,
    pub(crate) b: &'static str,
    pub(crate) unit: &'static str,
    /// Their difference, and the amplitude, in that unit.
    pub(crate) relative: f64,
    pub(crate) amplitude: f64,
    pub(crate) time_s: f64,
}

/// What an amplitude is the limit of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Limit {
    /// A softening joint no longer holds; the parameter tells where.
    Escape { parameter: &'static str },
    /// Damping that depends on the amplitude is negative.
    ActiveDamping,
}

impl fmt::Display for Reached {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            a,
            b,
            unit,
            relative,
            amplitude,
            time_s,
            ..
        } = self;
        write!(f, "{a} - {b} = {relative:e} {unit} at t = {time_s} s ")?;
        match self.limit {
            Limit::Escape { parameter } => write!(
                f,
                "is past 80 per cent of {parameter} = {amplitude:e} {unit}, beyond which the softening joint no longer holds"
            ),
            Limit::ActiveDamping => write!(
                f,
                "is past {amplitude:e} {unit}, beyond which the joint's damping is not positive semidefinite: the model is \
                 active there and can feed energy into the simulation"
            ),
        }
    }
}
