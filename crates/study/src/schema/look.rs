//! One look at a value of a table: what does it take?

use std::cell::RefCell;
use std::marker::PhantomData;

use serde::de::value::SeqDeserializer;
use serde::de::{
    self, DeserializeOwned, DeserializeSeed, IntoDeserializer, MapAccess, SeqAccess, Visitor,
};

use super::probe::Probe;

/// From a value to one within it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    /// That of a key.
    Key(&'static str),
    /// That of any entry of a table whose keys are names.
    Entry,
    /// One of a list.
    Item,
}

/// A kind of value that is taken where several are.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Taken {
    Number,
    Boolean,
    Text,
    Words(Vec<&'static str>),
    Table(Vec<&'static str>),
    ListOf(Box<Taken>),
}

/// What a value takes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) enum Seen {
    #[default]
    Nothing,
    Table(Vec<&'static str>),
    Map,
    List,
    Number,
    Integer,
    Boolean,
    Text,
    Words(Vec<&'static str>),
    /// Several kinds, and what the reader says that it expects.
    OneOf(String, Vec<Taken>),
}

/// What is offered where the kind of a value is open.
#[derive(Clone, Copy, Debug)]
pub(super) enum Offer {
    Number(f64),
    Boolean,
    Text(&'static str),
    Numbers,
    Bands,
    Texts,
    /// A table with a key that there is not: its refusal names those that there are.
    Table,
    Tables,
    Empty,
}

/// What values of texts have to be, in one place or another.
const OFFERS: [Offer; 17] = [
    Offer::Number(1.0),
    Offer::Boolean,
    Offer::Text("1:+Y"),
    Offer::Text("1:+RZ"),
    Offer::Text("1 ± 0.1"),
    Offer::Text("automatic"),
    Offer::Text("median"),
    Offer::Text("none"),
    Offer::Text("exact"),
    Offer::Text("energy-ratio"),
    Offer::Text("a word"),
    Offer::Numbers,
    Offer::Bands,
    Offer::Texts,
    Offer::Table,
    Offer::Tables,
    Offer::Empty,
];

/// Why a look ends.
#[derive(Debug)]
pub(super) enum End {
    /// Everything was seen.
    Done,
    /// The value is of another kind, or is refused.
    Refused,
    /// Keys that a table has.
    Keys(&'static [&'static str]),
    /// Words that there are.
    Words(&'static [&'static str]),
}

impl std::fmt::Display for End {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{self:?}")
    }
}

impl std::error::Error for End {}

impl de::Error for End {
    fn custom<T: std::fmt::Display>(_: T) -> Self {
        Self::Refused
    }

    fn unknown_field(_: &str, expected: &'static [&'static str]) -> Self {
        Self::Keys(expected)
    }

    fn unknown_variant(_: &str, expected: &'static [&'static str]) -> Self {
        Self::Words(expected)
    }
}

/// What is at the end of a path.
pub(super) fn look<T: DeserializeOwned>(path: &[Step]) -> Seen {
    let seen = RefCell::new(Seen::Nothing);
    // each look ends with an error, by design
    let _ = T::deserialize(Probe {
        path,
        seen: &seen,
        offer: None,
    });
    let found = seen.into_inner();
    let Seen::OneOf(expecting, _) = found else {
        return found;
    };
    let mut all: Vec<Taken> = Vec::new();
    for offer in OFFERS {
        let taken = RefCell::new(Seen::Nothing);
        let _ = T::deserialize(Probe {
            path,
            seen: &taken,
            offer: Some(offer),
        });
        if let Seen::OneOf(_, own) = taken.into_inner() {
            all.extend(
                own.into_iter()
                    .filter(|own| !all.contains(own))
                    .collect::<Vec<_>>(),
            );
        }
    }
    // a table with keys says more than one without, and a text that may be any more than words
    if all
        .iter()
        .any(|own| matches!(own, Taken::Table(keys) if !keys.is_empty()))
    {
        all.retain(|own| *own != Taken::Table(Vec::new()));
    }
    Seen::OneOf(expecting, all)
}

