//! The bolts of a joint: as many on B as on A, told apart by name, each at a place of its own.

use super::super::super::layout::{Bolts, MOST_BOLTS};
use super::super::MeasuredJoint;
use super::super::tables::{BoltsKey, JointPlaceTable};
use bolted_joint_frf::Dof;
use bolted_joint_study::{StudyError, StudyText};

/// Characters of a name, which becomes part of a file's name.
fn is_part_of_a_file_name(character: char) -> bool {
    character.is_ascii_alphanumeric() || character == '-' || character == '_'
}

/// The bolts that the places on A name, or on B where A is the ground.
pub(crate) fn bolts(
    study: &StudyText,
    place: &str,
    places: Option<&[JointPlaceTable]>,
    key: Option<BoltsKey>,
) -> Result<Bolts, StudyError> {
    let names = match places {
        Some(places) => names(study, place, places)?,
        // which is said where its substructure is checked
        None => Vec::new(),
    };
    match (names.is_empty(), key) {
        (true, None) => Ok(Bolts::One),
        (true, Some(_)) => study.refuse(
            "joint.bolts",
            "it for one bolt",
            "it only where `a.joint` and `b.joint` are lists of several places",
        ),
        (false, Some(BoltsKey::Alike)) => Ok(Bolts::Alike(names)),
        (false, Some(BoltsKey::Different)) => Ok(Bolts::Different(names)),
        (false, None) => study.refuse(
            "joint.bolts",
            format!("nothing for {} bolts", names.len()),
            "\"alike\" for one joint at all of them, or \"different\" for one joint each",
        ),
    }
}

/// The names of several places; none for a single one.
fn names(
    study: &StudyText,
    key: &str,
    places: &[JointPlaceTable],
) -> Result<Vec<String>, StudyError> {
    match places {
        [] => study.refuse(key, "an empty list", "the place of one bolt or more"),
        [only] => match &only.name {
            None => Ok(Vec::new()),
            Some(name) => study.refuse(
                format_args!("{key}.name"),
                format_args!("\"{name}\" for the only place"),
                "names where there are several places",
            ),
        },
        several => {
            let (count, most) = (several.len(), format!("{MOST_BOLTS} at most"));
            study.ensure(
                count <= MOST_BOLTS,
                key,
                format_args!("{count} places"),
                most,
            )?;
            let mut names: Vec<String> = Vec::new();
            for (index, place) in several.iter().enumerate() {
                let Some(name) = &place.name else {
                    return study.refuse(
                        key,
                        format!("no name of place {}", index + 1),
                        "a name for each of several places, such as name = \"left\"",
                    );
                };
                study.ensure(
                    !name.is_empty() && name.chars().all(is_part_of_a_file_name),
                    key,
                    format_args!("the name {name:?}"),
                    "letters from a to z, digits, \"-\" and \"_\" only: it becomes part of a file's name",
                )?;
                if let Some(same) = names.iter().find(|other| other.eq_ignore_ascii_case(name)) {
                    return study.refuse(
                        key,
                        format!("the names \"{same}\" and \"{name}\""),
                        "a name of its own for every place, whatever its case",
                    );
                }
                names.push(name.clone());
            }
            Ok(names)
        }
    }
}

/// The places on a substructure in the order of the bolts, each with the key that messages call it.
pub(super) fn places_of_bolts(
    study: &StudyText,
    key: &str,
    places: Vec<JointPlaceTable>,
    bolts: &Bolts,
) -> Result<Vec<(String, JointPlaceTable)>, StudyError> {
    let key = format!("{key}.joint");
    let names = names(study, &key, &places)?;
    if names.is_empty() && *bolts == Bolts::One {
        let keyed = places.into_iter().map(|place| (key.clone(), place));
        return Ok(keyed.collect());
    }
    let expected = format!("{}, as on A", counted(bolts.count()));
    let is_same = places.len() == bolts.count();
    study.ensure(is_same, &key, counted(places.len()), expected)?;
    let mut places: Vec<Option<JointPlaceTable>> = places.into_iter().map(Some).collect();
    let mut ordered = Vec::with_capacity(names.len());
    for name in bolts.names() {
        let position = names.iter().position(|other| other == name);
        let Some(place) = position.and_then(|position| places[position].take()) else {
            return study.refuse(
                key,
                format!("the names {}", quoted(&names)),
                format!("those on A, {}", quoted(bolts.names())),
            );
        };
        ordered.push((format!("{key} \"{name}\""), place));
    }
    Ok(ordered)
}

/// No degree of freedom belongs to two bolts.
pub(super) fn apart(
    study: &StudyText,
    key: &str,
    joints: &[MeasuredJoint],
    bolts: &Bolts,
) -> Result<(), StudyError> {
    for (index, joint) in joints.iter().enumerate() {
        for (before, other) in joints[..index].iter().enumerate() {
            let shared = joint.own_dofs().into_iter().find(|dof| {
                let is_same = |other: &Dof| other == dof || *other == dof.flipped();
                other.own_dofs().iter().any(is_same)
            });
            if let Some(dof) = shared {
                return shared_place(study, key, &dof.to_string(), bolts, [before, index]);
            }
        }
    }
    Ok(())
}

/// No position on a beam belongs to two bolts.
pub(super) fn apart_on_beam(
    study: &StudyText,
    key: &str,
    joints_m: &[f64],
    bolts: &Bolts,
) -> Result<(), StudyError> {
    for (index, x_m) in joints_m.iter().enumerate() {
        if let Some(before) = joints_m[..index].iter().position(|other| other == x_m) {
            return shared_place(study, key, &format!("x = {x_m}"), bolts, [before, index]);
        }
    }
    Ok(())
}

fn shared_place(
    study: &StudyText,
    key: &str,
    place: &str,
    bolts: &Bolts,
    [first, second]: [usize; 2],
) -> Result<(), StudyError> {
    let names = bolts.names();
    study.refuse(
        format!("{key}.joint"),
        format!(
            "{place} at \"{}\" and at \"{}\"",
            names[first], names[second]
        ),
        "a place of its own for every bolt",
    )
}

fn counted(places: usize) -> String {
    match places {
        1 => "1 place".to_owned(),
        places => format!("{places} places"),
    }
}

fn quoted(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    quoted.join(", ")
}
