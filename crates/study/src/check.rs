//! Checks that every method has use for: each names the file, the key, what was found and what was expected.

use std::collections::BTreeSet;
use std::fmt::Display;
use std::fs;
use std::ops::RangeInclusive;
use std::path::Path;

use bolted_joint_joint::is_one_line;

use super::{FrequencyTable, Method, StudyError, StudyText, UncertaintyTable};

/// Draws where a study has uncertain values and does not say how many, and more than anybody waits for.
const DRAWS: u64 = 2000;
const MOST_DRAWS: u64 = 1_000_000;

impl StudyText {
    /// Refuses a value.
    ///
    /// # Errors
    /// Always.
    pub fn refuse<T>(
        &self,
        key: impl Display,
        found: impl Display,
        expected: impl Display,
    ) -> Result<T, StudyError> {
        Err(self.refusal(key, found, expected))
    }

    /// Refuses a value unless it is `good`.
    ///
    /// # Errors
    /// [`StudyError::Value`] if it is not.
    pub fn ensure(
        &self,
        good: bool,
        key: impl Display,
        found: impl Display,
        expected: impl Display,
    ) -> Result<(), StudyError> {
        match good {
            true => Ok(()),
            false => self.refuse(key, found, expected),
        }
    }

    /// What has to be there.
    ///
    /// # Errors
    /// [`StudyError::Value`] if it is not.
    pub fn needed<T>(
        &self,
        key: impl Display,
        value: Option<T>,
        expected: impl Display,
    ) -> Result<T, StudyError> {
        value.ok_or_else(|| self.refusal(key, "nothing", expected))
    }

    /// A finite number above zero.
    ///
    /// # Errors
    /// [`StudyError::Value`] if it is none.
    pub fn positive(
        &self,
        key: impl Display,
        value: f64,
        expected: impl Display,
    ) -> Result<f64, StudyError> {
        self.ensure(value.is_finite() && value > 0.0, key, value, expected)?;
        Ok(value)
    }

    /// A finite number that is not negative.
    ///
    /// # Errors
    /// [`StudyError::Value`] if it is none.
    pub fn not_negative(
        &self,
        key: impl Display,
        value: f64,
        expected: impl Display,
    ) -> Result<f64, StudyError> {
        self.ensure(value.is_finite() && value >= 0.0, key, value, expected)?;
        Ok(value)
    }

    /// A standard deviation that is a part of the value: one beyond the whole was meant in per cent.
    ///
    /// # Errors
    /// [`StudyError::Value`] if it is above 1.
    pub fn part_of_whole(&self, key: impl Display, value: f64) -> Result<(), StudyError> {
        let expected = "a part of the whole, at most 1: 0.05 is 5 %";
        self.ensure(value <= 1.0, key, value, expected)
    }

    /// A number within a range.
    ///
    /// # Errors
    /// [`StudyError::Value`] if it is outside.
    pub fn within<T: PartialOrd + Display + Copy>(
        &self,
        key: impl Display,
        value: T,
        range: RangeInclusive<T>,
        expected: impl Display,
    ) -> Result<T, StudyError> {
        self.ensure(range.contains(&value), key, value, expected)?;
        Ok(value)
    }

    /// Numbers above zero, `fewest` or more, each larger than the one before.
    ///
    /// # Errors
    /// [`StudyError::Value`] if they are not.
    pub fn ascending(
        &self,
        key: impl Display,
        values: &[f64],
        fewest: usize,
        expected: impl Display,
    ) -> Result<(), StudyError> {
        let positive = values.iter().all(|value| value.is_finite() && *value > 0.0);
        let good = positive && values.len() >= fewest && values.is_sorted_by(|a, b| a < b);
        self.ensure(good, key, format_args!("{values:?}"), expected)
    }

    /// The method is the one that this reader is for.
    ///
    /// # Errors
    /// [`StudyError::Value`] if it is another.
    pub fn check_method(&self, found: Method, expected: &[Method]) -> Result<(), StudyError> {
        let names: Vec<String> = expected.iter().map(|m| format!("\"{m}\"")).collect();
        self.ensure(
            expected.contains(&found),
            "method",
            format_args!("\"{found}\""),
            format_args!(
                "{}; `bolted-joint {}` takes this study",
                names.join(" or "),
                found.command()
            ),
        )
    }

    /// A name of something: a line of text that an XML attribute can hold, since that is what becomes of it.
    ///
    /// # Errors
    /// [`StudyError::Value`] if it is none.
    pub fn check_name(&self, key: &str, name: &str) -> Result<(), StudyError> {
        self.ensure(
            is_one_line(name),
            key,
            format_args!("{name:?}"),
            "one line of text",
        )
    }

    /// Files that are measurements of their own: one that is named twice would count twice, and lower the variances of what it tells.
    ///
    /// # Errors
    /// [`StudyError::Value`] for the first that was named before.
    pub fn every_file_once<'f>(
        &self,
        key: impl Display,
        files: impl IntoIterator<Item = &'f Path>,
    ) -> Result<(), StudyError> {
        let mut seen = BTreeSet::new();
        for file in files {
            let path = self.resolved(file);
            let is_new = seen.insert(fs::canonicalize(&path).unwrap_or(path));
            self.ensure(
                is_new,
                &key,
                format_args!("\"{}\" twice", file.display()),
                "every measurement once: it would count as two",
            )?;
        }
        Ok(())
    }

    /// The frequencies to use, Hz; where an end is left out, everything there is. For methods that use all lines of one band.
    ///
    /// # Errors
    /// [`StudyError::Value`] for `frequency` if they are none, or more is said than a band.
    pub fn frequency_range_hz(&self, table: &FrequencyTable) -> Result<[f64; 2], StudyError> {
        for (key, there) in [
            ("bands", table.bands.is_some()),
            ("every", table.every.is_some()),
        ] {
            let expected = "`from` and `to` only, with this method";
            self.ensure(
                !there,
                format_args!("frequency.{key}"),
                "a choice of lines",
                expected,
            )?;
        }
        let from = table.from.unwrap_or(f64::MIN_POSITIVE);
        let to = table.to.unwrap_or(f64::MAX);
        let found = match (table.from, table.to) {
            (Some(from), None) => format!("from {from}"),
            (None, Some(to)) => format!("to {to}"),
            _ => format!("from {from} to {to}"),
        };
        let expected = "frequencies in Hz with 0 < from < to";
        self.ensure(from > 0.0 && from < to, "frequency", found, expected)?;
        Ok([from, to])
    }

    /// Draws and seed of a Monte Carlo simulation.
    ///
    /// # Errors
    /// [`StudyError::Value`] for too few or too many draws.
    pub fn draws(&self, table: Option<&UncertaintyTable>) -> Result<(u64, u64), StudyError> {
        let (draws, seed) = match table {
            Some(table) => (table.draws, table.seed.unwrap_or(1)),
            None => (DRAWS, 1),
        };
        let expected = format!("a number from 2 to {MOST_DRAWS}");
        self.within("uncertainty.draws", draws, 2..=MOST_DRAWS, expected)?;
        Ok((draws, seed))
    }
}
