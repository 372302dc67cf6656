//! Functions as MATLAB arrays: a file (`.mat`) of named arrays, as MATLAB's `save -v7` and `-v6`, Octave and SciPy write it.
//!
//! *MAT-File Format*, The MathWorks, level 5 MAT-files.

mod element;
mod other_level;

use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use flate2::bufread::ZlibDecoder;
use num_complex::Complex64;

use crate::arrays::{Array, ArrayFile, Element, Kind, functions, matrices};
use crate::read::opened;
use crate::structure::{NamedMatrices, StructureError};
use crate::{FileFormat, FrfError, FrfReading, ReadOptions, TableProblem};

use element::{COMPRESSED, Elements, MATRIX, UTF8, invalid};
use other_level::other_level;

/// Bytes before the first array.
const HEADER: u64 = 128;
/// Deflate cannot make data smaller than by this factor; an array that claims more is damaged or made to harm.
const LARGEST_RATIO: u64 = 1100;
/// More characters than the names of any test's degrees of freedom have.
const MOST_CHARACTERS: u64 = 1 << 22;
const SAVE: &str = "save('file.mat', 'frequency', 'frf', 'response', 'reference', '-v7')";

/// Reads the functions of a MATLAB file (`.mat`) of level 5: MATLAB's `save` with `-v7` or `-v6`, Octave's, or SciPy's `savemat`.
///
/// Its arrays have the names and meanings that [`read_npz`](crate::read_npz) states. Degrees of freedom are a cell array of
/// texts or a matrix of characters with a row for each.
///
/// # Errors
/// [`FrfError::Read`] if the file cannot be read, [`FrfError::Arrays`] with the cause if it cannot be used.
pub fn read_mat(path: impl AsRef<Path>, options: &ReadOptions) -> Result<FrfReading, FrfError> {
    let path = path.as_ref();
    read_mat_from(BufReader::new(opened(path)?), path, options)
}

/// As [`read_mat`], from any reader; `name` stands for the path in messages.
///
/// # Errors
/// As [`read_mat`].
pub fn read_mat_from(
    reader: impl Read + Seek,
    name: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<FrfReading, FrfError> {
    functions(MatFile::open(reader), name.as_ref(), options)
}

/// The matrices of a structure in a file.
pub(crate) fn matrices_from(
    reader: impl Read + Seek,
    name: &Path,
) -> Result<NamedMatrices, StructureError> {
    matrices(MatFile::open(reader), name)
}

/// The arrays of a file, by name.
struct MatFile<R> {
    reader: R,
    big_endian: bool,
    names: Vec<String>,
    /// Where the element of each array begins.
    places: Vec<u64>,
}

impl<R: Read + Seek> MatFile<R> {
    fn open(mut reader: R) -> Result<Self, TableProblem> {
        let mut header = Vec::new();
        let mut beginning = reader.by_ref().take(HEADER);
        beginning.read_to_end(&mut header).map_err(damaged)?;
        let big_endian = match header.get(124..HEADER as usize) {
            Some([0, 1, b'I', b'M']) => false,
            Some([1, 0, b'M', b'I']) => true,
            _ => return Err(other_level(&header)),
        };
        let mut file = Self {
            reader,
            big_endian,
            names: Vec::new(),
            places: Vec::new(),
        };
        let mut place = HEADER;
        while let Some(length) = file.note(place).map_err(damaged)? {
            place += length;
        }
        Ok(file)
    }

    /// Notes the array whose element begins at this place, and says how long that element is; nothing at the end of the file.
    fn note(&mut self, place: u64) -> io::Result<Option<u64>> {
        self.reader.seek(SeekFrom::Start(place))?;
        if self.reader.read(&mut [0])? == 0 {
            return Ok(None);
        }
        self.reader.seek(SeekFrom::Start(place))?;
        let tag = Elements::new(&mut self.reader, self.big_endian).tag()?;
        if let MATRIX | COMPRESSED = tag.number {
            let name = self.matrix(place)?.name;
            self.names.push(name);
            self.places.push(place);
        }
        Ok(Some(8 + tag.bytes))
    }

    /// The array whose element begins at this place.
    fn matrix(&mut self, place: u64) -> io::Result<Matrix<Box<dyn Read + '_>>> {
        let big_endian = self.big_endian;
        self.reader.seek(SeekFrom::Start(place))?;
        let tag = Elements::new(&mut self.reader, big_endian).tag()?;
        let data = BufReader::new((&mut self.reader).take(tag.bytes));
        let mut most = tag.bytes;
        let mut elements: Elements<Box<dyn Read>> = match tag.number {
            COMPRESSED => {
                let inflated = BufReader::new(ZlibDecoder::new(data));
                Elements::new(Box::new(inflated), big_endian)
            }
            _ => Elements::new(Box::new(data), big_endian),
        };
        if tag.number == COMPRESSED {
            let inner = elements.tag()?;
            most = tag.bytes.saturating_mul(LARGEST_RATIO);
            if inner.number != MATRIX || inner.bytes > most {
                let found = format!(
                    "a compressed element of type {} and {} bytes",
                    inner.number, inner.bytes
                );
                return Err(invalid(found));
            }
        }
        Matrix::begin(elements, most)
    }
}

