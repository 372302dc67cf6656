//! The members of a NumPy archive: the bytes are cut into arrays, which an intact archive then holds.
//!
//! What is in an archive's members is under a checksum, so that damage to the archive itself seldom reaches an array's header.
#![no_main]

use std::io::{Cursor, Write as _};

use bolted_joint_frf::{ReadOptions, read_npz_from};
use libfuzzer_sys::fuzz_target;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

const NAMES: [&str; 14] = [
    "frequency",
    "f",
    "frf",
    "H",
    "mobility",
    "response",
    "reference",
    "axes",
    "quantity",
    "unit",
    "coherence",
    "COH",
    "a name of its own",
    "averages",
];

/// Each member: a byte for its name, two for its length, and so many bytes.
fn archive(mut bytes: &[u8]) -> zip::result::ZipResult<Vec<u8>> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    while let Some((&[name, low, high], rest)) = bytes.split_first_chunk() {
        let length = usize::from(u16::from_le_bytes([low, high])).min(rest.len());
        let name = NAMES[usize::from(name) % NAMES.len()];
        let compression = match length % 2 {
            0 => CompressionMethod::Stored,
            _ => CompressionMethod::Deflated,
        };
        let options = SimpleFileOptions::default().compression_method(compression);
        zip.start_file(format!("{name}.npy"), options)?;
        zip.write_all(&rest[..length])?;
        bytes = &rest[length..];
    }
    Ok(zip.finish()?.into_inner())
}

fuzz_target!(|bytes: &[u8]| {
    // A name twice is refused by the writer already.
    if let Ok(archive) = archive(bytes) {
        let _ = read_npz_from(Cursor::new(archive), "bytes.npz", &ReadOptions::default())
            .and_then(|reading| reading.into_set());
    }
});
