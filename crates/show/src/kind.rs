//! What kind of file a path is: told by how it begins, and by its name where that leaves it open.

use std::fmt;
use std::fs;
use std::io::Read as _;
use std::path::Path;

use bolted_joint_files::text_table::{self, Cells};
use bolted_joint_files::{Decimal, Encoding, inputs, table_header, text_file};
use bolted_joint_frf::{Container, begins_with_shapes};
use bolted_joint_study::{Method, StudyText, TextKind};
use zip::ZipArchive;

use crate::tables::TableKind;

/// How much of a file is looked at before more of it is read.
const LOOKED_AT: u64 = 4096;

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// Measured functions, or what looks like a file of them.
    Functions(Container),
    /// Numbers that are no functions, with what they are for.
    Table(TableKind),
    /// Matrices of mass and stiffness of a structure.
    Matrices,
    /// Modes of a structure.
    Modes,
    /// A study, with its method where it names one that there is.
    Study(Option<Method>),
    /// An assembly of structures and joints.
    Assembly,
    /// A joint file.
    JointFile,
    /// Draws of a bootstrap or a Monte Carlo simulation.
    Draws,
    /// An FMU.
    Fmu,
    /// A system of FMUs.
    Ssp,
    /// JSON that is no joint file.
    OtherJson,
    /// A list, as in JSON.
    List,
    /// A zip archive that is no FMU and has no arrays.
    OtherZip,
    /// A folder.
    Folder,
    /// A pipe or a device: to tell what comes out of it is to read it, and then nothing is left for its reader.
    Pipe,
    /// Something else, or nothing that can be read: its reader says what is wrong.
    Unknown,
}

impl FileKind {
    /// What the file at `path` is. Nothing that is wrong with it is an error here.
    #[must_use]
    pub fn of(path: &Path) -> Self {
        if path.is_dir() {
            return Self::Folder;
        }
        if fs::metadata(path).is_ok_and(|found| !found.is_file()) {
            return Self::Pipe;
        }
        let mut beginning = Vec::new();
        let is_read = inputs::open(path)
            .and_then(|file| file.take(LOOKED_AT).read_to_end(&mut beginning))
            .is_ok();
        if !is_read || beginning.iter().all(u8::is_ascii_whitespace) {
            return Self::Unknown;
        }
        if beginning.starts_with(b"PK") {
            return of_zip(path);
        }
        let first = beginning.iter().find(|byte| !byte.is_ascii_whitespace());
        let named = |name: &str| {
            let extension = path.extension();
            extension.is_some_and(|extension| extension.eq_ignore_ascii_case(name))
        };
        if first == Some(&b'{') || named("json") {
            return text(path).map_or(Self::Unknown, |text| of_json(&text));
        }
        let container = Container::told_by(path, &beginning);
        // a comment begins tables and TOML alike
        let is_named_table = ["csv", "tsv", "txt"].iter().any(|name| named(name));
        if first == Some(&b'[')
            && !is_named_table
            && text(path).is_some_and(|text| of_json(&text) == Self::List)
        {
            return Self::List;
        }
        if let Some(container) = container
            && (container != Container::Table || is_named_table)
        {
            return match container {
                Container::Universal if begins_with_shapes(path) => Self::Modes,
                Container::Table => of_table(&beginning),
                container => Self::Functions(container),
            };
        }
        let kind = text(path).and_then(|text| StudyText::new(text, path).kind());
        match (kind, container) {
            (Some(TextKind::Study(method)), _) => Self::Study(method),
            (Some(TextKind::Assembly), _) => Self::Assembly,
            (Some(TextKind::Modes), _) => Self::Modes,
            // a comment and a misspelt key look like a table; the reader of TOML knows what the key should be
            (None, Some(Container::Table)) if !named("toml") => match has_numbers(&beginning) {
                true => of_table(&beginning),
                false => Self::Unknown,
            },
            (None, Some(container)) if !named("toml") => Self::Functions(container),
            (None, _) => Self::Unknown,
        }
    }
}

/// In whatever encoding: its reader says that it should be UTF-8.
fn text(path: &Path) -> Option<String> {
    let bytes = text_file::bytes(path).ok().flatten()?;
    Some(
        Encoding::decoded(&bytes)
            .trim_start_matches('\u{feff}')
            .to_owned(),
    )
}

/// Functions, unless its columns say that it is something else.
fn of_table(beginning: &[u8]) -> FileKind {
    let kind = TableKind::told_by(&Encoding::decoded(beginning));
    kind.map_or(FileKind::Functions(Container::Table), FileKind::Table)
}

