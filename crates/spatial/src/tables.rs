//! The tables of a study of method `frf-space`, as they are written.

use std::fmt;
use std::path::PathBuf;

use bolted_joint_frf::Quantity;
use bolted_joint_study::{
    Deviation, FrequencyTable, Method, OneOrMore, Paths, UnitsTable, one_or_more_tables,
};
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StudyFile {
    pub(crate) method: Method,
    pub(crate) name: String,
    #[serde(default)]
    pub(crate) notes: Vec<String>,
    /// Which motions the interfaces have; all six if left out.
    pub(crate) motions: Option<Vec<String>>,
    pub(crate) a: PartTable,
    pub(crate) b: PartTable,
    /// Further parts of a chain.
    pub(crate) c: Option<PartTable>,
    pub(crate) d: Option<PartTable>,
    pub(crate) e: Option<PartTable>,
    pub(crate) f: Option<PartTable>,
    #[serde(default)]
    pub(crate) assembly: AssemblyTable,
    #[serde(deserialize_with = "joints")]
    pub(crate) joint: Vec<JointTable>,
    #[serde(default)]
    pub(crate) frequency: FrequencyTable,
    #[serde(default)]
    pub(crate) noise: NoiseTable,
    #[serde(default)]
    pub(crate) budget: BudgetTable,
    /// What a plan may add.
    pub(crate) candidates: Option<CandidatesTable>,
}

fn joints<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<JointTable>, D::Error> {
    one_or_more_tables(
        deserializer,
        "a table [joint], or [[joint]] for each joint of a chain",
    )
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PartTable {
    /// Measured or computed functions.
    pub(crate) frf: Option<Paths>,
    /// Coherences of the functions, where they are in other files.
    pub(crate) coherence: Option<Paths>,
    /// Averages behind every function.
    pub(crate) averages: Option<f64>,
    /// What `frf` holds, where the file does not say.
    pub(crate) quantity: Option<Quantity>,
    pub(crate) units: Option<UnitsTable>,
    /// Modes.
    pub(crate) modal: Option<PathBuf>,
    /// Computed.
    pub(crate) beam: Option<BeamTable>,
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
    /// The interface to the next part of a chain.
    pub(crate) far: Option<InterfaceTable>,
}

/// Beams through a line of points.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BeamTable {
    pub(crate) points: Vec<BeamPointTable>,
    /// m.
    pub(crate) width: f64,
    /// m.
    pub(crate) height: f64,
    /// Direction of the height.
    pub(crate) height_along: [f64; 3],
    /// Pa.
    pub(crate) youngs_modulus: f64,
    /// kg/m³.
    pub(crate) density: f64,
    pub(crate) poissons_ratio: Option<f64>,
    #[serde(default)]
    pub(crate) theory: TheoryName,
    /// Nodes that do not move.
    #[serde(default)]
    pub(crate) held: Vec<u32>,
    pub(crate) damping_ratio: OneOrMore,
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BeamPointTable {
    pub(crate) node: u32,
    /// m.
    pub(crate) position: [f64; 3],
}

/// Which theory of bending a computed beam follows.
#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum TheoryName {
    #[default]
    Timoshenko,
    EulerBernoulli,
}

/// An interface of a part that has two.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct InterfaceTable {
    pub(crate) interface: Option<u32>,
    #[serde(default)]
    pub(crate) sensors: Vec<SensorTable>,
    #[serde(default)]
    pub(crate) impacts: Vec<ImpactTable>,
}

