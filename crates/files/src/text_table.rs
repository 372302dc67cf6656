//! Tables as text: which lines have cells, what parts the cells, and the cells themselves, by one tokeniser for every table that
//! is read.
//!
//! A row is a line, so that a quotation mark that is never closed spoils one row and messages name the right one.

use csv_core::{ReadRecordResult, Reader, ReaderBuilder, Terminator};

/// The lines of a table that have cells, with their numbers from 1: blank ones and comments (`#`) are left out.
pub fn rows(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let is_comment = |line: &str| line.trim().is_empty() || line.trim_start().starts_with('#');
    let text = text.trim_start_matches('\u{feff}');
    (1..)
        .zip(text.lines())
        .filter(move |(_, line)| !is_comment(line))
}

/// What parts the cells of a table: semicolons, tabs or commas, whichever of them its row of names has first in this order.
#[must_use]
pub fn separator(names: &str) -> char {
    let other = [';', '\t'].into_iter().find(|&c| names.contains(c));
    other.unwrap_or(',')
}

/// Takes rows apart.
#[derive(Debug)]
pub struct Cells {
    tokeniser: Reader,
    bytes: Vec<u8>,
    ends: Vec<usize>,
}

impl Cells {
    /// A tokeniser for rows whose cells this character parts.
    #[must_use]
    pub fn separated_by(separator: char) -> Self {
        let tokeniser = ReaderBuilder::new()
            .delimiter(u8::try_from(separator).unwrap_or(b','))
            .terminator(Terminator::Any(b'\n'))
            .build();
        Self {
            tokeniser,
            bytes: Vec::new(),
            ends: Vec::new(),
        }
    }

    /// The cells of a row, without blanks and quotation marks around them (RFC 4180: a separator in a quoted cell is part of it, two
    /// quotation marks in it are one).
    pub fn of(&mut self, row: &str) -> Vec<&str> {
        // Cells are no longer than the row, and no more than its characters and one.
        self.bytes.resize(row.len() + 1, 0);
        self.ends.resize(row.len() + 1, 0);
        self.tokeniser.reset();
        let (mut input, mut written, mut count) = (row.as_bytes(), 0, 0);
        loop {
            let bytes = &mut self.bytes[written..];
            let (result, read, more, ended) =
                self.tokeniser
                    .read_record(input, bytes, &mut self.ends[count..]);
            (input, written, count) = (&input[read..], written + more, count + ended);
            // With nothing left to read, the next turn ends the last cell.
            if result != ReadRecordResult::InputEmpty {
                break;
            }
        }
        let ends = &self.ends[..count];
        let starts = std::iter::once(0).chain(ends.iter().copied());
        starts
            .zip(ends)
            .map(|(start, &end)| {
                unquoted(str::from_utf8(&self.bytes[start..end]).unwrap_or_default())
            })
            .collect()
    }
}

/// Of a cell that has blanks before its quotation mark, which the standard does not know but instruments write.
fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    let inner = cell
        .strip_prefix('"')
        .and_then(|cell| cell.strip_suffix('"'));
    inner.map_or(cell, str::trim)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_those_of_the_standard() {
        for (separator, row, cells) in [
            (',', "1,2.5,-3e4", vec!["1", "2.5", "-3e4"]),
            (';', "1,5; 2,5 ;", vec!["1,5", "2,5", ""]),
            (',', "\"a, \"\"b\"\"\",c", vec!["a, \"b\"", "c"]),
            (',', "1, \"two\" ,3\r", vec!["1", "two", "3"]),
            (',', "1,\"never closed,3", vec!["1", "never closed,3"]),
            ('\t', "µm\tb\rc", vec!["µm", "b\rc"]),
            (',', ",", vec!["", ""]),
            (',', "\"\"", vec![""]),
        ] {
            let mut tokeniser = Cells::separated_by(separator);
            assert_eq!(tokeniser.of("\"an open,one"), ["an open,one"], "{row}");
            assert_eq!(tokeniser.of(row), cells, "{row}");
        }
    }

    #[test]
    fn rows_have_the_numbers_of_their_lines() {
        let text = "\u{feff}# a comment\n\n  # another\na,b\r\n \n1,2";
        let found: Vec<_> = rows(text).collect();
        assert_eq!(found, [(4, "a,b"), (6, "1,2")]);
        assert_eq!(["a,b", "a;b,c", "a\tb"].map(separator), [',', ';', '\t']);
    }
}
