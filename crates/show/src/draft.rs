//! A first study from the files of a folder, with a comment at everything that its author has to decide.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

use bolted_joint_frf::structure::ModalModel;
use bolted_joint_frf::{Direction, Dof, ReadOptions, read_frfs};
use thiserror::Error;

use crate::FileKind;
use crate::shown::some;

mod roles;
mod space;

use self::roles::{ToldBy, assembly, in_order};

/// Points that a comment lists at most.
const LISTED: usize = 24;

/// A study to begin with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Draft {
    /// Its text (TOML).
    pub text: String,
    /// What its author has to look at.
    pub notes: Vec<String>,
}

/// Why there is none.
#[derive(Debug, Error)]
pub enum DraftError {
    /// The folder cannot be read.
    #[error("{}: cannot be read ({source}); give the folder with the measurements", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// It has too few files.
    #[error(
        "{}: found {found}, expected measured functions (universal file, CSV, NPZ, MAT) or modes of two parts, and functions of their \
         assembly; where a part is a beam that is computed, begin with examples/tutorial/new.toml instead{refused}",
        path.display()
    )]
    TooFew {
        /// The folder.
        path: PathBuf,
        /// How many there are, in words.
        found: String,
        /// Files that look like them but cannot be read, and why.
        refused: String,
    },
}

/// A file that may be a part or the assembly.
struct Candidate {
    name: String,
    /// Further files of the same responses, of other references.
    further: Vec<String>,
    is_modal: bool,
    responses: BTreeSet<Dof>,
    references: BTreeSet<Dof>,
    /// Lowest and highest frequency, Hz.
    band_hz: [f64; 2],
    /// What is to be known of its functions.
    warning: Option<String>,
}

impl Candidate {
    /// Where something responds or is excited.
    fn points(&self) -> BTreeSet<Dof> {
        self.responses.union(&self.references).copied().collect()
    }

    /// Its file, or its files, as a study names them.
    fn files(&self) -> String {
        if self.further.is_empty() {
            return format!("{:?}", self.name);
        }
        let all = std::iter::once(&self.name).chain(&self.further);
        let all: Vec<String> = all.map(|name| format!("{name:?}")).collect();
        format!("[{}]", all.join(", "))
    }

    /// Its file, or its files, for people.
    fn named(&self) -> String {
        let all = std::iter::once(&self.name).chain(&self.further);
        all.map(String::as_str).collect::<Vec<_>>().join(" with ")
    }

    /// Whether both are of one measurement, which many programs write in one file for each reference.
    fn is_beside(&self, other: &Self) -> bool {
        let letters = |name: &str| name.replace(|c: char| c.is_ascii_digit(), "");
        !self.is_modal
            && !other.is_modal
            && letters(&self.name) == letters(&other.name)
            && self.responses == other.responses
            && self.references.is_disjoint(&other.references)
            && self.band_hz == other.band_hz
    }

    fn contains(&self, other: &Self) -> bool {
        other.responses.is_subset(&self.responses) && other.references.is_subset(&self.references)
    }
}

