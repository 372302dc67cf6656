//! The data sets of a universal file from first to last.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use num_complex::Complex64;

use super::header::{
    FREQUENCY_RESPONSE, Header, InRecord, RECORDS, function_type, function_type_name,
};
use super::lines::Lines;
use super::meaning::{Meaning, decide};
use super::{UffProblem, UnitSystem, values};
use crate::frf::{Frf, FrfError, FrfSet, Quantity};

/// How much of a line an error message shows.
const SHOWN_CHARACTERS: usize = 40;

/// What the caller knows better than the file.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct UffOptions {
    /// Takes the place of data types and labels: needed where they contradict each other or say nothing.
    pub quantity: Option<Quantity>,
    /// Takes the place of data set 164 and unit labels: needed where they contradict each other or are wrong.
    pub units: Option<UnitSystem>,
}

/// A data set 58 that is no frequency response function and was passed over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SkippedFunction {
    line: usize,
    kind: &'static str,
}

impl SkippedFunction {
    /// The line at which its data set begins.
    #[must_use]
    pub fn line(self) -> usize {
        self.line
    }

    /// The standard's name of its function type, such as "coherence".
    #[must_use]
    pub fn kind(self) -> &'static str {
        self.kind
    }
}

/// What was read from a universal file.
#[derive(Debug, Clone, PartialEq)]
pub struct UffReading {
    path: PathBuf,
    functions: Vec<Frf>,
    skipped_functions: Vec<SkippedFunction>,
    skipped_datasets: usize,
    units_stated: bool,
}

impl UffReading {
    /// The functions in the file's order, as receptances in SI units.
    #[must_use]
    pub fn functions(&self) -> &[Frf] {
        &self.functions
    }

    /// Data sets 58 that hold something else than a frequency response function.
    #[must_use]
    pub fn skipped_functions(&self) -> &[SkippedFunction] {
        &self.skipped_functions
    }

    /// The number of data sets that are neither functions (58) nor units (164).
    #[must_use]
    pub fn skipped_datasets(&self) -> usize {
        self.skipped_datasets
    }

    /// Whether the file (or the caller) states the units of every function; where it does not, SI was assumed.
    #[must_use]
    pub fn units_are_stated(&self) -> bool {
        self.units_stated
    }

    /// The functions as one set.
    ///
    /// # Errors
    /// [`FrfError::InFile`] around what [`FrfSet::new`] refuses.
    pub fn into_set(self) -> Result<FrfSet, FrfError> {
        FrfSet::new(self.functions).map_err(|source| FrfError::InFile {
            path: self.path,
            source: Box::new(source),
        })
    }
}

/// Reads the frequency response functions of a universal file.
///
/// Values become receptances in SI units (m/N, rad/N, m/(N·m), rad/(N·m)). What was measured follows from the specific
/// data types of records 9 and 10; unit and axis labels must agree with them, or decide where the types are unknown.
/// Units follow from data set 164 and from unit labels, which must agree; with neither, values are taken as SI.
/// Lines at 0 Hz of mobilities and accelerances are left out. Real ordinates are taken as real receptances and so on.
///
/// # Errors
/// [`FrfError::Read`] if the file cannot be read, [`FrfError::Uff`] with line and cause if it cannot be used.
pub fn read_uff58(path: impl AsRef<Path>, options: &UffOptions) -> Result<UffReading, FrfError> {
    let path = path.as_ref();
    let file = File::open(path).map_err(|source| FrfError::Read {
        path: path.to_owned(),
        source,
    })?;
    read_uff58_from(BufReader::new(file), path, options)
}

/// As [`read_uff58`], from any reader; `name` stands for the path in messages.
///
/// # Errors
/// As [`read_uff58`].
pub fn read_uff58_from(
    reader: impl BufRead,
    name: impl AsRef<Path>,
    options: &UffOptions,
) -> Result<UffReading, FrfError> {
    let mut scan = Scan {
        lines: Lines::new(reader, name.as_ref()),
        pending: Vec::new(),
        units: None,
        skipped_functions: Vec::new(),
        skipped_datasets: 0,
    };
    while scan.dataset()? {}
    scan.finish(options)
}

/// A function whose units may still be stated further down the file.
struct Pending {
    begun_at: usize,
    header: Header,
    frequency_hz: Vec<f64>,
    values: Vec<Complex64>,
}

struct Scan<R> {
    lines: Lines<R>,
    pending: Vec<Pending>,
    /// Units of the first data set 164 and the line at which it begins.
    units: Option<(usize, UnitSystem)>,
    skipped_functions: Vec<SkippedFunction>,
    skipped_datasets: usize,
}

impl<R: BufRead> Scan<R> {
    /// Reads or skips one data set; `false` at the end of the file.
    fn dataset(&mut self) -> Result<bool, FrfError> {
        loop {
            if !self.lines.advance()? {
                return Ok(false);
            }
            if self.lines.is_delimiter() {
                break;
            }
            if !self.lines.is_blank() {
                let found = shown(&self.lines.text());
                return Err(self.lines.problem(match self.nothing_yet() {
                    true => UffProblem::NotUniversalFile { found },
                    false => UffProblem::BetweenDatasets { found },
                }));
            }
        }
        let begun_at = self.lines.number();
        if !self.lines.advance()? {
            return Err(self.ends_inside("without a number", begun_at));
        }
        let text = self.lines.text();
        let number = text
            .split_whitespace()
            .next()
            .unwrap_or_default()
            .to_lowercase();
        match number.as_str() {
            "58" => self.function(begun_at)?,
            // The byte order, the format and the byte count of the values follow on this line.
            "58b" => return Err(self.lines.problem(UffProblem::BinaryDataset58)),
            "164" => self.units(begun_at)?,
            _ if number.starts_with(|c: char| c.is_ascii_digit()) => {
                self.skip_rest(&number, begun_at)?;
                self.skipped_datasets += 1;
            }
            _ => {
                let found = shown(&self.lines.text());
                return Err(self.lines.problem(UffProblem::DatasetNumber { found }));
            }
        }
        Ok(true)
    }

