//! `identify` for studies of lap models.

mod response;
mod update;

use std::path::{Path, PathBuf};

use super::super::error::CliError;
use super::IdentifyArguments;

pub(super) use response::run as response;
pub(super) use update::run as update;

/// What every page and picture of a lap model is written to.
struct Outputs {
    files: Vec<PathBuf>,
}

impl Outputs {
    /// `x.joint.json` stands for `x.2Nm.joint.json`, `x.4Nm.joint.json` where each torque has a file.
    fn at_torques(path: &Path, torques: &[Option<f64>]) -> Self {
        const EXTENSION: &str = ".joint.json";
        if torques.len() < 2 {
            return Self {
                files: vec![path.to_owned()],
            };
        }
        let file_name = path.file_name().unwrap_or_default().to_string_lossy();
        let extension = match file_name.strip_suffix(EXTENSION) {
            Some(stem) if !stem.is_empty() => EXTENSION,
            _ => "",
        };
        let stem = file_name.strip_suffix(extension).unwrap_or(&file_name);
        let of = |torque: &Option<f64>| {
            let torque = torque.unwrap_or(0.0);
            path.with_file_name(format!("{stem}.{torque}Nm{extension}"))
        };
        Self {
            files: torques.iter().map(of).collect(),
        }
    }
}

/// Refuses what belongs to measured functions only.
fn check_options(arguments: &IdentifyArguments) -> Result<(), CliError> {
    if let Some(draws) = arguments.bootstrap {
        return Err(CliError::option(
            "--bootstrap",
            draws,
            "a study of method \"frf-decoupling\"; the intervals of a lap model come from its information matrix",
        ));
    }
    Ok(())
}
