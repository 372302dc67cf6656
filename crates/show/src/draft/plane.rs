//! A first study of a joint with a translation and a rotation, between parts that were measured or are computed as beams.

use std::fmt::Write as _;

use bolted_joint_frf::{Direction, Dof};

use super::{Candidate, LISTED, ToldBy, frequency, stem};
use crate::shown::some;

/// What a part is known by.
pub(super) enum Part {
    /// Its functions, or its modes.
    File(Box<Candidate>),
    /// No file: a beam whose numbers are to be filled in.
    Beam,
}

impl Part {
    pub(super) fn of(file: Candidate) -> Self {
        Self::File(Box::new(file))
    }

    pub(super) fn file(&self) -> Option<&Candidate> {
        match self {
            Self::File(file) => Some(file),
            Self::Beam => None,
        }
    }

    fn has(&self, dof: Dof) -> bool {
        self.file().is_some_and(|own| own.has(dof))
    }

    /// Whether a rotation of it is known; that of a beam is computed.
    fn turns(&self) -> bool {
        let Some(own) = self.file() else {
            return true;
        };
        own.points().iter().any(|dof| dof.direction().is_rotation())
    }

    /// What a comment calls it.
    fn comment(&self, by: ToldBy, what: &str) -> String {
        match self {
            Self::File(_) => by.comment(what),
            Self::Beam => format!(
                "CHECK: {what}, of which there is no file: fill in the beam, or name frf or modal"
            ),
        }
    }

    /// Where the joint is on it, and which of its points were measured in the assembly.
    fn text(&self, assembly: &[Dof], measured: &[Dof]) -> String {
        match self {
            Self::File(own) => of_file(own, assembly),
            Self::Beam => of_beam(measured),
        }
    }
}

/// Two parts and both together.
pub(super) struct Plane {
    pub(super) a: Part,
    pub(super) b: Part,
    pub(super) assembly: Candidate,
    pub(super) by: ToldBy,
}

impl Plane {
    /// The study.
    pub(super) fn text(&self) -> String {
        let Self { a, b, assembly, by } = self;
        let all: Vec<Dof> = assembly.points().into_iter().collect();
        let (on_a, on_b): (Vec<Dof>, Vec<Dof>) = all.iter().partition(|dof| self.is_on_a(**dof));
        let files: Vec<&Candidate> = [a.file(), b.file(), Some(assembly)]
            .into_iter()
            .flatten()
            .collect();
        let mut text = format!(
            "# A joint between two parts, from functions of each part and of both together.\n\
             # Keys: docs/file-formats.md. CHECK: what only you can know.\n\
             method = \"frf-decoupling\"\nname = \"joint of {}\"          # CHECK: what the joint is called\n\n\
             [a]                                   # {}\n{}\n[b]                                   # {}\n{}\n\
             [assembly]                            # {}\nfrf = {}\n",
            self.names(),
            a.comment(*by, "the first part"),
            a.text(&all, &on_a),
            b.comment(*by, "the second part"),
            b.text(&all, &on_b),
            by.comment("both, bolted together"),
            assembly.files(),
        );
        for (key, points, part, letter) in
            [("points", &on_b, b, 'b'), ("points_on_a", &on_a, a, 'a')]
        {
            if !points.is_empty() {
                let list: Vec<String> = points.iter().map(|own| format!("\"{own}\"")).collect();
                let labels = match part {
                    Part::Beam => "",
                    Part::File(_) if points.iter().all(|dof| part.has(*dof)) => {
                        ", as its file calls them"
                    }
                    Part::File(_) => ", which its file has to have under these labels",
                };
                let _ = writeln!(
                    text,
                    "{key} = [{}]   # CHECK: points of part {letter}{labels}",
                    list.join(", ")
                );
            }
        }
        let model = match a.turns() && b.turns() {
            true => "\"full\"                        # or \"translation\", \"diagonal\"",
            false => {
                "\"translation\"                 # \"full\" or \"diagonal\" where theta is given on both parts"
            }
        };
        let many = match files.len() {
            1 => "that the file has".to_owned(),
            2 => "what both files have".to_owned(),
            _ => "what all three files have".to_owned(),
        };
        let _ = write!(
            text,
            "\n[joint]\nmodel = {model}\n\n{}",
            frequency(&files, &many)
        );
        text
    }

    /// What the parts are called, for people.
    fn names(&self) -> String {
        match (self.a.file(), self.b.file()) {
            (Some(a), Some(b)) => format!("{} and {}", stem(a), stem(b)),
            (Some(one), None) => format!("{} and a beam", stem(one)),
            (None, Some(one)) => format!("a beam and {}", stem(one)),
            (None, None) => "two beams".to_owned(),
        }
    }

    /// Whether a point of the assembly is one of part A: by the labels of its file, or because part B has another file.
    fn is_on_a(&self, dof: Dof) -> bool {
        if self.b.has(dof) {
            return false;
        }
        self.a.has(dof) || self.a.file().is_none() && self.b.file().is_some()
    }
}

/// The file of a part, and where the joint is on it: rather at a point that was not measured in the assembly.
fn of_file(own: &Candidate, assembly: &[Dof]) -> String {
    let points = own.points();
    let moves = || points.iter().filter(|dof| !dof.direction().is_rotation());
    let is_measured = |dof: &Dof| assembly.contains(dof) || assembly.contains(&dof.flipped());
    let y = moves()
        .find(|dof| !is_measured(dof))
        .or_else(|| moves().next());
    let theta = points.iter().find(|dof| is_turn_beside(**dof, y.copied()));
    let key = if own.is_modal { "modal" } else { "frf" };
    let modes = own.modes.as_ref().map_or_else(String::new, |name| {
        format!("modal = {name:?}   # gives what was not measured\n")
    });
    let turn = theta.map_or_else(String::new, |dof| format!(", theta = \"{dof}\""));
    let lever = match theta {
        Some(_) => "",
        None => {
            "# CHECK: or theta = { points = [\"…\", \"…\", \"…\"], spacing = 0.015 } of three sensors in a row\n"
        }
    };
    let place = y.map_or_else(String::new, Dof::to_string);
    format!(
        "{key} = {}\n{modes}joint = {{ y = \"{place}\"{turn} }}   # CHECK: where the joint is; points: {}\n{lever}",
        own.files(),
        some(&points, LISTED)
    )
}

/// A beam without numbers, so that nobody takes ours for theirs.
fn of_beam(measured: &[Dof]) -> String {
    let mut text = "beam = { length = 0.0, width = 0.0, height = 0.0, youngs_modulus = 0.0, density = 0.0, boundary = \"free-free\", \
                    damping_ratio = 0.0 }   # CHECK: m, Pa, kg/m³; or boundary = \"fixed-free\", …\n\
                    joint = { x = 0.0 }   # CHECK: m from its first end\n"
        .to_owned();
    if !measured.is_empty() {
        let places: Vec<String> = measured
            .iter()
            .map(|dof| format!("\"{dof}\" = 0.0"))
            .collect();
        let _ = writeln!(
            text,
            "points = {{ {} }}   # CHECK: m from its first end",
            places.join(", ")
        );
    }
    text
}

/// Whether a rotation goes with what bends along `y`: one about the same axis is a twist.
fn is_turn_beside(dof: Dof, y: Option<Dof>) -> bool {
    let about = match dof.direction() {
        Direction::RX => Direction::X,
        Direction::RY => Direction::Y,
        Direction::RZ => Direction::Z,
        _ => return false,
    };
    y.is_none_or(|y| y.direction() != about)
}
