//! The header of a table: comments with keys, and the row of column names.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use crate::{Dof, Quantity, TableProblem};
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
        let value = value.trim().trim_matches('"');
        let refused =
            |key, expected| TableProblem::whole(format_args!("{key} = \"{value}\""), expected);
        match key.trim().to_lowercase().as_str() {
            "quantity" => {
                let expected = "receptance, mobility or accelerance";
                self.quantity = Some(quantity(value).ok_or_else(|| refused("quantity", expected))?);
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

fn quantity(word: &str) -> Option<Quantity> {
    match word.to_lowercase().as_str() {
        "receptance" => Some(Quantity::Receptance),
        "mobility" => Some(Quantity::Mobility),
        "accelerance" => Some(Quantity::Accelerance),
        _ => None,
    }
}

/// What a column holds of its function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Part {
    Real,
    Imaginary,
    Magnitude,
    Phase,
    Coherence,
}

impl Part {
    fn from_word(word: &str) -> Option<Self> {
        Some(match word.to_lowercase().as_str() {
            "real" | "re" => Self::Real,
            "imaginary" | "imag" | "im" => Self::Imaginary,
            "magnitude" | "mag" | "amplitude" | "abs" => Self::Magnitude,
            "phase" => Self::Phase,
            "coherence" => Self::Coherence,
            _ => return None,
        })
    }

    fn name(self) -> &'static str {
        match self {
            Self::Real => "real part",
            Self::Imaginary => "imaginary part",
            Self::Magnitude => "magnitude",
            Self::Phase => "phase",
            Self::Coherence => "coherence",
        }
    }
}

/// The two columns that make a complex value; indices from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Form {
    Cartesian {
        real: usize,
        imaginary: usize,
    },
    Polar {
        magnitude: usize,
        phase: usize,
        radians: f64,
    },
}

/// One function of the table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Columns {
    pub(super) response: Dof,
    pub(super) reference: Dof,
    pub(super) quantity: Option<Quantity>,
    pub(super) unit: Option<String>,
    pub(super) form: Form,
    pub(super) coherence: Option<usize>,
}

/// One column as its name says.
struct Column {
    response: Dof,
    reference: Dof,
    part: Part,
    quantity: Option<Quantity>,
    unit: Option<String>,
}

/// The row of column names.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    pub(super) separator: char,
    pub(super) column_count: usize,
    /// In the table's order.
    pub(super) functions: Vec<Columns>,
}

impl Header {
    pub(super) fn read(row: &str) -> Result<Self, TableProblem> {
        let separator = separator(row);
        let mut cells = Cells::separated_by(separator);
        let names = cells.of(row);
        check_frequency(names.first().copied().unwrap_or_default())?;
        let mut order = Vec::new();
        let mut parts: BTreeMap<(Dof, Dof), BTreeMap<Part, (usize, Column)>> = BTreeMap::new();
        for (index, name) in names.iter().enumerate().skip(1) {
            let column = Column::read(name, index + 1)?;
            let pair = (column.response, column.reference);
            let part = column.part;
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
        let functions = order
            .into_iter()
            .map(|pair| Columns::from_parts(pair, parts.remove(&pair).unwrap_or_default()))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            separator,
            column_count: names.len(),
            functions,
        })
    }
}

/// A name without its unit, which stands in brackets at the end.
fn split_unit(name: &str) -> (&str, Option<&str>) {
    match (name.find('['), name.strip_suffix(']')) {
        (Some(at), Some(inner)) => (name[..at].trim(), Some(inner[at + 1..].trim())),
        _ => (name, None),
    }
}

fn check_frequency(name: &str) -> Result<(), TableProblem> {
    let (word, unit) = split_unit(name);
    let is_frequency = ["frequency", "freq", "f"]
        .iter()
        .any(|known| word.eq_ignore_ascii_case(known));
    let is_hertz = unit.is_none_or(|unit| unit.eq_ignore_ascii_case("hz"));
    match is_frequency && is_hertz {
        true => Ok(()),
        false => Err(TableProblem::at(
            "column 1",
            format_args!("\"{}\"", crate::shown(name)),
            "\"frequency [Hz]\" as the first column's name; write a header row, and frequencies in Hz",
        )),
    }
}

