//! The tables of a study of method `frf-space`, as they are written.

use std::path::PathBuf;

use bolted_joint_study::{FrequencyTable, Method};
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StudyFile {
    pub(crate) method: Method,
    pub(crate) name: String,
    #[serde(default)]
    pub(crate) notes: Vec<String>,
    pub(crate) a: SideTable,
    pub(crate) b: SideTable,
    pub(crate) assembly: AssemblyTable,
    pub(crate) joint: JointTable,
    #[serde(default)]
    pub(crate) frequency: FrequencyTable,
    #[serde(default)]
    pub(crate) noise: NoiseTable,
    #[serde(default)]
    pub(crate) budget: BudgetTable,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SideTable {
    pub(crate) frf: PathBuf,
    /// Node whose six motions are those of the interface.
    pub(crate) interface: Option<u32>,
    #[serde(default)]
    pub(crate) sensors: Vec<SensorTable>,
    #[serde(default)]
    pub(crate) impacts: Vec<ImpactTable>,
    /// DOFs elsewhere that respond, or are excited.
    #[serde(default)]
    pub(crate) responses: Vec<String>,
    #[serde(default)]
    pub(crate) references: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SensorTable {
    /// Of a sensor with three channels.
    pub(crate) node: Option<u32>,
    /// Of a sensor with one.
    pub(crate) dof: Option<String>,
    /// m.
    pub(crate) position: [f64; 3],
    /// Of the three channels; those of the interface if left out.
    pub(crate) axes: Option<[[f64; 3]; 3]>,
    /// Of the one channel; that of its DOF if left out.
    pub(crate) direction: Option<[f64; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ImpactTable {
    pub(crate) dof: String,
    /// m.
    pub(crate) position: [f64; 3],
    /// Of the force; that of the DOF if left out.
    pub(crate) direction: Option<[f64; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AssemblyTable {
    pub(crate) frf: PathBuf,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct JointTable {
    pub(crate) model: ModelName,
    /// Of bolts.
    pub(crate) axis: Option<[f64; 3]>,
    /// From one of two bolts to the other.
    pub(crate) line: Option<[f64; 3]>,
    /// Bolts on a circle.
    pub(crate) bolts: Option<usize>,
    /// Of equal bolts, m.
    pub(crate) positions: Option<Vec<[f64; 3]>>,
    /// Without mirror planes.
    #[serde(default)]
    pub(crate) twisted: bool,
    /// About the size of the interface, m.
    pub(crate) length: f64,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ModelName {
    Translations,
    Diagonal,
    Bolt,
    TwoBolts,
    BoltCircle,
    Bolts,
    Blocks,
    Full,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct NoiseTable {
    /// In parts of each function's r.m.s.
    pub(crate) relative: Option<f64>,
    /// Of the substructures' functions, in parts of each value.
    pub(crate) a: Option<f64>,
    pub(crate) b: Option<f64>,
}

/// `budget = "none"`, or deviations.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "expected \"none\" or a table with position, rotation and gain"
)]
pub(crate) enum BudgetTable {
    Word(NoBudget),
    Deviations(DeviationsTable),
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum NoBudget {
    None,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DeviationsTable {
    /// m.
    pub(crate) position: Option<f64>,
    /// rad.
    pub(crate) rotation: Option<f64>,
    pub(crate) gain: Option<f64>,
}

impl Default for BudgetTable {
    fn default() -> Self {
        Self::Deviations(DeviationsTable::default())
    }
}
