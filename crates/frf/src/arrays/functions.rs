//! A file of arrays, made into functions.

use std::path::Path;

use super::axes::{Counts, named, order};
use super::matrix::{Functions, Place};
use super::members::{Members, quantity};
use super::{Array, ArrayFile};
use crate::{FrfError, FrfReading, Quantity, ReadOptions, TableProblem};

/// Names of frequencies (Hz). Names of two letters or more are the same in capitals.
const FREQUENCY: &[&str] = &[
    "frequency",
    "frequencies",
    "frequency_hz",
    "freq",
    "freqs",
    "freq_hz",
    "f",
    "f_hz",
    "hz",
];
const MATRIX: &[&str] = &[
    "frf",
    "frfs",
    "H",
    "H1",
    "H2",
    "Hv",
    "Y",
    "receptance",
    "mobility",
    "accelerance",
    "inertance",
    "tf",
    "transfer_function",
];
const RESPONSE: &[&str] = &[
    "response",
    "responses",
    "response_dof",
    "response_dofs",
    "output",
    "outputs",
];
const REFERENCE: &[&str] = &[
    "reference",
    "references",
    "reference_dof",
    "reference_dofs",
    "excitation",
    "input",
    "inputs",
];
pub(super) const COHERENCE: &[&str] = &["coherence", "coh", "gamma_squared", "gamma2"];
pub(super) const AXES: &[&str] = &["axes"];
pub(super) const QUANTITY: &[&str] = &["quantity"];
pub(super) const UNITS: &[&str] = &["unit", "units"];
pub(super) const AVERAGES: &[&str] = &["averages", "n_averages", "averages_n"];

/// More functions than any test has: a thousand responses to a thousand references.
const MOST_FUNCTIONS: usize = 1 << 20;

/// Whether an array of this name is one of those that functions need.
pub(super) fn is_of_functions(name: &str) -> bool {
    let roles = [FREQUENCY, MATRIX, RESPONSE, REFERENCE, COHERENCE];
    let mut known = roles.into_iter().flatten();
    known.any(|known| known.eq_ignore_ascii_case(name))
}

/// Whether an array of this name means anything beside functions.
pub(super) fn is_known(name: &str) -> bool {
    let beside = [AXES, QUANTITY, UNITS, AVERAGES];
    let mut known = beside.into_iter().flatten();
    is_of_functions(name) || known.any(|known| known.eq_ignore_ascii_case(name))
}

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

/// What a matrix of this name holds; one that was found by being complex may as well be a spectrum of displacements.
fn of_name(name: &str) -> Option<Quantity> {
    let is_known = MATRIX.iter().any(|known| known.eq_ignore_ascii_case(name));
    Quantity::named(name).filter(|_| is_known)
}

/// What the array `quantity` says, or the matrix's own name, where nobody knows better.
fn one_quantity(
    stated: Option<Quantity>,
    matrix: &str,
    options: &ReadOptions,
) -> Result<Option<Quantity>, TableProblem> {
    let by_name = of_name(matrix);
    match (stated, by_name) {
        (Some(stated), Some(by_name)) if stated != by_name && options.quantity.is_none() => {
            Err(TableProblem::at(
                "array quantity",
                format_args!("{stated} beside a matrix named {matrix}"),
                format_args!(
                    "one quantity; correct one of them, or name the matrix frf, or state the right one in the study, such as \
                     quantity = \"{by_name}\" beside frf"
                ),
            ))
        }
        _ => Ok(stated.or(by_name)),
    }
}

fn functions_of<F: ArrayFile>(
    file: &mut F,
    path: &Path,
    options: &ReadOptions,
) -> Result<FrfReading, TableProblem> {
    let mut members = Members(file);
    let frequency = members.required(FREQUENCY, "frequency (Hz)")?;
    let matrix = members.matrix(MATRIX, COHERENCE)?;
    let response = members.required(RESPONSE, "response, degrees of freedom such as \"11:+Y\"")?;
    let reference =
        members.required(REFERENCE, "reference, degrees of freedom such as \"2:+Y\"")?;
    let coherence = members.find(COHERENCE)?;
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
    let units = members.units([counts.responses, counts.references])?;
    let averages = members.averages()?;
    let of_matrix = matrix.as_ref().or(coherence.as_ref());
    let of_matrix = of_matrix.cloned().unwrap_or_default();
    members.refuse_misspelt(counts.elements())?;
    // Before anything is reserved for them: as many functions as the names make are in the file, and not too many, since a
    // swollen matrix takes next to no room there.
    let matrix_place = place(&of_matrix, &members.numbers(&of_matrix)?)?;
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
    let mut taken = vec![
        ("frequencies", frequency),
        ("responses", response),
        ("references", reference),
    ];
    let (stated, lines) = match &matrix {
        Some(matrix) => {
            taken.push(("functions", matrix.clone()));
            let quantity = one_quantity(quantity, matrix, options)?;
            let stated = functions.stated(quantity, &units)?;
            (
                stated,
                functions.gather(members.numbers(matrix)?, &matrix_place)?,
            )
        }
        // coherences alone, for functions of another file
        None => (Vec::new(), Vec::new()),
    };
    taken.extend(coherence.iter().map(|name| ("coherence", name.clone())));
    let coherence = match coherence {
        None => None,
        Some(name) => {
            let array = members.numbers(&name)?;
            let coherence_place = place(&name, &array)?;
            Some(functions.gather(array, &coherence_place)?)
        }
    };
    let mut reading = functions.reading(F::FORMAT, path, &stated, lines, coherence, averages)?;
    reading.taken = taken;
    Ok(reading)
}
