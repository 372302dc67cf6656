//! A set of receptances as an archive of NumPy arrays, as [`super::read_npz`] reads it.

use std::fmt::Display;
use std::io::{self, Cursor, Write};

use num_complex::Complex64;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use crate::quantity::receptance_unit;
use crate::{Dof, FrfError, FrfSet};

/// The header of an array ends at a multiple of these bytes (NumPy Enhancement Proposal 1).
const ALIGNMENT: usize = 64;
/// Magic number, version 1.0 and the length of the header, bytes.
const PREAMBLE: usize = 10;

/// What is written where the set has no such function.
const MISSING: Complex64 = Complex64::new(f64::NAN, f64::NAN);

/// A set as an archive: `frf` is complex128 of frequencies × responses × references, m/N, m/(N·m), rad/N or rad/(N·m), and `frequency`
/// is in Hz. Responses and references are in ascending order.
///
/// `description` comes first, as bytes, with anything outside ASCII replaced by `?`. Nothing is rounded or deflated.
///
/// # Errors
/// [`FrfError::NotRectangular`] where a function between one of the responses and one of the references is missing.
pub fn to_npz(set: &FrfSet, description: &str) -> Result<Vec<u8>, FrfError> {
    let mut responses: Vec<Dof> = set.functions().map(|(response, _, _)| response).collect();
    let mut references: Vec<Dof> = set.functions().map(|(_, reference, _)| reference).collect();
    for all in [&mut responses, &mut references] {
        all.sort_unstable();
        all.dedup();
    }
    let (rows, columns, lines) = (responses.len(), references.len(), set.frequency_hz().len());
    let mut values = vec![MISSING; lines * rows * columns];
    let mut found = 0;
    for (response, reference, receptance) in set.functions() {
        let place = |all: &[Dof], dof| all.binary_search(&dof).unwrap_or_default();
        let at = place(&responses, response) * columns + place(&references, reference);
        for (line, &value) in receptance.iter().enumerate() {
            values[line * rows * columns + at] = value;
        }
        found += 1;
    }
    if found < rows * columns {
        return Err(FrfError::NotRectangular {
            functions: found,
            responses: rows,
            references: columns,
        });
    }
    let archive = Archive(ZipWriter::new(Cursor::new(Vec::new())));
    (archive.filled(
        set.frequency_hz(),
        &values,
        [&responses, &references],
        description,
    ))
    .map_err(FrfError::Archive)
}

