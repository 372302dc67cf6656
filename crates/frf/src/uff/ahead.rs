//! A reader whose next bytes can be looked at before they are taken: binary values say nowhere that they end.

use std::io::{self, BufRead, ErrorKind, Read};

pub(super) struct Ahead<R> {
    reader: R,
    looked_at: Vec<u8>,
    taken: usize,
}

impl<R: BufRead> Ahead<R> {
    pub(super) fn new(reader: R) -> Self {
        Self {
            reader,
            looked_at: Vec::new(),
            taken: 0,
        }
    }

    /// The next `count` bytes, or as many as there are; perhaps a few more.
    pub(super) fn peek(&mut self, count: usize) -> io::Result<&[u8]> {
        self.looked_at.drain(..self.taken);
        self.taken = 0;
        while self.looked_at.len() < count {
            let more = match self.reader.fill_buf() {
                Ok(more) => more,
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(error) => return Err(error),
            };
            if more.is_empty() {
                break;
            }
            let wanted = more.len().min(count - self.looked_at.len());
            self.looked_at.extend_from_slice(&more[..wanted]);
            self.reader.consume(wanted);
        }
        Ok(&self.looked_at)
    }
}

impl<R: BufRead> Read for Ahead<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let available = self.fill_buf()?;
        let count = available.len().min(buffer.len());
        buffer[..count].copy_from_slice(&available[..count]);
        self.consume(count);
        Ok(count)
    }
}

impl<R: BufRead> BufRead for Ahead<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        match self.taken < self.looked_at.len() {
            true => Ok(&self.looked_at[self.taken..]),
            false => self.reader.fill_buf(),
        }
    }

    fn consume(&mut self, amount: usize) {
        match self.taken < self.looked_at.len() {
            true => self.taken += amount,
            false => self.reader.consume(amount),
        }
    }
}
