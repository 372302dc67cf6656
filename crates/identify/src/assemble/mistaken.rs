//! Whether the assembly's functions are those of one of its substructures: a file that was named twice, or copied.

use super::super::error::IdentifyError;
use super::super::lines::Lines;
use super::super::study::{Source, Study, Substructure};
use std::path::Path;

/// Values that differ by less than this part are the same: copies are written with six digits at least.
const SAME: f64 = 1e-5;

/// Refuses a file of the assembly that is, or has the functions of, A or B: no joint makes nothing of two structures.
pub(super) fn refused(study: &Study, lines: &Lines) -> Result<(), IdentifyError> {
    let of_b = lines.points.len() - study.points_on_a;
    let sides = [
        (
            &study.b,
            'B',
            lines.structures()[1],
            lines.points[..of_b].iter(),
            0,
        ),
        (
            &study.a,
            'A',
            lines.structures()[0],
            lines.points[of_b..].iter(),
            of_b,
        ),
    ];
    for (substructure, name, receptances, points, first) in sides {
        let dofs = receptances.size() - points.len();
        for (number, &point) in points.enumerate() {
            let place = (first + number, first + number);
            let is_same = lines.measured.contains(&place)
                && (0..lines.frequency_hz.len()).all(|line| {
                    let own = receptances.at(line)[(dofs + number, dofs + number)];
                    let assembled = lines.assembly[line][place];
                    (own - assembled).norm() <= SAME * assembled.norm()
                });
            let is_same_file = || file_in_common(study, substructure).is_some();
            if is_same || is_same_file() {
                return Err(IdentifyError::AssemblyIsSubstructure {
                    path: study.assembly.path.clone(),
                    file: file_in_common(study, substructure).map(Path::to_owned),
                    substructure: name,
                    point,
                });
            }
        }
    }
    Ok(())
}

/// A file that has functions of both.
fn file_in_common<'s>(study: &'s Study, substructure: &Substructure) -> Option<&'s Path> {
    let Substructure::Measured {
        source: Source::Frf { file, .. },
        ..
    } = substructure
    else {
        return None;
    };
    let all: Vec<_> = file.function_files().map(std::fs::canonicalize).collect();
    let is_its = |path: &Path| {
        let path = std::fs::canonicalize(path);
        path.is_ok_and(|path| all.iter().flatten().any(|other| *other == path))
    };
    let mut own = study.assembly.function_files().map(AsRef::as_ref);
    own.find(|path| is_its(path))
}
