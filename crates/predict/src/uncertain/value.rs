//! A value as a study gives it: a number, a table of value and standard deviation, or `"1.42 ± 0.02"`.

use std::fmt;

use serde::de::{self, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// A value and its standard deviation, in the same unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uncertain {
    /// The value.
    pub value: f64,
    /// One standard deviation; zero for a value that is known exactly.
    pub standard_deviation: f64,
}

impl Uncertain {
    /// A value that is known exactly.
    #[must_use]
    pub fn exact(value: f64) -> Self {
        Self {
            value,
            standard_deviation: 0.0,
        }
    }

    /// Whether there is no doubt about it.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.standard_deviation == 0.0
    }

    /// What is wrong with it, whatever it is a value of.
    fn checked<E: de::Error>(value: f64, standard_deviation: f64) -> Result<Self, E> {
        if !value.is_finite() {
            return Err(E::custom(format!(
                "found the value {value}, expected a finite number"
            )));
        }
        if !(standard_deviation.is_finite() && standard_deviation >= 0.0) {
            return Err(E::custom(format!(
                "found the standard deviation {standard_deviation}, expected a number that is not negative"
            )));
        }
        Ok(Self {
            value,
            standard_deviation,
        })
    }
}

/// As a study has it: `1.42`, or `1.42 ± 0.02`.
impl fmt::Display for Uncertain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.is_exact() {
            true => write!(f, "{}", self.value),
            false => write!(f, "{} ± {}", self.value, self.standard_deviation),
        }
    }
}

impl<'de> Deserialize<'de> for Uncertain {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AnyForm)
    }
}

/// Any of the three forms.
struct AnyForm;

#[derive(Deserialize)]
#[serde(field_identifier, rename_all = "snake_case")]
enum Key {
    Value,
    StandardDeviation,
}

impl<'de> Visitor<'de> for AnyForm {
    type Value = Uncertain;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, \"1.42 ± 0.02\", or { value = 1.42, standard_deviation = 0.02 }")
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Uncertain, E> {
        Uncertain::checked(value, 0.0)
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Uncertain, E> {
        Uncertain::checked(value as f64, 0.0)
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Uncertain, E> {
        Uncertain::checked(value as f64, 0.0)
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Uncertain, E> {
        let number = |part: &str| {
            let part = part.trim().replace('−', "-");
            part.parse::<f64>().map_err(|_| {
                E::custom(format!(
                    "found {text:?}, expected a value and its standard deviation such as \"1.42 ± 0.02\""
                ))
            })
        };
        let parts = text.split_once('±').or_else(|| text.split_once("+/-"));
        match parts {
            Some((value, deviation)) => Uncertain::checked(number(value)?, number(deviation)?),
            None => Uncertain::checked(number(text)?, 0.0),
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Uncertain, A::Error> {
        let (mut value, mut deviation) = (None, None);
        while let Some(key) = map.next_key()? {
            match key {
                Key::Value => value = Some(map.next_value()?),
                Key::StandardDeviation => deviation = Some(map.next_value()?),
            }
        }
        let value = value.ok_or_else(|| de::Error::missing_field("value"))?;
        Uncertain::checked(value, deviation.unwrap_or(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::Uncertain;
    use serde::Deserialize;

    #[derive(Deserialize)]
    struct Table {
        x: Uncertain,
    }

    fn read(text: &str) -> Result<Uncertain, String> {
        toml::from_str::<Table>(&format!("x = {text}"))
            .map(|table| table.x)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn every_form_reads() {
        let expected = Uncertain {
            value: 1.42,
            standard_deviation: 0.02,
        };
        for text in [
            "\"1.42 ± 0.02\"",
            "\"1.42±0.02\"",
            "\"1.42 +/- 0.02\"",
            "{ value = 1.42, standard_deviation = 0.02 }",
        ] {
            assert_eq!(read(text).unwrap(), expected, "{text}");
        }
        for text in ["9000", "9000.0", "\"9000\"", "{ value = 9000 }"] {
            assert_eq!(read(text).unwrap(), Uncertain::exact(9000.0), "{text}");
        }
        assert_eq!(read("\"−2e-3 ± 1e-4\"").unwrap().value, -2e-3);
    }

    #[test]
    fn it_shows_as_it_is_written() {
        for text in ["1.42 ± 0.02", "9000"] {
            assert_eq!(read(&format!("{text:?}")).unwrap().to_string(), text);
        }
    }

    #[test]
    fn what_is_no_value_is_told() {
        for (text, expected) in [
            ("\"1.42 ± much\"", "found \"1.42 ± much\""),
            ("\"1.42 ± -0.02\"", "standard deviation -0.02"),
            ("nan", "the value NaN"),
            ("{ standard_deviation = 0.02 }", "missing field `value`"),
            ("{ value = 1, sd = 0.02 }", "unknown field `sd`"),
            ("true", "expected a number"),
        ] {
            let message = read(text).unwrap_err();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }
}
