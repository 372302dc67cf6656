//! One array of an archive: its header, and its elements one after the other.
//!
//! The format is that of NumPy Enhancement Proposal 1: a magic number, a version, the length of a header, the header as a Python
//! dictionary, and then the elements.

use std::io::Read;

use num_complex::Complex64;

use crate::TableProblem;
use crate::arrays::{self, Element};

const MAGIC: &[u8] = b"\x93NUMPY";
/// A header longer than this belongs to no array of numbers.
const LONGEST_HEADER: usize = 1 << 16;
/// A text longer than this names no degree of freedom.
const LONGEST_TEXT: usize = 1 << 12;

/// What the elements are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Float,
    Complex,
    Signed,
    Unsigned,
    /// Characters of four bytes.
    Text,
    Bytes,
}

/// Type of the elements.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Type {
    kind: Kind,
    big_endian: bool,
    /// Bytes of one element.
    size: usize,
}

impl Type {
    fn from_descr(descr: &str) -> Option<Self> {
        let (order, rest) = descr.split_at_checked(1)?;
        let (kind, digits) = rest.split_at_checked(1)?;
        let count: usize = digits.parse().ok()?;
        let (kind, size) = match (kind, count) {
            ("f", 4 | 8) => (Kind::Float, count),
            ("c", 8 | 16) => (Kind::Complex, count),
            ("i", 1 | 2 | 4 | 8) => (Kind::Signed, count),
            ("u", 1 | 2 | 4 | 8) => (Kind::Unsigned, count),
            ("U", 1..=LONGEST_TEXT) => (Kind::Text, 4 * count),
            ("S", 1..=LONGEST_TEXT) => (Kind::Bytes, count),
            _ => return None,
        };
        let big_endian = match order {
            "<" | "|" => false,
            ">" => true,
            "=" => cfg!(target_endian = "big"),
            _ => return None,
        };
        Some(Self {
            kind,
            big_endian,
            size,
        })
    }

    fn number<const N: usize>(&self, bytes: &[u8]) -> [u8; N] {
        let mut number = [0; N];
        number.copy_from_slice(&bytes[..N]);
        if self.big_endian {
            number.reverse();
        }
        number
    }

    fn real(&self, bytes: &[u8]) -> f64 {
        match bytes.len() {
            4 => f64::from(f32::from_le_bytes(self.number(bytes))),
            _ => f64::from_le_bytes(self.number(bytes)),
        }
    }

    fn integer(&self, bytes: &[u8]) -> f64 {
        match (self.kind, bytes.len()) {
            (Kind::Signed, 1) => f64::from(i8::from_le_bytes(self.number(bytes))),
            (Kind::Signed, 2) => f64::from(i16::from_le_bytes(self.number(bytes))),
            (Kind::Signed, 4) => f64::from(i32::from_le_bytes(self.number(bytes))),
            (Kind::Signed, _) => i64::from_le_bytes(self.number(bytes)) as f64,
            (_, 1) => f64::from(bytes[0]),
            (_, 2) => f64::from(u16::from_le_bytes(self.number(bytes))),
            (_, 4) => f64::from(u32::from_le_bytes(self.number(bytes))),
            _ => u64::from_le_bytes(self.number(bytes)) as f64,
        }
    }

    fn complex(&self, bytes: &[u8]) -> Complex64 {
        match self.kind {
            Kind::Complex => {
                let (re, im) = bytes.split_at(self.size / 2);
                Complex64::new(self.real(re), self.real(im))
            }
            Kind::Float => Complex64::from(self.real(bytes)),
            _ => Complex64::from(self.integer(bytes)),
        }
    }

    fn text(&self, bytes: &[u8]) -> String {
        let text: String = match self.kind {
            Kind::Text => bytes
                .chunks_exact(4)
                .map(|c| char::from_u32(u32::from_le_bytes(self.number(c))).unwrap_or('\u{fffd}'))
                .collect(),
            _ => String::from_utf8_lossy(bytes).into_owned(),
        };
        text.trim_end_matches('\0').trim().to_owned()
    }
}

/// The header of an array.
#[derive(Debug, Clone, PartialEq)]
struct Header {
    array_type: Type,
    fortran_order: bool,
    shape: Vec<usize>,
}

