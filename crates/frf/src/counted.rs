//! A reader that tells how many bytes have come out of it.

use std::io::{self, Read, Seek, SeekFrom};

/// A file whose reading is watched.
pub(super) struct Counted<'watch, R> {
    reader: R,
    read: u64,
    watch: &'watch dyn Fn(u64),
}

impl<'watch, R> Counted<'watch, R> {
    pub(super) fn new(reader: R, watch: &'watch dyn Fn(u64)) -> Self {
        Self {
            reader,
            read: 0,
            watch,
        }
    }
}

impl<R: Read> Read for Counted<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.reader.read(buffer)?;
        self.read += count as u64;
        (self.watch)(self.read);
        Ok(count)
    }
}

/// What is read once more counts once more.
impl<R: Seek> Seek for Counted<'_, R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.reader.seek(to)
    }
}
