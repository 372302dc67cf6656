//! Which published tables there are, and what they are called.

use std::fmt;
use std::str::FromStr;

use serde::{Serialize, Serializer};
use thiserror::Error;

macro_rules! tables {
    ($($(#[doc = $doc:literal])* $name:ident = $key:literal $(| $alias:literal)*, $title:literal;)*) => {
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

            /// Other names that the command line takes: the numbers of the tables that a step of chapter 5 holds.
            #[must_use]
            pub fn aliases(self) -> &'static [&'static str] {
                match self {
                    $(Self::$name => &[$($alias,)*],)*
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
    /// The beams of section 4.2.2, by two joint models.
    Figures4_30And4_32 = "4.30" | "4.32", "Figures 4.30 and 4.32: natural frequencies of the aluminium beams by two joint models";
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
    M10x16 = "m10x16" | "5.3", "Table 5.3: M10x16, aluminium beams";
    /// Aluminium beams, Table 5.4.
    M8x16 = "m8x16" | "5.4", "Table 5.4: M8x16, aluminium beams";
    /// Steel beams, Table 5.5.
    M10x35 = "m10x35" | "5.5", "Table 5.5: M10x35, steel beams";
    /// Steel beams, Table 5.6.
    M8x35 = "m8x35" | "5.6", "Table 5.6: M8x35, steel beams";
    /// The bolt of Table 5.6 with a longer A.
    LongM8x35 = "long-m8x35", "Section 5.3.2.3: M8x35 in an assembly with a longer substructure A";
    /// Tables 5.7 and 5.8.
    Torques = "torques" | "5.7" | "5.8", "Tables 5.7 and 5.8: M8x35 at four torques";
    /// Steel beams, Table 5.9.
    M6x30 = "m6x30" | "5.9", "Table 5.9: M6x30, steel beams";
    /// Two bolts of Table 5.9.
    TwoM6x30 = "two-m6x30", "Section 5.3.3.3: two M6x30 bolts";
    /// One bolt of two qualities.
    Table5_10 = "5.10", "Table 5.10: M6x30 of two qualities";
    /// Joints of the steel beams, summarised.
    Table5_11 = "5.11", "Table 5.11: bolts of three sizes on steel beams";
    /// Joints of the aluminium beams, summarised.
    Table5_12 = "5.12", "Table 5.12: bolts of two sizes on aluminium beams";
    /// The joints of Tables 5.3 to 5.6 and 5.9 with the rotation that the difference loses.
    Rotation = "rotation", "Chapter 5: what rotations by differences leave out of the joints";
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
            .find(|table| {
                let mut names = std::iter::once(table.key()).chain(table.aliases().iter().copied());
                names.any(|name| name.eq_ignore_ascii_case(text))
            })
            .ok_or_else(|| UnknownTable {
                found: text.to_owned(),
            })
    }
}

impl PublishedTable {
    /// How many sets of draws the table takes with so many numbers of samples.
    #[must_use]
    pub fn noisy_cases(self, samples: usize) -> usize {
        match self {
            Self::Table4_3 | Self::Figures4_30And4_32 | Self::TwoM6x30 | Self::Rotation => 0,
            Self::Table4_2 | Self::Table4_6 | Self::Table4_8 => 4 * samples,
            Self::Table4_4 => 3 * samples,
            Self::Table4_5 => 2 * samples,
            Self::Table4_9 => samples + 1,
            Self::Table4_7 | Self::Torques => 4,
            Self::LongM8x35 => 1,
            Self::Table5_10 | Self::Table5_11 => 3,
            Self::Table5_2
            | Self::M10x16
            | Self::M8x16
            | Self::M10x35
            | Self::M8x35
            | Self::M6x30
            | Self::Table5_12 => 2,
        }
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
