//! Values of binary data sets (58b): how they are stored is decided by where the data set ends.
//!
//! The first line states byte order, floating-point format, number of text lines and number of bytes. The last is not to be
//! relied on: some writers count the values and forget that a complex one has two parts, some store double precision
//! under a type of single precision, and with an uneven abscissa some store frequencies in single precision and others
//! in the precision of the values. So every layout that there is gets tried, smallest first, and the one is right
//! after whose last byte the closing `-1` follows.

use std::io::BufRead;

use num_complex::Complex64;

use super::UffProblem;
use super::header::{Layout, RECORDS};
use super::lines::Lines;
use crate::gathered::Gathered;
use crate::{FrfError, Selection};

/// Order of the bytes in a binary number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ByteOrder {
    /// Least significant byte first, as on PCs.
    Little,
    /// Most significant byte first.
    Big,
}

/// The first line of a binary data set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Form {
    pub(super) order: ByteOrder,
    /// Text lines between this line and the values.
    pub(super) text_lines: usize,
    /// The number of bytes of the values, as far as the line states it.
    bytes: Option<u64>,
}

/// More text lines than this before the values are no header.
const MOST_TEXT_LINES: usize = 100;
/// IEEE 754, which every computer uses by now.
const IEEE_754: &str = "2";

impl Form {
    /// From the line `    58b     1     2          11        6408     0     0           0           0`.
    pub(super) fn from_line(line: &str) -> Result<Self, UffProblem> {
        let mut fields = line.split_whitespace().skip(1);
        let mut next = || fields.next().unwrap_or_default().to_owned();
        let (order, format, text_lines, bytes) = (next(), next(), next(), next());
        let refused = |field, found: &str, expected| UffProblem::Field {
            record: 0,
            field,
            found: found.to_owned(),
            expected,
        };
        let order = match order.as_str() {
            "1" => ByteOrder::Little,
            "2" => ByteOrder::Big,
            _ => {
                let expected = "1 (little endian) or 2 (big endian)";
                return Err(refused("the byte order of data set 58b", &order, expected));
            }
        };
        if format != IEEE_754 {
            let expected =
                "2 (IEEE 754); formats of VAX (1) and IBM 370 (3) are not read, export as ASCII";
            return Err(refused(
                "the floating-point format of data set 58b",
                &format,
                expected,
            ));
        }
        let lines = text_lines
            .parse()
            .ok()
            .filter(|lines| (RECORDS..=MOST_TEXT_LINES).contains(lines));
        Ok(Self {
            order,
            text_lines: lines.ok_or_else(|| {
                let expected = "11, the records before the values";
                refused(
                    "the number of text lines of data set 58b",
                    &text_lines,
                    expected,
                )
            })?,
            bytes: bytes.parse().ok(),
        })
    }
}

/// Bytes of one stored number.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Width {
    Single = 4,
    Double = 8,
}

/// How one line of a function is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stored {
    abscissa: Option<Width>,
    ordinate: Width,
    parts: usize,
}

impl Stored {
    fn bytes(self) -> usize {
        self.abscissa.map_or(0, |width| width as usize) + self.parts * self.ordinate as usize
    }

    /// The layouts that writers use for what record 7 says, smallest first.
    fn candidates(layout: Layout) -> Vec<Self> {
        use Width::{Double, Single};
        let widths: &[(Width, Width)] = match (layout.double, layout.even.is_some()) {
            (false, true) => &[(Single, Single), (Double, Double)],
            (false, false) => &[(Single, Single), (Double, Single), (Double, Double)],
            (true, true) => &[(Double, Double)],
            (true, false) => &[(Single, Double), (Double, Double)],
        };
        widths
            .iter()
            .map(|&(abscissa, ordinate)| Self {
                abscissa: layout.even.is_none().then_some(abscissa),
                ordinate,
                parts: 1 + usize::from(layout.complex),
            })
            .collect()
    }
}

