//! `identify` for studies of lap models.

mod response;
mod update;

use std::path::{Path, PathBuf};

use bolted_joint::export::Timestamp;

use super::super::bolt_files::named;
use super::super::error::CliError;
use super::IdentifyArguments;

pub(super) use response::run as response;
pub(super) use update::run as update;

/// The joint file of each torque: `x.joint.json` stands for `x.2Nm.joint.json`, `x.4Nm.joint.json` where there are several.
fn at_torques(path: &Path, torques: &[Option<f64>]) -> Vec<PathBuf> {
    if torques.len() < 2 {
        return vec![path.to_owned()];
    }
    let torques = torques.iter().map(|torque| torque.unwrap_or(0.0));
    torques
        .map(|torque| named(path, &format!("{torque}Nm")))
        .collect()
}

/// When the report is written, if there is one. Refuses what belongs to measured functions only.
fn report_time(
    arguments: &IdentifyArguments,
    instead_of_rivals: &'static str,
) -> Result<Option<Timestamp>, CliError> {
    if let Some(draws) = arguments.bootstrap {
        return Err(CliError::option(
            "--bootstrap",
            draws,
            "a study of method \"frf-decoupling\"; the intervals of a lap model come from its information matrix",
        ));
    }
    if arguments.no_rivals {
        return Err(CliError::option("--no-rivals", "it", instead_of_rivals));
    }
    let report = arguments.report.as_ref();
    Ok(report.map(|_| Timestamp::from_environment()).transpose()?)
}
