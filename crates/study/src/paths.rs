//! Files that a key names: one, or a list of them that belong together.

use std::fmt;
use std::path::PathBuf;

use serde::de::value::SeqAccessDeserializer;
use serde::de::{self, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// The path of a file, or of several files that make one measurement, such as one for each reference.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Paths {
    /// The first one.
    pub first: PathBuf,
    /// The others.
    pub further: Vec<PathBuf>,
}

impl Paths {
    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = &PathBuf> {
        std::iter::once(&self.first).chain(&self.further)
    }
}

/// By hand, so that a list without a file is refused with what was expected.
impl<'de> Deserialize<'de> for Paths {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct PathsVisitor;
        impl<'de> Visitor<'de> for PathsVisitor {
            type Value = Paths;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the path of a file such as \"a.uff\", or a list of paths")
            }

            fn visit_str<E: de::Error>(self, path: &str) -> Result<Paths, E> {
                Ok(Paths {
                    first: path.into(),
                    further: Vec::new(),
                })
            }

            fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<Paths, A::Error> {
                let mut all: Vec<PathBuf> = Vec::deserialize(SeqAccessDeserializer::new(sequence))?;
                match all.is_empty() {
                    true => Err(de::Error::invalid_length(0, &self)),
                    false => Ok(Paths {
                        first: all.remove(0),
                        further: all,
                    }),
                }
            }
        }
        deserializer.deserialize_any(PathsVisitor)
    }
}
