//! A universal file as lines with their numbers, and as bytes where a data set is binary.

use std::borrow::Cow;
use std::io::{BufRead, ErrorKind, Read};
use std::path::{Path, PathBuf};

use super::UffProblem;
use super::ahead::Ahead;
use crate::FrfError;

/// The longest line that is still taken for text, bytes.
const LONGEST_LINE: usize = 65_536;

/// Width of the standard's records: writers fill the closing `-1` with blanks up to it.
const RECORD_WIDTH: usize = 80;
/// What ends a binary data set, straight after its values.
const DELIMITER: &[u8] = b"    -1";
/// Bytes of binary values that are read at a time.
const PIECE: u64 = 1 << 16;

/// The lines of one file, one at a time.
pub(super) struct Lines<R> {
    reader: Ahead<R>,
    path: PathBuf,
    number: usize,
    /// Bytes that are left, where that is known.
    remaining: Option<u64>,
    line: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(reader: R, path: &Path, length: Option<u64>) -> Self {
        Self {
            remaining: length,
            reader: Ahead::new(reader),
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
        self.took(read as u64);
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

    fn took(&mut self, bytes: u64) {
        self.remaining = self.remaining.map(|left| left.saturating_sub(bytes));
    }

    fn failed(&self, source: std::io::Error) -> FrfError {
        FrfError::Read {
            path: self.path.clone(),
            source,
        }
    }

    /// Whether the file is known to hold fewer than so many bytes more.
    pub(super) fn ends_within(&self, bytes: u64) -> bool {
        self.remaining.is_some_and(|left| left < bytes)
    }

    /// Takes `count` bytes that follow the current line, into `kept` if it is there; fewer at the end of the file.
    ///
    /// Line feeds among them count as ends of lines, as they do in an editor.
    pub(super) fn take_bytes(
        &mut self,
        count: u64,
        mut kept: Option<&mut Vec<u8>>,
    ) -> Result<u64, FrfError> {
        let mut taken = 0;
        while taken < count {
            let wanted = usize::try_from((count - taken).min(PIECE)).unwrap_or(0);
            let piece = match self.reader.fill_buf() {
                Ok(piece) => &piece[..piece.len().min(wanted)],
                Err(source) if source.kind() == ErrorKind::Interrupted => continue,
                Err(source) => return Err(self.failed(source)),
            };
            if piece.is_empty() {
                break;
            }
            self.number += piece.iter().filter(|byte| **byte == b'\n').count();
            if let Some(kept) = &mut kept {
                kept.extend_from_slice(piece);
            }
            let length = piece.len();
            self.reader.consume(length);
            self.took(length as u64);
            taken += length as u64;
        }
        Ok(taken)
    }

    /// Whether a closing `-1` follows straight away, or on a line of its own, as some writers have it.
    pub(super) fn delimiter_follows(&mut self) -> Result<bool, FrfError> {
        let next = match self.reader.peek(RECORD_WIDTH + 2) {
            Ok(next) => next,
            Err(source) => return Err(self.failed(source)),
        };
        let next = next.strip_prefix(b"\r").unwrap_or(next);
        let next = next.strip_prefix(b"\n").unwrap_or(next);
        Ok(next
            .get(..RECORD_WIDTH.min(next.len()))
            .and_then(|line| line.strip_prefix(DELIMITER))
            .is_some_and(|rest| {
                rest.iter()
                    .take_while(|byte| !matches!(byte, b'\n' | b'\r'))
                    .all(|byte| *byte == b' ')
            }))
    }

    /// Passes over bytes up to a closing `-1`, which stays; `false` if there is none up to the end of the file.
    pub(super) fn skip_to_delimiter(&mut self) -> Result<bool, FrfError> {
        loop {
            if self.delimiter_follows()? {
                return Ok(true);
            }
            let mut passed = 0;
            loop {
                let ahead = match self.reader.fill_buf() {
                    Ok(ahead) => ahead,
                    Err(source) if source.kind() == ErrorKind::Interrupted => continue,
                    Err(source) => return Err(self.failed(source)),
                };
                if ahead.is_empty() {
                    return Ok(false);
                }
                // At least one byte, and all up to one that a closing `-1` may begin with.
                let least = usize::from(passed == 0).min(ahead.len());
                let begins = |byte: &u8| matches!(byte, b' ' | b'\r' | b'\n');
                let next = ahead[least..].iter().position(begins);
                let count = next.map_or(ahead.len(), |next| least + next);
                passed += self.take_bytes(count as u64, None)?;
                if next.is_some() {
                    break;
                }
            }
        }
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
        Lines::new(bytes, Path::new("memory.uff"), None)
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
    fn a_closing_delimiter_is_found_among_any_bytes() {
        let filling: [&[u8]; 6] = [
            b"",
            b"\0\0",
            b"     ",
            b"\n\r    -\r\n   -1\n     -2\n",
            b"x    -1x\n    -12\n",
            &[7; 300],
        ];
        for before in filling {
            for first in filling {
                for end in ["    -1", "    -1\n", "\n    -1   \r\n", "\r\n    -1\nmore"] {
                    let bytes = [before, first, end.as_bytes()].concat();
                    let mut lines = lines(&bytes);
                    assert!(lines.skip_to_delimiter().unwrap(), "{bytes:?}");
                    while lines.advance().unwrap() && !lines.is_delimiter() {}
                    assert!(lines.is_delimiter());
                    let newlines = bytes
                        .iter()
                        .rev()
                        .skip_while(|b| **b != b'1')
                        .filter(|b| **b == b'\n');
                    assert_eq!(lines.number(), 1 + newlines.count());
                }
            }
            let mut without = lines(before);
            assert!(!without.skip_to_delimiter().unwrap());
        }
    }

    #[test]
    fn an_endless_line_is_refused_before_it_fills_the_memory() {
        let mut lines = Lines::new(
            std::io::BufReader::new(std::io::repeat(b'x')),
            Path::new("endless"),
            None,
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
