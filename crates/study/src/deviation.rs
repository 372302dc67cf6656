//! A standard deviation of a budget: a number, or `"exact"`.

use std::fmt;

use serde::de::{self, Visitor};
use serde::{Deserialize, Deserializer};

/// A standard deviation; 0 where the study says `"exact"`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation(pub f64);

/// By hand, since an untagged enum would not say what it takes.
impl<'de> Deserialize<'de> for Deviation {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct DeviationVisitor;
        impl Visitor<'_> for DeviationVisitor {
            type Value = Deviation;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a standard deviation or \"exact\"")
            }

            fn visit_str<E: de::Error>(self, word: &str) -> Result<Deviation, E> {
                match word {
                    "exact" => Ok(Deviation(0.0)),
                    _ => Err(E::invalid_value(de::Unexpected::Str(word), &self)),
                }
            }

            fn visit_f64<E: de::Error>(self, value: f64) -> Result<Deviation, E> {
                Ok(Deviation(value))
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Deviation, E> {
                Ok(Deviation(value as f64))
            }
        }
        deserializer.deserialize_any(DeviationVisitor)
    }
}
