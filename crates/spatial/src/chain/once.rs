//! Every channel and every impact is stated once: functions are found by their points, so that one that is stated twice would be at
//! two places.

use bolted_joint_frf::Dof;
use bolted_joint_study::{StudyError, StudyText};

use super::part::{Part, PartInterface};

/// Refuses a point that two sensors have, or two impacts, or one of them and what is measured elsewhere.
pub(super) fn every_point_once(study: &StudyText, parts: &[Part]) -> Result<(), StudyError> {
    for (what, all) in [
        ("sensor", channels as fn(&Part) -> Vec<Stated>),
        ("impact", impacts),
    ] {
        let mut seen: Vec<Stated> = Vec::new();
        for (key, dof) in parts.iter().flat_map(all) {
            let is_same = |(_, other): &&Stated| *other == dof || *other == dof.flipped();
            if let Some((first, other)) = seen.iter().find(is_same) {
                let found = format_args!("{dof}, where `{first}` has {other}").to_string();
                let expected = format_args!(
                    "a point of its own for each {what}: functions are found by their points, which have one number in all files"
                );
                return study.refuse(key, found, expected);
            }
            seen.push((key, dof));
        }
    }
    Ok(())
}

/// A point with its key in the study.
type Stated = (String, Dof);

fn channels(part: &Part) -> Vec<Stated> {
    let of = |own: &PartInterface| -> Vec<Stated> {
        let sensors = own.sensors.iter().enumerate();
        sensors
            .flat_map(|(place, (dofs, _))| {
                let key = format!("{}.sensors[{place}]", own.name);
                dofs.iter().map(move |dof| (key.clone(), *dof))
            })
            .collect()
    };
    let near = part.interfaces.iter().flat_map(of);
    near.chain(elsewhere(&part.name, "responses", &part.responses))
        .collect()
}

fn impacts(part: &Part) -> Vec<Stated> {
    let of = |own: &PartInterface| -> Vec<Stated> {
        let impacts = own.impacts.iter().enumerate();
        impacts
            .map(|(place, (dof, _))| (format!("{}.impacts[{place}]", own.name), *dof))
            .collect()
    };
    let near = part.interfaces.iter().flat_map(of);
    near.chain(elsewhere(&part.name, "references", &part.references))
        .collect()
}

fn elsewhere(part: &str, list: &str, dofs: &[Dof]) -> Vec<Stated> {
    let stated = dofs.iter().enumerate();
    stated
        .map(|(place, dof)| (format!("{part}.{list}[{place}]"), *dof))
        .collect()
}
