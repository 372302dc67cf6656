//! The tables of an assembly file as they stand there, before anything is checked.

use std::collections::BTreeMap;
use std::path::PathBuf;

use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::Boundary;
use bolted_joint_joint::About;
use bolted_joint_study::OneOrMore;
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AssemblyTables {
    pub(crate) name: String,
    pub(crate) about: Option<About>,
    #[serde(default)]
    pub(crate) mechanisms: bool,
    pub(crate) structures: BTreeMap<String, StructureTable>,
    #[serde(default)]
    pub(crate) joints: Vec<JointTable>,
    #[serde(default)]
    pub(crate) inputs: BTreeMap<String, String>,
    #[serde(default)]
    pub(crate) outputs: BTreeMap<String, String>,
    pub(crate) response: Option<ResponseTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StructureTable {
    pub(crate) matrices: Option<PathBuf>,
    pub(crate) modal: Option<PathBuf>,
    pub(crate) beam: Option<BeamTable>,
    #[serde(default)]
    pub(crate) points: BTreeMap<Dof, f64>,
    pub(crate) modes: Option<usize>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BeamTable {
    pub(crate) length: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) youngs_modulus: f64,
    pub(crate) density: f64,
    #[serde(default)]
    pub(crate) theory: TheoryName,
    pub(crate) poissons_ratio: Option<f64>,
    pub(crate) boundary: Boundary,
    pub(crate) damping_ratio: Option<OneOrMore>,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum TheoryName {
    #[default]
    Timoshenko,
    EulerBernoulli,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct JointTable {
    pub(crate) name: Option<String>,
    pub(crate) file: PathBuf,
    pub(crate) preload: Option<f64>,
    /// `structure`, and a degree of freedom for each of the joint's.
    pub(crate) a: BTreeMap<String, String>,
    pub(crate) b: BTreeMap<String, String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ResponseTable {
    pub(crate) kind: ResponseKind,
    pub(crate) from: Option<f64>,
    pub(crate) to: Option<f64>,
    pub(crate) lines: Option<usize>,
    pub(crate) duration: Option<f64>,
    pub(crate) step: Option<f64>,
    #[serde(default)]
    pub(crate) loads: BTreeMap<String, LoadTable>,
    pub(crate) harmonics: Option<usize>,
    pub(crate) mode: Option<usize>,
    pub(crate) of: Option<String>,
    pub(crate) amplitude: Option<[f64; 2]>,
}

#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ResponseKind {
    Linear,
    Modes,
    History,
    HarmonicBalance,
    Backbone,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LoadTable {
    pub(crate) amplitude: f64,
    pub(crate) frequency: Option<f64>,
    pub(crate) until: Option<f64>,
    pub(crate) phase: Option<f64>,
}
