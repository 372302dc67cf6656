//! The zip archive of an FMU: its entries, the texts in it, and what of it is damaged.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use super::CheckError;

/// An opened FMU.
pub(super) struct Archive {
    path: PathBuf,
    zip: zip::ZipArchive<File>,
}

impl Archive {
    pub(super) fn open(path: &Path) -> Result<Self, CheckError> {
        let file = File::open(path).map_err(|source| CheckError::Unreadable {
            path: path.to_owned(),
            source,
        })?;
        let zip = zip::ZipArchive::new(file).map_err(|source| CheckError::Archive {
            path: path.to_owned(),
            source,
        })?;
        Ok(Self {
            path: path.to_owned(),
            zip,
        })
    }

    /// Names of all entries, in their order.
    pub(super) fn names(&self) -> Vec<String> {
        (0..self.zip.len())
            .map(|index| {
                self.zip
                    .name_for_index(index)
                    .and_then(Result::ok)
                    .map_or_else(|| format!("entry {index}"), |name| name.into_owned())
            })
            .collect()
    }

    /// A text that every FMU of this program has.
    pub(super) fn text(&mut self, entry: &'static str) -> Result<String, CheckError> {
        self.optional_text(entry).ok_or_else(|| CheckError::Entry {
            path: self.path.clone(),
            entry,
        })
    }

    /// The text of an entry, if there is one and it is text.
    pub(super) fn optional_text(&mut self, entry: &str) -> Option<String> {
        let mut text = String::new();
        self.zip
            .by_name(entry)
            .ok()?
            .read_to_string(&mut text)
            .ok()?;
        Some(text)
    }

    /// The first bytes of an entry, if there is one.
    pub(super) fn beginning(&mut self, entry: &str) -> Option<Vec<u8>> {
        let mut bytes = Vec::new();
        let file = self.zip.by_name(entry).ok()?;
        file.take(16).read_to_end(&mut bytes).ok()?;
        Some(bytes)
    }

    /// Entries that do not unpack, and names that no FMU may have.
    pub(super) fn damage(&mut self) -> Vec<String> {
        let mut findings = Vec::new();
        for (index, name) in self.names().into_iter().enumerate() {
            if name.contains('\\') {
                findings.push(format!(
                    "{name:?}: found a backslash in the name of an entry, expected forward slashes"
                ));
            }
            let read = self
                .zip
                .by_index(index)
                .map_err(io::Error::other)
                .and_then(|mut file| io::copy(&mut file, &mut io::sink()));
            if let Err(refused) = read {
                findings.push(format!(
                    "{name}: found it damaged ({refused}), expected it to unpack; copy or export the FMU again"
                ));
            }
        }
        findings
    }

    /// Writes all entries below `folder`; names that lead out of it are an error.
    pub(super) fn unpack(&mut self, folder: &Path) -> io::Result<()> {
        for index in 0..self.zip.len() {
            let mut entry = self.zip.by_index(index).map_err(io::Error::other)?;
            let inside = entry.enclosed_name().ok_or_else(|| {
                io::Error::other(format!(
                    "entry {index} has a path that leads out of the FMU"
                ))
            })?;
            let path = folder.join(inside);
            if entry.is_dir() {
                fs::create_dir_all(&path)?;
                continue;
            }
            if let Some(parent) = path.parent() {
                fs::create_dir_all(parent)?;
            }
            io::copy(&mut entry, &mut File::create(&path)?)?;
        }
        Ok(())
    }
}
