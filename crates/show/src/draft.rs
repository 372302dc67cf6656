//! A first study from the files of a folder, with a comment at everything that its author has to decide.

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::FileKind;

mod candidate;
mod few;
mod plane;
mod roles;
mod space;

use self::candidate::{Candidate, candidate, together, with_modes_beside};
use self::plane::{Part, Plane};
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
    /// It is a file.
    #[error(
        "{}: found a file, expected the folder with the measurements; give the folder that it is in",
        path.display()
    )]
    File {
        /// The file.
        path: PathBuf,
    },
    /// It has too few files.
    #[error(
        "{}: found {found}, expected measured functions (universal file, CSV, NPZ, MAT) or modes of parts, and functions of their \
         assembly{refused}",
        path.display()
    )]
    TooFew {
        /// The folder.
        path: PathBuf,
        /// How many there are, in words.
        found: String,
        /// Files that look like them but cannot be read, and why; and those of other kinds.
        refused: String,
    },
    /// Their roles cannot be told.
    #[error("{}: found {found}, {why}{refused}", path.display())]
    Undecided {
        /// The folder.
        path: PathBuf,
        /// The files.
        found: String,
        /// What they are, what was expected, and how to say it.
        why: String,
        /// As above.
        refused: String,
    },
}

/// A study for the files of a folder: of two parts, and of both together; or in space of a chain of parts, and of them all.
///
/// Which file is which is told by names: `a`, `b`, and `assembly`, `joined`, `ab`, the names of two others put together or `c`; of
/// functions in space by what they contain: the points of the assembly are those of all parts. Else the one that has to be functions
/// and comes last by name is the assembly, and the study says that it was guessed. A part without a file is a beam to be filled in.
///
/// # Errors
/// [`DraftError`] if the folder cannot be read, has no such files, or some that leave open which is which.
pub fn draft(folder: &Path) -> Result<Draft, DraftError> {
    if folder.is_file() {
        return Err(DraftError::File {
            path: folder.to_owned(),
        });
    }
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
        found = with_modes_beside(together(found));
    }
    let most = match (is_in_space, found.len()) {
        (_, 0) => {
            return Err(DraftError::TooFew {
                path: folder.to_owned(),
                found: "no file of functions or modes in it".to_owned(),
                refused: refused + &other_tables(&paths),
            });
        }
        (true, 1 | 2) => {
            let why = "with points that move along three axes, expected functions of two parts or more and of all together; put them beside \
                       each other";
            return Err(undecided(folder, &found, why.to_owned(), refused));
        }
        (true, _) => space::MOST_PARTS,
        (false, _) => 2,
    };
    if let (false, 1 | 2) = (is_in_space, found.len()) {
        let names = found.clone();
        let plane = few::roles(found);
        let plane = plane.map_err(|why| undecided(folder, &names, why, refused.clone()))?;
        return Ok(of_plane(&plane, &[], &refused));
    }
    let Some((place, by)) = assembly(&found, is_in_space) else {
        let why = "which are modes, expected functions of the assembly as well".to_owned();
        return Err(undecided(folder, &found, why, refused));
    };
    let assembly = found.remove(place);
    in_order(&mut found);
    let others = found.split_off(most.min(found.len()));
    if is_in_space {
        let parts: Vec<Option<&Candidate>> = found.iter().map(Some).collect();
        let text = space::text(&found, &assembly, by);
        let hint = "places near the joint are to be filled in: look for CHECK in the study";
        let notes = notes(&parts, &assembly, by, &others, &refused, hint);
        return Ok(Draft { text, notes });
    }
    let mut parts = found.into_iter().map(Part::of);
    let (a, b) = (parts.next(), parts.next());
    let plane = Plane {
        a: a.unwrap_or(Part::Beam),
        b: b.unwrap_or(Part::Beam),
        assembly,
        by,
    };
    Ok(of_plane(&plane, &others, &refused))
}

fn of_plane(plane: &Plane, others: &[Candidate], refused: &str) -> Draft {
    let parts = [plane.a.file(), plane.b.file()];
    let hint = "the points of the joint are guesses: look for CHECK in the study";
    Draft {
        text: plane.text(),
        notes: notes(&parts, &plane.assembly, plane.by, others, refused, hint),
    }
}

/// What the author of a study has to know.
fn notes(
    parts: &[Option<&Candidate>],
    assembly: &Candidate,
    by: ToldBy,
    others: &[Candidate],
    refused: &str,
    hint: &str,
) -> Vec<String> {
    let told = parts.iter().zip('a'..).map(|(own, letter)| {
        let named = own.map_or_else(|| "a beam".to_owned(), Candidate::named);
        format!("{letter} {named}")
    });
    let mut notes = vec![format!(
        "part {}, the assembly {}",
        told.collect::<Vec<_>>()
            .join(", part ")
            .replacen(' ', " is taken to be ", 1),
        assembly.named()
    )];
    if parts.iter().any(Option::is_none) {
        notes.push(
            "of a beam there is no file: fill in its numbers, which are 0 in the study, or name frf or modal".to_owned(),
        );
    }
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
    let used = parts.iter().flatten().copied().chain([assembly]);
    notes.extend(
        used.filter_map(|own| own.warning.as_ref())
            .map(|own| format!("warning: {own}")),
    );
    if !refused.is_empty() {
        notes.push(format!("not read: {}", refused.trim_start_matches("; ")));
    }
    notes.push(hint.to_owned());
    notes
}

fn undecided(folder: &Path, found: &[Candidate], why: String, refused: String) -> DraftError {
    let names: Vec<String> = found.iter().map(Candidate::named).collect();
    DraftError::Undecided {
        path: folder.to_owned(),
        found: names.join(" and "),
        why,
        refused,
    }
}

/// Tables that other methods begin with.
fn other_tables(paths: &[PathBuf]) -> String {
    let mut text = String::new();
    for path in paths {
        if let FileKind::Table(kind) = FileKind::of(path)
            && let Some(taker) = kind.taken_by()
        {
            let _ = write!(text, "; {} is {kind}, for {taker}", path.display());
        }
    }
    text
}

/// The band that all files have.
fn frequency(all: &[&Candidate], many: &str) -> String {
    let [from, to] = (all.iter()).fold([0.0, f64::INFINITY], |[from, to]: [f64; 2], own| {
        [from.max(own.band_hz[0]), to.min(own.band_hz[1])]
    });
    let reaches_farther = all.iter().any(|own| own.band_hz[1] > to);
    let ends_it = |own: &&&Candidate| own.is_modal && own.band_hz[1] == to && reaches_farther;
    let why = all.iter().find(ends_it).map_or_else(String::new, |own| {
        format!("   # CHECK: the highest mode in {}", own.name)
    });
    format!(
        "[frequency]                           # Hz; {many}\nfrom = {}\nto = {}{why}\n",
        toml_float(from),
        toml_float(to),
    )
}

fn stem(own: &Candidate) -> String {
    let stem = own.name.split('.').next().unwrap_or_default();
    stem.chars().filter(|c| !['"', '\\'].contains(c)).collect()
}

/// A number that TOML takes for one with a fraction.
fn toml_float(value: f64) -> String {
    format!("{value:?}")
}
