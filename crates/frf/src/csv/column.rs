//! One column of a table by its name: between which degrees of freedom it lies, what it holds, and in which unit.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use super::decibel::Decibel;
use super::header::Keys;
use crate::{Dof, Quantity, TableProblem};

/// What a column holds of its function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Part {
    Real,
    Imaginary,
    Complex,
    Magnitude,
    Phase,
    Coherence,
}

impl Part {
    /// Its words, as messages list them.
    pub(super) const WORDS: [&'static str; 6] = [
        "real",
        "imaginary",
        "complex",
        "magnitude",
        "phase",
        "coherence",
    ];

    fn from_word(word: &str) -> Option<Self> {
        Some(match word.to_lowercase().as_str() {
            "real" | "re" => Self::Real,
            "imaginary" | "imag" | "im" => Self::Imaginary,
            "complex" | "cplx" => Self::Complex,
            "magnitude" | "mag" | "amplitude" | "abs" => Self::Magnitude,
            "phase" => Self::Phase,
            "coherence" => Self::Coherence,
            _ => return None,
        })
    }

    /// What messages call it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Real => "real part",
            Self::Imaginary => "imaginary part",
            Self::Complex => "complex value",
            Self::Magnitude => "magnitude",
            Self::Phase => "phase",
            Self::Coherence => "coherence",
        }
    }
}

/// The columns that make a complex value; indices from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Form {
    Cartesian {
        real: usize,
        imaginary: usize,
    },
    Polar {
        magnitude: usize,
        phase: usize,
        /// Radians in one unit of the phase.
        radians: f64,
        /// Of a magnitude in dB what 0 dB is, in the function's unit.
        zero_db: Option<f64>,
    },
    Complex(usize),
    /// A coherence alone, in a table of coherences.
    None,
}

