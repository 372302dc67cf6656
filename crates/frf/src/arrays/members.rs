//! The members of a file of arrays that hold names, frequencies or one word.

use std::collections::BTreeSet;
use std::fmt::Display;

use bolted_joint_files::nearest;

use super::functions::{AVERAGES, is_of_functions};
use super::matrices::{MASS, STIFFNESS};
use super::{Array, ArrayFile, Element, Kind};
use crate::{Dof, Quantity, TableProblem};

/// A file of arrays, asked for what functions need.
pub(super) struct Members<'file, F>(pub(super) &'file mut F);

impl<F: ArrayFile> Members<'_, F> {
    /// The one array that has one of these names; those of two letters or more may be in capitals.
    pub(super) fn find(&self, wanted: &[&str]) -> Result<Option<String>, TableProblem> {
        let is_one = |name: &str, known: &str| {
            name == known || known.len() > 1 && name.eq_ignore_ascii_case(known)
        };
        let names = self.0.names().iter();
        let found: Vec<&str> = names
            .filter(|name| wanted.iter().any(|known| is_one(name, known)))
            .map(String::as_str)
            .collect();
        match found.as_slice() {
            [] => Ok(None),
            [one] => Ok(Some((*one).to_owned())),
            [others @ .., last] => Err(TableProblem::whole(
                format_args!("both {} and {last}", others.join(", ")),
                "one of them; save only the one that is meant",
            )),
        }
    }

    /// The matrix of functions: the array of one of these names, else the only complex one with more than one axis; none where
    /// only a coherence is there.
    pub(super) fn matrix(
        &mut self,
        named: &[&str],
        coherence: &[&str],
    ) -> Result<Option<String>, TableProblem> {
        if let Some(name) = self.find(named)? {
            return Ok(Some(name));
        }
        let mut complex = Vec::new();
        for name in self.0.names().to_vec() {
            // an array that cannot be read is none of the candidates
            if let Ok(array) = self.0.array(&name)
                && array.kind() == Kind::Complex
                && array.shape().iter().filter(|&&length| length > 1).count() > 0
            {
                complex.push(name);
            }
        }
        let wanted = "frf, the matrix of functions";
        match complex.as_slice() {
            [one] => Ok(Some(one.clone())),
            [] if self.find(coherence)?.is_some() => Ok(None),
            [] => self.required(named, wanted).map(Some),
            several => Err(TableProblem::whole(
                format_args!(
                    "several complex arrays, {}",
                    crate::shown(&several.join(", "))
                ),
                format_args!(
                    "one named frf, the matrix of functions; rename the one that is meant, with {}",
                    F::SAVE
                ),
            )),
        }
    }

    /// An array of functions that has to be there.
    pub(super) fn required(
        &self,
        names: &[&str],
        wanted: &'static str,
    ) -> Result<String, TableProblem> {
        self.find(names)?.ok_or_else(|| match self.has_matrices() {
            true => TableProblem::whole(
                format_args!("the arrays {}, matrices of a structure", self.there()),
                "functions over frequency; what has no functions is named by the key `matrices` of a study or an assembly",
            ),
            false => self.missing(names, wanted, F::SAVE),
        })
    }

    /// An array of a structure's matrices that has to be there.
    pub(super) fn required_of_matrices(
        &self,
        names: &[&str],
        wanted: &'static str,
    ) -> Result<String, TableProblem> {
        self.find(names)?
            .ok_or_else(|| self.missing(names, wanted, F::SAVE_MATRICES))
    }

    fn has_matrices(&self) -> bool {
        let has = |names| matches!(self.find(names), Ok(Some(_)));
        has(MASS) && has(STIFFNESS)
    }

    fn missing(&self, names: &[&str], wanted: &'static str, save: &str) -> TableProblem {
        // what is something else is not misspelt
        let mut others = self.0.names().iter().filter(|own| !is_of_functions(own));
        let meant = others.find_map(|own| Some((own, nearest(own, names)?)));
        let meant = meant.map_or_else(String::new, |(own, meant)| {
            format!("; found `{}`, did you mean `{meant}`?", crate::shown(own))
        });
        TableProblem::whole(
            format_args!("the arrays {}", self.there()),
            format_args!("{wanted}; save them with {save}{}{meant}", F::HINT),
        )
    }

    fn there(&self) -> String {
        match self.0.names() {
            [] => "of no name at all".to_owned(),
            names => crate::shown(&names.join(", ")),
        }
    }

    /// The one text of an array, if it is there.
    pub(super) fn text(&mut self, name: &str) -> Result<Option<String>, TableProblem> {
        let Some(found) = self.find(&[name])? else {
            return Ok(None);
        };
        let array = self.array(&found)?;
        one(name, &array)?;
        Ok(texts::<F>(name, array, |_| Ok(()))?.pop())
    }

    /// Units: none, one for all functions, or one for each response (row) and reference, row by row.
    pub(super) fn units(
        &mut self,
        [responses, references]: [usize; 2],
    ) -> Result<Vec<String>, TableProblem> {
        // archives of before have both
        let of_each = self.find(&["units"])?;
        let Some(name) = of_each.map_or_else(|| self.find(&["unit"]), |name| Ok(Some(name)))?
        else {
            return Ok(Vec::new());
        };
        let array = self.array(&name)?;
        let long = |shape: &[usize]| -> Vec<usize> {
            let lengths = shape.iter().copied();
            lengths.filter(|&length| length != 1).collect()
        };
        let [own, all] = [long(array.shape()), long(&[responses, references])];
        if !own.is_empty() && own != all {
            let expected = format_args!(
                "one unit, or {responses} × {references}: one for each response and reference"
            );
            return Err(value(
                &name,
                format_args!("shape {:?}", array.shape()),
                expected,
            ));
        }
        let by_columns = array.fortran_order() && own.len() > 1;
        let texts = texts::<F>(&name, array, |_| Ok(()))?;
        Ok(match by_columns {
            false => texts,
            true => (0..texts.len())
                .map(|n| texts[n / references + n % references * responses].clone())
                .collect(),
        })
    }

    pub(super) fn averages(&mut self) -> Result<Option<f64>, TableProblem> {
        let Some(name) = self.find(AVERAGES)? else {
            return Ok(None);
        };
        let name = name.as_str();
        let array = self.array(name)?;
        one(name, &array)?;
        let good = |_, number: f64| match number.is_finite() && number >= 1.0 {
            true => Ok(()),
            false => Err(value(name, number, "a number of at least 1")),
        };
        Ok(reals::<F>(name, array, good)?.pop())
    }

    /// Strictly increasing frequencies, Hz; met early, since a swollen array would have to repeat itself.
    pub(super) fn frequencies(&mut self, name: &str) -> Result<Vec<f64>, TableProblem> {
        let array = self.array(name)?;
        one_axis(name, &array)?;
        let frequencies = reals::<F>(name, array, |before, hz| {
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

    pub(super) fn dofs(&mut self, name: &str) -> Result<Vec<Dof>, TableProblem> {
        let array = self.array(name)?;
        let found = match array.kind() {
            _ if array.shape().contains(&0) => Some("no entry"),
            Kind::Real | Kind::Complex => Some("numbers"),
            Kind::Text => None,
        };
        if let Some(found) = found {
            let expected = "a text such as \"11:+Y\" for each, a node and a direction; save it as a list of texts";
            return Err(value(name, found, expected));
        }
        one_axis(name, &array)?;
        let mut known = BTreeSet::new();
        let mut dofs = Vec::new();
        texts::<F>(name, array, |text| {
            let dof: Dof = text.parse().map_err(|source| TableProblem::Dof {
                at: format!("array {name}, entry {}", dofs.len() + 1),
                source,
            })?;
            if !known.insert(dof) {
                let found = format!("\"{text}\" twice");
                return Err(value(name, found, "every degree of freedom once"));
            }
            dofs.push(dof);
            Ok(())
        })?;
        Ok(dofs)
    }

    /// Degrees of freedom of coordinates, each once; none where the text is empty.
    pub(super) fn points(&mut self, name: &str) -> Result<Vec<Option<Dof>>, TableProblem> {
        let array = self.array(name)?;
        one_axis(name, &array)?;
        let mut points: Vec<Option<Dof>> = Vec::new();
        texts::<F>(name, array, |text| {
            let dof = match text.is_empty() {
                true => None,
                false => Some(text.parse().map_err(|source| TableProblem::Dof {
                    at: format!("array {name}, entry {}", points.len() + 1),
                    source,
                })?),
            };
            let is_known = |dof: Dof| {
                let mut named = points.iter().flatten();
                named.any(|&other| other == dof || other == dof.flipped())
            };
            if dof.is_some_and(is_known) {
                let found = format!("\"{text}\" twice");
                return Err(value(name, found, "every degree of freedom once"));
            }
            points.push(dof);
            Ok(())
        })?;
        Ok(points)
    }

    /// An array of numbers.
    pub(super) fn numbers(&mut self, name: &str) -> Result<F::Array<'_>, TableProblem> {
        let array = self.array(name)?;
        match array.kind() {
            Kind::Text => Err(wrong_kind::<F>(
                name,
                Kind::Text,
                "numbers, such as complex ones",
            )),
            Kind::Real | Kind::Complex => Ok(array),
        }
    }

    fn array(&mut self, name: &str) -> Result<F::Array<'_>, TableProblem> {
        self.0.array(name)
    }
}

