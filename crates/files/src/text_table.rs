//! Tables as text: which lines have cells, what parts the cells, and the cells themselves, by one tokeniser for every table that
//! is read.
//!
//! A row is a line, so that a quotation mark that is never closed spoils one row and messages name the right one.

use csv_core::{ReadRecordResult, Reader, ReaderBuilder, Terminator};

/// The lines of a table that have cells, with their numbers from 1: blank ones, comments (`#`) and what is for Excel alone are left
/// out.
pub fn rows(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let text = text.trim_start_matches('\u{feff}');
    (1..).zip(lines(text)).filter(|(number, line)| {
        let is_other = is_blank(line) || line.trim_start().starts_with('#');
        !(is_other || *number == 1 && is_for_excel(line))
    })
}

/// Lines that end in LF, CR LF, or CR alone, as Excel for the Macintosh writes them.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let end = rest.find(['\n', '\r']).unwrap_or(rest.len());
        let (line, after) = rest.split_at(end);
        let ends = ["\r\n", "\r", "\n"];
        rest = ends
            .iter()
            .find_map(|end| after.strip_prefix(end))
            .unwrap_or_default();
        Some(line)
    })
}

/// Whether a line has nothing in any cell: a spreadsheet writes `;;;` for a row that was emptied.
#[must_use]
pub fn is_blank(line: &str) -> bool {
    line.chars()
        .all(|c| c.is_whitespace() || [';', ','].contains(&c))
}

/// Whether a table's first line only tells Excel what parts the cells, such as `sep=;`.
#[must_use]
pub fn is_for_excel(line: &str) -> bool {
    let line = line.trim().trim_matches('"').to_lowercase();
    let separator = line.strip_prefix("sep=");
    // a tab at the end is a blank
    separator.is_some_and(|separator| separator.chars().count() <= 1)
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
    /// Columns of the table, where they are known.
    columns: Option<usize>,
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
            columns: None,
        }
    }

    /// For rows of a table of so many columns: empty cells behind these, which a separator at the end of a line makes, are none.
    #[must_use]
    pub fn of_columns(self, columns: usize) -> Self {
        Self {
            columns: Some(columns),
            ..self
        }
    }

    /// The names of the columns, which are as many as have one: what is empty at the end is none. Rows that come after have as many.
    pub fn names(&mut self, row: &str) -> Vec<&str> {
        self.columns = None;
        let columns = self.of(row).iter().rposition(|name| !name.is_empty());
        self.columns = Some(columns.map_or(0, |last| last + 1));
        self.of(row)
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
        let columns = self.columns;
        let mut cells: Vec<&str> = starts
            .zip(ends)
            .map(|(start, &end)| {
                unquoted(str::from_utf8(&self.bytes[start..end]).unwrap_or_default())
            })
            .collect();
        while columns.is_some_and(|columns| cells.len() > columns)
            && cells.last().is_some_and(|cell| cell.is_empty())
        {
            cells.pop();
        }
        cells
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
    fn a_separator_at_the_end_of_lines_makes_no_column() {
        let mut cells = Cells::separated_by(';');
        assert_eq!(cells.names("a;b;;"), ["a", "b"]);
        for (row, expected) in [
            ("1;2;", vec!["1", "2"]),
            ("1;2", vec!["1", "2"]),
            ("1;;;", vec!["1", ""]),
            ("1;2;3", vec!["1", "2", "3"]),
            ("1;2;;3;", vec!["1", "2", "", "3"]),
            ("1", vec!["1"]),
        ] {
            assert_eq!(cells.of(row), expected, "{row}");
        }
        assert_eq!(Cells::separated_by(',').of_columns(1).of("1,"), ["1"]);
    }

    #[test]
    fn rows_have_the_numbers_of_their_lines() {
        let text = "\u{feff}# a comment\n\n  # another\na,b\r\n \n1,2";
        let found: Vec<_> = rows(text).collect();
        assert_eq!(found, [(4, "a,b"), (6, "1,2")]);
        let text = "sep=;\r\na;b\r\n;;\r\n1;2\r\n";
        let found: Vec<_> = rows(text).collect();
        assert_eq!(found, [(2, "a;b"), (4, "1;2")]);
        let found: Vec<_> = rows("a;b\r1;2\r\r3;4").collect();
        assert_eq!(found, [(1, "a;b"), (2, "1;2"), (4, "3;4")]);
        assert!(["sep=;", "\"sep=,\"", "SEP=\t"].map(is_for_excel) == [true; 3]);
        assert!(["separation;1", "sep=12", "a;sep=;"].map(is_for_excel) == [false; 3]);
        assert_eq!(["a,b", "a;b,c", "a\tb"].map(separator), [',', ';', '\t']);
    }
}
