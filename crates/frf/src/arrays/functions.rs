//! A file of arrays, made into functions.

use std::path::Path;

use super::axes::{Counts, named, order};
use super::matrix::{Functions, Place};
use super::members::{Members, by_name, quantity};
use super::{Array, ArrayFile};
use crate::{FrfError, FrfReading, ReadOptions, TableProblem};

const FREQUENCY: &[&str] = &["frequency", "frequency_hz", "freq", "freqs", "f"];
const MATRIX: &[&str] = &[
    "frf",
    "FRF",
    "H",
    "Y",
    "receptance",
    "mobility",
    "accelerance",
];
const RESPONSE: &[&str] = &["response", "responses"];
const REFERENCE: &[&str] = &["reference", "references"];

/// More functions than any test has: a thousand responses to a thousand references.
const MOST_FUNCTIONS: usize = 1 << 20;

/// Reads the functions of a file of arrays, if it could be opened.
pub(crate) fn functions<F: ArrayFile>(
    opened: Result<F, TableProblem>,
    path: &Path,
    options: &ReadOptions,
) -> Result<FrfReading, FrfError> {
    opened
        .and_then(|mut file| functions_of(&mut file, path, options))
        .map_err(|problem| FrfError::Arrays {
            path: path.to_owned(),
            problem: Box::new(problem),
        })
}

fn functions_of<F: ArrayFile>(
    file: &mut F,
    path: &Path,
    options: &ReadOptions,
) -> Result<FrfReading, TableProblem> {
    let mut members = Members(file);
    let frequency = members.required(FREQUENCY, "frequency (Hz)")?;
    let matrix = members.required(MATRIX, "frf, the matrix of functions")?;
    let response = members.required(RESPONSE, "response, degrees of freedom such as \"11:+Y\"")?;
    let reference =
        members.required(REFERENCE, "reference, degrees of freedom such as \"2:+Y\"")?;
    let frequency_hz = members.frequencies(&frequency)?;
    let responses = members.dofs(&response)?;
    let references = members.dofs(&reference)?;
    let counts = Counts {
        responses: responses.len(),
        references: references.len(),
        frequencies: frequency_hz.len(),
    };
    let axes = members.text("axes")?.map(|text| named(&text)).transpose()?;
    let place = |name: &str, array: &F::Array<'_>| {
        order(name, array.shape(), counts, axes.as_deref()).map(|order| Place {
            order,
            shape: array.shape().to_vec(),
            fortran_order: array.fortran_order(),
        })
    };
    let quantity = members
        .text("quantity")?
        .map(|text| quantity(&text))
        .transpose()?;
    let unit = members.text("unit")?;
    let averages = members.averages()?;
    let array = members.numbers(&matrix)?;
    // Before anything is reserved for them: as many functions as the names make are in the file, and not too many, since a
    // swollen matrix takes next to no room there.
    let matrix_place = place(&matrix, &array)?;
    if responses.len().saturating_mul(references.len()) > MOST_FUNCTIONS {
        let (responses, references) = (responses.len(), references.len());
        return Err(TableProblem::whole(
            format_args!("the names of {responses} responses and {references} references"),
            format_args!(
                "at most {MOST_FUNCTIONS} functions between them; save only those that are needed"
            ),
        ));
    }
    let functions = Functions {
        pairs: (0..responses.len() * references.len())
            .map(|index| {
                (
                    responses[index / references.len()],
                    references[index % references.len()],
                )
            })
            .collect(),
        references: references.len(),
        frequency_hz,
        options,
    };
    let stated = functions.stated(quantity.or_else(|| by_name(&matrix)), unit.as_deref())?;
    let lines = functions.gather(array, &matrix_place)?;
    let coherence = match members.find(&["coherence"])? {
        None => None,
        Some(name) => {
            let array = members.numbers(&name)?;
            let coherence_place = place(&name, &array)?;
            Some(functions.gather(array, &coherence_place)?)
        }
    };
    functions.reading(F::FORMAT, path, &stated, lines, coherence, averages)
}
