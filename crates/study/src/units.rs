//! `units`: in what the functions of a file are, by the names of two units.

use std::fmt::Display;

use bolted_joint_frf::UnitSystem;
use serde::Deserialize;

use super::{StudyError, StudyText};

/// Units of a file of functions, by name.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnitsTable {
    length: String,
    force: String,
}

impl StudyText {
    /// The units that the table at `key` names, where there is one.
    ///
    /// # Errors
    /// [`StudyError::Value`] for names that are none of units.
    pub fn units(
        &self,
        key: impl Display,
        table: Option<&UnitsTable>,
    ) -> Result<Option<UnitSystem>, StudyError> {
        let Some(UnitsTable { length, force }) = table else {
            return Ok(None);
        };
        let units = UnitSystem::named(length, force);
        let found = format_args!("length = {length:?}, force = {force:?}");
        let expected = "units of length and force such as { length = \"mm\", force = \"N\" }";
        self.ensure(units.is_some(), key, found, expected)?;
        Ok(units)
    }

    /// Refuses what is stated of a file of functions where there is none: `stated` has for each such key its name, what it says, and
    /// whether it is there.
    ///
    /// # Errors
    /// [`StudyError::Value`] for the first of them that is there.
    pub fn beside_functions_only(
        &self,
        key: impl Display,
        has_functions: bool,
        stated: &[(&str, &str, bool)],
    ) -> Result<(), StudyError> {
        for (name, found, is_there) in stated {
            self.ensure(
                !is_there || has_functions,
                format_args!("{key}.{name}"),
                found,
                "it beside `frf` only",
            )?;
        }
        Ok(())
    }
}
