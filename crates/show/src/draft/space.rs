//! A first study in space: sensors and impacts near the joint whose places are to be filled in, or nodes with six motions.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use bolted_joint_frf::{Direction, Dof};

use super::{Candidate, ToldBy, frequency, stem};
use crate::shown::some;

/// Parts that a study has names for.
pub(super) const MOST_PARTS: usize = 6;

/// Points that a comment lists at most.
const LISTED: usize = 12;

const TRANSLATIONS: [Direction; 3] = [Direction::X, Direction::Y, Direction::Z];
const ROTATIONS: [Direction; 3] = [Direction::RX, Direction::RY, Direction::RZ];

/// Whether some point moves along all three axes: a plane has two motions of a point.
pub(super) fn is_in_space(own: &Candidate) -> bool {
    !nodes_with(&own.responses, &TRANSLATIONS).is_empty()
}

/// Nodes that have all of these directions.
fn nodes_with(points: &BTreeSet<Dof>, wanted: &[Direction]) -> Vec<u32> {
    let mut nodes: BTreeMap<u32, BTreeSet<Direction>> = BTreeMap::new();
    for dof in points {
        nodes.entry(dof.node()).or_default().insert(dof.direction());
    }
    let has_all =
        |own: &BTreeSet<Direction>| wanted.iter().all(|direction| own.contains(direction));
    let found = nodes.into_iter().filter(|(_, own)| has_all(own));
    found.map(|(node, _)| node).collect()
}

pub(super) fn text(parts: &[Candidate], assembly: &Candidate, by: ToldBy) -> String {
    let names: Vec<String> = parts.iter().map(stem).collect();
    let is_chain = parts.len() > 2;
    let mut text = format!(
        "# {} between parts, from functions of each part and of all together.\n\
         # Keys: docs/file-formats.md. CHECK: what only you can know.\n\
         method = \"frf-space\"\nname = \"{} of {}\"   # CHECK: what it is called\n",
        if is_chain {
            "Joints in space"
        } else {
            "A joint in space"
        },
        if is_chain { "joints" } else { "joint" },
        listed(&names)
    );
    if is_chain {
        text += "budget = \"none\"                       # errors of sensors and impacts are estimated with one joint that is sought\n";
    }
    for (n, (own, letter)) in parts.iter().zip('a'..).enumerate() {
        let is_inner = n > 0 && n + 1 < parts.len();
        let _ = write!(text, "\n[{letter}]\n{}", part(own, assembly, is_inner));
    }
    let _ = write!(
        text,
        "\n[assembly]                            # {}\nfrf = {:?}\n",
        by.comment("all parts, bolted together"),
        assembly.name
    );
    for place in 1..parts.len() {
        let (head, known) = match is_chain {
            true => (
                format!(
                    "[[joint]]                             # {} to {}",
                    names[place - 1],
                    names[place]
                ),
                ", or known = \"NAME.joint.json\" in place of both",
            ),
            false => ("[joint]".to_owned(), ""),
        };
        let _ = write!(
            text,
            "\n{head}\nmodel = \"full\"                        # or \"bolt\", \"diagonal\"{known}\n\
             length = 0.03                         # CHECK: m, about the size of the interface\n"
        );
    }
    let files: Vec<&Candidate> = parts.iter().chain([assembly]).collect();
    let _ = write!(
        text,
        "\n{}",
        frequency(
            &files,
            if is_chain {
                "what all of these files have"
            } else {
                "what all three files have"
            }
        )
    );
    text
}

fn listed(names: &[String]) -> String {
    match names {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        names => names.concat(),
    }
}

/// The file of a part, and what lies near its joints.
fn part(own: &Candidate, assembly: &Candidate, is_inner: bool) -> String {
    let key = if own.is_modal { "modal" } else { "frf" };
    let mut text = format!("{key} = {:?}\n", own.name);
    let both: BTreeSet<Dof> = own
        .responses
        .intersection(&own.references)
        .copied()
        .collect();
    let all = [TRANSLATIONS, ROTATIONS].concat();
    let nodes = nodes_with(&both, &all);
    match nodes.as_slice() {
        [] => {
            text += &places(own);
            if is_inner {
                text += "# CHECK: those near the joint to the next part belong into far = { sensors = […], impacts = […] }\n";
            }
        }
        [first, others @ ..] => {
            let _ = writeln!(text, "interface = {first}{}", choice(&nodes));
            let mut taken = vec![*first];
            if let (true, Some(last)) = (is_inner, others.last()) {
                let _ = writeln!(text, "far = {{ interface = {last} }}{}", choice(&nodes));
                taken.push(*last);
            }
            let elsewhere = |points: &BTreeSet<Dof>, of_assembly: &BTreeSet<Dof>| -> Vec<String> {
                let both = points.intersection(of_assembly);
                let both = both.filter(|dof| !taken.contains(&dof.node()));
                both.map(|dof| format!("\"{dof}\"")).collect()
            };
            for (key, list) in [
                ("responses", elsewhere(&own.responses, &assembly.responses)),
                (
                    "references",
                    elsewhere(&own.references, &assembly.references),
                ),
            ] {
                if !list.is_empty() {
                    let _ = writeln!(text, "{key} = [{}]", list.join(", "));
                }
            }
        }
    }
    text
}

fn choice(nodes: &[u32]) -> String {
    match nodes {
        [_] => "   # a node with six motions".to_owned(),
        nodes => {
            let names: BTreeSet<u32> = nodes.iter().copied().collect();
            format!(
                "   # CHECK: the node at the joint; with six motions: {}",
                some(&names, LISTED)
            )
        }
    }
}

/// Sensors and impacts, at places that are not known.
fn places(own: &Candidate) -> String {
    let triaxial = nodes_with(&own.responses, &TRANSLATIONS);
    let mut text = "# CHECK: positions in m from the middle of the joint, in one system of axes for all parts; what is not near the joint goes\n\
                    # into responses = [\"…\"] and references = [\"…\"] instead\nsensors = [\n"
        .to_owned();
    for node in &triaxial {
        let _ = writeln!(text, "  {{ node = {node}, position = [0.0, 0.0, 0.0] }},");
    }
    for dof in own
        .responses
        .iter()
        .filter(|dof| !triaxial.contains(&dof.node()))
    {
        let _ = writeln!(text, "  {{ dof = \"{dof}\", position = [0.0, 0.0, 0.0] }},");
    }
    text += "]\nimpacts = [\n";
    for dof in &own.references {
        let _ = writeln!(text, "  {{ dof = \"{dof}\", position = [0.0, 0.0, 0.0] }},");
    }
    text + "]\n"
}
