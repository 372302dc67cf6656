//! The header of a table: comments with keys, the row of column names, and perhaps a row of units below it.

use std::collections::BTreeMap;

use super::column::{Column, Columns, Part, no_name, split_unit};
use crate::{Dof, Quantity, TableProblem};
use bolted_joint_files::Decimal;
use bolted_joint_files::text_table::{Cells, separator};

/// What comments of the form `# key = value` say of all functions.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Keys {
    pub(super) quantity: Option<Quantity>,
    pub(super) unit: Option<String>,
    pub(super) averages: Option<f64>,
}

impl Keys {
    /// Takes in a comment; one without a known key is for people.
    pub(super) fn read(&mut self, comment: &str) -> Result<(), TableProblem> {
        let text = comment.trim_start_matches('#');
        let Some((key, value)) = text.split_once(['=', ':']) else {
            return Ok(());
        };
        // a spreadsheet fills a comment up with empty cells
        let value = value.trim_end_matches([';', ',', '\t', ' ']);
        let value = value.trim().trim_matches('"');
        let refused = |key, expected: &str| {
            TableProblem::whole(format_args!("{key} = \"{value}\""), expected)
        };
        match key.trim().to_lowercase().as_str() {
            "quantity" => {
                let named = Quantity::named(value);
                let unknown = || refused("quantity", &Quantity::instead_of(value));
                self.quantity = Some(named.ok_or_else(unknown)?);
            }
            "unit" => self.unit = Some(value.to_owned()),
            "averages" => {
                let number = value
                    .parse()
                    .ok()
                    .filter(|n: &f64| n.is_finite() && *n >= 1.0);
                let expected = "a number of at least 1";
                self.averages = Some(number.ok_or_else(|| refused("averages", expected))?);
            }
            _ => {}
        }
        Ok(())
    }
}

/// What a row above the numbers is, where it does not name all columns as it should.
pub(super) enum Above {
    /// The row of names: its first cell names the frequency.
    Names,
    /// A line for people.
    Title,
    /// Numbers already.
    Numbers,
}

impl Above {
    /// Tells by the first cell.
    pub(super) fn of(row: &str) -> Self {
        let mut cells = Cells::separated_by(separator(row));
        let first = cells.names(row).first().copied().unwrap_or_default();
        let word = first.split(['_', '[', '(', ' ']).next();
        match Decimal::Either.parse(first) {
            Some(_) => Self::Numbers,
            None if word.is_some_and(is_frequency) => Self::Names,
            None => Self::Title,
        }
    }
}

/// The row of column names, as far as it has been read.
pub(super) struct Names {
    pub(super) separator: char,
    frequency_unit: Option<String>,
    pub(super) columns: Vec<Column>,
}

/// What the header says of the table's columns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    pub(super) separator: char,
    pub(super) column_count: usize,
    /// In the table's order.
    pub(super) functions: Vec<Columns>,
}

impl Names {
    /// Takes the row of names apart.
    pub(super) fn read(row: &str) -> Result<Self, TableProblem> {
        let separator = separator(row);
        let mut cells = Cells::separated_by(separator);
        let names = cells.names(row);
        let frequency_unit = frequency_unit(names.first().copied().unwrap_or_default())?;
        let mut columns: Vec<Column> = Vec::new();
        for (index, name) in names.iter().enumerate().skip(1) {
            let column = match columns.last() {
                // cells of a spreadsheet that were joined
                Some(before) if name.is_empty() && before.part.is_none() => before.clone(),
                _ => Column::read(name, index + 1)?,
            };
            columns.push(column);
        }
        Ok(Self {
            separator,
            frequency_unit,
            columns,
        })
    }

    /// Whether the row below the names holds units: its first cell, in the column of frequencies, is a word.
    pub(super) fn are_units(&self, row: &str) -> bool {
        let mut cells = Cells::separated_by(self.separator);
        let first = cells
            .of(row)
            .first()
            .copied()
            .unwrap_or_default()
            .to_owned();
        first.contains(char::is_alphabetic) && Decimal::Either.parse(&first).is_none()
    }

