//! The lines of a table as programs end and encode them, one at a time: a table may be larger than the memory.

use std::io::{self, BufRead};
use std::path::Path;

use bolted_joint_files::text_table::is_blank;

use crate::{FrfError, TableProblem};

/// The longest line that is still taken for a table, bytes.
const LONGEST_LINE: usize = 1 << 20;

/// The lines of a file with their numbers.
pub(super) struct Rows<'path, R> {
    reader: R,
    path: &'path Path,
    pub(super) number: usize,
    line: Vec<u8>,
    /// Whether the current line ended in CR, behind which LF is no line of its own.
    after_cr: bool,
    /// Whether the current line is still to be read as numbers.
    pub(super) held: bool,
}

impl<'path, R: BufRead> Rows<'path, R> {
    /// Before the first line; `path` stands in messages.
    pub(super) fn of(reader: R, path: &'path Path) -> Self {
        Self {
            reader,
            path,
            number: 0,
            line: Vec::new(),
            after_cr: false,
            held: false,
        }
    }

    /// On to the next line that is neither blank nor a comment; whether there is one.
    pub(super) fn advance_to_cells(&mut self) -> Result<bool, FrfError> {
        if std::mem::take(&mut self.held) {
            return Ok(true);
        }
        while self.advance()? {
            let text = self.text();
            if !is_blank(&text) && !text.starts_with('#') {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// On to the next line, whatever it is; whether there is one.
    pub(super) fn advance(&mut self) -> Result<bool, FrfError> {
        self.line.clear();
        self.number += 1;
        let read = self.read_line().map_err(|source| FrfError::Read {
            path: self.path.to_owned(),
            source,
        })?;
        if self.line.len() > LONGEST_LINE {
            return Err(self.problem(TableProblem::whole(
                format_args!("a line of more than {LONGEST_LINE} bytes"),
                "a table; is this another format?",
            )));
        }
        if self.number == 1 {
            if self.line.starts_with(b"\xFF\xFE") || self.line.starts_with(b"\xFE\xFF") {
                let expected = "UTF-8; save the table as \"CSV UTF-8\"";
                return Err(self.problem(TableProblem::whole("UTF-16 text", expected)));
            }
            if self.line.starts_with(b"\xEF\xBB\xBF") {
                self.line.drain(..3);
            }
        }
        Ok(read)
    }

    /// Appends bytes up to LF, CR LF, or CR alone, as Excel for the Macintosh ends lines, or until they are more than a table has in
    /// a line; whether there was anything.
    fn read_line(&mut self) -> io::Result<bool> {
        let mut is_any = false;
        loop {
            let bytes = match self.reader.fill_buf() {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                bytes => bytes?,
            };
            let Some(&first) = bytes.first() else {
                return Ok(is_any);
            };
            // the line before ended in CR, and this LF belongs to it
            if std::mem::take(&mut self.after_cr) && first == b'\n' {
                self.reader.consume(1);
                continue;
            }
            is_any = true;
            let end = bytes.iter().position(|byte| [b'\n', b'\r'].contains(byte));
            let room = (LONGEST_LINE + 1).saturating_sub(self.line.len());
            let taken = end.map_or(bytes.len(), |end| end + 1).min(room);
            self.line.extend_from_slice(&bytes[..taken]);
            self.after_cr = bytes[taken - 1] == b'\r';
            let is_whole = end.is_some_and(|end| taken == end + 1);
            self.reader.consume(taken);
            if is_whole || taken == room {
                return Ok(true);
            }
        }
    }

    /// The current line: UTF-8 where it is valid, Latin-1 where it is not.
    pub(super) fn text(&self) -> String {
        match std::str::from_utf8(&self.line) {
            Ok(text) => text.to_owned(),
            Err(_) => self.line.iter().copied().map(char::from).collect(),
        }
    }

    /// What is wrong with the current line.
    pub(super) fn problem(&self, problem: TableProblem) -> FrfError {
        FrfError::Csv {
            path: self.path.to_owned(),
            line: self.number,
            problem: Box::new(problem),
        }
    }
}
