//! The members of an archive: which arrays there are, and those that hold names, frequencies or one word.

use std::collections::BTreeSet;
use std::io::{BufReader, Read, Seek};

use zip::ZipArchive;
use zip::read::ZipFile;

use super::NpzProblem;
use super::array::{Array, Header};
use crate::{Dof, Quantity};

/// Deflate cannot make data smaller than by this factor; a member that claims more is damaged or made to harm.
const LARGEST_RATIO: u64 = 1100;

/// The arrays of a file, by name.
pub(super) struct Archive<R> {
    zip: ZipArchive<R>,
    names: Vec<String>,
}

impl<R: Read + Seek> Archive<R> {
    pub(super) fn open(reader: R) -> Result<Self, NpzProblem> {
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
    pub(super) fn find(&self, wanted: &[&str]) -> Result<Option<String>, NpzProblem> {
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

    pub(super) fn required(
        &self,
        names: &[&str],
        wanted: &'static str,
    ) -> Result<String, NpzProblem> {
        self.find(names)?.ok_or_else(|| NpzProblem::Missing {
            wanted,
            there: match self.names.is_empty() {
                true => "of no name at all".to_owned(),
                false => crate::shown(&self.names.join(", ")),
            },
        })
    }

    pub(super) fn array(
        &mut self,
        name: &str,
    ) -> Result<Array<BufReader<ZipFile<'_, R>>>, NpzProblem> {
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
    pub(super) fn text(&mut self, name: &str) -> Result<Option<String>, NpzProblem> {
        if !self.names.iter().any(|known| known == name) {
            return Ok(None);
        }
        let array = self.array(name)?;
        one(name, &array.header)?;
        Ok(array.texts(|_| Ok(()))?.pop())
    }

    pub(super) fn averages(&mut self) -> Result<Option<f64>, NpzProblem> {
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
pub(super) fn frequencies(array: Array<impl Read>, name: &str) -> Result<Vec<f64>, NpzProblem> {
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

pub(super) fn dofs(array: Array<impl Read>, name: &str) -> Result<Vec<Dof>, NpzProblem> {
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

pub(super) fn quantity(text: &str) -> Result<Quantity, NpzProblem> {
    let expected = "receptance, mobility or accelerance";
    by_name(&text.to_lowercase())
        .ok_or_else(|| value("quantity", format!("\"{}\"", crate::shown(text)), expected))
}

pub(super) fn by_name(name: &str) -> Option<Quantity> {
    [
        Quantity::Receptance,
        Quantity::Mobility,
        Quantity::Accelerance,
    ]
    .into_iter()
    .find(|quantity| quantity.to_string() == name)
}
