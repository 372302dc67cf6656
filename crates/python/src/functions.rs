//! Files of frequency response functions, as bytes that NumPy takes for arrays.

use std::path::PathBuf;

use bolted_joint::frf::{Coherence, Frf, Quantity, ReadOptions, read_frfs};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// Response, reference, frequencies (float64), values (complex128, or float64 for coherence), as the machine has them.
type Curve<'py> = (String, String, Bound<'py, PyBytes>, Bound<'py, PyBytes>);

/// Reads a file of functions, whatever its format.
///
/// Gives receptances in SI, coherences, averages if they are stated, and whether the file states its units.
///
/// Raises `ValueError` with file, line or key for what cannot be read.
#[pyfunction]
#[pyo3(signature = (path, quantity = None, averages = None))]
#[expect(
    clippy::type_complexity,
    reason = "a tuple for Python, which names its parts"
)]
pub(super) fn read_functions<'py>(
    py: Python<'py>,
    path: PathBuf,
    quantity: Option<&str>,
    averages: Option<f64>,
) -> PyResult<(Vec<Curve<'py>>, Vec<Curve<'py>>, Option<f64>, bool)> {
    let options = ReadOptions {
        quantity: quantity.map(to_quantity).transpose()?,
        averages,
        ..ReadOptions::default()
    };
    let reading = py
        .detach(|| read_frfs(&path, &options))
        .map_err(|error| PyValueError::new_err(error.to_string()))?;
    let functions = reading.functions().iter().map(|frf| function(py, frf));
    let coherences = reading.coherences.iter().map(|of| coherence(py, of));
    Ok((
        functions.collect(),
        coherences.collect(),
        reading.averages(),
        reading.units_are_stated(),
    ))
}

fn to_quantity(name: &str) -> PyResult<Quantity> {
    match name {
        "receptance" => Ok(Quantity::Receptance),
        "mobility" => Ok(Quantity::Mobility),
        "accelerance" => Ok(Quantity::Accelerance),
        other => Err(PyValueError::new_err(format!(
            "quantity: found {other:?}, expected \"receptance\", \"mobility\" or \"accelerance\""
        ))),
    }
}

fn function<'py>(py: Python<'py>, frf: &Frf) -> Curve<'py> {
    let parts = frf
        .receptance()
        .iter()
        .flat_map(|value| [value.re, value.im]);
    (
        frf.response().to_string(),
        frf.reference().to_string(),
        bytes(py, frf.frequency_hz().iter().copied()),
        bytes(py, parts),
    )
}

fn coherence<'py>(py: Python<'py>, coherence: &Coherence) -> Curve<'py> {
    (
        coherence.response.to_string(),
        coherence.reference.to_string(),
        bytes(py, coherence.frequency_hz.iter().copied()),
        bytes(py, coherence.gamma_squared.iter().copied()),
    )
}

fn bytes(py: Python<'_>, numbers: impl Iterator<Item = f64>) -> Bound<'_, PyBytes> {
    let all: Vec<u8> = numbers.flat_map(f64::to_ne_bytes).collect();
    PyBytes::new(py, &all)
}
