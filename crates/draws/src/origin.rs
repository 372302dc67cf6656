//! What draws were made from: two parts belong together only if all of it is the same.

use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use bolted_joint_files::{TOOL, VERSION};
use bolted_joint_joint::{InputFile, JointFile};

use super::error::DrawsError;

/// What draws were made from, and how many there are in all.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Program that made them.
    pub tool: String,
    /// Version of that program.
    pub version: String,
    /// Name of the study, for people.
    pub study: String,
    /// Draws in all parts together.
    pub draws: u64,
    /// Seed.
    pub seed: u64,
    /// The study and its files.
    pub inputs: Vec<InputFile>,
    /// SHA-256 of the joint that they are drawn about, to the last bit of its numbers.
    pub joint_sha256: String,
}

impl Origin {
    /// Draws about the joint of these files, which have no scatter from draws yet.
    ///
    /// # Errors
    /// [`DrawsError::Json`] if a file cannot be written.
    pub fn of<'f>(
        study: &str,
        files: impl IntoIterator<Item = &'f JointFile>,
        draws: u64,
        seed: u64,
    ) -> Result<Self, DrawsError> {
        let mut digest = Sha256::new();
        let mut inputs = Vec::new();
        for file in files {
            let mut file = file.clone();
            if let Some(provenance) = file.provenance.take() {
                inputs = provenance.inputs;
            }
            if let Some(uncertainty) = &mut file.uncertainty {
                uncertainty.bootstrap = None;
                for at in uncertainty
                    .over_preload
                    .iter_mut()
                    .flat_map(|own| &mut own.at)
                {
                    at.bootstrap = None;
                }
            }
            digest.update(serde_json::to_vec(&file)?);
        }
        let joint_sha256 = digest
            .finalize()
            .into_iter()
            .map(|byte| format!("{byte:02x}"));
        Ok(Self {
            tool: TOOL.to_owned(),
            version: VERSION.to_owned(),
            study: study.to_owned(),
            draws,
            seed,
            inputs,
            joint_sha256: joint_sha256.collect(),
        })
    }

    /// Whether draws of this origin, in the file at `path`, belong to the `expected` ones of `reference`.
    pub(super) fn check(
        &self,
        path: &Path,
        expected: &Self,
        reference: &str,
    ) -> Result<(), DrawsError> {
        let other = |what: &str, found: &str, expected: &str| {
            Err(DrawsError::Other {
                path: path.to_owned(),
                what: what.to_owned(),
                found: found.to_owned(),
                expected: expected.to_owned(),
                reference: reference.to_owned(),
            })
        };
        let number = |what, found: u64, expected: u64| match found == expected {
            true => Ok(()),
            false => other(what, &found.to_string(), &expected.to_string()),
        };
        let program = |own: &Self| format!("{} {}", own.tool, own.version);
        let (found, wanted) = (program(self), program(expected));
        if found != wanted {
            return other("the program", &found, &wanted);
        }
        if self.inputs.len() != expected.inputs.len() {
            return other("the study", &quoted(&self.study), &quoted(&expected.study));
        }
        for (found, wanted) in self.inputs.iter().zip(&expected.inputs) {
            if found.role != wanted.role || found.sha256 != wanted.sha256 {
                let [found, wanted] = [found, wanted].map(named);
                return other("the file", &found, &wanted);
            }
        }
        number("the number of all draws", self.draws, expected.draws)?;
        number("the seed", self.seed, expected.seed)?;
        if self.joint_sha256 != expected.joint_sha256 {
            let what = "a joint whose numbers have the SHA-256";
            return other(
                what,
                short(&self.joint_sha256),
                short(&expected.joint_sha256),
            );
        }
        Ok(())
    }
}

fn quoted(name: &str) -> String {
    format!("{name:?}")
}

pub(super) fn named(file: &InputFile) -> String {
    format!(
        "{} ({}, SHA-256 {})",
        file.file,
        file.role,
        short(&file.sha256)
    )
}

/// As much of a hash as tells it from others.
fn short(sha256: &str) -> &str {
    sha256.get(..12).unwrap_or(sha256)
}
