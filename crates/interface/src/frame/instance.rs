//! What a line of a frame is written for: itself, a DOF, or what a law declares.

use super::laws::{InnerRate, LawMemory, LawParameter};

/// One of those that a line is written for.
pub(super) enum Instance<'a> {
    Alone,
    Dof(usize),
    Parameter(&'a LawParameter),
    Memory(&'a LawMemory),
    Rate(&'a LawMemory, &'a InnerRate),
}

impl Instance<'_> {
    pub(super) fn row(&self) -> Option<usize> {
        match self {
            Self::Alone | Self::Parameter(_) => None,
            Self::Dof(row) => Some(*row),
            Self::Memory(memory) | Self::Rate(memory, _) => Some(memory.row),
        }
    }

    pub(super) fn law(&self) -> Option<usize> {
        match self {
            Self::Alone | Self::Dof(_) => None,
            Self::Parameter(parameter) => Some(parameter.law),
            Self::Memory(memory) | Self::Rate(memory, _) => Some(memory.law),
        }
    }
}