    fn nothing_yet(&self) -> bool {
        self.pending.is_empty()
            && self.units.is_none()
            && self.skipped_functions.is_empty()
            && self.skipped_datasets == 0
    }

    fn ends_inside(&self, dataset: &str, begun_at: usize) -> FrfError {
        let dataset = dataset.to_owned();
        self.lines
            .problem(UffProblem::EndsInside { dataset, begun_at })
    }

    /// Goes on to the closing `-1`.
    fn skip_rest(&mut self, dataset: &str, begun_at: usize) -> Result<(), FrfError> {
        loop {
            if !self.lines.advance()? {
                return Err(self.ends_inside(dataset, begun_at));
            }
            if self.lines.is_delimiter() {
                return Ok(());
            }
        }
    }

    fn function(&mut self, begun_at: usize) -> Result<(), FrfError> {
        let mut records: [String; RECORDS] = Default::default();
        for (index, record) in records.iter_mut().enumerate() {
            if !self.lines.advance()? {
                return Err(self.ends_inside("58", begun_at));
            }
            if self.lines.is_delimiter() {
                return Err(self.lines.problem(UffProblem::HeaderEnds {
                    dataset: 58,
                    begun_at,
                    found: index,
                    expected: RECORDS,
                }));
            }
            *record = self.lines.text().into_owned();
        }
        let kind =
            function_type(&records).map_err(|problem| in_header(&self.lines, begun_at, problem))?;
        if kind != FREQUENCY_RESPONSE {
            self.skip_rest("58", begun_at)?;
            self.skipped_functions.push(SkippedFunction {
                line: begun_at,
                kind: function_type_name(kind),
            });
            return Ok(());
        }
        let header = Header::from_records(&records)
            .map_err(|problem| in_header(&self.lines, begun_at, problem))?;
        let (frequency_hz, values) = values::read(&mut self.lines, header.layout, begun_at)?;
        self.pending.push(Pending {
            begun_at,
            header,
            frequency_hz,
            values,
        });
        Ok(())
    }

    fn units(&mut self, begun_at: usize) -> Result<(), FrfError> {
        let mut records = Vec::new();
        loop {
            if !self.lines.advance()? {
                return Err(self.ends_inside("164", begun_at));
            }
            if self.lines.is_delimiter() {
                break;
            }
            records.push(self.lines.text().into_owned());
        }
        if records.len() < 2 {
            return Err(self.lines.problem(UffProblem::HeaderEnds {
                dataset: 164,
                begun_at,
                found: records.len(),
                expected: 2,
            }));
        }
        // The first record is two lines below the opening `-1`.
        let units = UnitSystem::from_records(&records)
            .map_err(|(index, problem)| self.lines.problem_at(begun_at + 2 + index, problem))?;
        match self.units {
            None => self.units = Some((begun_at, units)),
            Some((_, first)) if first.agrees_with(units) => {}
            Some((first_line, _)) => {
                return Err(self
                    .lines
                    .problem_at(begun_at, UffProblem::SecondUnits { first_line }));
            }
        }
        Ok(())
    }

    fn finish(self, options: &UffOptions) -> Result<UffReading, FrfError> {
        if self.nothing_yet() {
            return Err(self.lines.problem_at(1, UffProblem::Empty));
        }
        let units = self.units.map(|(_, units)| units);
        let mut units_stated = true;
        let mut functions = Vec::with_capacity(self.pending.len());
        for function in self.pending {
            let begun_at = function.begun_at;
            let meaning = decide(&function.header, units, options)
                .map_err(|problem| in_header(&self.lines, begun_at, problem))?;
            units_stated &= meaning.units_stated;
            functions.push(function.into_frf(meaning).map_err(|source| {
                self.lines
                    .problem_at(begun_at, UffProblem::Function(Box::new(source)))
            })?);
        }
        Ok(UffReading {
            path: self.lines.path().to_owned(),
            functions,
            skipped_functions: self.skipped_functions,
            skipped_datasets: self.skipped_datasets,
            units_stated,
        })
    }
}

impl Pending {
    fn into_frf(self, meaning: Meaning) -> Result<Frf, FrfError> {
        let values = self
            .values
            .into_iter()
            .map(|value| value * meaning.to_si)
            .collect();
        Frf::from_measured(
            self.header.response,
            self.header.reference,
            meaning.quantity,
            self.frequency_hz,
            values,
        )
    }
}

/// An error in a header record, at that record's line: record 1 is two lines below the opening `-1`.
fn in_header<R: BufRead>(
    lines: &Lines<R>,
    begun_at: usize,
    (record, problem): InRecord,
) -> FrfError {
    lines.problem_at(begun_at + 1 + record, problem)
}

/// The beginning of a line, fit for a message.
fn shown(text: &str) -> String {
    let mut shown: String = text
        .trim()
        .chars()
        .take(SHOWN_CHARACTERS)
        .flat_map(char::escape_debug)
        .collect();
    if text.trim().chars().count() > SHOWN_CHARACTERS {
        shown.push('…');
    }
    shown
}