/// A study for the files of a folder: of two parts, and of both together; or in space of a chain of parts, and of them all.
///
/// Which file is which is told by names: `a`, `b`, and `assembly`, `joined`, `ab`, the names of two others put together or `c`; of
/// functions in space by what they contain: the points of the assembly are those of all parts. Else the one that has to be functions
/// and comes last by name is the assembly, and the study says that it was guessed.
///
/// # Errors
/// [`DraftError`] if the folder cannot be read, or has fewer than three such files.
pub fn draft(folder: &Path) -> Result<Draft, DraftError> {
    let entries = std::fs::read_dir(folder).and_then(Iterator::collect::<io::Result<Vec<_>>>);
    let entries = entries.map_err(|source| DraftError::Folder {
        path: folder.to_owned(),
        source,
    })?;
    let mut paths: Vec<PathBuf> = entries.iter().map(std::fs::DirEntry::path).collect();
    paths.sort();
    let mut refused = String::new();
    let mut found = Vec::new();
    for path in &paths {
        match candidate(path) {
            Some(Ok(own)) => found.push(own),
            Some(Err(why)) => {
                let _ = write!(refused, "; {why}");
            }
            None => {}
        }
    }
    let is_in_space = found.iter().any(space::is_in_space);
    if !is_in_space {
        found = together(found);
    }
    let place = assembly(&found, is_in_space);
    let (Some((place, by)), true) = (place, found.len() >= 3) else {
        let names: Vec<&str> = found.iter().map(|own| own.name.as_str()).collect();
        return Err(DraftError::TooFew {
            path: folder.to_owned(),
            found: match names.as_slice() {
                [] => "no file of functions or modes in it".to_owned(),
                names => names.join(", "),
            },
            refused,
        });
    };
    let assembly = found.remove(place);
    in_order(&mut found);
    let most = if is_in_space { space::MOST_PARTS } else { 2 };
    let others = found.split_off(most.min(found.len()));
    let [a, b, ..] = found.as_slice() else {
        return Err(DraftError::TooFew {
            path: folder.to_owned(),
            found: assembly.name,
            refused,
        });
    };
    let parts = found.iter().zip('a'..);
    let parts: Vec<String> = parts
        .map(|(own, letter)| format!("{letter} {}", own.named()))
        .collect();
    let mut notes = vec![format!(
        "part {}, the assembly {}",
        parts.join(", part ").replacen(' ', " is taken to be ", 1),
        assembly.named()
    )];
    if by == ToldBy::Order {
        notes.push(
            "which file is which was guessed by the order of their names: look for CHECK in the study, or call them a, b and assembly"
                .to_owned(),
        );
    }
    if !others.is_empty() {
        let names = others.iter().map(Candidate::named);
        notes.push(format!(
            "not used: {}",
            names.collect::<Vec<_>>().join(", ")
        ));
    }
    let used = found.iter().chain([&assembly]);
    notes.extend(
        used.filter_map(|own| own.warning.as_ref())
            .map(|own| format!("warning: {own}")),
    );
    if !refused.is_empty() {
        notes.push(format!("not read: {}", refused.trim_start_matches("; ")));
    }
    notes.push(match is_in_space {
        true => "places near the joint are to be filled in: look for CHECK in the study".to_owned(),
        false => "the points of the joint are guesses: look for CHECK in the study".to_owned(),
    });
    Ok(Draft {
        text: match is_in_space {
            true => space::text(&found, &assembly, by),
            false => text(a, b, &assembly, by),
        },
        notes,
    })
}

/// Files of one measurement as one.
fn together(found: Vec<Candidate>) -> Vec<Candidate> {
    let mut all: Vec<Candidate> = Vec::new();
    for own in found {
        match all.iter_mut().find(|other| other.is_beside(&own)) {
            Some(first) => {
                first.further.push(own.name);
                first.references.extend(own.references);
            }
            None => all.push(own),
        }
    }
    all
}

/// `None` for a file of another kind.
fn candidate(path: &Path) -> Option<Result<Candidate, String>> {
    let name = path.file_name()?.to_str()?.to_owned();
    match FileKind::of(path) {
        FileKind::Functions(_) => {
            let read = read_frfs(path, &ReadOptions::default()).and_then(|reading| {
                let warning = reading.phase_warning();
                reading.into_set().map(|set| (set, warning))
            });
            Some(
                read.map_err(|refused| refused.to_string())
                    .map(|(set, warning)| {
                        let hz = set.frequency_hz();
                        Candidate {
                            name,
                            further: Vec::new(),
                            is_modal: false,
                            responses: set.functions().map(|own| own.0).collect(),
                            references: set.functions().map(|own| own.1).collect(),
                            band_hz: [hz[0], hz[hz.len() - 1]],
                            warning,
                        }
                    }),
            )
        }
        FileKind::Modes => Some(
            ModalModel::read(path)
                .map_err(|refused| refused.to_string())
                .map(|model| {
                    let last = model
                        .modes()
                        .iter()
                        .map(|mode| mode.frequency_hz)
                        .fold(0.0, f64::max);
                    let points: BTreeSet<Dof> = model.points().iter().copied().collect();
                    Candidate {
                        name,
                        further: Vec::new(),
                        is_modal: true,
                        responses: points.clone(),
                        references: points,
                        band_hz: [0.0, last],
                        warning: None,
                    }
                }),
        ),
        _ => None,
    }
}