/// What may be added to a test.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CandidatesTable {
    #[serde(default)]
    pub(crate) sensors: Vec<CandidateSensorTable>,
    #[serde(default)]
    pub(crate) impacts: Vec<CandidateImpactTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CandidateSensorTable {
    /// The table that it would be added to: `a`, `b`, `b.far`.
    pub(crate) to: String,
    pub(crate) node: Option<u32>,
    pub(crate) dof: Option<String>,
    pub(crate) position: [f64; 3],
    pub(crate) axes: Option<[[f64; 3]; 3]>,
    pub(crate) direction: Option<[f64; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CandidateImpactTable {
    pub(crate) to: String,
    pub(crate) dof: String,
    pub(crate) position: [f64; 3],
    pub(crate) direction: Option<[f64; 3]>,
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

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AssemblyTable {
    /// Left out while nothing is measured.
    pub(crate) frf: Option<Paths>,
    /// Coherences of the functions, where they are in other files.
    pub(crate) coherence: Option<Paths>,
    /// Averages behind every function.
    pub(crate) averages: Option<f64>,
    /// What `frf` holds, where the file does not say.
    pub(crate) quantity: Option<Quantity>,
    pub(crate) units: Option<UnitsTable>,
    /// Which of the DOFs will be measured; all if left out. Of a plan alone.
    pub(crate) responses: Option<Vec<String>>,
    pub(crate) references: Option<Vec<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct JointTable {
    /// Of a joint that is sought.
    pub(crate) model: Option<ModelName>,
    /// Joint file of one that is not.
    pub(crate) known: Option<PathBuf>,
    /// What a plan takes it to be.
    pub(crate) expected: Option<ExpectedTable>,
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
    pub(crate) length: Option<f64>,
}

/// A joint file, or matrices.
pub(crate) enum ExpectedTable {
    File(PathBuf),
    Matrices(MatricesTable),
}

/// By hand, as [`BudgetTable`], so that a wrong key of the table is named.
impl<'de> Deserialize<'de> for ExpectedTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ExpectedVisitor;
        impl<'de> Visitor<'de> for ExpectedVisitor {
            type Value = ExpectedTable;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the path of a joint file, or a table with stiffness and damping")
            }

            fn visit_str<E: de::Error>(self, path: &str) -> Result<ExpectedTable, E> {
                Ok(ExpectedTable::File(path.into()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ExpectedTable, A::Error> {
                let table = MatricesTable::deserialize(MapAccessDeserializer::new(map))?;
                Ok(ExpectedTable::Matrices(table))
            }
        }
        deserializer.deserialize_any(ExpectedVisitor)
    }
}

/// A row and a column for each motion of the study, or for all six.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MatricesTable {
    pub(crate) stiffness: Vec<Vec<f64>>,
    pub(crate) damping: Vec<Vec<f64>>,
}

#[derive(Clone, Copy, PartialEq, Deserialize)]
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
pub(crate) enum BudgetTable {
    None,
    Deviations(DeviationsTable),
}

impl<'de> Deserialize<'de> for BudgetTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct BudgetVisitor;
        impl<'de> Visitor<'de> for BudgetVisitor {
            type Value = BudgetTable;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"none\" or a table with position, rotation, gain, sensors, hits, origin and joint")
            }

            fn visit_str<E: de::Error>(self, word: &str) -> Result<BudgetTable, E> {
                match word {
                    "none" => Ok(BudgetTable::None),
                    _ => Err(E::invalid_value(de::Unexpected::Str(word), &self)),
                }
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<BudgetTable, A::Error> {
                DeviationsTable::deserialize(MapAccessDeserializer::new(map))
                    .map(BudgetTable::Deviations)
            }
        }
        deserializer.deserialize_any(BudgetVisitor)
    }
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DeviationsTable {
    /// m.
    pub(crate) position: Option<Deviation>,
    /// rad.
    pub(crate) rotation: Option<Deviation>,
    pub(crate) gain: Option<Deviation>,
    /// How far sensors of the assembly are from where they were in the substructures' tests, and hits likewise.
    pub(crate) sensors: Option<PoseTable>,
    pub(crate) hits: Option<PoseTable>,
    /// How far all places of an interface may be off as a whole, and the joint itself.
    pub(crate) origin: Option<PoseTable>,
    pub(crate) joint: Option<PoseTable>,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with position and rotation")]
pub(crate) struct PoseTable {
    /// m.
    pub(crate) position: Option<Deviation>,
    /// rad.
    pub(crate) rotation: Option<Deviation>,
}

impl Default for BudgetTable {
    fn default() -> Self {
        Self::Deviations(DeviationsTable::default())
    }
}