/// All elements as real numbers, as long as `good` holds for each and the one before it.
fn reals<F: ArrayFile>(
    name: &str,
    array: impl Array,
    mut good: impl FnMut(Option<f64>, f64) -> Result<(), TableProblem>,
) -> Result<Vec<f64>, TableProblem> {
    let kind = array.kind();
    let mut numbers: Vec<f64> = Vec::new();
    if kind != Kind::Real {
        return Err(wrong_kind::<F>(name, kind, "real numbers"));
    }
    array.each(|element| {
        if let Element::Number(number) = element {
            good(numbers.last().copied(), number.re)?;
            numbers.push(number.re);
        }
        Ok(())
    })?;
    Ok(numbers)
}

/// All elements as texts, as long as `good` holds for each.
fn texts<F: ArrayFile>(
    name: &str,
    array: impl Array,
    mut good: impl FnMut(&str) -> Result<(), TableProblem>,
) -> Result<Vec<String>, TableProblem> {
    let kind = array.kind();
    if kind != Kind::Text {
        return Err(wrong_kind::<F>(name, kind, "texts such as \"11:+Y\""));
    }
    let mut texts = Vec::new();
    array.each(|element| {
        if let Element::Text(text) = element {
            good(&text)?;
            texts.push(text);
        }
        Ok(())
    })?;
    Ok(texts)
}

