//! The FMU's zip archive: the same bytes for the same contents and date.

use std::io::{Cursor, Read as _, Write as _};

use zip::result::{ZipError, ZipResult};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

use super::{ExportError, Timestamp};

/// A file of the FMU.
pub(super) struct File {
    /// Path in the FMU, with forward slashes.
    pub(super) path: String,
    pub(super) content: Content,
    pub(super) executable: bool,
}

/// What is in a file.
pub(super) enum Content {
    Bytes(Vec<u8>),
    /// An archive, which compression does not make smaller.
    Archive(Vec<u8>),
    /// The one file of an archive, compressed as it is there.
    Packed(ZipArchive<Cursor<&'static [u8]>>),
}

impl File {
    pub(super) fn text(path: &str, text: impl Into<String>) -> Self {
        Self::bytes(path, text.into().into_bytes())
    }

    pub(super) fn bytes(path: &str, bytes: impl Into<Vec<u8>>) -> Self {
        Self {
            path: path.to_owned(),
            content: Content::Bytes(bytes.into()),
            executable: false,
        }
    }
}

impl Content {
    /// The one file of an archive.
    pub(super) fn packed(archive: &'static [u8]) -> Result<Self, ExportError> {
        Ok(Self::Packed(ZipArchive::new(Cursor::new(archive))?))
    }

    /// Length before compression, bytes.
    pub(super) fn size(&self) -> usize {
        match self {
            Self::Bytes(bytes) | Self::Archive(bytes) => bytes.len(),
            Self::Packed(archive) => archive
                .decompressed_size()
                .and_then(|size| size.try_into().ok())
                .unwrap_or(0),
        }
    }

    pub(super) fn bytes(self) -> Result<Vec<u8>, ExportError> {
        match self {
            Self::Bytes(bytes) | Self::Archive(bytes) => Ok(bytes),
            Self::Packed(mut archive) => {
                let mut bytes = Vec::new();
                let mut file = archive.by_index(0)?;
                file.read_to_end(&mut bytes).map_err(ZipError::from)?;
                Ok(bytes)
            }
        }
    }
}

/// The archive of `files` in their order, all dated `date`.
pub(super) fn archive(files: Vec<File>, date: Timestamp) -> Result<Vec<u8>, ExportError> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for file in files {
        add(&mut writer, file, zip_time(date))?;
    }
    Ok(writer.finish()?.into_inner())
}

fn add(writer: &mut ZipWriter<Cursor<Vec<u8>>>, file: File, date: DateTime) -> ZipResult<()> {
    let permissions = if file.executable { 0o755 } else { 0o644 };
    let (bytes, method) = match file.content {
        Content::Bytes(bytes) => (bytes, CompressionMethod::Deflated),
        Content::Archive(bytes) => (bytes, CompressionMethod::Stored),
        Content::Packed(mut archive) => {
            // one copy for the date, one for the name
            let mut dated = ZipWriter::new(Cursor::new(Vec::new()));
            dated.raw_copy_file_touch(archive.by_index_raw(0)?, date, Some(permissions))?;
            let mut dated = dated.finish_into_readable()?;
            return writer.raw_copy_file_rename(dated.by_index_raw(0)?, file.path);
        }
    };
    let options = SimpleFileOptions::default()
        .compression_method(method)
        .last_modified_time(date)
        .unix_permissions(permissions);
    writer.start_file(&*file.path, options)?;
    writer.write_all(&bytes)?;
    Ok(())
}

/// Zip knows the years 1980 to 2107 and even seconds; what lies outside becomes 1980-01-01.
fn zip_time(date: Timestamp) -> DateTime {
    let at = date.civil();
    DateTime::from_date_and_time(
        at.year,
        at.month,
        at.day,
        at.hour,
        at.minute,
        at.second / 2 * 2,
    )
    .unwrap_or(DateTime::DEFAULT)
}
