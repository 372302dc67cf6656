//! The data sets of a universal file from first to last.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::binary::Form;
use super::dataset_name::dataset_name;
use super::datasets::Units;
use super::function_type::{COHERENCE, FREQUENCY_RESPONSE, function_type_name};
use super::header::{Header, InRecord, RECORDS, function_type};
use super::lines::Lines;
use super::meaning::{check_abscissa, decide};
use super::{UffProblem, binary, values};
use crate::gathered::Gathered;
use crate::read::opened;
use crate::summary::Statements;
use crate::{
    Coherence, Dof, FileFormat, Frf, FrfError, FrfReading, ReadOptions, Selection, SkippedDatasets,
    SkippedFunction, shown,
};

/// Reads the frequency response functions of a universal file.
///
/// Values become receptances in SI units (m/N, rad/N, m/(N·m), rad/(N·m)). What was measured follows from the specific
/// data types of records 9 and 10; unit and axis labels must agree with them, or decide where the types are unknown.
/// Units follow from data set 164 and from unit labels, which must agree; with neither, values are taken as SI.
/// Lines at 0 Hz of mobilities and accelerances are left out. Real ordinates are taken as real receptances and so on.
/// Ordinary coherences are read too. Functions that are not selected are passed over without a look at their values.
///
/// # Errors
/// [`FrfError::Read`] if the file cannot be read, [`FrfError::Uff`] with line and cause if it cannot be used.
pub fn read_uff58(path: impl AsRef<Path>, options: &ReadOptions) -> Result<FrfReading, FrfError> {
    let path = path.as_ref();
    let file = opened(path)?;
    let length = file
        .metadata()
        .ok()
        .filter(|m| m.is_file())
        .map(|m| m.len());
    read_uff58_of(BufReader::new(file), path, length, options)
}

/// As [`read_uff58`], from any reader; `name` stands for the path in messages.
///
/// # Errors
/// As [`read_uff58`].
pub fn read_uff58_from(
    reader: impl BufRead,
    name: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<FrfReading, FrfError> {
    read_uff58_of(reader, name.as_ref(), None, options)
}

/// As [`read_uff58_from`], where the file's length (bytes) is known.
pub(crate) fn read_uff58_of(
    reader: impl BufRead,
    name: &Path,
    length: Option<u64>,
    options: &ReadOptions,
) -> Result<FrfReading, FrfError> {
    let mut scan = Scan {
        lines: Lines::new(reader, name, length),
        selection: &options.selection,
        pending: Vec::new(),
        coherences: Vec::new(),
        not_selected: BTreeSet::new(),
        units: None,
        skipped_functions: Vec::new(),
        skipped_datasets: BTreeMap::new(),
        datasets: 0,
    };
    while scan.dataset()? {}
    scan.finish(options)
}

/// A function whose units may still be stated further down the file.
struct Pending {
    begun_at: usize,
    format: FileFormat,
    header: Header,
    lines: Gathered,
}

struct Scan<'options, R> {
    lines: Lines<R>,
    selection: &'options Selection,
    pending: Vec<Pending>,
    coherences: Vec<Coherence>,
    not_selected: BTreeSet<(Dof, Dof)>,
    units: Units,
    skipped_functions: Vec<SkippedFunction>,
    /// How many there are of each number.
    skipped_datasets: BTreeMap<String, usize>,
    /// Data sets of any kind that have been met.
    datasets: usize,
}

