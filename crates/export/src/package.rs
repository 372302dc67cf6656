//! The last step of every export: pictures aside, all files go into one archive, with the libraries beside them.

use std::path::Path;

use super::archive::{File, archive};
use super::platforms::{Library, binaries};
use super::{ExportError, FmiVersion, Timestamp};
use bolted_joint_files::whole_file;

/// A file of an FMU.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// Path in the FMU.
    pub path: String,
    /// Length before compression, bytes.
    pub size: usize,
}

/// An FMU as it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Packed {
    /// Libraries in it.
    pub libraries: Vec<Library>,
    /// Its files.
    pub entries: Vec<Entry>,
    bytes: Vec<u8>,
}

impl Packed {
    /// The archive of these files, without libraries of its own.
    pub(super) fn of(files: Vec<File>, date: Timestamp) -> Result<Self, ExportError> {
        let entries = files.iter().map(|file| Entry {
            path: file.path.clone(),
            size: file.content.size(),
        });
        Ok(Self {
            libraries: Vec::new(),
            entries: entries.collect(),
            bytes: archive(files, date)?,
        })
    }

    /// The FMU itself.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Writes the FMU to `path`, whole or not at all.
    ///
    /// # Errors
    ///
    /// [`ExportError::Unwritable`] where the system refuses.
    pub fn write(&self, path: &Path) -> Result<(), ExportError> {
        whole_file::write(path, &self.bytes).map_err(|source| ExportError::Unwritable {
            path: path.to_path_buf(),
            source,
        })
    }
}

/// The FMU of these files, with the libraries of this platform and of those in a folder.
pub(super) fn packed(
    mut files: Vec<File>,
    platforms: Option<&Path>,
    library_name: &str,
    version: FmiVersion,
    date: Timestamp,
) -> Result<Packed, ExportError> {
    let mut libraries = Vec::new();
    for binary in binaries(platforms, library_name, version)? {
        libraries.push(binary.library);
        files.push(File {
            path: binary.path,
            content: binary.content,
            executable: true,
        });
    }
    Ok(Packed {
        libraries,
        ..Packed::of(files, date)?
    })
}
