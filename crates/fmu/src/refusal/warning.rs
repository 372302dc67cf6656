//! Why a call that did its work is answered with a warning.

use std::fmt;

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