/// An array whose elements are still to be read.
pub(super) struct Array<R> {
    name: String,
    header: Header,
    reader: R,
}

impl<R: Read> Array<R> {
    /// Reads the header of the member `name`, which has `member_bytes` bytes in all.
    pub(super) fn open(name: &str, mut reader: R, member_bytes: u64) -> Result<Self, TableProblem> {
        let problem = |found: String, expected| bad_header(name, &found, expected);
        let mut fixed = [0; 8];
        let magic = "a NumPy array (.npy)";
        let read = |reader: &mut R, bytes: &mut [u8]| {
            reader
                .read_exact(bytes)
                .map_err(|error| problem(error.to_string(), magic))
        };
        read(&mut reader, &mut fixed)?;
        if !fixed.starts_with(MAGIC) {
            return Err(problem(format!("{:02x?}", &fixed[..6]), magic));
        }
        let length_bytes = match fixed[6] {
            1 => 2,
            2 | 3 => 4,
            version => return Err(problem(format!("version {version}"), "version 1, 2 or 3")),
        };
        let mut length = [0; 4];
        read(&mut reader, &mut length[..length_bytes])?;
        let length = u32::from_le_bytes(length) as usize;
        if length > LONGEST_HEADER {
            return Err(problem(
                format!("a header of {length} bytes"),
                "at most 65536",
            ));
        }
        let mut text = vec![0; length];
        read(&mut reader, &mut text)?;
        let header = Header::from_text(name, &String::from_utf8_lossy(&text))?;
        let expected = header
            .shape
            .iter()
            .try_fold(header.array_type.size as u64, |bytes, &n| {
                bytes.checked_mul(n as u64)
            });
        let found = member_bytes.saturating_sub((fixed.len() + length_bytes + length) as u64);
        if expected != Some(found) {
            return Err(cut_short(name, found, expected.unwrap_or(u64::MAX)));
        }
        Ok(Self {
            name: name.to_owned(),
            header,
            reader,
        })
    }
}

impl<R: Read> arrays::Array for Array<R> {
    fn kind(&self) -> arrays::Kind {
        match self.header.array_type.kind {
            Kind::Text | Kind::Bytes => arrays::Kind::Text,
            Kind::Complex => arrays::Kind::Complex,
            Kind::Float | Kind::Signed | Kind::Unsigned => arrays::Kind::Real,
        }
    }

    fn shape(&self) -> &[usize] {
        &self.header.shape
    }

    fn fortran_order(&self) -> bool {
        self.header.fortran_order
    }

    fn each(
        mut self,
        mut take: impl FnMut(Element) -> Result<(), TableProblem>,
    ) -> Result<(), TableProblem> {
        let array_type = &self.header.array_type;
        let count: usize = self.header.shape.iter().product();
        let mut element = vec![0; array_type.size];
        for index in 0..count {
            self.reader.read_exact(&mut element).map_err(|_| {
                let [found, expected] = [index, count].map(|n| (n * array_type.size) as u64);
                cut_short(&self.name, found, expected)
            })?;
            take(match array_type.kind {
                Kind::Text | Kind::Bytes => Element::Text(array_type.text(&element)),
                _ => Element::Number(array_type.complex(&element)),
            })?;
        }
        // an archive checks its sum where it ends
        match self.reader.read(&mut [0]) {
            Ok(0) => Ok(()),
            Ok(_) => {
                let expected = (count * array_type.size) as u64;
                Err(cut_short(&self.name, expected + 1, expected))
            }
            Err(error) => Err(TableProblem::at(
                format_args!("array {}", self.name),
                format_args!("damaged data ({error})"),
                "an archive as it was written; save or copy it again",
            )),
        }
    }
}

/// A header that cannot be read.
fn bad_header(array: &str, found: &str, expected: &str) -> TableProblem {
    let expected = format!("{expected}; save it again with numpy.savez");
    TableProblem::at(format_args!("array {array}"), found, expected)
}

