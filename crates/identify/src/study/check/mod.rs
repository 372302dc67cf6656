//! Checks of a study's tables: what passes is complete, physical and without contradiction.

mod assembly;
mod bolts;
mod rotation;
mod settings;
mod start;
mod substructure;
mod torque;

use std::path::Path;

use super::super::error::IdentifyError;
use crate::StudyMethod;

/// Makes errors that name the study's file.
pub(super) struct Checker<'a> {
    pub(super) path: &'a Path,
}

impl Checker<'_> {
    fn refuse<T>(
        &self,
        key: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Result<T, IdentifyError> {
        Err(IdentifyError::Study {
            path: self.path.to_owned(),
            key: key.into(),
            found: found.into(),
            expected: expected.into(),
        })
    }

    /// This reader's own method; the others have readers of their own.
    pub(super) fn method(&self, method: StudyMethod) -> Result<(), IdentifyError> {
        match method {
            StudyMethod::FrfDecoupling => Ok(()),
            other => self.refuse(
                "method",
                format!("{other:?}"),
                "\"frf-decoupling\", whose study this command needs",
            ),
        }
    }

    pub(super) fn name(&self, name: &str) -> Result<(), IdentifyError> {
        if name.trim().is_empty() || name.chars().any(char::is_control) {
            return self.refuse("name", format!("{name:?}"), "one line of text");
        }
        Ok(())
    }
}

/// The names of the keys that are there, or `none`.
fn names_given(none: &str, keys: &[(&str, bool)]) -> String {
    let given: Vec<&str> = keys
        .iter()
        .filter_map(|&(name, there)| there.then_some(name))
        .collect();
    if given.is_empty() {
        none.to_owned()
    } else {
        given.join(" and ")
    }
}
