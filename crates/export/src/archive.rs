//! The FMU's zip archive: the same bytes for the same contents and date.

use std::io::{Cursor, Write as _};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::{ExportError, Timestamp};

/// A file of the FMU.
pub(super) struct File {
    /// Path in the FMU, with forward slashes.
    pub(super) path: String,
    pub(super) bytes: Vec<u8>,
    pub(super) executable: bool,
}

impl File {
    pub(super) fn text(path: &str, text: impl Into<String>) -> Self {
        Self::bytes(path, text.into().into_bytes())
    }

    pub(super) fn bytes(path: &str, bytes: impl Into<Vec<u8>>) -> Self {
        Self {
            path: path.to_owned(),
            bytes: bytes.into(),
            executable: false,
        }
    }
}

/// The archive of `files` in their order, all dated `date`.
pub(super) fn archive(files: &[File], date: Timestamp) -> Result<Vec<u8>, ExportError> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for file in files {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(zip_time(date))
            .unix_permissions(if file.executable { 0o755 } else { 0o644 });
        writer.start_file(&*file.path, options)?;
        writer
            .write_all(&file.bytes)
            .map_err(zip::result::ZipError::from)?;
    }
    Ok(writer.finish()?.into_inner())
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
