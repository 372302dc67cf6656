//! MATLAB files that are not of level 5: which kind one is, its beginning says for sure.

use super::{HEADER, SAVE};
use crate::TableProblem;

/// How HDF5 begins.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";
/// The version in the header of -v7.3, by the order of bytes.
const VERSION_73: [[u8; 4]; 2] = [[0, 2, b'I', b'M'], [2, 0, b'M', b'I']];

/// What a file that begins so is, and how it becomes one that can be read.
pub(super) fn other_level(beginning: &[u8]) -> TableProblem {
    let version = beginning.get(124..HEADER as usize);
    let is_73 = beginning.starts_with(HDF5)
        || beginning.starts_with(b"MATLAB 7.3")
        || VERSION_73.iter().any(|own| version == Some(own));
    let (found, python) = if is_73 {
        (
            "a MATLAB file of -v7.3, which is HDF5",
            ", or read it with the Python module (read, with h5py)",
        )
    } else if is_of_level_4(beginning) {
        ("a MATLAB file of -v4", "")
    } else if beginning.starts_with(b"MATLAB") {
        ("a damaged header of a MATLAB file", "")
    } else {
        ("no MATLAB file", "")
    };
    TableProblem::whole(
        found,
        format_args!(
            "a file of level 5, of {SAVE}; load the file in MATLAB and save it so{python}"
        ),
    )
}

/// Whether a file begins with a matrix of level 4: a type in four digits MOPT, rows and columns, 0 or 1 for an imaginary part, the
/// length of its name.
fn is_of_level_4(beginning: &[u8]) -> bool {
    let fields = |number: fn([u8; 4]) -> u32| -> Option<[u32; 5]> {
        let mut fields = beginning.chunks_exact(4).map(|bytes| {
            let mut four = [0; 4];
            four.copy_from_slice(bytes);
            number(four)
        });
        let [mut kind, mut rows, mut columns, mut imaginary, mut name] = [0; 5];
        for field in [
            &mut kind,
            &mut rows,
            &mut columns,
            &mut imaginary,
            &mut name,
        ] {
            *field = fields.next()?;
        }
        Some([kind, rows, columns, imaginary, name])
    };
    let is_one = |fields: [u32; 5]| {
        let [kind, _, _, imaginary, name] = fields;
        let [machine, zero, precision, class] = [1000, 100, 10, 1].map(|digit| kind / digit % 10);
        kind < 5000
            && machine < 5
            && zero == 0
            && precision < 6
            && class < 3
            && imaginary < 2
            && (1..=64).contains(&name)
    };
    [u32::from_le_bytes, u32::from_be_bytes]
        .into_iter()
        .any(|number| fields(number).is_some_and(is_one))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_beginning_tells_the_level() {
        let of_4 = [0_u32, 3, 1, 0, 2].map(u32::to_le_bytes).concat();
        let mut of_73 = [b' '; 128];
        of_73[124..].copy_from_slice(b"\0\x02IM");
        #[rustfmt::skip]
        let cases: [(&[u8], &str); 6] = [
            (b"MATLAB 7.3 MAT-file, Platform: GLNXA64", "found a MATLAB file of -v7.3, which is HDF5, expected"),
            (&of_73, "of -v7.3, which is HDF5"),
            (b"\x89HDF\r\n\x1a\n\0", "of -v7.3, which is HDF5"),
            (&of_4, "found a MATLAB file of -v4, expected"),
            (b"MATLAB 5.0 MAT-file", "found a damaged header"),
            (b"PNG", "found no MATLAB file, expected a file of level 5"),
        ];
        for (beginning, expected) in cases {
            let refused = other_level(beginning).to_string();
            assert!(refused.contains(expected), "{expected}: {refused}");
        }
    }
}