impl<R: Read + Seek> ArrayFile for MatFile<R> {
    const FORMAT: FileFormat = FileFormat::Matlab;
    const SAVE: &str = SAVE;
    const SAVE_MATRICES: &str = "save('file.mat', 'M', 'K', 'C', 'points', '-v7')";
    const HINT: &str =
        "; fields of a structure become arrays by save('file.mat', '-struct', 'name', '-v7')";
    const CONVERT: &str = "convert it before saving: double(…), cellstr(…)";
    type Array<'file>
        = Matrix<Box<dyn Read + 'file>>
    where
        Self: 'file;

    fn names(&self) -> &[String] {
        &self.names
    }

    fn array(&mut self, name: &str) -> Result<Self::Array<'_>, TableProblem> {
        let places = self.names.iter().zip(&self.places);
        let place = places
            .filter(|(known, _)| *known == name)
            .map(|(_, &place)| place)
            .next();
        let matrix = self.matrix(place.unwrap_or(HEADER)).map_err(damaged)?;
        matrix.usable()
    }
}

/// What the elements of an array are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Class {
    Cells,
    Characters,
    Numbers,
    /// What holds neither numbers nor texts, or not as a table.
    Other(&'static str),
}

impl Class {
    /// Classes of arrays by their number in the file.
    fn of(number: u32) -> Self {
        match number {
            1 => Self::Cells,
            4 => Self::Characters,
            6..=15 => Self::Numbers,
            2 => Self::Other("a structure"),
            5 => Self::Other("a sparse matrix"),
            17 => Self::Other("an object, such as a string array or a table"),
            _ => Self::Other("an array of a class of its own"),
        }
    }
}

/// An array whose elements are still to be read.
struct Matrix<R> {
    name: String,
    class: Class,
    complex: bool,
    shape: Vec<usize>,
    elements: Elements<R>,
    /// More bytes than this its elements do not have.
    most_bytes: u64,
}

impl<R: Read> Matrix<R> {
    /// Reads what stands before the data of an array that has at most this many bytes.
    fn begin(mut elements: Elements<R>, most_bytes: u64) -> io::Result<Self> {
        let flags = elements.words()?.first().copied().unwrap_or_default();
        let class = Class::of(flags & 0xff);
        let lengths = match flags & 0xff {
            17 => Vec::new(),
            _ => elements.words()?,
        };
        let (_, name) = elements.short()?;
        Ok(Self {
            name: String::from_utf8_lossy(&name).into_owned(),
            class,
            complex: flags & 0x0800 != 0,
            shape: lengths.into_iter().map(|n| n as usize).collect(),
            elements,
            most_bytes,
        })
    }

    /// Refuses a shape that the bytes cannot hold. Asked only of arrays that are read, since others may be as large as they like.
    fn check_size(&self) -> io::Result<()> {
        let most = match self.class {
            Class::Characters => self.most_bytes.min(MOST_CHARACTERS),
            _ => self.most_bytes,
        };
        let shape = &self.shape;
        // a number takes at least a byte, and rows without columns take room here
        let count = shape
            .iter()
            .try_fold(1_u64, |count, &n| count.checked_mul(n.max(1) as u64));
        match count.is_some_and(|count| count <= most.max(1)) {
            true => Ok(()),
            false => Err(invalid(format!(
                "an array of {shape:?} in {} bytes, expected at most {most} elements",
                self.most_bytes
            ))),
        }
    }

    /// This array, if it holds numbers or texts; a matrix of characters is a column with a text in each row.
    fn usable(mut self) -> Result<Self, TableProblem> {
        if !matches!(self.class, Class::Other(_)) {
            self.check_size().map_err(damaged)?;
        }
        match self.class {
            Class::Other(found) => Err(TableProblem::at(
                format_args!("array {}", self.name),
                found,
                "numbers, a cell array of texts or a matrix of characters; convert it before saving: full(…), double(…), cellstr(…)",
            )),
            Class::Characters => {
                let rows = self.shape.first().copied().unwrap_or_default();
                self.shape = vec![rows, 1];
                Ok(self)
            }
            Class::Cells | Class::Numbers => Ok(self),
        }
    }

