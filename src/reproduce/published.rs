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
    /// The joint of section 4.2.1.
    Table4_3 = "4.3", "Table 4.3: joint of the steel beams";
    /// Beams with a fully populated joint, equations (3.18), (3.19) and (3.21).
    Table4_4 = "4.4", "Table 4.4: steel beams, decoupling equations compared (5 % response pollution)";
    /// The same with measured and with estimated rotations.
    Table4_5 = "4.5", "Table 4.5: steel beams, rotations measured or estimated (5 % response pollution)";
    /// Approaches 1 to 4.
    Table4_6 = "4.6", "Table 4.6: approaches 1 to 4 (1 % response pollution)";
    /// Approach 4 with FRF pollution.
    Table4_7 = "4.7", "Table 4.7: approach 4 with FRF pollution";
    /// Approach 4 with response pollution.
    Table4_8 = "4.8", "Table 4.8: approach 4 with response pollution";
    /// Both procedures at 1 %.
    Table4_9 = "4.9", "Table 4.9: both noise procedures at 1 %";
    /// The joint at two lines of the M10x16 assembly.
    Table5_2 = "5.2", "Table 5.2: M10x16, decoupled at 112.5 and 344 Hz";
    /// Aluminium beams, Table 5.3.
    M10x16 = "m10x16", "Table 5.3: M10x16, aluminium beams";
    /// Aluminium beams, Table 5.4.
    M8x16 = "m8x16", "Table 5.4: M8x16, aluminium beams";
    /// Steel beams, Table 5.5.
    M10x35 = "m10x35", "Table 5.5: M10x35, steel beams";
    /// Steel beams, Table 5.6.
    M8x35 = "m8x35", "Table 5.6: M8x35, steel beams";
    /// The bolt of Table 5.6 with a longer A.
    LongM8x35 = "long-m8x35", "Section 5.3.2.3: M8x35 in an assembly with a longer substructure A";
    /// Tables 5.7 and 5.8.
    Torques = "torques", "Tables 5.7 and 5.8: M8x35 at four torques";
    /// Steel beams, Table 5.9.
    M6x30 = "m6x30", "Table 5.9: M6x30, steel beams";
    /// Two bolts of Table 5.9.
    TwoM6x30 = "two-m6x30", "Section 5.3.3.3: two M6x30 bolts";
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
