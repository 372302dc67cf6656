//! Whether the assembly's functions are those of one of its substructures: a file that was named twice, or copied.

use super::super::error::IdentifyError;
use super::super::lines::Lines;
use super::super::study::{FrfFile, Source, Study, Substructure};
use bolted_joint_frf::FrfError;
use std::fs;
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

/// The error of a file that does not have what is asked for; where it is named twice, with what it is named for.
pub(super) fn explained(study: &Study, error: IdentifyError) -> IdentifyError {
    let (path, source) = match error {
        IdentifyError::Frf(FrfError::InFile { path, source })
            if matches!(
                *source,
                FrfError::NoneSelected { .. } | FrfError::MissingPair { .. }
            ) =>
        {
            (path, source)
        }
        error => return error,
    };
    let files = [
        ("a", functions_of(&study.a)),
        ("b", functions_of(&study.b)),
        ("the assembly", Some(&study.assembly)),
    ];
    let named = files
        .into_iter()
        .filter(|(_, file)| file.is_some_and(|file| is_among(&path, file)));
    let roles: Vec<&'static str> = named.map(|(role, _)| role).collect();
    let source = FrfError::InFile { path, source };
    match roles.len() > 1 {
        true => IdentifyError::NamedTwice {
            source: Box::new(source),
            roles,
        },
        false => IdentifyError::Frf(source),
    }
}

/// A file that has functions of both.
fn file_in_common<'s>(study: &'s Study, substructure: &Substructure) -> Option<&'s Path> {
    let file = functions_of(substructure)?;
    let mut own = study.assembly.function_files().map(AsRef::as_ref);
    own.find(|path| is_among(path, file))
}

fn functions_of(substructure: &Substructure) -> Option<&FrfFile> {
    match substructure {
        Substructure::Measured {
            source: Source::Frf { file, .. },
            ..
        } => Some(file),
        _ => None,
    }
}

/// Whether a path leads to one of the files of a measurement.
fn is_among(path: &Path, file: &FrfFile) -> bool {
    let Ok(path) = fs::canonicalize(path) else {
        return false;
    };
    let mut others = file.function_files().map(fs::canonicalize);
    others.any(|other| other.is_ok_and(|other| other == path))
}
