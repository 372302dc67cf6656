//! Tables that several methods have.

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{self, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// `[frequency]`: the lines that are used, Hz.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrequencyTable {
    /// Lower end of the band.
    pub from: Option<f64>,
    /// Its upper end.
    pub to: Option<f64>,
    /// Several bands in place of one.
    pub bands: Option<Vec<[f64; 2]>>,
    /// Every how many lines one is used.
    pub every: Option<u64>,
}

/// `[uncertainty]`: how a Monte Carlo simulation draws.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UncertaintyTable {
    /// Draws.
    pub draws: u64,
    /// Seed.
    pub seed: Option<u64>,
}

/// A number, or a list of numbers.
#[derive(Clone, Debug)]
pub enum OneOrMore {
    /// A number.
    One(f64),
    /// A list.
    More(Vec<f64>),
}

impl OneOrMore {
    /// The numbers.
    #[must_use]
    pub fn list(&self) -> Vec<f64> {
        match self {
            Self::One(number) => vec![*number],
            Self::More(numbers) => numbers.clone(),
        }
    }
}

/// By hand, since an untagged enum would not say which number of a list is wrong.
impl<'de> Deserialize<'de> for OneOrMore {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumbersVisitor;
        impl<'de> Visitor<'de> for NumbersVisitor {
            type Value = OneOrMore;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number or a list of numbers")
            }

            fn visit_f64<E: de::Error>(self, number: f64) -> Result<OneOrMore, E> {
                Ok(OneOrMore::One(number))
            }

            fn visit_i64<E: de::Error>(self, number: i64) -> Result<OneOrMore, E> {
                self.visit_f64(number as f64)
            }

            fn visit_u64<E: de::Error>(self, number: u64) -> Result<OneOrMore, E> {
                self.visit_f64(number as f64)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<OneOrMore, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(sequence)).map(OneOrMore::More)
            }
        }
        deserializer.deserialize_any(NumbersVisitor)
    }
}

/// One table `[key]`, or several `[[key]]`; an untagged enum would not say which key of the table is wrong.
///
/// # Errors
/// That of the table, or that there is something else than `expecting`.
pub fn one_or_more_tables<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    deserializer: D,
    expecting: &'static str,
) -> Result<Vec<T>, D::Error> {
    deserializer.deserialize_any(Tables(expecting, PhantomData))
}

struct Tables<T>(&'static str, PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for Tables<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Vec<T>, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(|table| vec![table])
    }

    fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<Vec<T>, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(sequence))
    }
}