    /// Takes in the row of units below the names.
    pub(super) fn take_units(&mut self, row: &str) -> Result<(), TableProblem> {
        let expected = self.columns.len() + 1;
        let mut cells = Cells::separated_by(self.separator).of_columns(expected);
        let units = cells.of(row.trim_end_matches(['\n', '\r']));
        if units.len() != expected {
            return Err(TableProblem::whole(
                format_args!("a row of {} units", units.len()),
                format_args!("{expected}, one for each column, empty where there is none"),
            ));
        }
        for (index, cell) in units.into_iter().enumerate() {
            let Some(unit) = unit_of_cell(cell) else {
                continue;
            };
            let stated = match index.checked_sub(1) {
                None if !unit.eq_ignore_ascii_case("hz") => {
                    return Err(TableProblem::at(
                        "column 1",
                        format_args!("the unit \"{}\"", crate::shown(unit)),
                        "Hz in the row of units, or numbers in every row below the names",
                    ));
                }
                None => &mut self.frequency_unit,
                Some(column) => &mut self.columns[column].unit,
            };
            match stated {
                Some(stated) if stated != unit && index > 0 => {
                    return Err(TableProblem::at(
                        format_args!("column {}", index + 1),
                        format_args!(
                            "the unit \"{}\" below a name with the unit \"{stated}\"",
                            crate::shown(unit)
                        ),
                        "the same in both, or one of them alone",
                    ));
                }
                stated => *stated = Some(unit.to_owned()),
            }
        }
        Ok(())
    }

    /// The functions that the columns make; `keys` say what the columns do not.
    pub(super) fn grouped(self, keys: &Keys) -> Result<Header, TableProblem> {
        let column_count = self.columns.len() + 1;
        let mut order = Vec::new();
        let mut parts: BTreeMap<(Dof, Dof), BTreeMap<Part, (usize, Column)>> = BTreeMap::new();
        for (index, column) in (1..).zip(self.columns) {
            let pair = (column.response, column.reference);
            let Some(part) = column.part else {
                return Err(no_name(&column.name, index + 1));
            };
            if !parts.contains_key(&pair) {
                order.push(pair);
            }
            if parts
                .entry(pair)
                .or_default()
                .insert(part, (index, column))
                .is_some()
            {
                return Err(TableProblem::at(
                    format_args!("column {}", index + 1),
                    format_args!("a second {} of {} / {}", part.name(), pair.0, pair.1),
                    "one; remove the one that is not wanted",
                ));
            }
        }
        let is_coherence = |parts: &BTreeMap<Part, _>| parts.keys().all(|&p| p == Part::Coherence);
        let coherence_alone = parts.values().all(is_coherence);
        let functions = order
            .into_iter()
            .map(|pair| {
                let parts = parts.remove(&pair).unwrap_or_default();
                Columns::from_parts(pair, parts, keys, coherence_alone)
            })
            .collect::<Result<_, _>>()?;
        Ok(Header {
            separator: self.separator,
            column_count,
            functions,
        })
    }
}

/// A unit in a cell of its own: in brackets or not; nothing for an empty cell or a dash.
fn unit_of_cell(cell: &str) -> Option<&str> {
    let inner = [('[', ']'), ('(', ')')].iter().find_map(|&(open, close)| {
        let inner = cell.strip_prefix(open)?.strip_suffix(close)?;
        // "(m/s^2)/(N)" has no brackets around it
        (!inner.contains([open, close])).then_some(inner.trim())
    });
    let unit = inner.unwrap_or(cell);
    (!["", "-", "–", "—"].contains(&unit)).then_some(unit)
}

/// The unit in the name of the first column, which holds frequencies in Hz.
fn frequency_unit(name: &str) -> Result<Option<String>, TableProblem> {
    let (word, unit) = match name.rsplit_once('_') {
        Some((word, unit)) => (word, Some(unit)),
        None => split_unit(name),
    };
    let is_hertz = unit.is_none_or(|unit| unit.eq_ignore_ascii_case("hz"));
    match is_frequency(word) && is_hertz {
        true => Ok(unit.map(str::to_owned)),
        false => Err(TableProblem::at(
            "column 1",
            format_args!("\"{}\"", crate::shown(name)),
            "\"frequency [Hz]\" as the first column's name; write a header row, and frequencies in Hz",
        )),
    }
}

fn is_frequency(word: &str) -> bool {
    ["frequency", "freq", "f"]
        .iter()
        .any(|known| word.eq_ignore_ascii_case(known))
}
