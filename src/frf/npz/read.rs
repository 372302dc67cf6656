//! An archive of arrays, made into functions; of the matrix only the functions and lines that are asked for are kept.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

use num_complex::Complex64;
use zip::ZipArchive;
use zip::read::ZipFile;

use super::NpzProblem;
use super::array::{Array, Header};
use super::axes::{Counts, Over, named, order};
use crate::frf::gathered::Gathered;
use crate::frf::statement::{Stated, Statement};
use crate::frf::{Coherence, Dof, FrfError, FrfReading, Quantity, ReadOptions};

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

/// Deflate cannot make data smaller than by this factor; a member that claims more is damaged or made to harm.
const LARGEST_RATIO: u64 = 1100;

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
) -> Result<FrfReading, NpzProblem> {
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
    // Before anything is reserved for them: as many functions as the names make are in the file.
    let matrix_place = place(&matrix, &array.header)?;
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

/// The arrays of a file, by name.
struct Archive<R> {
    zip: ZipArchive<R>,
    names: Vec<String>,
}

impl<R: Read + Seek> Archive<R> {
    fn open(reader: R) -> Result<Self, NpzProblem> {
        let zip = ZipArchive::new(reader).map_err(|error| NpzProblem::Archive {
            reason: error.to_string(),
        })?;
        let names = zip
            .file_names()
            .filter_map(|name| Some(name.ok()?.strip_suffix(".npy")?.to_owned()))
            .collect();
        Ok(Self { zip, names })
    }

    /// The one array that has one of these names.
    fn find(&self, wanted: &[&str]) -> Result<Option<String>, NpzProblem> {
        let mut found = self
            .names
            .iter()
            .filter(|name| wanted.contains(&name.as_str()));
        match (found.next(), found.next()) {
            (Some(first), Some(second)) => Err(NpzProblem::TwoOfAKind {
                first: first.clone(),
                second: second.clone(),
            }),
            (first, _) => Ok(first.cloned()),
        }
    }

    fn required(&self, names: &[&str], wanted: &'static str) -> Result<String, NpzProblem> {
        self.find(names)?.ok_or_else(|| NpzProblem::Missing {
            wanted,
            there: match self.names.is_empty() {
                true => "of no name at all".to_owned(),
                false => crate::frf::shown(&self.names.join(", ")),
            },
        })
    }

    fn array(&mut self, name: &str) -> Result<Array<BufReader<ZipFile<'_, R>>>, NpzProblem> {
        let file =
            self.zip
                .by_name(&format!("{name}.npy"))
                .map_err(|error| NpzProblem::Archive {
                    reason: format!("array {name}: {error}"),
                })?;
        let (bytes, stored) = (file.size(), file.compressed_size());
        if bytes > stored.saturating_mul(LARGEST_RATIO) {
            return Err(NpzProblem::Length {
                array: name.to_owned(),
                found: stored,
                expected: bytes,
            });
        }
        Array::open(name, BufReader::new(file), bytes)
    }

    /// The one text of an array, if it is there.
    fn text(&mut self, name: &str) -> Result<Option<String>, NpzProblem> {
        if !self.names.iter().any(|known| known == name) {
            return Ok(None);
        }
        let array = self.array(name)?;
        one(name, &array.header)?;
        Ok(array.texts(|_| Ok(()))?.pop())
    }

    fn averages(&mut self) -> Result<Option<f64>, NpzProblem> {
        let name = "averages";
        if !self.names.iter().any(|known| known == name) {
            return Ok(None);
        }
        let array = self.array(name)?;
        one(name, &array.header)?;
        Ok(array
            .reals(|_, number| match number.is_finite() && number >= 1.0 {
                true => Ok(()),
                false => Err(value(name, number, "a number of at least 1")),
            })?
            .pop())
    }
}

fn value(array: &str, found: impl ToString, expected: &'static str) -> NpzProblem {
    NpzProblem::Value {
        array: array.to_owned(),
        found: found.to_string(),
        expected,
    }
}

