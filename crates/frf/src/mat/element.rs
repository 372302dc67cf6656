//! The elements that a MATLAB file is made of: a tag with type and length, then the data, filled up to eight bytes.
//!
//! *MAT-File Format*, The MathWorks, level 5 MAT-files: data types, tags, small data elements.

use std::io::{self, Read};

/// Longest element that is no array of numbers: names, dimensions, flags.
const LONGEST_SHORT: u64 = 1 << 12;

// Types of elements, by the number in their tag.
pub(super) const MATRIX: u32 = 14;
pub(super) const COMPRESSED: u32 = 15;
pub(super) const UTF8: u32 = 16;

/// What stands before the data of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Tag {
    pub(super) number: u32,
    pub(super) bytes: u64,
    /// Data of up to four bytes that stand in the tag itself.
    inside: Option<[u8; 4]>,
}

/// Elements of a file or of an array, one after the other.
pub(super) struct Elements<R> {
    reader: R,
    pub(super) big_endian: bool,
}

impl<R: Read> Elements<R> {
    pub(super) fn new(reader: R, big_endian: bool) -> Self {
        Self { reader, big_endian }
    }

    pub(super) fn tag(&mut self) -> io::Result<Tag> {
        let mut bytes = [0; 8];
        self.reader.read_exact(&mut bytes)?;
        let [first, second] = [0, 4].map(|at| self.word(&bytes[at..]));
        let [.., a, b, c, d] = bytes;
        Ok(match first >> 16 {
            0 => Tag {
                number: first,
                bytes: second.into(),
                inside: None,
            },
            length => Tag {
                number: first & 0xffff,
                bytes: length.min(4).into(),
                inside: Some([a, b, c, d]),
            },
        })
    }

    /// The data of a short element: flags, dimensions, a name.
    pub(super) fn short(&mut self) -> io::Result<(Tag, Vec<u8>)> {
        let tag = self.tag()?;
        if tag.bytes > LONGEST_SHORT {
            return Err(invalid(format!("an element of {} bytes", tag.bytes)));
        }
        let mut data = vec![0; tag.bytes as usize];
        self.data(tag).read_exact(&mut data)?;
        self.skip_filling(tag)?;
        Ok((tag, data))
    }

    /// Whole numbers of four bytes, such as flags and dimensions.
    pub(super) fn words(&mut self) -> io::Result<Vec<u32>> {
        let (_, data) = self.short()?;
        Ok(data.chunks_exact(4).map(|word| self.word(word)).collect())
    }

    /// Hands each number of the next element to `take`.
    pub(super) fn numbers<E: From<io::Error>>(
        &mut self,
        mut take: impl FnMut(f64) -> Result<(), E>,
    ) -> Result<Tag, E> {
        let tag = self.tag()?;
        let size = match tag.number {
            1 | 2 | 16 => 1,
            3 | 4 | 17 => 2,
            5..=7 | 18 => 4,
            9 | 12 | 13 => 8,
            other => return Err(invalid(format!("numbers of type {other}")).into()),
        };
        let (count, big_endian) = (tag.bytes / size as u64, self.big_endian);
        let mut data = self.data(tag);
        let mut number = [0; 8];
        for _ in 0..count {
            let bytes = &mut number[..size];
            data.read_exact(bytes)?;
            if big_endian {
                bytes.reverse();
            }
            take(value(tag.number, number))?;
        }
        drop(data);
        self.skip_filling(tag)?;
        Ok(tag)
    }

    /// The data of an element whose tag has been read.
    pub(super) fn data(&mut self, tag: Tag) -> Box<dyn Read + '_> {
        match tag.inside {
            Some(bytes) => Box::new(io::Cursor::new(bytes).take(tag.bytes)),
            None => Box::new((&mut self.reader).take(tag.bytes)),
        }
    }

    fn skip_filling(&mut self, tag: Tag) -> io::Result<()> {
        let filling = match tag.inside {
            Some(_) => 0,
            None => tag.bytes.next_multiple_of(8) - tag.bytes,
        };
        let skipped = io::copy(&mut (&mut self.reader).take(filling), &mut io::sink())?;
        match skipped == filling {
            true => Ok(()),
            false => Err(io::ErrorKind::UnexpectedEof.into()),
        }
    }

    fn word(&self, bytes: &[u8]) -> u32 {
        let mut word = [0; 4];
        word.copy_from_slice(&bytes[..4]);
        match self.big_endian {
            true => u32::from_be_bytes(word),
            false => u32::from_le_bytes(word),
        }
    }
}

/// A number of this type from its bytes, little endian, filled up with what was there before.
fn value(number: u32, bytes: [u8; 8]) -> f64 {
    let [a, b, c, d, ..] = bytes;
    match number {
        1 => f64::from(a as i8),
        2 | 16 => f64::from(a),
        3 => f64::from(i16::from_le_bytes([a, b])),
        4 | 17 => f64::from(u16::from_le_bytes([a, b])),
        5 => f64::from(i32::from_le_bytes([a, b, c, d])),
        6 | 18 => f64::from(u32::from_le_bytes([a, b, c, d])),
        7 => f64::from(f32::from_le_bytes([a, b, c, d])),
        9 => f64::from_le_bytes(bytes),
        12 => i64::from_le_bytes(bytes) as f64,
        _ => u64::from_le_bytes(bytes) as f64,
    }
}

pub(super) fn invalid(found: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, format!("found {found}"))
}
