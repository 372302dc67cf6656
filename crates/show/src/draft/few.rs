//! Which study one or two files are enough for: parts without a file are beams that are computed.

use super::plane::{Part, Plane};
use super::roles::{ToldBy, assembly, is_named_assembly};
use super::{Candidate, LISTED};
use crate::shown::some;

/// The roles of one file or two; or what cannot be decided, and how to say it.
pub(super) fn roles(mut found: Vec<Candidate>) -> Result<Plane, String> {
    let is_part = |own: &Candidate| {
        !is_named_assembly(own) && ["a", "b"].iter().any(|letter| own.is_called(letter))
    };
    if found.iter().all(|own| own.is_modal || is_part(own)) {
        return Err(
            "which are parts by their names or because they hold modes, expected functions of both parts together as well; call their \
             file assembly"
                .to_owned(),
        );
    }
    if let [one, other] = found.as_slice()
        && !found
            .iter()
            .any(|own| is_part(own) || is_named_assembly(own))
        && one.pairs == other.pairs
    {
        return Err(
            "which have the same functions, expected to know whether both are tests of the assembly, or one is of a part; call that of a \
             part a or b and that of the assembly assembly, or give each test a folder of its own"
                .to_owned(),
        );
    }
    let Some((place, by)) = assembly(&found, false) else {
        return Err("expected functions of both parts together".to_owned());
    };
    let assembly = found.remove(place);
    match found.pop() {
        Some(part) => Ok(beside_a_beam(part, assembly, by)),
        None => alone(assembly),
    }
}

/// One part has a file; the other one is a beam.
fn beside_a_beam(part: Candidate, assembly: Candidate, by: ToldBy) -> Plane {
    let is_b = part.is_called("b");
    let (a, b) = match is_b {
        true => (Part::Beam, Part::of(part)),
        false => (Part::of(part), Part::Beam),
    };
    Plane { a, b, assembly, by }
}

/// One file with everything in it.
fn alone(all: Candidate) -> Result<Plane, String> {
    let mut groups = all.groups();
    match groups.len() {
        0 | 1 => Ok(Plane {
            a: Part::Beam,
            b: Part::Beam,
            by: match is_named_assembly(&all) {
                true => ToldBy::ItsOwn,
                false => ToldBy::Order,
            },
            assembly: all,
        }),
        2 => {
            let assembly = groups.remove(1);
            Ok(beside_a_beam(groups.remove(0), assembly, ToldBy::Order))
        }
        count => {
            let told = groups.iter().map(|own| some(own.points(), LISTED));
            Err(format!(
                "with {count} groups of functions that nothing connects ({}), expected a file for each part and one for the assembly: the \
                 points of a part have the same labels in its own file as in that of the assembly; write each group into a file of its own, \
                 called a, b and assembly",
                told.collect::<Vec<_>>().join("; ")
            ))
        }
    }
}
