//! A value as a study states it: a number, or `"70e9 ± 7e8"` with the standard deviation that goes with it.

use std::fmt;

use serde::de::{self, Visitor};
use serde::{Deserialize, Deserializer};

/// What a text has to be.
const EXPECTED: &str = "a number, or a text such as \"70e9 ± 7e8\" or \"70e9 ± 1 %\": a value and its standard \
     deviation, both in the key's SI unit, which is not written, or the deviation in %";

/// A value, and its standard deviation if that is stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stated {
    /// The value.
    pub value: f64,
    /// Its standard deviation, as it is stated.
    pub deviation: Option<StatedDeviation>,
}

/// A standard deviation, as a study states it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StatedDeviation {
    /// In the unit of the value.
    Absolute(f64),
    /// As a part of the value.
    Relative(f64),
}

impl Stated {
    /// A value alone.
    #[must_use]
    pub fn alone(value: f64) -> Self {
        Self {
            value,
            deviation: None,
        }
    }

    /// The standard deviation in the unit of the value, where one is stated.
    #[must_use]
    pub fn standard_deviation(&self) -> Option<f64> {
        self.deviation.map(|deviation| match deviation {
            StatedDeviation::Absolute(absolute) => absolute,
            StatedDeviation::Relative(part) => part * self.value.abs(),
        })
    }

    /// The standard deviation as a part of the value, where one is stated.
    #[must_use]
    pub fn relative_deviation(&self) -> Option<f64> {
        self.deviation.map(|deviation| match deviation {
            StatedDeviation::Absolute(absolute) => absolute / self.value.abs(),
            StatedDeviation::Relative(part) => part,
        })
    }

    /// A value and its deviation from a text.
    fn of_text(text: &str) -> Result<Self, String> {
        let refused = |why: &str| Err(format!("found {text:?}{why}, expected {EXPECTED}"));
        let parts = text.split_once('±').or_else(|| text.split_once("+/-"));
        let Some((value, deviation)) = parts else {
            return refused("");
        };
        let number = |part: &str| part.trim().replace('−', "-").parse::<f64>().ok();
        let Some(value) = number(value).filter(|value| value.is_finite()) else {
            return refused(", whose value is no finite number");
        };
        let (deviation, is_relative) = match deviation.trim().strip_suffix('%') {
            Some(percent) => (percent, true),
            None => (deviation, false),
        };
        let Some(size) = number(deviation) else {
            let why = format!(", where {:?} is no number", deviation.trim());
            return refused(&why);
        };
        if !(size.is_finite() && size >= 0.0) {
            return refused(", whose standard deviation is negative or not finite");
        }
        if is_relative && value == 0.0 {
            return refused(", and a part of 0 is no standard deviation");
        }
        let deviation = match is_relative {
            true => StatedDeviation::Relative(size / 100.0),
            false => StatedDeviation::Absolute(size),
        };
        Ok(Self {
            value,
            deviation: Some(deviation),
        })
    }
}

/// As a study has it.
impl fmt::Display for Stated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.value)?;
        match self.deviation {
            None => Ok(()),
            Some(StatedDeviation::Absolute(absolute)) => write!(f, " ± {absolute}"),
            Some(StatedDeviation::Relative(part)) => write!(f, " ± {} %", 100.0 * part),
        }
    }
}

impl<'de> Deserialize<'de> for Stated {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct StatedVisitor;
        impl Visitor<'_> for StatedVisitor {
            type Value = Stated;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPECTED)
            }

            fn visit_f64<E: de::Error>(self, value: f64) -> Result<Stated, E> {
                Ok(Stated::alone(value))
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Stated, E> {
                Ok(Stated::alone(value as f64))
            }

            fn visit_u64<E: de::Error>(self, value: u64) -> Result<Stated, E> {
                Ok(Stated::alone(value as f64))
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Stated, E> {
                Stated::of_text(text).map_err(E::custom)
            }
        }
        deserializer.deserialize_any(StatedVisitor)
    }
}

#[cfg(test)]
mod tests {
    use super::Stated;
    use serde::Deserialize;

    #[derive(Deserialize)]
    struct Table {
        x: Stated,
    }

    fn read(text: &str) -> Result<Stated, String> {
        toml::from_str::<Table>(&format!("x = {text}"))
            .map(|table| table.x)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn a_deviation_is_absolute_or_a_part() {
        #[rustfmt::skip]
        let cases = [
            ("70e9", 70e9, None, None),
            ("70", 70.0, None, None),
            ("\"70e9 ± 7e8\"", 70e9, Some(7e8), Some(0.01)),
            ("\"70e9±7e8\"", 70e9, Some(7e8), Some(0.01)),
            ("\"70e9 +/- 7e8\"", 70e9, Some(7e8), Some(0.01)),
            ("\"70e9 ± 1 %\"", 70e9, Some(7e8), Some(0.01)),
            ("\"70e9 ± 1%\"", 70e9, Some(7e8), Some(0.01)),
            ("\"−0.5 ± 0.25\"", -0.5, Some(0.25), Some(0.5)),
            ("\"−0.5 ± 50 %\"", -0.5, Some(0.25), Some(0.5)),
            ("\"0 ± 0.25\"", 0.0, Some(0.25), Some(f64::INFINITY)),
        ];
        for (text, value, absolute, relative) in cases {
            let stated = read(text).unwrap();
            assert_eq!(stated.value, value, "{text}");
            assert_eq!(stated.standard_deviation(), absolute, "{text}");
            assert_eq!(stated.relative_deviation(), relative, "{text}");
        }
        assert_eq!(
            read("\"70e9 +/- 1 %\"").unwrap().to_string(),
            "70000000000 ± 1 %"
        );
    }

    #[test]
    fn what_is_no_value_with_its_deviation_is_told() {
        #[rustfmt::skip]
        let cases = [
            ("\"70e9\"", "found \"70e9\", expected a number, or a text such as"),
            ("\"70e9 ± -7e8\"", "standard deviation is negative"),
            ("\"70e9 ± inf\"", "negative or not finite"),
            ("\"70e9 ± much\"", "\"much\" is no number"),
            ("\"70e9 ± 1 GPa\"", "where \"1 GPa\" is no number, expected"),
            ("\"70e9 ± 1 ‰\"", "\"1 ‰\" is no number"),
            ("\"70 GPa ± 1\"", "value is no finite number"),
            ("\"nan ± 1\"", "value is no finite number"),
            ("\"0 ± 1 %\"", "a part of 0"),
            ("true", "expected a number"),
        ];
        for (text, expected) in cases {
            let message = read(text).unwrap_err();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }
}
