//! An archive of arrays, made into functions.

use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

use super::array::Header;
use super::axes::{Counts, named, order};
use super::matrix::{Functions, Place};
use super::members::{Archive, by_name, dofs, frequencies, quantity};
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

/// Reads the functions of a NumPy archive (`.npz`), stored or deflated.
///
/// Its arrays are `frequency` (Hz), `frf` (real or complex, with one axis for responses, one for references, one for
/// frequencies; axes of length one may be missing), `response` and `reference` (degrees of freedom such as `11:+Y`), and if need be
/// `axes` (such as `frequency,response,reference`), `quantity`, `unit`, `coherence` (as `frf`) and `averages`. Where lengths are
/// equal and `axes` is not there, the file is refused. Values become receptances in SI units.
///
/// # Errors
/// [`FrfError::Read`] if the file cannot be read, [`FrfError::Npz`] with the cause if it cannot be used.
pub fn read_npz(path: impl AsRef<Path>, options: &ReadOptions) -> Result<FrfReading, FrfError> {
    let path = path.as_ref();
    let file = File::open(path).map_err(|source| FrfError::Read {
        path: path.to_owned(),
        source,
    })?;
    read_npz_from(BufReader::new(file), path, options)
}

/// As [`read_npz`], from any reader; `name` stands for the path in messages.
///
/// # Errors
/// As [`read_npz`].
pub fn read_npz_from(
    reader: impl Read + Seek,
    name: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<FrfReading, FrfError> {
    let path = name.as_ref();
    read(reader, path, options).map_err(|problem| FrfError::Npz {
        path: path.to_owned(),
        problem: Box::new(problem),
    })
}

fn read(
    reader: impl Read + Seek,
    path: &Path,
    options: &ReadOptions,
) -> Result<FrfReading, TableProblem> {
    let mut archive = Archive::open(reader)?;
    let frequency = archive.required(FREQUENCY, "frequency (Hz)")?;
    let matrix = archive.required(MATRIX, "frf, the matrix of functions")?;
    let response = archive.required(RESPONSE, "response, degrees of freedom such as \"11:+Y\"")?;
    let reference =
        archive.required(REFERENCE, "reference, degrees of freedom such as \"2:+Y\"")?;
    let frequency_hz = frequencies(archive.array(&frequency)?, &frequency)?;
    let responses = dofs(archive.array(&response)?, &response)?;
    let references = dofs(archive.array(&reference)?, &reference)?;
    let counts = Counts {
        responses: responses.len(),
        references: references.len(),
        frequencies: frequency_hz.len(),
    };
    let axes = archive.text("axes")?.map(|text| named(&text)).transpose()?;
    let place = |array: &str, header: &Header| {
        order(array, &header.shape, counts, axes.as_deref()).map(|order| Place {
            order,
            shape: header.shape.clone(),
            fortran_order: header.fortran_order,
        })
    };
    let quantity = archive
        .text("quantity")?
        .map(|text| quantity(&text))
        .transpose()?;
    let unit = archive.text("unit")?;
    let averages = archive.averages()?;
    let array = archive.array(&matrix)?;
    // Before anything is reserved for them: as many functions as the names make are in the file, and not too many, since a
    // swollen matrix takes next to no room there.
    let matrix_place = place(&matrix, &array.header)?;
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
    let coherence = match archive.find(&["coherence"])? {
        None => None,
        Some(name) => {
            let array = archive.array(&name)?;
            let coherence_place = place(&name, &array.header)?;
            Some(functions.gather(array, &coherence_place)?)
        }
    };
    functions.reading(path, &stated, lines, coherence, averages)
}
