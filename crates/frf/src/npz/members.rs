//! The members of an archive: which arrays there are, and those that hold names, frequencies or one word.

use std::collections::BTreeSet;
use std::fmt::Display;
use std::io::{BufReader, Read, Seek};

use zip::ZipArchive;
use zip::read::ZipFile;

use super::array::{Array, Header, cut_short};
use crate::{Dof, Quantity, TableProblem};

/// How arrays are saved so that they can be read.
const SAVE: &str = "save them with numpy.savez(file, frequency=…, frf=…, response=…, reference=…)";

/// Deflate cannot make data smaller than by this factor; a member that claims more is damaged or made to harm.
const LARGEST_RATIO: u64 = 1100;

/// The arrays of a file, by name.
pub(super) struct Archive<R> {
    zip: ZipArchive<R>,
    names: Vec<String>,
}

impl<R: Read + Seek> Archive<R> {
    pub(super) fn open(reader: R) -> Result<Self, TableProblem> {
        let zip = ZipArchive::new(reader).map_err(broken)?;
        let names = zip
            .file_names()
            .filter_map(|name| Some(name.ok()?.strip_suffix(".npy")?.to_owned()))
            .collect();
        Ok(Self { zip, names })
    }

    /// The one array that has one of these names.
    pub(super) fn find(&self, wanted: &[&str]) -> Result<Option<String>, TableProblem> {
        let mut found = self
            .names
            .iter()
            .filter(|name| wanted.contains(&name.as_str()));
        match (found.next(), found.next()) {
            (Some(first), Some(second)) => Err(TableProblem::whole(
                format_args!("both {first} and {second}"),
                "one of them; save only the one that is meant",
            )),
            (first, _) => Ok(first.cloned()),
        }
    }

    pub(super) fn required(
        &self,
        names: &[&str],
        wanted: &'static str,
    ) -> Result<String, TableProblem> {
        self.find(names)?.ok_or_else(|| {
            let there = match self.names.is_empty() {
                true => "of no name at all".to_owned(),
                false => crate::shown(&self.names.join(", ")),
            };
            let found = format!("the arrays {there}");
            TableProblem::whole(found, format_args!("{wanted}; {SAVE}"))
        })
    }

    pub(super) fn array(
        &mut self,
        name: &str,
    ) -> Result<Array<BufReader<ZipFile<'_, R>>>, TableProblem> {
        let file = self.zip.by_name(&format!("{name}.npy"));
        let file = file.map_err(|error| broken(format_args!("array {name}: {error}")))?;
        let (bytes, stored) = (file.size(), file.compressed_size());
        if bytes > stored.saturating_mul(LARGEST_RATIO) {
            return Err(cut_short(name, stored, bytes));
        }
        Array::open(name, BufReader::new(file), bytes)
    }

    /// The one text of an array, if it is there.
    pub(super) fn text(&mut self, name: &str) -> Result<Option<String>, TableProblem> {
        if !self.names.iter().any(|known| known == name) {
            return Ok(None);
        }
        let array = self.array(name)?;
        one(name, &array.header)?;
        Ok(array.texts(|_| Ok(()))?.pop())
    }

    pub(super) fn averages(&mut self) -> Result<Option<f64>, TableProblem> {
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

/// No zip archive, or a broken one.
fn broken(reason: impl Display) -> TableProblem {
    let expected = "a file of numpy.savez; save or copy it again";
    TableProblem::whole(format_args!("a broken archive ({reason})"), expected)
}

fn value(array: &str, found: impl Display, expected: &'static str) -> TableProblem {
    TableProblem::at(format_args!("array {array}"), found, expected)
}

fn one(array: &str, header: &Header) -> Result<(), TableProblem> {
    match header.shape.iter().all(|&length| length == 1) {
        true => Ok(()),
        false => Err(wrong_shape(array, header, "one entry")),
    }
}

fn wrong_shape(array: &str, header: &Header, expected: &'static str) -> TableProblem {
    value(array, format_args!("shape {:?}", header.shape), expected)
}

fn one_axis(array: &str, header: &Header) -> Result<(), TableProblem> {
    let axes = header.shape.iter().filter(|&&length| length != 1);
    match axes.count() {
        0 | 1 => Ok(()),
        _ => Err(wrong_shape(array, header, "one axis")),
    }
}

/// Strictly increasing frequencies, Hz; met early, since a swollen array would have to repeat itself.
pub(super) fn frequencies(array: Array<impl Read>, name: &str) -> Result<Vec<f64>, TableProblem> {
    one_axis(name, &array.header)?;
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

pub(super) fn dofs(array: Array<impl Read>, name: &str) -> Result<Vec<Dof>, TableProblem> {
    one_axis(name, &array.header)?;
    let mut known = BTreeSet::new();
    let mut dofs = Vec::new();
    array.texts(|text| {
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

pub(super) fn quantity(text: &str) -> Result<Quantity, TableProblem> {
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
