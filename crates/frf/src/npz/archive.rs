//! The members of an archive: which arrays there are, and where each begins.

use std::fmt::Display;
use std::io::{BufReader, Read, Seek};

use zip::ZipArchive;
use zip::read::ZipFile;

use super::array::{Array, cut_short};
use crate::arrays::ArrayFile;
use crate::{FileFormat, TableProblem};

/// Deflate cannot make data smaller than by this factor; a member that claims more is damaged or made to harm.
const LARGEST_RATIO: u64 = 1100;

/// The arrays of a file, by name.
pub(super) struct Archive<R> {
    zip: ZipArchive<R>,
    names: Vec<String>,
}

impl<R: Read + Seek> Archive<R> {
    pub(super) fn open(reader: R) -> Result<Self, TableProblem> {
        let zip = ZipArchive::new(reader).map_err(broken)?;
        if zip.index_for_name("[Content_Types].xml").is_some() {
            return Err(TableProblem::whole(
                "a workbook of Excel or a document of Office",
                "a table: save the sheet as CSV",
            ));
        }
        let names = zip
            .file_names()
            .filter_map(|name| Some(name.ok()?.strip_suffix(".npy")?.to_owned()))
            .collect();
        Ok(Self { zip, names })
    }
}

impl<R: Read + Seek> ArrayFile for Archive<R> {
    const FORMAT: FileFormat = FileFormat::Archive;
    const SAVE: &str = "numpy.savez(file, frequency=…, frf=…, response=…, reference=…)";
    const SAVE_MATRICES: &str = "numpy.savez(file, M=…, K=…, C=…, points=[…])";
    const CONVERT: &str = "convert it with astype before saving";
    type Array<'file>
        = Array<BufReader<ZipFile<'file, R>>>
    where
        Self: 'file;

    fn names(&self) -> &[String] {
        &self.names
    }

    fn array(&mut self, name: &str) -> Result<Self::Array<'_>, TableProblem> {
        let file = self.zip.by_name(&format!("{name}.npy"));
        let file = file.map_err(|error| broken(format_args!("array {name}: {error}")))?;
        let (bytes, stored) = (file.size(), file.compressed_size());
        if bytes > stored.saturating_mul(LARGEST_RATIO) {
            return Err(cut_short(name, stored, bytes));
        }
        Array::open(name, BufReader::new(file), bytes)
    }
}

/// No zip archive, or a broken one.
fn broken(reason: impl Display) -> TableProblem {
    let expected = "a file of numpy.savez; save or copy it again";
    TableProblem::whole(format_args!("a broken archive ({reason})"), expected)
}
