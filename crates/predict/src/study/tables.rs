//! The tables of a study's file, as they stand there.

use std::path::PathBuf;

use serde::Deserialize;

use crate::fractal::StoredEnergy;
use crate::patch::{LossFactor, SignedAxis};
use crate::pressure::{ConePressure, Reach, ZoneForce};
use crate::uncertain::Uncertain;
use bolted_joint_study::{Method, UncertaintyTable};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyFile {
    pub(super) method: Method,
    pub(super) name: String,
    #[serde(default)]
    pub(super) notes: Vec<String>,
    pub(super) materials: MaterialsTable,
    pub(super) surface: SurfaceTable,
    pub(super) contact: ContactTable,
    pub(super) layer: Option<LayerTable>,
    pub(super) interface: InterfaceTable,
    pub(super) pressure: Option<PressureTable>,
    #[serde(default)]
    pub(super) bolts: Vec<BoltTable>,
    pub(super) tightening: Option<TighteningTable>,
    pub(super) joint: JointTable,
    pub(super) damping: DampingTable,
    pub(super) microslip: Option<MicroslipTable>,
    pub(super) uncertainty: Option<UncertaintyTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialsTable {
    pub(super) a: MaterialTable,
    pub(super) b: MaterialTable,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialTable {
    /// Pa.
    pub(super) youngs_modulus: Uncertain,
    pub(super) poissons_ratio: Uncertain,
    /// kg/m³.
    pub(super) density: Option<f64>,
}

/// Of the two surfaces together, or each of them.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SurfaceTable {
    pub(super) profiles: Option<Vec<PathBuf>>,
    pub(super) band: Option<BandTable>,
    pub(super) fractal_dimension: Option<Uncertain>,
    /// m.
    pub(super) roughness: Option<Uncertain>,
    pub(super) correlation: Option<f64>,
    pub(super) a: Option<OneSurfaceTable>,
    pub(super) b: Option<OneSurfaceTable>,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OneSurfaceTable {
    pub(super) profiles: Option<Vec<PathBuf>>,
    pub(super) band: Option<BandTable>,
    pub(super) fractal_dimension: Option<Uncertain>,
    /// m.
    pub(super) roughness: Option<Uncertain>,
    pub(super) correlation: Option<f64>,
}

/// Wavelengths, m.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BandTable {
    pub(super) from: f64,
    pub(super) to: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ContactTable {
    /// Pa.
    pub(super) hardness: Uncertain,
    /// Coefficient.
    pub(super) friction: Option<Uncertain>,
    /// Pa.
    pub(super) shear_strength: Option<Uncertain>,
    /// Tangential load over the friction force.
    pub(super) friction_ratio: Option<Uncertain>,
}

/// That the interface slips under the joint's motion.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MicroslipTable {
    /// Of the relative motion, m; rad of a joint whose rotation slips alone.
    pub(super) amplitudes: Option<AmplitudesTable>,
}

/// Smallest and largest.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AmplitudesTable {
    pub(super) from: f64,
    pub(super) to: f64,
}

/// The virtual layer.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LayerTable {
    /// Of the part of side a and of side b that the layer takes the place of, m.
    pub(super) thickness: [f64; 2],
    pub(super) loss_factor: Option<Uncertain>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InterfaceTable {
    /// m.
    pub(super) x: Option<[f64; 2]>,
    /// m.
    pub(super) y: Option<[f64; 2]>,
    /// Along x and y.
    pub(super) elements: Option<[usize; 2]>,
    pub(super) field: Option<PathBuf>,
    /// m².
    pub(super) area: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PressureTable {
    pub(super) model: Option<PressureModel>,
    /// Of the layers on side a and b, m.
    pub(super) thickness: Option<[f64; 2]>,
    pub(super) reach: Option<Reach>,
    pub(super) force: Option<ZoneForce>,
    /// Degrees.
    pub(super) half_angle: Option<f64>,
    /// m.
    pub(super) head_diameter: Option<f64>,
    /// m.
    pub(super) depth: Option<f64>,
    pub(super) distribution: Option<ConePressure>,
    /// m.
    pub(super) clearance: Option<f64>,
    /// About x and y, N·m.
    pub(super) bending_moment: Option<[Uncertain; 2]>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum PressureModel {
    Uniform,
    Kavi,
    Cone,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BoltTable {
    /// m.
    pub(super) x: f64,
    /// m.
    pub(super) y: f64,
    /// m.
    pub(super) diameter: f64,
    /// N.
    pub(super) preload: Option<Uncertain>,
    /// N·m.
    pub(super) torque: Option<Uncertain>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TighteningTable {
    pub(super) nut_factor: Option<Uncertain>,
    pub(super) thread: Option<ThreadTable>,
    pub(super) scatter: Option<ScatterWord>,
    /// N·m.
    pub(super) torques: Option<Vec<f64>>,
    /// N·m.
    pub(super) nominal: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ThreadTable {
    /// m; the coarse one of ISO 261 if it is left out.
    pub(super) pitch: Option<f64>,
    /// Coefficient in the thread.
    pub(super) friction: Uncertain,
    /// Coefficient under the head.
    pub(super) head_friction: Uncertain,
    /// Outer diameter of the bearing surface under the head, m.
    pub(super) head_diameter: f64,
    /// Its inner diameter, that of the hole, m.
    pub(super) hole_diameter: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum ScatterWord {
    EachBolt,
    Common,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JointTable {
    pub(super) translation: Option<SignedAxis>,
    pub(super) rotation: Option<SignedAxis>,
    pub(super) dofs: Option<Vec<String>>,
    /// m.
    pub(super) reference: Option<Vec<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DampingTable {
    /// Hz.
    pub(super) frequency: f64,
    pub(super) loss_factor: Option<LossFactor>,
    pub(super) stored_energy: Option<StoredEnergy>,
    /// kg.
    pub(super) mass: Option<f64>,
    #[serde(default)]
    pub(super) normal: NormalWord,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum NormalWord {
    #[default]
    Hysteretic,
    Viscous,
}