impl Form {
    /// Where phases stand, and whether they are in radian.
    pub(super) fn phases_at(self) -> Option<(usize, bool)> {
        match self {
            // the other unit, a degree, is less than a radian
            Self::Polar { phase, radians, .. } => Some((phase, radians >= 1.0)),
            _ => None,
        }
    }
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
#[derive(Clone)]
pub(super) struct Column {
    /// What stands in the file.
    pub(super) name: String,
    pub(super) response: Dof,
    pub(super) reference: Dof,
    /// `None` until a row below the names says it.
    pub(super) part: Option<Part>,
    pub(super) quantity: Option<Quantity>,
    pub(super) unit: Option<String>,
}

/// The part and the quantity that some words say; `None` for other words, and for two of a kind.
pub(super) fn said(words: &str) -> Option<(Option<Part>, Option<Quantity>)> {
    let (mut part, mut quantity) = (None, None);
    for word in words.split_whitespace() {
        match (Part::from_word(word), Quantity::named(word)) {
            (Some(found), _) if part.is_none() => part = Some(found),
            (None, Some(found)) if quantity.is_none() => quantity = Some(found),
            _ => return None,
        }
    }
    Some((part, quantity))
}

/// What is said of a name that does not tell what is in its column.
pub(super) fn no_name(name: &str, column: usize) -> TableProblem {
    TableProblem::at(
        format_args!("column {column}"),
        format_args!("the name \"{}\"", crate::shown(name)),
        "RESPONSE/REFERENCE, one of real, imaginary, complex, magnitude, phase and coherence, and perhaps a quantity and a [unit], such as \
         \"11:+Y/2:+Y accelerance real [m/s^2/N]\"; what it holds may also stand in a row below",
    )
}

/// A name without its unit, which stands in brackets at the end, or behind a blank in parentheses.
pub(super) fn split_unit(name: &str) -> (&str, Option<&str>) {
    let place = match name.chars().last() {
        Some(']') => name.find('['),
        // "(m/s^2)/(N)" has no parentheses around it
        Some(')') => name.rfind(" (").map(|blank| blank + 1),
        _ => None,
    };
    match place {
        Some(at) => (name[..at].trim(), Some(name[at + 1..name.len() - 1].trim())),
        None => (name, None),
    }
}

impl Column {
    /// A column by its name; `column` counts from 1.
    pub(super) fn read(name: &str, column: usize) -> Result<Self, TableProblem> {
        let at = || format!("column {column}");
        let no_name = || no_name(name, column);
        let (text, unit) = split_unit(name);
        let (pair, words) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let (response, reference) = pair.split_once('/').ok_or_else(no_name)?;
        let dof = |text: &str| {
            text.parse::<Dof>()
                .map_err(|source| TableProblem::Dof { at: at(), source })
        };
        let (response, reference) = (dof(response)?, dof(reference)?);
        let (part, quantity) = said(words).ok_or_else(no_name)?;
        Ok(Self {
            name: crate::shown(name),
            response,
            reference,
            part,
            quantity,
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
    /// The function that the columns of one pair make.
    pub(super) fn from_parts(
        pair: (Dof, Dof),
        mut parts: BTreeMap<Part, (usize, Column)>,
        keys: &Keys,
        coherence_alone: bool,
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
        let (form, stated) = match (real, imaginary, take(Part::Complex), magnitude, phase) {
            (Some((real, first)), Some((imaginary, second)), None, None, None) => {
                (Form::Cartesian { real, imaginary }, vec![first, second])
            }
            (None, None, Some((index, column)), None, None) => (Form::Complex(index), vec![column]),
            (None, None, None, Some((magnitude, first)), Some((phase, mut second))) => {
                let radians = second.radians(phase)?;
                second.unit = None;
                let form = Form::Polar {
                    magnitude,
                    phase,
                    radians,
                    zero_db: None,
                };
                (form, vec![first, second])
            }
            (None, None, None, None, None) if coherence_alone => (Form::None, Vec::new()),
            _ => {
                let expected = "columns for real and imaginary part, for magnitude and phase, or one of complex numbers";
                return Err(TableProblem::of_function(pair, found, expected));
            }
        };
        let differing = |first: &str, second: &str| {
            let found = format!("\"{first}\" in one column and \"{second}\" in another");
            TableProblem::of_function(pair, found, "the same in both")
        };
        let (mut unit, mut quantity) = (None::<String>, None::<Quantity>);
        for column in &stated {
            match (&unit, &column.unit) {
                (Some(first), Some(second)) if first != second => {
                    return Err(differing(first, second));
                }
                (None, Some(_)) => unit.clone_from(&column.unit),
                _ => {}
            }
            match (quantity, column.quantity) {
                (Some(first), Some(second)) if first != second => {
                    return Err(differing(&first.to_string(), &second.to_string()));
                }
                (None, found) => quantity = found,
                _ => {}
            }
        }
        let columns = Self {
            response: pair.0,
            reference: pair.1,
            quantity: quantity.or(keys.quantity),
            unit: unit.or_else(|| keys.unit.clone()),
            form,
            coherence,
        };
        columns.without_decibels(pair)
    }

    /// The same with the unit behind the decibels, where the unit is one.
    fn without_decibels(mut self, pair: (Dof, Dof)) -> Result<Self, TableProblem> {
        let Some(label) = self.unit.as_deref().filter(|label| Decibel::is_one(label)) else {
            return Ok(self);
        };
        let at = |found: String, expected: &'static str| {
            Err(TableProblem::of_function(pair, found, expected))
        };
        let Some(decibel) = Decibel::read(label) else {
            return at(
                format!("the unit \"{}\"", crate::shown(label)),
                "decibels with what 0 dB is, a number above zero and a unit, such as [dB re 1 m/s^2/N]",
            );
        };
        match &mut self.form {
            Form::Polar { zero_db, .. } => *zero_db = Some(decibel.reference),
            Form::None => {}
            Form::Cartesian { .. } | Form::Complex(_) => {
                return at(
                    format!("real and imaginary parts in \"{}\"", crate::shown(label)),
                    "decibels of a magnitude only, beside a phase",
                );
            }
        }
        self.unit = Some(decibel.unit.to_owned());
        Ok(self)
    }
}
