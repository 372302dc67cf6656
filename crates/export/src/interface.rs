//! Which of the two FMUs a joint is exported as.

use std::fmt;

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

    /// The hand-written model description, the only place where variables are declared.
    pub(super) fn template(self) -> &'static str {
        match self {
            Self::Element => include_str!("../../../modelDescription/element.xml"),
            Self::Lap => include_str!("../../../modelDescription/lap.xml"),
        }
    }
}

impl fmt::Display for Interface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
