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
    let [a, b] = lines.structures();
    for (name, substructure, receptances, places) in [
        ('B', &study.b, b, 0..of_b),
        ('A', &study.a, a, of_b..lines.points.len()),
    ] {
        let file = file_in_common(study, substructure);
        let dofs = receptances.size() - places.len();
        let is_its = |(number, place): &(usize, usize)| {
            let (own, place) = ((dofs + number, dofs + number), (*place, *place));
            file.is_some()
                || lines.measured.contains(&place)
                    && (0..lines.frequency_hz.len()).all(|line| {
                        let assembled = lines.assembly[line][place];
                        let alone = receptances.at(line)[own];
                        (alone - assembled).norm() <= SAME * assembled.norm()
                    })
        };
        if let Some((_, place)) = places.enumerate().find(is_its) {
            return Err(IdentifyError::AssemblyIsSubstructure {
                path: study.assembly.path.clone(),
                file: file.map(Path::to_owned),
                substructure: name,
                point: lines.points[place],
            });
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
