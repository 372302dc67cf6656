//! Studies that Python has as dictionaries.

use std::path::PathBuf;

use bolted_joint::study::{PATH_KEYS, StudyText};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The TOML text of a study that is given as JSON.
///
/// Raises `ValueError` for what TOML has no word for, such as null.
#[pyfunction]
pub(super) fn to_toml(json: &str) -> PyResult<String> {
    let refused = |found: String| PyValueError::new_err(format!("study: {found}"));
    let tables: toml::Table =
        serde_json::from_str(json).map_err(|error| refused(error.to_string()))?;
    toml::to_string(&tables).map_err(|error| refused(error.to_string()))
}

/// The JSON text of a study in TOML.
///
/// Raises `ValueError` with line and column for what is not TOML.
#[pyfunction]
pub(super) fn to_json(toml: &str) -> PyResult<String> {
    let refused = |found: String| PyValueError::new_err(format!("study: {found}"));
    let tables: toml::Table = toml::from_str(toml).map_err(|error| refused(error.to_string()))?;
    serde_json::to_string(&tables).map_err(|error| refused(error.to_string()))
}

/// Keys of a study whose texts are paths.
#[pyfunction]
pub(super) fn path_keys() -> Vec<&'static str> {
    PATH_KEYS.to_vec()
}

/// The command that the study in a file is for: `identify`, `predict` or `respond`.
///
/// Raises `ValueError` where the file cannot be read or names no method.
#[pyfunction]
pub(super) fn command_of(study: PathBuf) -> PyResult<&'static str> {
    let method = StudyText::read(&study).and_then(|study| study.method());
    let command = method.map(|method| method.command());
    command.map_err(|error| PyValueError::new_err(error.to_string()))
}
