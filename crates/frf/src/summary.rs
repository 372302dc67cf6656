//! What a file of functions says of itself, what the caller says in its place, and what nobody says.

use std::fmt;
use std::path::PathBuf;

use super::{ByteOrder, Coherence, Quantity, UnitSystem, relative_variance};

/// Different statements of one kind that are kept.
const MOST_LISTED: usize = 12;

/// How a function is written down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileFormat {
    /// Universal file, data set 58.
    UniversalText,
    /// Universal file, data set 58b.
    UniversalBinary(ByteOrder),
    /// Table (CSV).
    Table,
    /// NumPy archive (npz).
    Archive,
    /// MATLAB file (mat).
    Matlab,
}

impl fmt::Display for FileFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::UniversalText => "universal file, 58 (ASCII)",
            Self::UniversalBinary(ByteOrder::Little) => {
                "universal file, 58b (binary, little endian)"
            }
            Self::UniversalBinary(ByteOrder::Big) => "universal file, 58b (binary, big endian)",
            Self::Table => "table (CSV)",
            Self::Archive => "NumPy archive (npz)",
            Self::Matlab => "MATLAB file (mat)",
        })
    }
}

/// Who said something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StatedBy {
    /// The file.
    File,
    /// The caller, whose word takes the place of the file's.
    Caller,
}

/// Where the units of a function are from.
#[derive(Debug, Clone, PartialEq)]
pub enum UnitStatement {
    /// A label of the file, such as `g/N`.
    Label(String),
    /// Data set 164 of a universal file.
    Dataset164(UnitSystem),
    /// The caller.
    Caller(UnitSystem),
    /// Nobody: taken as SI.
    Assumed,
}

/// What was read from one file, and by whose word the values are what they were taken for.
#[derive(Debug, Clone, PartialEq)]
pub struct FileSummary {
    /// The file.
    pub path: PathBuf,
    /// Functions that were asked for.
    pub functions: usize,
    /// Functions that are there but were not asked for.
    pub left_out: usize,
    /// How the functions are written down, each way once.
    pub formats: Vec<FileFormat>,
    /// What was measured, and who says so, each once.
    pub quantities: Vec<(Quantity, StatedBy)>,
    /// Units of the functions, each once.
    pub units: Vec<UnitStatement>,
    /// Coherences of these functions.
    pub coherences: usize,
    /// Averages behind every function, where they are known, and who says so.
    pub averages: Option<(f64, StatedBy)>,
    /// Lowest, median and highest σ/|H| over the lines that coherence and averages give, where both are known.
    pub coherence_noise: Option<[f64; 3]>,
}

/// Lowest, median and highest σ/|H| of coherences with this number of averages.
pub(super) fn coherence_noise(coherences: &[Coherence], averages: f64) -> Option<[f64; 3]> {
    let lines = coherences
        .iter()
        .flat_map(|coherence| &coherence.gamma_squared);
    let mut noise: Vec<f64> = lines
        .map(|&gamma_squared| relative_variance(gamma_squared, averages).sqrt())
        .collect();
    noise.sort_by(f64::total_cmp);
    let median = noise.get(noise.len() / 2)?;
    Some([*noise.first()?, *median, *noise.last()?])
}

/// Statements about the functions of a file, each once.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Statements {
    pub(super) formats: Vec<FileFormat>,
    pub(super) quantities: Vec<(Quantity, StatedBy)>,
    pub(super) units: Vec<UnitStatement>,
    /// Whether the units of some function are stated by nobody.
    assumed_units: bool,
}

impl Statements {
    /// Takes in those about one more function.
    pub(super) fn add(
        &mut self,
        format: FileFormat,
        quantity: (Quantity, StatedBy),
        units: UnitStatement,
    ) {
        add(&mut self.formats, format);
        add(&mut self.quantities, quantity);
        self.assumed_units |= units == UnitStatement::Assumed;
        add(&mut self.units, units);
    }

    /// Takes in that a coherence alone is there, which has neither quantity nor unit.
    pub(super) fn add_coherence(&mut self, format: FileFormat) {
        add(&mut self.formats, format);
    }

    /// Takes in those about the functions of another file.
    pub(super) fn extend(&mut self, other: Self) {
        let Self {
            formats,
            quantities,
            units,
            assumed_units,
        } = other;
        formats
            .into_iter()
            .for_each(|own| add(&mut self.formats, own));
        quantities
            .into_iter()
            .for_each(|own| add(&mut self.quantities, own));
        units.into_iter().for_each(|own| add(&mut self.units, own));
        self.assumed_units |= assumed_units;
    }

    /// Whether somebody states the units of every function.
    pub(super) fn have_units(&self) -> bool {
        !self.assumed_units
    }
}

/// Adds what is not there yet; of a file with a label of its own for every function, some are enough.
fn add<T: PartialEq>(list: &mut Vec<T>, item: T) {
    if list.len() < MOST_LISTED && !list.contains(&item) {
        list.push(item);
    }
}
