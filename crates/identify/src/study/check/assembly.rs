//! `[assembly]`: files of functions, points and torque.

use super::super::Substructure;
use super::super::set_up::Accelerometer;
use super::super::tables::NoiseTable;
use super::super::{FrfFile, FurtherAssembly};
use super::stated::not_negative;
use bolted_joint_frf::{Dof, Quantity};
use bolted_joint_study::{Paths, Stated, StudyError, StudyText, UnitsTable};

/// What a study says of a file of functions.
#[derive(Clone, Copy)]
pub(crate) struct MeasuredAs<'t> {
    pub(crate) coherence: Option<&'t Paths>,
    pub(crate) quantity: Option<Quantity>,
    pub(crate) units: Option<&'t UnitsTable>,
    pub(crate) averages: Option<f64>,
    pub(crate) accelerometer_mass: Option<&'t Stated>,
}

/// More than that is no accelerometer, and a slip of the unit.
const MOST_ACCELEROMETER_KG: f64 = 1.0;

/// A file of functions with what `[key]` states beside it.
pub(crate) fn frf_file(
    study: &StudyText,
    key: &str,
    paths: &Paths,
    stated: &MeasuredAs<'_>,
) -> Result<FrfFile, StudyError> {
    let units = study.units(format_args!("{key}.units"), stated.units)?;
    if let Some(found) = stated.averages {
        let key = format!("{key}.averages");
        study.within(key, found, 1.0..=f64::MAX, "a number of at least 1")?;
    }
    let accelerometer = |mass: &Stated| {
        let key = format!("{key}.accelerometer_mass");
        not_negative(study, &key, mass, "kg", MOST_ACCELEROMETER_KG)?;
        Ok::<_, StudyError>(Accelerometer {
            mass_kg: mass.value,
            standard_deviation_kg: mass.standard_deviation(),
        })
    };
    Ok(FrfFile {
        path: study.resolved(&paths.first),
        further: paths
            .further
            .iter()
            .map(|path| study.resolved(path))
            .collect(),
        coherence: stated.coherence.map_or_else(Vec::new, |paths| {
            paths.iter().map(|path| study.resolved(path)).collect()
        }),
        quantity: stated.quantity,
        units,
        averages: stated.averages,
        accelerometer: stated.accelerometer_mass.map(accelerometer).transpose()?,
    })
}

/// The points of B, then those of A.
pub(crate) fn points(
    study: &StudyText,
    of_b: Vec<Dof>,
    of_a: Vec<Dof>,
) -> Result<Vec<Dof>, StudyError> {
    let points = [of_b, of_a].concat();
    let expected = "one or more measured points of B, three for the best result, or points_on_a with points of A";
    study.ensure(
        !points.is_empty(),
        "assembly.points",
        "an empty list",
        expected,
    )?;
    for (index, point) in points.iter().enumerate() {
        let before = &points[..index];
        if let Some(same) = before.iter().find(|&p| p == point || *p == point.flipped()) {
            let found = match same == point {
                true => format!("{point} twice"),
                false => format!("both {same} and {point}, which are one point"),
            };
            return study.refuse("assembly.points", found, "every point once");
        }
    }
    Ok(points)
}

/// The same functions under the same points are one measurement, not two.
pub(crate) fn every_assembly_once(
    study: &StudyText,
    all: &[FurtherAssembly],
) -> Result<(), StudyError> {
    for (place, assembly) in all.iter().enumerate() {
        let mut before = all[..place].iter();
        let is_same = |other: &FurtherAssembly| {
            other
                .file
                .function_files()
                .eq(assembly.file.function_files())
                && other.points == assembly.points
        };
        study.ensure(
            !before.any(is_same),
            format_args!("assembly[{place}].frf"),
            format_args!(
                "{} with the same points as before",
                assembly.file.path.display()
            ),
            "every measurement once: it would count as two",
        )?;
    }
    Ok(())
}

/// Every point of the assembly on the structure `[side]` has a place there if it is a beam, and if it is a measured structure where
/// any point has.
pub(crate) fn positions(
    study: &StudyText,
    side: &str,
    points: &[Dof],
    structure: &Substructure,
) -> Result<(), StudyError> {
    let (positions_m, origin) = match structure {
        Substructure::Beam { positions_m, .. } => (positions_m, "the beam's first end"),
        Substructure::Ground { .. } => {
            return study.ensure(
                points.is_empty(),
                "assembly.points_on_a",
                "points of a ground",
                "no such key: what does not move has no functions",
            );
        }
        Substructure::Measured { positions_m, .. } if positions_m.is_empty() => return Ok(()),
        Substructure::Measured { positions_m, .. } => {
            (positions_m, "any point along the structure")
        }
    };
    for point in points {
        let has_direction = point.direction().is_translation() || point.direction().is_rotation();
        let expected = "a direction such as \"11:+Y\" on a beam";
        study.ensure(has_direction, "assembly.points", point, expected)?;
        study.ensure(
            positions_m.contains_key(point),
            format_args!("{side}.points"),
            format_args!("no position of {point}"),
            format_args!("\"{point}\" = its distance from {origin} in m"),
        )?;
    }
    Ok(())
}

/// With points on A both structures' functions are one set, which has one noise.
/// Where no assembly has points on A, a measured A has no positions of any.
pub(crate) fn no_positions(study: &StudyText, a: &Substructure) -> Result<(), StudyError> {
    let has_positions = match a {
        Substructure::Measured { positions_m, .. } => !positions_m.is_empty(),
        Substructure::Beam { .. } | Substructure::Ground { .. } => false,
    };
    let expected =
        "those of the assembly's points, which are on B as long as assembly.points_on_a names none";
    study.ensure(!has_positions, "a.points", "positions", expected)
}

pub(crate) fn one_noise(study: &StudyText, noise: Option<&NoiseTable>) -> Result<(), StudyError> {
    let differ = noise.is_some_and(|noise| noise.a != noise.b);
    let expected = "the same of a and b, as assembly.points_on_a names points of A";
    study.ensure(!differ, "noise", "a and b with different noise", expected)
}

pub(crate) fn torque(study: &StudyText, torque: Option<f64>) -> Result<Option<f64>, StudyError> {
    let expected = "a tightening torque in N·m that is not negative";
    let check = |torque| study.not_negative("assembly.torque", torque, expected);
    torque.map(check).transpose()
}
