//! The files that a study names, by their keys: a missing one is told with its key, before anything is computed.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use bolted_joint_files::misspelt::did_you_mean;
use bolted_joint_files::nearest;
use toml::{Table, Value};

use super::{StudyError, StudyText};

/// Keys whose texts are paths, in every kind of study and in an assembly file.
pub const PATH_KEYS: [&str; 11] = [
    "coherence",
    "expected",
    "field",
    "file",
    "frf",
    "joint",
    "known",
    "matrices",
    "modal",
    "profiles",
    "repeats",
];

/// Tables of an assembly file whose keys are names, and whose texts are points.
const CHANNELS: [&str; 2] = ["inputs", "outputs"];

/// A file that a study names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedFile {
    /// The key, such as `assembly[1].frf`.
    pub key: String,
    /// The path as it is written.
    pub name: String,
    /// The path that is meant.
    pub path: PathBuf,
}

impl StudyText {
    /// The files that are named; none where the text is not TOML.
    #[must_use]
    pub fn named_files(&self) -> Vec<NamedFile> {
        let tables = toml::from_str::<Table>(self.text()).unwrap_or_default();
        let mut found = Vec::new();
        self.walk("", &Value::Table(tables), false, &mut found);
        found
    }

    fn walk(&self, key: &str, value: &Value, is_path: bool, found: &mut Vec<NamedFile>) {
        match value {
            Value::Table(table) => {
                for (own, value) in table {
                    // names of loads and motions are the user's own
                    if key.is_empty() && CHANNELS.contains(&own.as_str()) {
                        continue;
                    }
                    let key = match key {
                        "" => own.clone(),
                        key => format!("{key}.{own}"),
                    };
                    self.walk(&key, value, PATH_KEYS.contains(&own.as_str()), found);
                }
            }
            Value::Array(values) => {
                for (place, value) in values.iter().enumerate() {
                    let key = match value {
                        Value::Table(_) => format!("{key}[{place}]"),
                        _ => key.to_owned(),
                    };
                    self.walk(&key, value, is_path, found);
                }
            }
            Value::String(name) if is_path => found.push(NamedFile {
                key: key.to_owned(),
                name: name.clone(),
                path: self.resolved(Path::new(name)),
            }),
            _ => {}
        }
    }

    /// Refuses the first of these files that is not there.
    ///
    /// # Errors
    /// [`StudyError::Value`] with its key.
    pub fn check_is_there(&self, files: &[NamedFile]) -> Result<(), StudyError> {
        let is_missing = |file: &&NamedFile| {
            let found = fs::metadata(&file.path);
            found.is_err_and(|error| error.kind() == io::ErrorKind::NotFound)
        };
        let Some(missing) = files.iter().find(is_missing) else {
            return Ok(());
        };
        let found = format!("{:?}, which is not there", missing.name);
        let expected = "the path of a file, relative to the study's own folder";
        let advice = match missing.name.contains(char::is_control) {
            true => format!("; {ESCAPES}"),
            false => self.suggestion(&missing.path),
        };
        self.refuse(&missing.key, found, format_args!("{expected}{advice}"))
    }

    /// A file that may have been meant: beside the missing one or, where its folder is missing, of its name beside the study.
    fn suggestion(&self, missing: &Path) -> String {
        let name = missing.file_name().and_then(|name| name.to_str());
        let is_away = missing.parent().is_some_and(|folder| !is_here(folder));
        let beside = name.filter(|name| is_away && self.resolved(Path::new(name)).exists());
        match beside {
            Some(name) => format!("; did you mean `{name}`?"),
            None => alike(missing),
        }
    }
}

/// Whether a path is that of a folder that is there; a path without any is.
fn is_here(folder: &Path) -> bool {
    folder.as_os_str().is_empty() || folder.is_dir()
}

/// What is said where a backslash in a text of TOML was meant as such.
pub(super) const ESCAPES: &str =
    "in \"…\" a backslash begins an escape: write a path in '…', or with forward slashes";

/// What is beside a missing file and called nearly like it; or beside its folder, where that is missing as well.
fn alike(missing: &Path) -> String {
    let folder = match missing.parent() {
        Some(folder) if !is_here(folder) => return alike(folder),
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .filter_map(|entry| entry.file_name().into_string().ok())
        .collect();
    names.sort();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    // that endings are alike says nothing
    let stem = |name: &str| name.split('.').next().unwrap_or_default().to_owned();
    let wanted = missing.file_name().and_then(|name| name.to_str());
    let wanted = wanted.unwrap_or_default();
    let names: Vec<&str> = names
        .into_iter()
        .filter(|name| nearest(&stem(wanted), &[stem(name).as_str()]).is_some())
        .collect();
    did_you_mean(wanted, &names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_by_their_keys_and_missing_ones_told() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("beam.uff"), "").unwrap();
        let text = "name = \"x.uff\"\n[a]\nfrf = [\"beam.uff\", \"baem.uff\"]\njoint = { y = \"2:+Y\" }\n[[assembly]]\nfrf = \"beam.uff\"\n\
                    [[assembly]]\nfrf = \"C:\\temp.uff\"\n";
        let study = StudyText::new(text, &folder.path().join("study.toml"));
        let files = study.named_files();
        let keys: Vec<&str> = files.iter().map(|file| file.key.as_str()).collect();
        assert_eq!(
            keys,
            ["a.frf", "a.frf", "assembly[0].frf", "assembly[1].frf"]
        );
        let refused = study.check_is_there(&files).unwrap_err().to_string();
        assert!(
            refused.contains("`a.frf`: found \"baem.uff\", which is not there"),
            "{refused}"
        );
        assert!(refused.ends_with("did you mean `beam.uff`?"), "{refused}");
        fs::create_dir(folder.path().join("measured")).unwrap();
        for (name, meant) in [
            ("data/beam.uff", "beam.uff"),
            ("mesured/b.uff", "measured"),
            ("Beam.UFF", "beam.uff"),
        ] {
            let text = format!("[a]\nfrf = \"{name}\"\n");
            let study = StudyText::new(text, &folder.path().join("study.toml"));
            let refused = study.check_is_there(&study.named_files());
            let refused = refused.unwrap_err().to_string();
            let meant = format!("did you mean `{meant}`?");
            assert!(refused.ends_with(&meant), "{refused}");
        }
        let refused = study.check_is_there(&files[3..]).unwrap_err().to_string();
        assert!(refused.contains("\"C:\\temp.uff\""), "{refused}");
        assert!(refused.ends_with(ESCAPES), "{refused}");
    }
}
