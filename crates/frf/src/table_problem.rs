//! What can be wrong in a table or an archive of functions: where, what was found, what was expected and what to do.

use std::fmt::Display;

use thiserror::Error;

use super::{Dof, DofError, FrfError};

/// What is wrong with a table or an archive.
#[derive(Debug, Error)]
pub enum TableProblem {
    /// Something that is not as it should be.
    #[error("{at}found {found}, expected {expected}")]
    Unusable {
        /// Where, with a colon and a space behind it; nothing for the line or the file as a whole.
        at: String,
        /// What was found.
        found: String,
        /// What was expected, and how to get there.
        expected: String,
    },
    /// A name that is no degree of freedom.
    #[error("{at}: {source}")]
    Dof {
        /// Which column, or which entry of an array.
        at: String,
        /// What is wrong with it.
        source: DofError,
    },
    /// A function is not usable as it is.
    #[error("{0}")]
    Function(#[source] Box<FrfError>),
}

impl TableProblem {
    /// Something in the line or the file as a whole.
    pub(super) fn whole(found: impl Display, expected: impl Display) -> Self {
        Self::Unusable {
            at: String::new(),
            found: found.to_string(),
            expected: expected.to_string(),
        }
    }

    /// Something at a place such as a column or an array.
    pub(super) fn at(place: impl Display, found: impl Display, expected: impl Display) -> Self {
        Self::Unusable {
            at: format!("{place}: "),
            found: found.to_string(),
            expected: expected.to_string(),
        }
    }

    /// Something that is said of a function.
    pub(super) fn of_function(
        (response, reference): (Dof, Dof),
        found: impl Display,
        expected: impl Display,
    ) -> Self {
        let place = format_args!("function {response} / {reference}");
        Self::at(place, found, expected)
    }
}