/// Elements of a type that is not usable.
fn wrong_type(array: &str, found: &str, expected: &str) -> TableProblem {
    let expected = format!("{expected}; convert it with astype before saving");
    TableProblem::at(
        format_args!("array {array}"),
        format_args!("type \"{found}\""),
        expected,
    )
}

/// More or less bytes than the header says.
pub(super) fn cut_short(array: &str, found: u64, expected: u64) -> TableProblem {
    TableProblem::at(
        format_args!("array {array}"),
        format_args!("{found} bytes"),
        format_args!("{expected} by its header; the file is cut short or damaged, save it again"),
    )
}

impl Header {
    /// From a dictionary such as `{'descr': '<c16', 'fortran_order': False, 'shape': (3, 3, 2048), }`.
    fn from_text(array: &str, text: &str) -> Result<Self, TableProblem> {
        let value = |key: &str| {
            let (_, after) = text.split_once(&format!("'{key}'"))?;
            Some(after.trim_start().strip_prefix(':')?.trim_start())
        };
        let problem = |expected| bad_header(array, &crate::shown(text), expected);
        let descr = value("descr").ok_or_else(|| problem("a key 'descr'"))?;
        let type_problem = |found: &str| {
            let expected = "float32 or 64, complex64 or 128, integers, or texts; no Python objects and no records";
            wrong_type(array, &crate::shown(found), expected)
        };
        let name = descr
            .strip_prefix('\'')
            .and_then(|rest| rest.split_once('\''))
            .map(|(name, _)| name)
            .ok_or_else(|| type_problem(descr))?;
        let array_type = Type::from_descr(name).ok_or_else(|| type_problem(name))?;
        let fortran_order = match value("fortran_order") {
            Some(text) if text.starts_with("False") => false,
            Some(text) if text.starts_with("True") => true,
            _ => return Err(problem("a key 'fortran_order' of True or False")),
        };
        let shape = value("shape")
            .and_then(|rest| rest.strip_prefix('(')?.split_once(')'))
            .and_then(|(inner, _)| {
                inner
                    .split(',')
                    .map(|number| number.trim().trim_end_matches('L'))
                    .filter(|number| !number.is_empty())
                    .map(|number| number.parse().ok())
                    .collect::<Option<Vec<usize>>>()
            })
            .ok_or_else(|| problem("a key 'shape' with whole numbers"))?;
        Ok(Self {
            array_type,
            fortran_order,
            shape,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(text: &str) -> Result<Header, TableProblem> {
        Header::from_text("frf", text)
    }

    #[test]
    fn headers_of_numpy_are_read() {
        let found = header("{'descr': '>c8', 'fortran_order': True, 'shape': (3, 2, 2048), }   \n")
            .unwrap();
        assert_eq!(found.shape, [3, 2, 2048]);
        assert!(found.fortran_order && found.array_type.big_endian);
        assert_eq!(
            (found.array_type.kind, found.array_type.size),
            (Kind::Complex, 8)
        );
        assert!(
            header("{'descr': '<f8', 'fortran_order': False, 'shape': (), }")
                .unwrap()
                .shape
                .is_empty()
        );
        assert_eq!(
            header("{'descr': '<U5', 'fortran_order': False, 'shape': (3L,), }")
                .unwrap()
                .shape,
            [3]
        );
    }

    #[test]
    fn other_headers_are_refused_with_what_they_hold() {
        let with = |descr: &str, order: &str, shape: &str| {
            format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}")
        };
        for (text, named) in [
            (with("'|O'", "False", "(3,)"), "|O"),
            (with("[('a', '<f8')]", "False", "(3,)"), "[("),
            (with("'<f16'", "False", "(3,)"), "<f16"),
            (with("'<U99999'", "False", "(3,)"), "<U99999"),
            (with("'<f8'", "0", "(3,)"), "fortran_order"),
            (with("'<f8'", "False", "(-3,)"), "shape"),
            (with("'<f8'", "False", "3"), "shape"),
            (String::new(), "descr"),
            ("{'descr': ''}".to_owned(), "type"),
            ("{'descr': 'µ8', ".to_owned(), "µ8"),
        ] {
            let message = header(&text).unwrap_err().to_string();
            assert!(message.contains(named), "{text}: {message}");
        }
    }
}
