//! One draw, and which of them are made.

use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

/// What a draw gave.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Draw {
    /// Its results, in the order of their names.
    Values(Vec<f64>),
    /// None, for this reason.
    Refused(String),
}

impl Draw {
    /// The results, if there are any.
    #[must_use]
    pub fn values(&self) -> Option<&[f64]> {
        match self {
            Self::Values(values) => Some(values),
            Self::Refused(_) => None,
        }
    }
}

/// Which of all draws are made.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Share {
    /// All of them.
    #[default]
    Whole,
    /// Those with these numbers.
    Part(Range<u64>),
    /// None: all have been made.
    Made(Arc<[Draw]>),
}

impl Share {
    /// The numbers of those that are made, of `all`.
    #[must_use]
    pub fn numbers(&self, all: u64) -> Range<u64> {
        match self {
            Self::Whole => 0..all,
            Self::Part(numbers) => numbers.clone(),
            Self::Made(_) => 0..0,
        }
    }
}
