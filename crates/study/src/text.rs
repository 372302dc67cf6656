//! A study's text, and where it lies: what every reader starts from.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::DeserializeOwned;

use bolted_joint_files::misspelt::with_meant;
use bolted_joint_files::{nearest, text_file};

use super::named::ESCAPES;
use super::{Method, StudyError};

/// The text of a study, and where it lies.
#[derive(Clone, Debug)]
pub struct StudyText {
    path: PathBuf,
    text: String,
}

impl StudyText {
    /// Reads a study's file.
    ///
    /// # Errors
    /// [`StudyError::File`] if it cannot be read, is empty, too long or no text.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        let text = text_file::read(path, "a study (TOML)")?;
        Ok(Self::new(text, path))
    }

    /// A study's text that is at hand; `path` tells where it lies.
    pub fn new(text: impl Into<String>, path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            text: text.into(),
        }
    }

    /// The study's own file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The study's folder, which its paths are relative to.
    #[must_use]
    pub fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }

    /// A path that stands in the study.
    #[must_use]
    pub fn resolved(&self, path: &Path) -> PathBuf {
        self.folder().join(path)
    }

    /// The study's tables.
    ///
    /// # Errors
    /// [`StudyError::Syntax`] with line and column for what is not TOML, keys that do not belong, keys that are missing and
    /// values of another type.
    pub fn tables<T: DeserializeOwned>(&self) -> Result<T, StudyError> {
        toml::from_str(&self.text).map_err(|error| {
            let message = error.to_string();
            let message = match self.is_escape(&error) {
                true => format!("{}; {ESCAPES}", message.trim_end()),
                false => {
                    let table = toml::from_str::<toml::Table>(&self.text).unwrap_or_default();
                    with_meant(message.trim_end(), table.keys().map(String::as_str))
                }
            };
            StudyError::Syntax {
                path: self.path.clone(),
                message,
            }
        })
    }

    /// Whether an error of the parser's is about a backslash in a text, as paths of Windows have it.
    fn is_escape(&self, error: &toml::de::Error) -> bool {
        let Some(place) = error.span().map(|span| span.start) else {
            return false;
        };
        let before = self.text.get(..place).unwrap_or_default();
        let begin = before.rfind('\n').map_or(0, |end| end + 1);
        let line = self.text[begin..].lines().next().unwrap_or_default();
        let is_toml = toml::from_str::<toml::Table>(&self.text).is_ok();
        !is_toml
            && line
                .split('"')
                .skip(1)
                .step_by(2)
                .any(|text| text.contains('\\'))
    }

    /// The method that the study asks for, whatever else is in it.
    ///
    /// # Errors
    /// [`StudyError::Syntax`] if the text is not TOML, has no method, or one that there is not.
    pub fn method(&self) -> Result<Method, StudyError> {
        #[derive(Deserialize)]
        struct MethodAlone {
            method: Option<Method>,
        }
        let MethodAlone { method } = self.tables()?;
        method.ok_or_else(|| {
            let keys = toml::from_str::<toml::Table>(&self.text).unwrap_or_default();
            let mut keys = keys.keys();
            match keys.find(|key| nearest(key, &["method"]).is_some()) {
                Some(key) => self.refusal(
                    "method",
                    format_args!("`{key}`"),
                    "it; did you mean `method`?",
                ),
                None => {
                    let names = Method::ALL.map(|method| format!("\"{method}\""));
                    let expected =
                        format!("one of {}, such as method = {}", names.join(", "), names[0]);
                    self.refusal("method", "nothing", expected)
                }
            }
        })
    }

    /// The error for a value that cannot be used.
    pub fn refusal(
        &self,
        key: impl Display,
        found: impl Display,
        expected: impl Display,
    ) -> StudyError {
        StudyError::value(&self.path, key, found, expected)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn a_misspelt_key_gets_the_one_that_was_meant() {
        let of = |text: &str| {
            let refused =
                StudyText::new(text, Path::new("s.toml")).tables::<crate::FrequencyTable>();
            refused.unwrap_err().to_string()
        };
        let refused = of("fromm = 5");
        assert!(
            refused
                .ends_with("unknown field `fromm`, expected one of `from`, `to`, `bands`, `every`; did you mean `from`?"),
            "{refused}"
        );
        assert!(!of("stiffness = 5").contains("did you mean"));
        let method = StudyText::new("method = \"frf-decopling\"", Path::new("s.toml")).method();
        let refused = method.unwrap_err().to_string();
        assert!(
            refused.ends_with("did you mean `frf-decoupling`?"),
            "{refused}"
        );
        let misspelt = StudyText::new("methd = \"respond\"", Path::new("s.toml"));
        let refused = misspelt.method().unwrap_err().to_string();
        assert!(
            refused.ends_with("`method`: found `methd`, expected it; did you mean `method`?"),
            "{refused}"
        );
        assert_eq!(misspelt.kind(), Some(crate::TextKind::Study(None)));
    }

    #[test]
    fn a_study_without_a_method_gets_all_of_them() {
        let refused = StudyText::new("name = \"x\"", Path::new("s.toml")).method();
        let refused = refused.unwrap_err().to_string();
        let expected =
            "s.toml: `method`: found nothing, expected one of \"frf-decoupling\", \"frf-space\"";
        assert!(refused.starts_with(expected), "{refused}");
    }

    #[test]
    fn paths_of_windows_get_other_quotation_marks() {
        for path in [
            "C:\\temp\\x.csv",
            "D:\\users\\x.csv",
            "C:\\Daten\\x.csv",
            "C:\\",
        ] {
            let text = format!("method = \"respond\"\nfrf = \"{path}\"\n");
            let refused = StudyText::new(text, Path::new("s.toml")).method();
            let refused = refused.unwrap_err().to_string();
            assert!(refused.contains("line 2"), "{refused}");
            assert!(refused.ends_with(ESCAPES), "{refused}");
        }
        let other = StudyText::new("method = \"respond\"\nx = 1 2\n", Path::new("s.toml"));
        assert!(!other.method().unwrap_err().to_string().contains(ESCAPES));
    }
}
