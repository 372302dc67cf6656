//! Lines of a universal file as bytes with their numbers, so that junk is met early and binary data sets can be added.

use std::borrow::Cow;
use std::io::{BufRead, Read};
use std::path::{Path, PathBuf};

use super::UffProblem;
use crate::frf::FrfError;

/// The longest line that is still taken for text, bytes.
const LONGEST_LINE: usize = 65_536;

/// The lines of one file, one at a time.
pub(super) struct Lines<R> {
    reader: R,
    path: PathBuf,
    number: usize,
    line: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(reader: R, path: &Path) -> Self {
        Self {
            reader,
            path: path.to_owned(),
            number: 0,
            line: Vec::new(),
        }
    }

    /// Goes on to the next line; `false` at the end of the file, whose number is then one past the last line's.
    pub(super) fn advance(&mut self) -> Result<bool, FrfError> {
        self.line.clear();
        self.number += 1;
        let limit = LONGEST_LINE as u64 + 1;
        let read = (&mut self.reader)
            .take(limit)
            .read_until(b'\n', &mut self.line)
            .map_err(|source| FrfError::Read {
                path: self.path.clone(),
                source,
            })?;
        if self.line.len() > LONGEST_LINE {
            return Err(self.problem(UffProblem::LineTooLong {
                limit: LONGEST_LINE,
            }));
        }
        if self.number == 1 && self.line.starts_with(b"\xEF\xBB\xBF") {
            self.line.drain(..3);
        }
        while matches!(self.line.last(), Some(b'\n' | b'\r')) {
            self.line.pop();
        }
        Ok(read > 0)
    }

    /// The current line without its end: UTF-8 where it is valid, Latin-1 where it is not.
    pub(super) fn text(&self) -> Cow<'_, str> {
        match std::str::from_utf8(&self.line) {
            Ok(text) => Cow::Borrowed(text),
            Err(_) => Cow::Owned(self.line.iter().copied().map(char::from).collect()),
        }
    }

    pub(super) fn is_blank(&self) -> bool {
        self.line.trim_ascii().is_empty()
    }

    /// Whether the line is `    -1`, which begins and ends a data set: columns 1 to 6 and nothing else.
    pub(super) fn is_delimiter(&self) -> bool {
        self.line.trim_ascii_end().len() <= 6 && self.line.trim_ascii() == b"-1"
    }

    /// The number of the current line, from 1.
    pub(super) fn number(&self) -> usize {
        self.number
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// An error at the current line.
    pub(super) fn problem(&self, problem: UffProblem) -> FrfError {
        self.problem_at(self.number, problem)
    }

    /// An error at the line of that number.
    pub(super) fn problem_at(&self, line: usize, problem: UffProblem) -> FrfError {
        FrfError::Uff {
            path: self.path.clone(),
            line,
            problem,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Lines<&[u8]> {
        Lines::new(bytes, Path::new("memory.uff"))
    }

    #[test]
    fn lines_lose_their_ends_and_keep_their_numbers() {
        let mut lines = lines(b"\xEF\xBB\xBFone\r\n\n\xB5m\nlast");
        let mut seen = Vec::new();
        while lines.advance().unwrap() {
            seen.push((lines.number(), lines.text().into_owned(), lines.is_blank()));
        }
        let text = |number, text: &str, blank| (number, text.to_owned(), blank);
        assert_eq!(
            seen,
            [
                text(1, "one", false),
                text(2, "", true),
                text(3, "µm", false),
                text(4, "last", false)
            ]
        );
    }

    #[test]
    fn only_minus_one_in_the_first_six_columns_is_a_delimiter() {
        for (line, expected) in [
            ("    -1", true),
            ("-1", true),
            ("    -1          ", true),
            ("         -1", false),
            ("    -1    58", false),
            ("    -12", false),
        ] {
            let mut lines = lines(line.as_bytes());
            lines.advance().unwrap();
            assert_eq!(lines.is_delimiter(), expected, "{line:?}");
        }
    }

    #[test]
    fn an_endless_line_is_refused_before_it_fills_the_memory() {
        let mut lines = Lines::new(
            std::io::BufReader::new(std::io::repeat(b'x')),
            Path::new("endless"),
        );
        assert!(matches!(
            lines.advance().unwrap_err(),
            FrfError::Uff {
                line: 1,
                problem: UffProblem::LineTooLong {
                    limit: LONGEST_LINE
                },
                ..
            }
        ));
    }
}