    /// The texts of a matrix of characters, which lies column by column.
    fn rows(&mut self, rows: usize) -> io::Result<Vec<String>> {
        let mut units = Vec::new();
        let tag = self.elements.numbers(|unit| {
            units.push(unit as u16);
            match units.len() as u64 > MOST_CHARACTERS {
                true => Err(cut_short()),
                false => Ok(()),
            }
        })?;
        if rows > 1 && units.len() < rows {
            return Err(cut_short());
        }
        let text = |row: usize| {
            let row = units.iter().skip(row).step_by(rows);
            let text = match tag.number {
                UTF8 => String::from_utf8_lossy(&row.map(|&unit| unit as u8).collect::<Vec<_>>())
                    .into_owned(),
                _ => String::from_utf16_lossy(&row.copied().collect::<Vec<_>>()),
            };
            text.trim().to_owned()
        };
        Ok((0..rows).map(text).collect())
    }

    /// The text of the next cell.
    fn cell(&mut self) -> Result<String, Stop> {
        let (tag, big_endian) = (self.elements.tag()?, self.elements.big_endian);
        let data = Elements::new(self.elements.data(tag), big_endian);
        let mut cell = Matrix::begin(data, tag.bytes)?;
        cell.check_size()?;
        match (cell.class, cell.shape.first()) {
            (Class::Characters, Some(0 | 1)) => Ok(cell.rows(1)?.concat()),
            _ => Err(Stop::Problem(TableProblem::at(
                format_args!("array {}", self.name),
                "a cell that is no line of text",
                "a cell array of texts such as {'11:+Y', '12:+Y'}",
            ))),
        }
    }

    fn numbers(
        &mut self,
        take: &mut impl FnMut(Element) -> Result<(), TableProblem>,
    ) -> Result<(), Stop> {
        let count: usize = self.shape.iter().product();
        let mut real = Vec::new();
        let mut met = 0;
        if self.complex {
            self.elements.numbers(|number| {
                real.push(number);
                io::Result::Ok(())
            })?;
        }
        self.elements.numbers(|number| {
            let value = match self.complex {
                true => Complex64::new(real.get(met).copied().ok_or_else(cut_short)?, number),
                false => Complex64::from(number),
            };
            met += 1;
            take(Element::Number(value)).map_err(Stop::Problem)
        })?;
        match met == count && (!self.complex || real.len() == count) {
            true => Ok(()),
            false => Err(cut_short().into()),
        }
    }
}

impl<R: Read> Array for Matrix<R> {
    fn kind(&self) -> Kind {
        match (self.class, self.complex) {
            (Class::Numbers, false) => Kind::Real,
            (Class::Numbers, true) => Kind::Complex,
            _ => Kind::Text,
        }
    }

    fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// MATLAB's first index runs fastest.
    fn fortran_order(&self) -> bool {
        true
    }

    fn each(
        mut self,
        mut take: impl FnMut(Element) -> Result<(), TableProblem>,
    ) -> Result<(), TableProblem> {
        let count: usize = self.shape.iter().product();
        let done = match self.class {
            Class::Numbers => self.numbers(&mut take),
            Class::Characters => self.rows(count).map_err(Stop::from).and_then(|rows| {
                rows.into_iter()
                    .try_for_each(|row| take(Element::Text(row)))
                    .map_err(Stop::Problem)
            }),
            _ => (0..count).try_for_each(|_| {
                let text = self.cell()?;
                take(Element::Text(text)).map_err(Stop::Problem)
            }),
        };
        done.map_err(|stop| match stop {
            Stop::Problem(problem) => problem,
            Stop::Io(error) => {
                let expected = "the elements that the array states; the file is cut short or damaged, save it again";
                TableProblem::at(format_args!("array {}", self.name), error, expected)
            }
        })
    }
}

/// Why the elements of an array end early.
enum Stop {
    Io(io::Error),
    Problem(TableProblem),
}

impl From<io::Error> for Stop {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// More or fewer elements than the array states.
fn cut_short() -> io::Error {
    invalid("another number of elements".to_owned())
}

fn damaged(error: io::Error) -> TableProblem {
    let expected = format_args!("a file of {SAVE}; save or copy it again");
    TableProblem::whole(format_args!("a damaged MATLAB file ({error})"), expected)
}
