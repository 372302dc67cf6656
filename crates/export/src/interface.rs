//! Which of the two FMUs a joint is exported as.

use std::fmt;

use bolted_joint_interface::Expanded;

use super::ExportError;

/// Interface of the FMU.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum Interface {
    /// The massless joint between two structures: motion in, force out.
    #[default]
    Element,
    /// Two supported bodies and the joint between them: loads in, motion out.
    Lap,
}

impl Interface {
    /// Name as on the command line and in `resources/start.txt`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Element => "element",
            Self::Lap => "lap",
        }
    }

    /// One line for people.
    #[must_use]
    pub fn summary(self) -> &'static str {
        match self {
            Self::Element => "bolted joint between two structures (motion in, force out)",
            Self::Lap => {
                "two supported bodies and the bolted joint between them (loads in, motion out)"
            }
        }
    }

    /// The model description with the variables of all joints.
    pub(super) fn expanded(self) -> Result<Expanded, ExportError> {
        let [element, lap] =
            Expanded::present().map_err(|refused| ExportError::Interface(Box::new(refused)))?;
        Ok(match self {
            Self::Element => element,
            Self::Lap => lap,
        })
    }
}

impl fmt::Display for Interface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