impl<R: BufRead> Scan<'_, R> {
    /// Reads or skips one data set; `false` at the end of the file.
    fn dataset(&mut self) -> Result<bool, FrfError> {
        let Some(begun) = self.lines.next_dataset(self.datasets == 0)? else {
            return Ok(false);
        };
        let begun_at = begun.at;
        match begun.number.as_str() {
            "58" => self.function(None, begun_at)?,
            "58b" => {
                let form = Form::from_line(&self.lines.text())
                    .map_err(|problem| self.lines.problem(problem))?;
                self.function(Some(form), begun_at)?;
            }
            "164" => self.lines.read_units(&mut self.units, begun_at)?,
            _ => {
                self.lines.pass_over(&begun)?;
                *self.skipped_datasets.entry(begun.number).or_default() += 1;
            }
        }
        self.datasets += 1;
        Ok(true)
    }

    fn function(&mut self, form: Option<Form>, begun_at: usize) -> Result<(), FrfError> {
        let records = self.records(begun_at)?;
        for _ in RECORDS..form.map_or(RECORDS, |form| form.text_lines) {
            self.lines.advance()?;
        }
        let in_header = |lines: &Lines<R>, problem| in_header(lines, begun_at, problem);
        let kind = function_type(&records).map_err(|problem| in_header(&self.lines, problem))?;
        let skipped = |between| SkippedFunction {
            line: begun_at,
            kind: function_type_name(kind),
            between,
        };
        let header = match Header::from_records(&records) {
            Ok(header) => header,
            // What is passed over need not be understood, unless it takes that to know where it ends.
            Err(_) if kind != FREQUENCY_RESPONSE && form.is_none() => {
                self.lines.skip_rest("58", begun_at)?;
                self.skipped_functions.push(skipped(None));
                return Ok(());
            }
            Err(problem) => return Err(in_header(&self.lines, problem)),
        };
        let (response, reference) = (header.response, header.reference);
        let is_read = matches!(kind, FREQUENCY_RESPONSE | COHERENCE);
        let selection = Some(self.selection).filter(|s| is_read && s.wants(response, reference));
        let gathered = match (form, selection) {
            (Some(form), selection) => {
                binary::read(&mut self.lines, header.layout, form, begun_at, selection)?
            }
            (None, Some(selection)) => {
                values::read(&mut self.lines, header.layout, begun_at, selection)?
            }
            (None, None) => {
                self.lines.skip_rest("58", begun_at)?;
                Gathered::default()
            }
        };
        match (kind, selection) {
            (FREQUENCY_RESPONSE, Some(_)) => self.pending.push(Pending {
                begun_at,
                format: form.map_or(FileFormat::UniversalText, |form| {
                    FileFormat::UniversalBinary(form.order)
                }),
                header,
                lines: gathered,
            }),
            (FREQUENCY_RESPONSE, None) => {
                self.not_selected.insert((response, reference));
            }
            (COHERENCE, Some(_)) => self.coherence(&header, gathered, begun_at)?,
            (COHERENCE, None) => {}
            _ => self
                .skipped_functions
                .push(skipped(Some((response, reference)))),
        }
        Ok(())
    }

    fn records(&mut self, begun_at: usize) -> Result<[String; RECORDS], FrfError> {
        let mut records: [String; RECORDS] = Default::default();
        for (index, record) in records.iter_mut().enumerate() {
            if !self.lines.advance()? {
                return Err(self.lines.ends_inside("58", begun_at));
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
        Ok(records)
    }

    fn coherence(
        &mut self,
        header: &Header,
        lines: Gathered,
        begun_at: usize,
    ) -> Result<(), FrfError> {
        check_abscissa(&header.abscissa)
            .map_err(|problem| in_header(&self.lines, begun_at, problem))?;
        let gamma_squared = lines.values.iter().map(|value| value.re).collect();
        let coherence = Coherence::new(
            header.response,
            header.reference,
            lines.frequency_hz,
            gamma_squared,
        );
        self.coherences.push(coherence.map_err(|source| {
            self.lines
                .problem_at(begun_at, UffProblem::Function(Box::new(source)))
        })?);
        Ok(())
    }

    fn finish(self, options: &ReadOptions) -> Result<FrfReading, FrfError> {
        if self.datasets == 0 {
            return Err(self.lines.problem_at(1, UffProblem::Empty));
        }
        let units = self.units.map(|(_, units)| units);
        let mut statements = Statements::default();
        let mut functions = Vec::with_capacity(self.pending.len());
        for function in self.pending {
            let begun_at = function.begun_at;
            let meaning = decide(&function.header, units, options)
                .map_err(|problem| in_header(&self.lines, begun_at, problem))?;
            statements.add(function.format, meaning.quantity, meaning.units);
            let pair = (function.header.response, function.header.reference);
            let frf: Result<Frf, FrfError> =
                function
                    .lines
                    .into_frf(pair, meaning.quantity.0, meaning.to_si, self.selection);
            functions.push(frf.map_err(|source| {
                match source {
                    // No fault of the function: the file has other lines than those that are asked for.
                    source @ FrfError::EmptyBand { .. } => FrfError::InFile {
                        path: self.lines.path().to_owned(),
                        source: Box::new(source),
                    },
                    source => self
                        .lines
                        .problem_at(begun_at, UffProblem::Function(Box::new(source))),
                }
            })?);
        }
        Ok(FrfReading {
            path: self.lines.path().to_owned(),
            functions,
            coherences: self.coherences,
            averages: options.averages_or(None),
            not_selected: self.not_selected,
            skipped_functions: self.skipped_functions,
            skipped_datasets: self
                .skipped_datasets
                .into_iter()
                .map(|(number, count)| SkippedDatasets {
                    holds: dataset_name(&number),
                    number: shown(&number),
                    count,
                })
                .collect(),
            statements,
            coherence_files: Vec::new(),
            taken: Vec::new(),
        })
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
