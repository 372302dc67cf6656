//! The tables of a study file.

use std::path::PathBuf;

use bolted_joint_study::{FrequencyTable, Method};
use serde::Deserialize;

use super::Place;
use crate::response::data::{PhaseOf, Use};
use crate::response::terms::NamedTerm;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyFile {
    pub(super) method: Method,
    pub(super) name: String,
    #[serde(default)]
    pub(super) notes: Vec<String>,
    pub(super) torque: Option<f64>,
    pub(super) model: ModelTable,
    #[serde(default)]
    pub(super) known: KnownTable,
    #[serde(default)]
    pub(super) noise: NoiseTable,
    #[serde(default)]
    pub(super) frequency: FrequencyTable,
    #[serde(default)]
    pub(super) sine: Vec<SineTable>,
    #[serde(default)]
    pub(super) backbone: Vec<FileTable>,
    #[serde(default)]
    pub(super) decay: Vec<DecayTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ModelTable {
    pub(super) drive: Place,
    pub(super) response: Place,
    pub(super) terms: Option<Vec<NamedTerm>>,
    #[serde(default = "yes")]
    pub(super) compare: bool,
    pub(super) harmonics: Option<usize>,
    #[serde(default)]
    pub(super) other_modes: bool,
}

const fn yes() -> bool {
    true
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KnownTable {
    pub(super) k: Option<f64>,
    pub(super) m: Option<f64>,
    pub(super) c: Option<f64>,
    pub(super) k12: Option<f64>,
    pub(super) c12: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NoiseTable {
    pub(super) response: Option<f64>,
    pub(super) force: Option<f64>,
    pub(super) floor_m: Option<f64>,
    pub(super) frequency: Option<f64>,
    pub(super) damping: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SineTable {
    pub(super) file: PathBuf,
    pub(super) name: Option<String>,
    #[serde(default, rename = "use")]
    pub(super) used_for: Use,
    pub(super) phase_of: Option<PhaseOf>,
    pub(super) phase_sign: Option<i8>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FileTable {
    pub(super) file: PathBuf,
    pub(super) name: Option<String>,
    #[serde(default, rename = "use")]
    pub(super) used_for: Use,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DecayTable {
    pub(super) file: PathBuf,
    pub(super) name: Option<String>,
    #[serde(default, rename = "use")]
    pub(super) used_for: Use,
    /// Hz
    pub(super) band: Option<[f64; 2]>,
}