impl Offer {
    /// Whether a visitor takes it, and as what.
    pub(super) fn to<'de, V: Visitor<'de>>(
        self,
        visitor: V,
    ) -> (Option<Taken>, Result<V::Value, End>) {
        let numbers = || vec![1.0, 2.0];
        let (result, own) = match self {
            Self::Number(number) => (visitor.visit_f64(number), Taken::Number),
            Self::Boolean => (visitor.visit_bool(true), Taken::Boolean),
            Self::Text(text) => (visitor.visit_str(text), Taken::Text),
            Self::Numbers => {
                let list = SeqDeserializer::new(numbers().into_iter());
                (
                    visitor.visit_seq(list),
                    Taken::ListOf(Box::new(Taken::Number)),
                )
            }
            Self::Bands => {
                let list = SeqDeserializer::new([numbers()].into_iter());
                let inner = Taken::ListOf(Box::new(Taken::Number));
                (visitor.visit_seq(list), Taken::ListOf(Box::new(inner)))
            }
            Self::Texts => {
                let list = SeqDeserializer::new(["1:+Y"].into_iter());
                (
                    visitor.visit_seq(list),
                    Taken::ListOf(Box::new(Taken::Text)),
                )
            }
            Self::Table => (visitor.visit_map(UnknownKey), Taken::Table(Vec::new())),
            Self::Tables => {
                let list = SeqDeserializer::new([UnknownTable].into_iter());
                let inner = Taken::Table(Vec::new());
                (visitor.visit_seq(list), Taken::ListOf(Box::new(inner)))
            }
            Self::Empty => (visitor.visit_map(NoKey), Taken::Table(Vec::new())),
        };
        let taken = match (&result, own) {
            (Ok(_), own) => Some(own),
            (Err(End::Keys(keys)), Taken::Table(_)) => Some(Taken::Table(keys.to_vec())),
            (Err(End::Keys(keys)), Taken::ListOf(_)) => {
                Some(Taken::ListOf(Box::new(Taken::Table(keys.to_vec()))))
            }
            (Err(End::Words(words)), Taken::Text) => Some(Taken::Words(words.to_vec())),
            _ => None,
        };
        (taken, result)
    }
}

/// A table with one key that there is not.
struct UnknownKey;

impl<'de> MapAccess<'de> for UnknownKey {
    type Error = End;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, End> {
        seed.deserialize("\u{1}".into_deserializer()).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, _: V) -> Result<V::Value, End> {
        Err(End::Refused)
    }
}

/// A table without keys.
struct NoKey;

impl<'de> MapAccess<'de> for NoKey {
    type Error = End;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, _: K) -> Result<Option<K::Value>, End> {
        Ok(None)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, _: V) -> Result<V::Value, End> {
        Err(End::Refused)
    }
}

/// The value of [`Offer::Tables`].
struct UnknownTable;

impl<'de> IntoDeserializer<'de, End> for UnknownTable {
    type Deserializer = de::value::MapAccessDeserializer<UnknownKey>;

    fn into_deserializer(self) -> Self::Deserializer {
        de::value::MapAccessDeserializer::new(UnknownKey)
    }
}

/// The one entry of a table or list that is looked into.
pub(super) struct Within<'a, 'de> {
    pub(super) key: Option<&'static str>,
    pub(super) rest: Probe<'a>,
    pub(super) is_met: bool,
    pub(super) of: PhantomData<&'de ()>,
}

impl<'de> MapAccess<'de> for Within<'_, 'de> {
    type Error = End;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, End> {
        if std::mem::replace(&mut self.is_met, true) {
            return Ok(None);
        }
        // a name that is a degree of freedom serves for both
        let key = self.key.unwrap_or("1:+Y");
        seed.deserialize(key.into_deserializer()).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, End> {
        seed.deserialize(self.rest)
    }
}

impl<'de> SeqAccess<'de> for Within<'_, 'de> {
    type Error = End;

    fn next_element_seed<S: DeserializeSeed<'de>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, End> {
        match std::mem::replace(&mut self.is_met, true) {
            true => Ok(None),
            false => seed.deserialize(self.rest).map(Some),
        }
    }
}
