//! The tables of a layered beam's study as they stand in its TOML file, before anything is checked.

use serde::Deserialize;

use bolted_joint_frf::structure::Boundary;
use bolted_joint_study::{Method, OneOrMore, UncertaintyTable};

use super::super::super::uncertain::Uncertain;
use super::super::beam_mode::{Route, StoredEnergy};
use super::super::fasteners::{FastenerKind, NormalForceRule};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyFile {
    pub(super) method: Method,
    pub(super) name: String,
    #[serde(default)]
    pub(super) notes: Vec<String>,
    pub(super) beam: BeamTable,
    pub(super) fasteners: FastenersTable,
    pub(super) friction: FrictionTable,
    pub(super) motion: MotionTable,
    #[serde(default)]
    pub(super) joint: JointTable,
    pub(super) uncertainty: Option<UncertaintyTable>,
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BeamTable {
    pub(super) length: f64,
    pub(super) width: f64,
    pub(super) boundary: Boundary,
    pub(super) stiffness_ratio: Option<Uncertain>,
    pub(super) layer: Vec<LayerTable>,
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LayerTable {
    pub(super) thickness: f64,
    pub(super) youngs_modulus: f64,
    pub(super) density: f64,
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FastenersTable {
    pub(super) kind: FastenerKind,
    pub(super) diameter: f64,
    pub(super) count: Option<usize>,
    pub(super) pitch: Option<f64>,
    pub(super) positions: Option<Vec<f64>>,
    pub(super) stress: Option<Uncertain>,
    pub(super) preload: Option<Uncertain>,
    pub(super) torque: Option<OneOrMore>,
    pub(super) nut_factor: Option<Uncertain>,
    #[serde(default)]
    pub(super) normal_force: NormalForceRule,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FrictionTable {
    pub(super) alpha_mu: Option<Uncertain>,
    pub(super) calibration: Option<CalibrationTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CalibrationTable {
    pub(super) damping_ratio: Uncertain,
    pub(super) amplitude: f64,
    pub(super) mode: Option<usize>,
    pub(super) drive_point: Option<f64>,
    pub(super) beam: Option<BeamTable>,
    pub(super) fasteners: Option<FastenersTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MotionTable {
    pub(super) mode: Option<usize>,
    pub(super) modes: Option<usize>,
    pub(super) drive_point: Option<f64>,
    pub(super) amplitude: AmplitudeTable,
    #[serde(default)]
    pub(super) route: Route,
    #[serde(default)]
    pub(super) stored_energy: StoredEnergy,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AmplitudeTable {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) count: Option<usize>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JointTable {
    pub(super) damping: Option<DampingName>,
    pub(super) amplitude: Option<f64>,
    pub(super) nominal_torque: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum DampingName {
    OverAmplitude,
    Linear,
}