fn text(a: &Candidate, b: &Candidate, assembly: &Candidate, by: ToldBy) -> String {
    let points: Vec<String> = assembly
        .points()
        .iter()
        .map(|own| format!("\"{own}\""))
        .collect();
    format!(
        "# A joint between two parts, from functions of each part and of both together.\n\
         # Keys: docs/file-formats.md. CHECK: what only you can know.\n\
         method = \"frf-decoupling\"\nname = \"joint of {} and {}\"          # CHECK: what the joint is called\n\n\
         [a]                                   # {}\n{}\n[b]                                   # {}\n{}\n\
         [assembly]                            # {}\nfrf = {}\n\
         points = [{}]   # CHECK: points of part b (points_on_a for those of a)\n\n\
         [joint]\n{}\n\n{}",
        stem(a),
        stem(b),
        by.comment("the first part"),
        part(a),
        by.comment("the second part"),
        part(b),
        by.comment("both, bolted together"),
        assembly.files(),
        points.join(", "),
        model(&[a, b]),
        frequency(&[a, b, assembly], "three"),
    )
}

/// The band that all files have.
fn frequency(all: &[&Candidate], many: &str) -> String {
    let [from, to] = (all.iter()).fold([0.0, f64::INFINITY], |[from, to]: [f64; 2], own| {
        [from.max(own.band_hz[0]), to.min(own.band_hz[1])]
    });
    format!(
        "[frequency]                           # Hz; what all {many} files have\nfrom = {}\nto = {}\n",
        toml_float(from),
        toml_float(to),
    )
}

/// The joint model that these parts have functions for.
fn model(parts: &[&Candidate]) -> String {
    let turns = |own: &&Candidate| own.points().iter().any(|dof| dof.direction().is_rotation());
    if parts.iter().all(turns) {
        "model = \"full\"                        # or \"translation\", \"diagonal\"".to_owned()
    } else {
        "model = \"translation\"                 # \"full\" or \"diagonal\" where theta is given on both parts".to_owned()
    }
}

/// The file of a part, and where the joint is on it.
fn part(own: &Candidate) -> String {
    let points = own.points();
    let y = points.iter().find(|dof| !dof.direction().is_rotation());
    let theta = points.iter().find(|dof| is_turn_beside(**dof, y.copied()));
    let key = if own.is_modal { "modal" } else { "frf" };
    let turn = theta.map_or_else(String::new, |dof| format!(", theta = \"{dof}\""));
    let lever = match theta {
        Some(_) => "",
        None => {
            "# CHECK: or theta = { points = [\"…\", \"…\", \"…\"], spacing = 0.015 } of three sensors in a row\n"
        }
    };
    let place = y.map_or_else(String::new, Dof::to_string);
    format!(
        "{key} = {}\njoint = {{ y = \"{place}\"{turn} }}   # CHECK: where the joint is; points: {}\n{lever}",
        own.files(),
        some(&points, LISTED)
    )
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

fn stem(own: &Candidate) -> String {
    let stem = own.name.split('.').next().unwrap_or_default();
    stem.chars().filter(|c| !['"', '\\'].contains(c)).collect()
}

/// A number that TOML takes for one with a fraction.
fn toml_float(value: f64) -> String {
    format!("{value:?}")
}