impl Column {
    fn read(name: &str, column: usize) -> Result<Self, TableProblem> {
        let at = || format!("column {column}");
        let no_name = || {
            TableProblem::at(
                at(),
                format_args!("the name \"{}\"", crate::shown(name)),
                "RESPONSE/REFERENCE, one of real, imaginary, magnitude, phase and coherence, and perhaps a quantity and a [unit], such as \
                 \"11:+Y/2:+Y accelerance real [m/s^2/N]\"",
            )
        };
        let (text, unit) = split_unit(name);
        let mut words = text.split_whitespace();
        let (response, reference) = words
            .next()
            .and_then(|pair| pair.split_once('/'))
            .ok_or_else(no_name)?;
        let dof = |text: &str| {
            text.parse::<Dof>()
                .map_err(|source| TableProblem::Dof { at: at(), source })
        };
        let (response, reference) = (dof(response)?, dof(reference)?);
        let (mut part, mut stated) = (None, None);
        for word in words {
            match (Part::from_word(word), quantity(word)) {
                (Some(found), _) if part.is_none() => part = Some(found),
                (None, Some(found)) if stated.is_none() => stated = Some(found),
                _ => return Err(no_name()),
            }
        }
        Ok(Self {
            response,
            reference,
            part: part.ok_or_else(no_name)?,
            quantity: stated,
            unit: unit.map(str::to_owned),
        })
    }

    /// Radians in one unit of a phase.
    fn radians(&self, index: usize) -> Result<f64, TableProblem> {
        match self.unit.as_deref() {
            Some("rad") => Ok(1.0),
            Some("deg" | "°") => Ok(PI / 180.0),
            other => Err(TableProblem::at(
                format_args!("column {}", index + 1),
                format_args!("a phase in \"{}\"", other.unwrap_or("no unit")),
                "[deg] or [rad] after its name",
            )),
        }
    }
}

impl Columns {
    fn from_parts(
        pair: (Dof, Dof),
        mut parts: BTreeMap<Part, (usize, Column)>,
    ) -> Result<Self, TableProblem> {
        let coherence = parts.remove(&Part::Coherence).map(|(index, _)| index);
        let found: Vec<&str> = parts.keys().map(|part| part.name()).collect();
        let found = match found.is_empty() {
            true => "a coherence alone".to_owned(),
            false => found.join(" and "),
        };
        let mut take = |part| parts.remove(&part);
        let (real, imaginary) = (take(Part::Real), take(Part::Imaginary));
        let (magnitude, phase) = (take(Part::Magnitude), take(Part::Phase));
        let (form, first, second) = match (real, imaginary, magnitude, phase) {
            (Some((real, first)), Some((imaginary, second)), None, None) => {
                (Form::Cartesian { real, imaginary }, first, second)
            }
            (None, None, Some((magnitude, first)), Some((phase, mut second))) => {
                let radians = second.radians(phase)?;
                second.unit = None;
                (
                    Form::Polar {
                        magnitude,
                        phase,
                        radians,
                    },
                    first,
                    second,
                )
            }
            _ => {
                let expected = "columns for real and imaginary part, or for magnitude and phase";
                return Err(TableProblem::of_function(pair, found, expected));
            }
        };
        let differing = |first: String, second: String| {
            let found = format!("\"{first}\" in one column and \"{second}\" in another");
            TableProblem::of_function(pair, found, "the same in both")
        };
        let unit = match (first.unit, second.unit) {
            (Some(first), Some(second)) if first != second => return Err(differing(first, second)),
            (first, second) => first.or(second),
        };
        let quantity = match (first.quantity, second.quantity) {
            (Some(first), Some(second)) if first != second => {
                return Err(differing(first.to_string(), second.to_string()));
            }
            (first, second) => first.or(second),
        };
        Ok(Self {
            response: pair.0,
            reference: pair.1,
            quantity,
            unit,
            form,
            coherence,
        })
    }
}
