//! Which published tables there are, and what they are called.

use std::fmt;
use std::str::FromStr;

use serde::{Serialize, Serializer};
use thiserror::Error;

macro_rules! tables {
    ($($(#[doc = $doc:literal])* $name:ident = $key:literal, $title:literal;)*) => {
        /// A table of the thesis, or a step of the chain of its chapter 5.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum PublishedTable {
            $($(#[doc = $doc])* $name,)*
        }

        impl PublishedTable {
            /// All of them in the order of the thesis.
            pub const ALL: &[Self] = &[$(Self::$name,)*];

            /// What the command line calls it.
            #[must_use]
            pub fn key(self) -> &'static str {
                match self {
                    $(Self::$name => $key,)*
                }
            }

            /// What it shows.
            #[must_use]
            pub fn title(self) -> &'static str {
                match self {
                    $(Self::$name => $title,)*
                }
            }
        }
    };
}

tables! {
    /// Lumped chain, equations (3.18), (3.19) and (3.21).
    Table4_2 = "4.2", "Table 4.2: lumped chain, decoupling equations compared (5 % response pollution)";
}

/// A name that is no table.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{found:?} is no table; expected one of {}", keys())]
pub struct UnknownTable {
    /// What was given.
    pub found: String,
}

fn keys() -> String {
    let keys: Vec<&str> = PublishedTable::ALL
        .iter()
        .map(|table| table.key())
        .collect();
    keys.join(", ")
}

impl FromStr for PublishedTable {
    type Err = UnknownTable;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Self::ALL
            .iter()
            .copied()
            .find(|table| table.key().eq_ignore_ascii_case(text))
            .ok_or_else(|| UnknownTable {
                found: text.to_owned(),
            })
    }
}

impl fmt::Display for PublishedTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.title())
    }
}

impl Serialize for PublishedTable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.key())
    }
}
