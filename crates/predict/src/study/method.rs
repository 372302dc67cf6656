//! Which method a prediction asks for, before the reader of that method takes over.

use std::path::Path;

use serde::Deserialize;

use super::error::PredictError;
use bolted_joint_files::text_file;

/// The method of a prediction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PredictionMethod {
    /// Contact of fractal surfaces under the bolts' pressure (Zhao).
    FractalContact,
    /// An elastic layer in place of the joint (Tian).
    VirtualMaterial,
    /// A layered beam whose interfaces slip (Kavi).
    LayeredBeam,
}

#[derive(Deserialize)]
struct MethodAlone {
    method: PredictionMethod,
}

impl PredictionMethod {
    /// The method that a study's file names.
    ///
    /// # Errors
    /// [`PredictError::File`] if the file cannot be read, [`PredictError::Syntax`] if it is no TOML or there is no such method.
    pub fn read(path: &Path) -> Result<Self, PredictError> {
        let text = text_file::read(path, "a study (TOML)")?;
        let alone: MethodAlone = toml::from_str(&text).map_err(|error| PredictError::Syntax {
            path: path.to_owned(),
            message: error.to_string().trim_end().to_owned(),
        })?;
        Ok(alone.method)
    }

    /// Its name, as a study has it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::FractalContact => "fractal-contact",
            Self::VirtualMaterial => "virtual-material",
            Self::LayeredBeam => "layered-beam",
        }
    }
}