/// Reads the values of a data set that began at line `begun_at`, up to and including the closing `-1`.
///
/// The current line is the last of the header. With `selection` its lines are kept, without it nothing is.
pub(super) fn read<R: BufRead>(
    lines: &mut Lines<R>,
    layout: Layout,
    form: Form,
    begun_at: usize,
    selection: Option<&Selection>,
) -> Result<Gathered, FrfError> {
    let count = layout.lines as u64;
    let mut raw = Vec::new();
    let mut taken = 0;
    let candidates = Stored::candidates(layout);
    for &stored in &candidates {
        let wanted = count.saturating_mul(stored.bytes() as u64);
        // A count that the file cannot hold is not read for, so that it does not fill the memory either.
        if lines.ends_within(wanted - taken) {
            break;
        }
        taken += lines.take_bytes(wanted - taken, selection.map(|_| &mut raw))?;
        if taken < wanted {
            break;
        }
        if lines.delimiter_follows()? {
            while lines.advance()? && !lines.is_delimiter() {}
            return Ok(selection.map_or_else(Gathered::default, |selection| {
                decode(&raw, stored, layout, form.order, selection)
            }));
        }
    }
    Err(lines.problem_at(
        begun_at,
        UffProblem::BinaryLength {
            lines: layout.lines,
            expected: candidates
                .iter()
                .map(|stored| count.saturating_mul(stored.bytes() as u64))
                .collect(),
            stated: form.bytes,
        },
    ))
}

fn decode(
    raw: &[u8],
    stored: Stored,
    layout: Layout,
    order: ByteOrder,
    selection: &Selection,
) -> Gathered {
    let mut gathered = Gathered::default();
    for (index, line) in raw.chunks_exact(stored.bytes()).enumerate() {
        let mut numbers = Numbers { bytes: line, order };
        let hz = match (stored.abscissa, layout.even) {
            (Some(width), _) => numbers.next(width),
            (None, even) => {
                let (minimum, increment) = even.unwrap_or_default();
                minimum + index as f64 * increment
            }
        };
        let re = numbers.next(stored.ordinate);
        let im = match layout.complex {
            true => numbers.next(stored.ordinate),
            false => 0.0,
        };
        gathered.push(selection, hz, Complex64::new(re, im));
    }
    gathered
}

struct Numbers<'line> {
    bytes: &'line [u8],
    order: ByteOrder,
}

impl Numbers<'_> {
    fn next(&mut self, width: Width) -> f64 {
        match width {
            Width::Single => {
                let bytes = self.take();
                f64::from(match self.order {
                    ByteOrder::Little => f32::from_le_bytes(bytes),
                    ByteOrder::Big => f32::from_be_bytes(bytes),
                })
            }
            Width::Double => {
                let bytes = self.take();
                match self.order {
                    ByteOrder::Little => f64::from_le_bytes(bytes),
                    ByteOrder::Big => f64::from_be_bytes(bytes),
                }
            }
        }
    }

    /// The next bytes; zeros past the end, which the chunks of [`decode`] do not reach.
    fn take<const N: usize>(&mut self) -> [u8; N] {
        match self.bytes.split_first_chunk::<N>() {
            Some((first, rest)) => {
                self.bytes = rest;
                *first
            }
            None => [0; N],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_line_is_read_or_refused_by_its_field() {
        let line =
            "    58b     2     2          11        6408     0     0           0           0";
        let form = Form::from_line(line).unwrap();
        assert_eq!(
            (form.order, form.text_lines, form.bytes),
            (ByteOrder::Big, 11, Some(6408))
        );
        for (line, named) in [
            ("58b 0 2 11 6408", "byte order"),
            ("58b", "byte order"),
            ("58b 1 1 11 6408", "VAX"),
            ("58b 1 3 11 6408", "IBM"),
            ("58b 1 2 7 6408", "text lines"),
            ("58b 1 2 99999999 6408", "text lines"),
        ] {
            let message = Form::from_line(line).unwrap_err().to_string();
            assert!(message.contains(named), "{line}: {message}");
        }
    }
}