fn one(array: &str, header: &Header) -> Result<(), NpzProblem> {
    match header.shape.iter().all(|&length| length == 1) {
        true => Ok(()),
        false => Err(wrong_shape(array, header, "one entry")),
    }
}

fn wrong_shape(array: &str, header: &Header, expected: &str) -> NpzProblem {
    NpzProblem::Shape {
        array: array.to_owned(),
        found: format!("{:?}", header.shape),
        expected: expected.to_owned(),
    }
}

/// Strictly increasing frequencies, Hz; met early, since a swollen array would have to repeat itself.
fn frequencies(array: Array<impl Read>, name: &str) -> Result<Vec<f64>, NpzProblem> {
    if array
        .header
        .shape
        .iter()
        .filter(|&&length| length != 1)
        .count()
        > 1
    {
        return Err(wrong_shape(name, &array.header, "one axis"));
    }
    let frequencies = array.reals(|before, hz| {
        let good = hz.is_finite() && hz >= 0.0 && before.is_none_or(|before| before < hz);
        let expected =
            "finite frequencies in Hz, not negative and strictly increasing; sort the lines";
        good.then_some(()).ok_or_else(|| value(name, hz, expected))
    })?;
    match frequencies.is_empty() {
        true => Err(value(name, "no entry", "at least one frequency in Hz")),
        false => Ok(frequencies),
    }
}

fn dofs(array: Array<impl Read>, name: &str) -> Result<Vec<Dof>, NpzProblem> {
    if array
        .header
        .shape
        .iter()
        .filter(|&&length| length != 1)
        .count()
        > 1
    {
        return Err(wrong_shape(name, &array.header, "one axis"));
    }
    let mut known = BTreeSet::new();
    let mut dofs = Vec::new();
    array.texts(|text| {
        let dof: Dof = text.parse().map_err(|source| NpzProblem::Dof {
            array: name.to_owned(),
            entry: dofs.len() + 1,
            source,
        })?;
        if !known.insert(dof) {
            return Err(NpzProblem::Twice {
                array: name.to_owned(),
                found: text.to_owned(),
            });
        }
        dofs.push(dof);
        Ok(())
    })?;
    Ok(dofs)
}

fn quantity(text: &str) -> Result<Quantity, NpzProblem> {
    let expected = "receptance, mobility or accelerance";
    by_name(&text.to_lowercase()).ok_or_else(|| {
        value(
            "quantity",
            format!("\"{}\"", crate::frf::shown(text)),
            expected,
        )
    })
}

fn by_name(name: &str) -> Option<Quantity> {
    [
        Quantity::Receptance,
        Quantity::Mobility,
        Quantity::Accelerance,
    ]
    .into_iter()
    .find(|quantity| quantity.to_string() == name)
}

/// How the elements of a matrix lie.
struct Place {
    order: Vec<Over>,
    shape: Vec<usize>,
    fortran_order: bool,
}

impl Place {
    /// Response, reference and line of the element at each place, in the order of the file.
    fn each(&self) -> impl Iterator<Item = [usize; 3]> {
        let axes = self.shape.len();
        let mut at = vec![0; axes];
        let count: usize = self.shape.iter().product();
        (0..count).map(move |_| {
            let mut indices = [0; 3];
            for (&over, &index) in self.order.iter().zip(&at) {
                indices[match over {
                    Over::Response => 0,
                    Over::Reference => 1,
                    Over::Frequency => 2,
                }] = index;
            }
            for step in 0..axes {
                let axis = if self.fortran_order {
                    step
                } else {
                    axes - 1 - step
                };
                at[axis] += 1;
                if at[axis] < self.shape[axis] {
                    break;
                }
                at[axis] = 0;
            }
            indices
        })
    }
}

/// The functions that the names of an archive make.
struct Functions<'options> {
    pairs: Vec<(Dof, Dof)>,
    references: usize,
    frequency_hz: Vec<f64>,
    options: &'options ReadOptions,
}

