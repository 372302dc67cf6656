//! Which method a study asks for, before the reader of that method takes over.

use std::path::Path;

use serde::Deserialize;

use super::error::IdentifyError;
use bolted_joint_files::text_file;

/// The method of a study.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StudyMethod {
    /// The joint from frequency response functions of substructures and assembly.
    #[default]
    FrfDecoupling,
    /// The lap model from natural frequencies.
    LapUpdate,
    /// The lap model from responses at several levels.
    LapResponse,
}

#[derive(Deserialize)]
struct MethodAlone {
    method: Option<StudyMethod>,
}

impl StudyMethod {
    /// The method of a study's file. Where the file says none or is no TOML, the reader of the default method will say so.
    ///
    /// # Errors
    /// [`IdentifyError::File`] if the file cannot be read, [`IdentifyError::Syntax`] if there is no such method.
    pub fn read(path: &Path) -> Result<Self, IdentifyError> {
        let text = text_file::read(path, "a study (TOML)")?;
        if text.parse::<toml::Table>().is_err() {
            return Ok(Self::default());
        }
        let alone: MethodAlone = toml::from_str(&text).map_err(|error| IdentifyError::Syntax {
            path: path.to_owned(),
            message: error.to_string().trim_end().to_owned(),
        })?;
        Ok(alone.method.unwrap_or_default())
    }
}
