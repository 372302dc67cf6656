//! A reader without a text: it follows a path and notes what is asked of it at the end.

use std::cell::RefCell;
use std::fmt;
use std::marker::PhantomData;

use serde::de::value::StrDeserializer;
use serde::de::{Deserializer, IntoDeserializer, Visitor};

use super::look::{End, Offer, Seen, Step, Within};

/// The reader.
#[derive(Clone, Copy)]
pub(super) struct Probe<'a> {
    pub(super) path: &'a [Step],
    pub(super) seen: &'a RefCell<Seen>,
    /// What to give where the kind of a value is open.
    pub(super) offer: Option<Offer>,
}

impl<'a> Probe<'a> {
    /// Notes what is asked for at the end of the path, or goes on along it.
    fn note<'de, V: Visitor<'de>>(self, seen: Seen, visitor: V) -> Result<V::Value, End> {
        match self.path.split_first() {
            None => {
                self.seen.replace(seen);
                Err(End::Done)
            }
            Some((&step, rest)) => {
                let within = Within {
                    key: match step {
                        Step::Key(key) => Some(key),
                        Step::Entry | Step::Item => None,
                    },
                    rest: Probe { path: rest, ..self },
                    is_met: false,
                    of: PhantomData,
                };
                match step {
                    Step::Key(_) | Step::Entry => visitor.visit_map(within),
                    Step::Item => visitor.visit_seq(within),
                }
            }
        }
    }
}

/// What a visitor says that it expects.
struct Expecting<'v, V>(&'v V);

impl<'de, V: Visitor<'de>> fmt::Display for Expecting<'_, V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.expecting(f)
    }
}

macro_rules! noted {
    ($($method:ident: $seen:expr),* $(,)?) => {
        $(fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, End> {
            self.note($seen, visitor)
        })*
    };
}

impl<'de> Deserializer<'de> for Probe<'_> {
    type Error = End;

    noted! {
        deserialize_bool: Seen::Boolean,
        deserialize_i8: Seen::Integer,
        deserialize_i16: Seen::Integer,
        deserialize_i32: Seen::Integer,
        deserialize_i64: Seen::Integer,
        deserialize_u8: Seen::Integer,
        deserialize_u16: Seen::Integer,
        deserialize_u32: Seen::Integer,
        deserialize_u64: Seen::Integer,
        deserialize_f32: Seen::Number,
        deserialize_f64: Seen::Number,
        deserialize_char: Seen::Text,
        deserialize_str: Seen::Text,
        deserialize_string: Seen::Text,
        deserialize_identifier: Seen::Text,
        deserialize_seq: Seen::List,
        deserialize_map: Seen::Map,
        deserialize_bytes: Seen::Nothing,
        deserialize_byte_buf: Seen::Nothing,
        deserialize_unit: Seen::Nothing,
        deserialize_ignored_any: Seen::Nothing,
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, End> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, End> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_unit_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, End> {
        self.note(Seen::Nothing, visitor)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, End> {
        self.note(Seen::List, visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, End> {
        self.note(Seen::List, visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        keys: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, End> {
        self.note(Seen::Table(keys.to_vec()), visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        words: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, End> {
        match self.path {
            [] => self.note(Seen::Words(words.to_vec()), visitor),
            _ => {
                let none: StrDeserializer<'_, End> = "".into_deserializer();
                visitor.visit_enum(none)
            }
        }
    }

    /// Where several kinds of values are taken: what the visitor makes of the offer.
    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, End> {
        let expecting = Expecting(&visitor).to_string();
        match (self.path, self.offer) {
            ([], Some(offer)) => {
                let (taken, result) = offer.to(visitor);
                self.seen
                    .replace(Seen::OneOf(expecting, taken.into_iter().collect()));
                result
            }
            _ => self.note(Seen::OneOf(expecting, Vec::new()), visitor),
        }
    }
}
