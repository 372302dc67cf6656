//! The archive as old programs read it: its headers, byte by byte, after PKWARE's APPNOTE.TXT.

use bolted_joint::export::{FmiVersion, Interface};

use crate::{Failure, export_as};

/// Little-endian number of `N` bytes at `at`.
fn number<const N: usize>(bytes: &[u8], at: usize) -> usize {
    let bytes = bytes[at..at + N].iter().rev();
    bytes.fold(0, |number, &byte| number << 8 | usize::from(byte))
}

/// What both headers of a file have in common, from "version needed to extract" on: sections 4.3.7 and 4.3.12.
fn check_common(bytes: &[u8], at: usize, name: &str) {
    let version_needed = number::<2>(bytes, at);
    assert!(version_needed <= 20, "{name}: version {version_needed}");
    // No encryption (bit 0), no data descriptor (3), no patches (5), no UTF-8 names (11), no masking (13).
    let flags = number::<2>(bytes, at + 2);
    assert_eq!(flags & !0b110, 0, "{name}: flags {flags:#b}");
    let method = number::<2>(bytes, at + 4);
    assert!(matches!(method, 0 | 8), "{name}: method {method}");
    for (size, what) in [(at + 14, "compressed"), (at + 18, "size")] {
        let size = number::<4>(bytes, size);
        assert!(0 < size && size < 0xffff_ffff, "{name}: {what} {size}");
    }
    assert_eq!(number::<2>(bytes, at + 24), 0, "{name}: extra field");
}

fn check_name(name: &str) {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
    assert!(name.chars().all(is_plain), "{name}");
    assert!(!name.starts_with('/') && !name.ends_with('/') && !name.contains(".."));
}

fn check(bytes: &[u8], paths: &[&str]) {
    // End of central directory, 4.3.16: without comment, the last 22 bytes.
    let end = bytes.len() - 22;
    assert_eq!(number::<4>(bytes, end), 0x0605_4b50);
    for disk in [end + 4, end + 6] {
        assert_eq!(number::<2>(bytes, disk), 0, "one disk");
    }
    let count = number::<2>(bytes, end + 10);
    assert_eq!([number::<2>(bytes, end + 8), count], [paths.len(); 2]);
    let directory = number::<4>(bytes, end + 16);
    assert_eq!(directory + number::<4>(bytes, end + 12), end);

    let (mut central, mut local) = (directory, 0);
    for path in paths {
        assert_eq!(number::<4>(bytes, central), 0x0201_4b50, "{path}");
        check_common(bytes, central + 6, path);
        let length = number::<2>(bytes, central + 28);
        let name = str::from_utf8(&bytes[central + 46..central + 46 + length]).unwrap();
        assert_eq!(name, *path);
        check_name(name);
        assert_eq!(number::<2>(bytes, central + 32), 0, "{path}: comment");
        // A regular file: no link (upper half of the external attributes, as Unix has it).
        assert_eq!(number::<2>(bytes, central + 40) >> 12, 0o10, "{path}");
        assert_eq!(number::<4>(bytes, central + 42), local, "{path}: no gap");

        assert_eq!(number::<4>(bytes, local), 0x0403_4b50, "{path}");
        check_common(bytes, local + 4, path);
        // version, flags, method, time, CRC, sizes and name length are the same in both
        let [here, there] = [&bytes[local + 4..], &bytes[central + 6..]];
        assert_eq!(here[..24], there[..24], "{path}");
        assert_eq!(&bytes[local + 30..local + 30 + length], path.as_bytes());
        local += 30 + length + number::<4>(bytes, local + 18);
        central += 46 + length;
    }
    assert_eq!((central, local), (end, directory));
}

#[test]
fn programs_of_the_nineties_can_unpack_it() -> Result<(), Failure> {
    for version in [FmiVersion::V2, FmiVersion::V3] {
        for (name, interface) in [
            ("m10-aluminium.joint.json", Interface::Element),
            ("pirdayr-ex03.joint.json", Interface::Lap),
        ] {
            let (fmu, _) = export_as(name, interface, version)?;
            let paths: Vec<&str> = fmu.entries().iter().map(|entry| &*entry.path).collect();
            check(fmu.bytes(), &paths);
        }
    }
    Ok(())
}
