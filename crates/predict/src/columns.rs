//! Columns of numbers with units in their names, as profiles and pressure fields come in.

use std::path::{Path, PathBuf};

use bolted_joint_files::Decimal;
use bolted_joint_files::text_file::{self, TextFileError};
use bolted_joint_files::text_table::{self, Cells};
use bolted_joint_frf::shown;

/// A column that a table must have.
#[derive(Debug, Clone, Copy)]
pub(super) struct Column {
    pub(super) name: &'static str,
    /// Units and how many SI units each is; the first is shown in messages.
    pub(super) units: &'static [(&'static str, f64)],
}

/// Units of length; the first is the usual one of a drawing.
pub(super) const LENGTHS: &[(&str, f64)] = &[
    ("mm", 1e-3),
    ("m", 1.0),
    ("um", 1e-6),
    ("µm", 1e-6),
    ("μm", 1e-6),
    ("nm", 1e-9),
];

/// The rows of a table in SI units.
#[derive(Debug)]
pub(super) struct Rows<const N: usize> {
    pub(super) path: PathBuf,
    /// Line of the column names, from 1.
    pub(super) header_line: usize,
    /// Line of each row, and its values in the order asked for.
    pub(super) rows: Vec<(usize, [f64; N])>,
}

impl<const N: usize> Rows<N> {
    pub(super) fn problem(
        &self,
        line: usize,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> TextFileError {
        TextFileError::in_line(&self.path, line, found, expected)
    }
}

/// Reads the columns `wanted` of a table; other columns are passed over.
///
/// Names are `distance_mm` or `distance [mm]`. Lines that begin with `#` are comments. Columns are separated by semicolons,
/// tabs or commas, whichever of them the row of names has first in this order; with semicolons or tabs decimals may be commas.
pub(super) fn read<const N: usize>(
    path: &Path,
    what: &'static str,
    wanted: [Column; N],
) -> Result<Rows<N>, TextFileError> {
    let text = text_file::read(path, what)?;
    let mut lines = text_table::rows(&text);
    let example: Vec<String> = wanted.iter().map(Column::example).collect();
    let Some((header_line, header)) = lines.next() else {
        let expected = format!("the row of column names, such as {}", example.join(","));
        return Err(TextFileError::in_line(
            path,
            1,
            "nothing but comments",
            expected,
        ));
    };
    let separator = text_table::separator(header);
    let mut tokeniser = Cells::separated_by(separator);
    let names: Vec<String> = tokeniser
        .names(header)
        .into_iter()
        .map(str::to_owned)
        .collect();
    let mut places = [(0, 1.0); N];
    for (place, column) in places.iter_mut().zip(wanted) {
        let mut matching = names
            .iter()
            .enumerate()
            .filter_map(|(index, name)| Some((index, column.to_si(name)?)));
        *place = matching.next().ok_or_else(|| {
            let units: Vec<&str> = column.units.iter().map(|(unit, _)| *unit).collect();
            let expected = format!(
                "a column {} with the unit in its name: {}",
                column.example(),
                units.join(", ")
            );
            TextFileError::in_line(path, header_line, shown(header.trim()), expected)
        })?;
        if let Some((second, _)) = matching.next() {
            let found = format!("a second column {}", shown(&names[second]));
            return Err(TextFileError::in_line(
                path,
                header_line,
                found,
                "one of each quantity",
            ));
        }
    }
    let mut decimal = Decimal::beside(separator);
    let mut rows = Vec::new();
    for (line, text) in lines {
        let cells = tokeniser.of(text);
        if cells.len() != names.len() {
            let found = format!("{} fields", cells.len());
            let expected = format!("{} as in the row of names", names.len());
            return Err(TextFileError::in_line(path, line, found, expected));
        }
        let mut values = [0.0; N];
        for (value, &(place, si)) in values.iter_mut().zip(&places) {
            let parsed = decimal.parse(cells[place]);
            let (number, used) = parsed.filter(|(n, _)| n.is_finite()).ok_or_else(|| {
                let found = format!("\"{}\" as {}", shown(cells[place]), names[place]);
                TextFileError::in_line(path, line, found, "a finite number such as 1.25e-3")
            })?;
            decimal = used;
            *value = number * si;
        }
        rows.push((line, values));
    }
    Ok(Rows {
        path: path.to_owned(),
        header_line,
        rows,
    })
}

impl Column {
    fn example(&self) -> String {
        let unit = self.units.first().map_or("", |(unit, _)| unit);
        format!("{}_{unit}", self.name)
    }

    /// SI units in one unit of a column of this name; `None` if it is another quantity, has no unit or an unknown one.
    fn to_si(self, name: &str) -> Option<f64> {
        let (word, unit) = match name.strip_suffix(']').and_then(|name| name.split_once('[')) {
            Some((word, unit)) => (word.trim(), unit.trim()),
            None => name.rsplit_once('_')?,
        };
        let known = |(known, si): &(&str, f64)| (*known == unit).then_some(*si);
        word.eq_ignore_ascii_case(self.name)
            .then(|| self.units.iter().find_map(known))?
    }
}