impl Functions<'_> {
    fn wants(&self, (response, reference): (Dof, Dof)) -> bool {
        self.options.selection.wants(response, reference)
    }

    /// What each function is, if it is asked for.
    fn stated(
        &self,
        quantity: Option<Quantity>,
        unit: Option<&str>,
    ) -> Result<Vec<Option<Stated>>, NpzProblem> {
        self.pairs
            .iter()
            .map(|&(response, reference)| {
                let statement = Statement {
                    response,
                    reference,
                    quantity,
                    unit,
                };
                self.wants((response, reference))
                    .then(|| {
                        statement
                            .decide(self.options)
                            .map_err(NpzProblem::Statement)
                    })
                    .transpose()
            })
            .collect()
    }

    /// The wanted lines of each wanted function, nothing of the others.
    fn gather(
        &self,
        array: Array<impl Read>,
        place: &Place,
    ) -> Result<Vec<Vec<Complex64>>, NpzProblem> {
        let first = self
            .frequency_hz
            .partition_point(|&hz| self.before_band(hz));
        let last = self
            .frequency_hz
            .partition_point(|&hz| self.before_band(hz) || self.in_band(hz));
        let mut lines: Vec<Vec<Complex64>> = self
            .pairs
            .iter()
            .map(|&pair| match self.wants(pair) {
                true => vec![Complex64::default(); last - first],
                false => Vec::new(),
            })
            .collect();
        let mut places = place.each();
        array.each_complex(|value| {
            if let Some([response, reference, line]) = places.next() {
                let function = &mut lines[response * self.references + reference];
                if let Some(kept) = line
                    .checked_sub(first)
                    .and_then(|line| function.get_mut(line))
                {
                    *kept = value;
                }
            }
            Ok(())
        })?;
        Ok(lines)
    }

    fn in_band(&self, hz: f64) -> bool {
        self.options.selection.wants_line(hz)
    }

    fn before_band(&self, hz: f64) -> bool {
        self.options
            .selection
            .band_hz()
            .is_some_and(|[from, _]| hz < from)
    }

    fn reading(
        self,
        path: &Path,
        stated: &[Option<Stated>],
        lines: Vec<Vec<Complex64>>,
        coherence: Option<Vec<Vec<Complex64>>>,
        averages: Option<f64>,
    ) -> Result<FrfReading, NpzProblem> {
        let function = |source| NpzProblem::Function(Box::new(source));
        let kept_hz: Vec<f64> = self
            .frequency_hz
            .iter()
            .copied()
            .filter(|&hz| self.in_band(hz))
            .collect();
        let mut reading = FrfReading {
            path: path.to_owned(),
            functions: Vec::new(),
            coherences: Vec::new(),
            averages: self.options.averages.or(averages),
            not_selected: BTreeSet::new(),
            skipped_functions: Vec::new(),
            skipped_datasets: 0,
            units_stated: true,
        };
        for ((&pair, stated), values) in self.pairs.iter().zip(stated).zip(lines) {
            let Some(stated) = stated else {
                reading.not_selected.insert(pair);
                continue;
            };
            reading.units_stated &= stated.units_stated;
            let gathered = Gathered::of_band(kept_hz.clone(), values, &self.frequency_hz);
            let selection = &self.options.selection;
            let frf = gathered.into_frf(pair, stated.quantity, stated.to_si, selection);
            reading.functions.push(frf.map_err(function)?);
        }
        for (&pair, values) in self.pairs.iter().zip(coherence.unwrap_or_default()) {
            if self.wants(pair) {
                let gamma_squared = values.iter().map(|value| value.re).collect();
                let coherence = Coherence::new(pair.0, pair.1, kept_hz.clone(), gamma_squared);
                reading.coherences.push(coherence.map_err(function)?);
            }
        }
        Ok(reading)
    }
}