struct Archive(ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    fn filled(
        mut self,
        frequency_hz: &[f64],
        values: &[Complex64],
        [responses, references]: [&[Dof]; 2],
        description: &str,
    ) -> io::Result<Vec<u8>> {
        let ascii = description
            .chars()
            .map(|c| if c.is_ascii() { c } else { '?' });
        let mut ascii: Vec<u8> = ascii.map(|c| c as u8).collect();
        // NumPy has no bytes of no length
        ascii.resize(ascii.len().max(1), 0);
        self.put("description", &format!("|S{}", ascii.len()), "()", &ascii)?;
        self.put_text("quantity", "receptance")?;
        self.put_text("axes", "frequency,response,reference")?;
        let texts = |dofs: &[Dof]| dofs.iter().map(Dof::to_string).collect::<Vec<_>>();
        let (rows, columns) = (responses.len(), references.len());
        self.put_texts("response", of_one_axis(rows), &texts(responses))?;
        self.put_texts("reference", of_one_axis(columns), &texts(references))?;
        let of_row = |&response: &Dof| {
            let units = references.iter();
            units.map(move |&reference| receptance_unit(response, reference).to_owned())
        };
        let units: Vec<String> = responses.iter().flat_map(of_row).collect();
        self.put_texts("unit", format!("({rows}, {columns})"), &units)?;
        let bytes: Vec<u8> = frequency_hz
            .iter()
            .flat_map(|hz| hz.to_le_bytes())
            .collect();
        self.put("frequency", "<f8", of_one_axis(frequency_hz.len()), &bytes)?;
        let numbers = values.iter().flat_map(|value| [value.re, value.im]);
        let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
        let shape = format!("({}, {rows}, {columns})", frequency_hz.len());
        self.put("frf", "<c16", shape, &bytes)?;
        Ok(self.0.finish()?.into_inner())
    }

    fn put_text(&mut self, name: &str, text: &str) -> io::Result<()> {
        let characters = text.chars().count();
        self.put(
            name,
            &format!("<U{characters}"),
            "()",
            &in_four_bytes(text, characters),
        )
    }

    fn put_texts(&mut self, name: &str, shape: impl Display, texts: &[String]) -> io::Result<()> {
        let longest = texts.iter().map(|text| text.chars().count()).max();
        let longest = longest.unwrap_or(1);
        let bytes: Vec<u8> = texts
            .iter()
            .flat_map(|text| in_four_bytes(text, longest))
            .collect();
        self.put(name, &format!("<U{longest}"), shape, &bytes)
    }

    fn put(&mut self, name: &str, descr: &str, shape: impl Display, data: &[u8]) -> io::Result<()> {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .large_file(u32::try_from(data.len()).is_err());
        self.0.start_file(format!("{name}.npy"), options)?;
        let header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
        let padded = (PREAMBLE + header.len() + 1).next_multiple_of(ALIGNMENT) - PREAMBLE;
        let length = u16::try_from(padded).map_err(io::Error::other)?;
        self.0.write_all(b"\x93NUMPY\x01\x00")?;
        self.0.write_all(&length.to_le_bytes())?;
        self.0
            .write_all(format!("{header:<width$}\n", width = padded - 1).as_bytes())?;
        self.0.write_all(data)
    }
}

/// A shape as Python writes it.
fn of_one_axis(length: usize) -> String {
    format!("({length},)")
}

/// Characters of four bytes, with zeros up to this many.
fn in_four_bytes(text: &str, characters: usize) -> Vec<u8> {
    let mut bytes: Vec<u8> = text
        .chars()
        .flat_map(|c| u32::from(c).to_le_bytes())
        .collect();
    bytes.resize(4 * characters, 0);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Frf;

    /// A missing function would be a hole in the matrix.
    #[test]
    fn functions_that_fill_no_matrix_are_refused() {
        let function = |response: &str, reference: &str| {
            let [response, reference] = [response, reference].map(|dof| dof.parse().unwrap());
            Frf::new(response, reference, vec![1.0, 2.0], vec![Complex64::ONE; 2]).unwrap()
        };
        let three = [("1:+X", "2:+X"), ("1:+X", "3:+X"), ("4:+X", "2:+X")];
        let set = FrfSet::new(three.map(|(a, b)| function(a, b)).to_vec()).unwrap();
        let refused = to_npz(&set, "").unwrap_err().to_string();
        assert!(
            refused.starts_with(
                "found 3 functions between 2 responses and 2 references, expected all 4"
            ),
            "{refused}"
        );
    }

    /// By the reader, which is tested with archives of NumPy; also without a description.
    #[test]
    fn what_was_written_is_read() {
        let [response, reference] = ["1:+X", "2:+RZ"].map(|dof| dof.parse().unwrap());
        let values = vec![Complex64::new(0.1, -0.2), Complex64::new(3e-9, 4e9)];
        let function = Frf::new(response, reference, vec![1.0, 2.5], values).unwrap();
        let functions = [function];
        let set = FrfSet::new(functions.to_vec()).unwrap();
        for description in ["", "π"] {
            let archive = to_npz(&set, description).unwrap();
            let options = crate::ReadOptions::default();
            let read = super::super::read_npz_from(Cursor::new(archive), "x.npz", &options);
            assert_eq!(read.unwrap().functions(), functions);
        }
    }
}