/// Elements that cannot be used where they stand.
fn wrong_kind<F: ArrayFile>(name: &str, found: Kind, expected: &'static str) -> TableProblem {
    let found = match found {
        Kind::Real => "real numbers",
        Kind::Complex => "complex numbers",
        Kind::Text => "texts",
    };
    value(name, found, format_args!("{expected}; {}", F::CONVERT))
}

fn value(array: &str, found: impl Display, expected: impl Display) -> TableProblem {
    TableProblem::at(format_args!("array {array}"), found, expected)
}

fn one(name: &str, array: &impl Array) -> Result<(), TableProblem> {
    match array.shape().iter().all(|&length| length == 1) {
        true => Ok(()),
        false => Err(wrong_shape(name, array, "one entry")),
    }
}

fn wrong_shape(name: &str, array: &impl Array, expected: &'static str) -> TableProblem {
    value(name, format_args!("shape {:?}", array.shape()), expected)
}

fn one_axis(name: &str, array: &impl Array) -> Result<(), TableProblem> {
    match array.shape().iter().filter(|&&length| length != 1).count() {
        0 | 1 => Ok(()),
        _ => Err(wrong_shape(name, array, "one axis")),
    }
}

pub(super) fn quantity(text: &str) -> Result<Quantity, TableProblem> {
    Quantity::named(text).ok_or_else(|| {
        let found = format!("\"{}\"", crate::shown(text));
        value("quantity", found, Quantity::instead_of(text))
    })
}