/// Whether one of the rows below the names begins with a number, as those of a table do, and those of a text or a script do not.
fn has_numbers(beginning: &[u8]) -> bool {
    let text = Encoding::decoded(beginning);
    let mut rows = text_table::rows(&text);
    let Some((_, names)) = rows.next() else {
        return false;
    };
    let separator = text_table::separator(names);
    let mut cells = Cells::separated_by(separator);
    // units may stand in a row of their own
    rows.take(3).any(|(_, row)| {
        let first = cells
            .of(row)
            .first()
            .copied()
            .unwrap_or_default()
            .to_owned();
        Decimal::beside(separator).parse(&first).is_some()
    })
}

/// Whether a file has nothing in it.
pub(crate) fn is_blank(path: &Path) -> bool {
    let bytes = text_file::beginning(path).unwrap_or_default();
    bytes.trim().is_empty()
}

/// A joint file is told by its format or, if it is damaged, by what stands in it.
fn of_json(text: &str) -> FileKind {
    if text.contains("\"bolted-joint-draws/") {
        return FileKind::Draws;
    }
    let is_joint = match serde_json::from_str::<serde_json::Value>(text) {
        Ok(serde_json::Value::Array(_)) => return FileKind::List,
        Err(_) if text.trim_start().starts_with('[') => {
            return match table_header(text) {
                Some(_) => FileKind::Unknown,
                None => FileKind::List,
            };
        }
        Ok(value) => {
            let format = value.get("format").and_then(serde_json::Value::as_str);
            format.is_some_and(|format| format.starts_with("bolted-joint/"))
                || value.get("joint").is_some()
        }
        Err(_) => text.contains("\"bolted-joint/") || text.contains("\"joint\""),
    };
    match is_joint {
        true => FileKind::JointFile,
        false if text.trim_start().starts_with('{') => FileKind::OtherJson,
        false => FileKind::Unknown,
    }
}

fn of_zip(path: &Path) -> FileKind {
    let names: Vec<String> = match inputs::open(path).map(ZipArchive::new) {
        Ok(Ok(archive)) => archive
            .file_names()
            .filter_map(|name| name.ok())
            .map(|name| name.into_owned())
            .collect(),
        _ => Vec::new(),
    };
    let has = |wanted: &[&str]| names.iter().any(|name| wanted.contains(&name.as_str()));
    let named = |name: &str| {
        let extension = path.extension();
        extension.is_some_and(|extension| extension.eq_ignore_ascii_case(name))
    };
    if has(&["modelDescription.xml"]) || named("fmu") {
        FileKind::Fmu
    } else if has(&["SystemStructure.ssd"]) || named("ssp") {
        FileKind::Ssp
    } else if has(&["M.npy", "mass.npy"]) && has(&["K.npy", "stiffness.npy"]) {
        FileKind::Matrices
    } else if names.iter().any(|name| name.ends_with(".npy")) || named("npz") {
        FileKind::Functions(Container::Archive)
    } else {
        FileKind::OtherZip
    }
}

impl fmt::Display for FileKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Functions(Container::Universal) => f.write_str("a universal file"),
            Self::Functions(Container::Table) => f.write_str("a table (CSV)"),
            Self::Functions(Container::Archive) => f.write_str("a NumPy archive (npz)"),
            Self::Functions(Container::SingleArray) => f.write_str("a NumPy array (npy)"),
            Self::Functions(Container::Matlab) => f.write_str("a MATLAB file (mat)"),
            Self::Table(kind) => kind.fmt(f),
            Self::Matrices => f.write_str("matrices of a structure"),
            Self::Modes => f.write_str("modes of a structure"),
            Self::Study(Some(method)) => write!(f, "a study of method \"{method}\""),
            Self::Study(None) => f.write_str("a study"),
            Self::Assembly => f.write_str("an assembly file"),
            Self::JointFile => f.write_str("a joint file"),
            Self::Draws => f.write_str("a file of draws"),
            Self::Fmu => f.write_str("an FMU"),
            Self::Ssp => f.write_str("a system of FMUs (SSP)"),
            Self::OtherJson => f.write_str("a JSON file"),
            Self::List => f.write_str("a list, as in JSON"),
            Self::OtherZip => f.write_str("a zip archive"),
            Self::Folder => f.write_str("a folder"),
            Self::Pipe => f.write_str("a pipe or a device"),
            Self::Unknown => f.write_str("a file of an unknown kind"),
        }
    }
}

