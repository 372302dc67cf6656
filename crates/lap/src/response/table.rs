//! Columns of numbers with units in their names, as the tables of responses have them.

use std::collections::HashSet;
use std::path::Path;

use bolted_joint_files::Decimal;
use bolted_joint_files::text_file::{self, TextFileError};
use bolted_joint_files::text_table::{self, Cells};

use crate::error::LapError;

/// A table of numbers.
pub(super) struct NumberTable<'p> {
    path: &'p Path,
    names: Vec<String>,
    /// Number of the line in the file, and its values; an empty cell is none.
    rows: Vec<(usize, Vec<Option<f64>>)>,
}

impl<'p> NumberTable<'p> {
    /// Reads a table: comment lines with `#`, a header, rows of numbers. Separators and decimals are those of every table.
    pub(super) fn read(path: &'p Path) -> Result<Self, TextFileError> {
        let text = text_file::read(path, "a table of responses (CSV)")?;
        let problem = |line, found: String, expected: &str| {
            TextFileError::in_line(path, line, found, expected)
        };
        let mut lines = text_table::rows(&text);
        let Some((header_line, header)) = lines.next() else {
            return Err(problem(
                1,
                "nothing but comments".to_owned(),
                "a header and rows of numbers",
            ));
        };
        let separator = text_table::separator(header);
        let mut decimal = Decimal::beside(separator);
        let mut tokeniser = Cells::separated_by(separator);
        let names: Vec<String> = tokeniser
            .names(header)
            .into_iter()
            .map(str::to_owned)
            .collect();
        if let Some(name) = names
            .iter()
            .find(|name| names.iter().filter(|n| n == name).count() > 1)
        {
            return Err(problem(
                header_line,
                format!("the column {name:?} twice"),
                "every column once",
            ));
        }
        let mut rows = Vec::new();
        for (line, text) in lines {
            let cells = tokeniser.of(text);
            if cells.len() != names.len() {
                return Err(problem(
                    line,
                    format!("{} cells", cells.len()),
                    &format!(
                        "{} as in the header; with decimal commas, separate the columns by semicolons",
                        names.len()
                    ),
                ));
            }
            let number = |cell: &&str| match *cell {
                "" => Ok(None),
                text => match decimal.parse(text) {
                    Some((value, used)) if value.is_finite() => {
                        decimal = used;
                        Ok(Some(value))
                    }
                    _ => Err(problem(line, format!("{text:?}"), "a finite number")),
                },
            };
            let values = cells.iter().map(number).collect::<Result<_, _>>()?;
            rows.push((line, values));
        }
        Ok(Self { path, names, rows })
    }

    /// The line of the file and the values of some columns in each row. `wanted` are places of columns.
    pub(super) fn rows(&self) -> &[(usize, Vec<Option<f64>>)] {
        &self.rows
    }

    /// Takes rows away that equal an earlier one in all columns, and says how many these were.
    pub(super) fn without_repeats(&mut self) -> usize {
        let all = self.rows.len();
        let mut seen = HashSet::new();
        self.rows.retain(|(_, values)| {
            let bits: Vec<Option<u64>> = values.iter().map(|own| own.map(f64::to_bits)).collect();
            seen.insert(bits)
        });
        all - self.rows.len()
    }

    /// The place of the column with one of these names, and which name it has.
    pub(super) fn column(&self, names: &[&str]) -> Option<(usize, usize)> {
        names.iter().enumerate().find_map(|(which, wanted)| {
            let place = self.names.iter().position(|name| name == wanted)?;
            Some((place, which))
        })
    }

    /// The same where there must be one; `why` follows what is expected.
    pub(super) fn required(&self, names: &[&str], why: &str) -> Result<(usize, usize), LapError> {
        self.column(names).ok_or_else(|| {
            let found = format!("the columns {}", self.names.join(", "));
            self.problem(1, found, &format!("a column {}{why}", names.join(" or ")))
        })
    }

    /// What is wrong in a line of the file.
    pub(super) fn problem(&self, line: usize, found: String, expected: &str) -> LapError {
        TextFileError::in_line(self.path, line, found, expected).into()
    }
}