/// The command that takes a file of this kind, as one types it; `None` where no command does.
#[must_use]
pub fn command_for(kind: FileKind, path: &Path) -> Option<String> {
    let path = path.display();
    match kind {
        FileKind::Study(Some(method)) => {
            let output = match method {
                Method::Respond => "NAME.csv",
                _ => "NAME.joint.json",
            };
            Some(format!(
                "bolted-joint {} {path} -o {output}",
                method.command()
            ))
        }
        FileKind::Assembly => Some(format!("bolted-joint respond {path} -o NAME.csv")),
        FileKind::JointFile => Some(format!("bolted-joint export {path} -o NAME.fmu")),
        FileKind::Draws => Some(format!(
            "bolted-joint merge STUDY.toml {path} ... -o NAME.joint.json"
        )),
        FileKind::Fmu | FileKind::Ssp => Some(format!("bolted-joint check {path}")),
        FileKind::Functions(_)
        | FileKind::Table(_)
        | FileKind::Matrices
        | FileKind::Modes
        | FileKind::Study(None) => Some(format!("bolted-joint show {path}")),
        FileKind::OtherJson
        | FileKind::List
        | FileKind::OtherZip
        | FileKind::Folder
        | FileKind::Pipe
        | FileKind::Unknown => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_pipe_is_not_read_to_tell_what_it_is() {
        use std::io::Write as _;
        use std::os::fd::AsRawFd as _;

        let (mut reader, mut writer) = std::io::pipe().unwrap();
        writer
            .write_all(b"{\"format\": \"bolted-joint/1\"}")
            .unwrap();
        drop(writer);
        let path = format!("/dev/fd/{}", reader.as_raw_fd());
        assert_eq!(FileKind::of(path.as_ref()), FileKind::Pipe);
        let refused = crate::show(path.as_ref()).unwrap_err().to_string();
        assert!(refused.contains("cannot be read twice"), "{refused}");
        let mut left = String::new();
        reader.read_to_string(&mut left).unwrap();
        assert!(left.starts_with("{\"format\""), "{left}");
    }

    #[test]
    fn files_are_told_by_what_is_in_them() {
        let folder = tempfile::tempdir().unwrap();
        #[rustfmt::skip]
        let cases: [(&str, &[u8], FileKind); 25] = [
            ("a.uff", b"    -1\n    58\n", FileKind::Functions(Container::Universal)),
            ("a.txt", b"\n    -1\n    58\n", FileKind::Functions(Container::Universal)),
            ("s.csv", b"time_s,displacement_m\n", FileKind::Table(TableKind::Decay)),
            ("a.csv", b"1,2\n", FileKind::Functions(Container::Table)),
            ("a", b"# quantity = mobility\nfrequency,1\n2,3\n", FileKind::Functions(Container::Table)),
            ("a.md", b"# A title\n\nA sentence, and another.\nMore.\n", FileKind::Unknown),
            ("a.npy", b"\x93NUMPY\x01", FileKind::Functions(Container::SingleArray)),
            ("a.dat", b"MATLAB 5.0 MAT-file", FileKind::Functions(Container::Matlab)),
            ("j.joint.json", b"{\"format\": \"bolted-joint/1\"}", FileKind::JointFile),
            ("j.txt", b"{\"format\": \"bolted-joint/1\", ", FileKind::JointFile),
            ("d.json", b"{\"format\": \"bolted-joint-draws/1\"}", FileKind::Draws),
            ("o.json", b"{\"a\": 1}", FileKind::OtherJson),
            ("c.toml", b"# a study\nmethod = \"respond\"\n", FileKind::Study(Some(Method::Respond))),
            ("s.toml", b"method = \"respond\"\n", FileKind::Study(Some(Method::Respond))),
            ("m.toml", b"# a study\nmethd = \"respond\"\n", FileKind::Study(None)),
            ("t.toml", b"# a study\nname = \"a\"\n", FileKind::Unknown),
            ("s.json", b"method = 1\n", FileKind::Unknown),
            ("e.toml", b" \n", FileKind::Unknown),
            ("l.json", b"[]", FileKind::List),
            ("l", b"\n [{\"format\": \"bolted-joint/1\"}]", FileKind::List),
            ("l.joint.json", b"[[1, 2],", FileKind::List),
            ("h.joint.json", b"[frequency]\nfrom = 1\n", FileKind::Unknown),
            ("s", b"[structures.a]\n", FileKind::Assembly),
            ("z.zip", b"PK\x03\x04", FileKind::OtherZip),
            ("z.fmu", b"PK\x03\x04", FileKind::Fmu),
        ];
        for (name, contents, expected) in cases {
            let path = folder.path().join(name);
            std::fs::write(&path, contents).unwrap();
            assert_eq!(FileKind::of(&path), expected, "{name}");
        }
        assert_eq!(FileKind::of(folder.path()), FileKind::Folder);
        assert_eq!(
            FileKind::of(&folder.path().join("missing")),
            FileKind::Unknown
        );
    }
}
