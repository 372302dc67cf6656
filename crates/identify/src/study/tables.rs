//! The tables of a study as they stand in its TOML file, before anything is checked.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{self, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use bolted_joint_frf::structure::{Boundary, Difference};
use bolted_joint_frf::{Dof, Quantity};
use bolted_joint_joint::Bodies;
use bolted_joint_study::{
    FrequencyTable, Method, OneOrMore, Paths, Stated, UnitsTable, one_or_more_tables,
};

use super::super::bands::{BandChoice, BandChoices};
use super::super::level::LevelMeasure;
use super::super::model::JointModel;
use super::super::noise::StatedFloor;
use super::super::torque::TorqueDependence;
use super::budget::BudgetKey;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyFile {
    pub(super) method: Method,
    pub(super) name: String,
    pub(super) a: SubstructureTable,
    pub(super) b: SubstructureTable,
    #[serde(deserialize_with = "assemblies")]
    pub(super) assembly: Vec<AssemblyTable>,
    pub(super) joint: JointTable,
    #[serde(default)]
    pub(super) frequency: FrequencyTable,
    #[serde(default)]
    pub(super) bands: BandsTable,
    pub(super) noise: Option<NoiseTable>,
    pub(super) budget: Option<BudgetKey>,
    pub(super) start: Option<StartTable>,
    pub(super) bodies: Option<Bodies>,
    #[serde(default)]
    pub(super) notes: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SubstructureTable {
    pub(super) frf: Option<Paths>,
    pub(super) coherence: Option<Paths>,
    pub(super) quantity: Option<Quantity>,
    pub(super) units: Option<UnitsTable>,
    pub(super) averages: Option<f64>,
    pub(super) accelerometer_mass: Option<Stated>,
    pub(super) modal: Option<PathBuf>,
    pub(super) beam: Option<BeamTable>,
    #[serde(default)]
    pub(super) ground: bool,
    pub(super) section: Option<SectionTable>,
    #[serde(default, deserialize_with = "places")]
    pub(super) joint: Option<Vec<JointPlaceTable>>,
    #[serde(default)]
    pub(super) points: BTreeMap<Dof, Stated>,
}

/// A rectangular cross-section that bends about its width.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SectionTable {
    pub(super) width: Stated,
    pub(super) height: Stated,
    pub(super) youngs_modulus: Stated,
    pub(super) poissons_ratio: Option<Stated>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BeamTable {
    pub(super) length: Stated,
    pub(super) width: Stated,
    pub(super) height: Stated,
    pub(super) youngs_modulus: Stated,
    pub(super) density: Stated,
    #[serde(default)]
    pub(super) theory: TheoryName,
    pub(super) poissons_ratio: Option<Stated>,
    pub(super) boundary: Boundary,
    pub(super) damping_ratio: Option<OneOrMore>,
    pub(super) loss_factor: Option<Stated>,
}

/// Which theory a computed beam follows.
#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum TheoryName {
    #[default]
    Timoshenko,
    EulerBernoulli,
}

/// One place of a bolt, or several.
fn places<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<Vec<JointPlaceTable>>, D::Error> {
    let expecting = "the joint's place as a table, or a list of such tables for several bolts";
    one_or_more_tables(deserializer, expecting).map(Some)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JointPlaceTable {
    pub(super) name: Option<String>,
    pub(super) y: Option<Dof>,
    pub(super) theta: Option<ThetaTable>,
    pub(super) x: Option<Stated>,
    pub(super) mass: Option<Stated>,
    pub(super) inertia: Option<Stated>,
}

pub(super) enum ThetaTable {
    Measured(Dof),
    Difference(DifferenceTable),
}

/// By hand, since an untagged enum would not say which key of the table is wrong.
impl<'de> Deserialize<'de> for ThetaTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ThetaVisitor;
        impl<'de> Visitor<'de> for ThetaVisitor {
            type Value = ThetaTable;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(
                    "a rotation such as \"2:+RZ\", or { points = [points], spacing = metres }",
                )
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<ThetaTable, E> {
                text.parse().map(ThetaTable::Measured).map_err(E::custom)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ThetaTable, A::Error> {
                DifferenceTable::deserialize(MapAccessDeserializer::new(map))
                    .map(ThetaTable::Difference)
            }
        }
        deserializer.deserialize_any(ThetaVisitor)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DifferenceTable {
    pub(super) points: Vec<Dof>,
    pub(super) spacing: Stated,
    #[serde(default)]
    pub(super) difference: Difference,
}

fn assemblies<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<AssemblyTable>, D::Error> {
    one_or_more_tables(deserializer, "a table [assembly], or several [[assembly]]")
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AssemblyTable {
    pub(super) frf: Paths,
    pub(super) coherence: Option<Paths>,
    pub(super) quantity: Option<Quantity>,
    pub(super) units: Option<UnitsTable>,
    pub(super) averages: Option<f64>,
    pub(super) accelerometer_mass: Option<Stated>,
    #[serde(default)]
    pub(super) points: Vec<Dof>,
    #[serde(default)]
    pub(super) points_on_a: Vec<Dof>,
    #[serde(default)]
    pub(super) repeats: Vec<Paths>,
    pub(super) torque: Option<f64>,
    pub(super) level: Option<ExcitationTable>,
    pub(super) a: Option<SubstructureTable>,
    pub(super) b: Option<SubstructureTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JointTable {
    pub(super) model: JointModel,
    #[serde(default)]
    pub(super) torques: TorqueDependence,
    pub(super) bolts: Option<BoltsKey>,
    pub(super) rivals: Option<bool>,
}

/// Level at which an assembly was measured.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ExcitationTable {
    pub(super) force: Option<f64>,
    pub(super) displacement: Option<f64>,
    pub(super) velocity: Option<f64>,
    pub(super) acceleration: Option<f64>,
    #[serde(default)]
    pub(super) measure: LevelMeasure,
}

/// `[bands]`: one word for every entry, or a choice for each.
#[derive(Default)]
pub(super) struct BandsTable(pub(super) BandChoices);

/// What an entry is averaged over.
#[derive(Default)]
pub(super) struct BandKey(BandChoice);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BandsOfEntries {
    #[serde(default)]
    yy: BandKey,
    #[serde(default)]
    ytheta: BandKey,
    #[serde(default)]
    thetatheta: BandKey,
}

fn band_word<E: de::Error>(word: &str) -> Result<BandChoice, E> {
    match word {
        "automatic" => Ok(BandChoice::Automatic),
        "median" => Ok(BandChoice::Median),
        _ => Err(E::invalid_value(
            de::Unexpected::Str(word),
            &"\"automatic\" or \"median\"",
        )),
    }
}

/// By hand, for the same reason as [`ThetaTable`].
impl<'de> Deserialize<'de> for BandsTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct BandsVisitor;
        impl<'de> Visitor<'de> for BandsVisitor {
            type Value = BandsTable;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"automatic\", \"median\", or a table with yy, ytheta and thetatheta")
            }

            fn visit_str<E: de::Error>(self, word: &str) -> Result<BandsTable, E> {
                band_word(word).map(|choice| BandsTable(BandChoices::all(choice)))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<BandsTable, A::Error> {
                let BandsOfEntries {
                    yy: BandKey(yy),
                    ytheta: BandKey(ytheta),
                    thetatheta: BandKey(thetatheta),
                } = BandsOfEntries::deserialize(MapAccessDeserializer::new(map))?;
                Ok(BandsTable(BandChoices {
                    yy,
                    ytheta,
                    thetatheta,
                }))
            }
        }
        deserializer.deserialize_any(BandsVisitor)
    }
}

impl<'de> Deserialize<'de> for BandKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ChoiceVisitor;
        impl<'de> Visitor<'de> for ChoiceVisitor {
            type Value = BandKey;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of bands [from, to], \"automatic\" or \"median\"")
            }

            fn visit_str<E: de::Error>(self, word: &str) -> Result<BandKey, E> {
                band_word(word).map(BandKey)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<BandKey, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(sequence))
                    .map(|bands| BandKey(BandChoice::Given(bands)))
            }
        }
        deserializer.deserialize_any(ChoiceVisitor)
    }
}

/// What several bolts have to do with each other.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum BoltsKey {
    Alike,
    Different,
}

/// A joint to start the search from.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StartTable {
    pub(super) stiffness: Vec<Vec<f64>>,
    pub(super) damping: Vec<Vec<f64>>,
}

/// Noise of the assembly's functions, and of the measured substructures' where that is another.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NoiseTable {
    pub(super) relative: Option<f64>,
    #[serde(default)]
    pub(super) floor: FloorKey,
    #[serde(default)]
    pub(super) a: LevelTable,
    #[serde(default)]
    pub(super) b: LevelTable,
}

#[derive(Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LevelTable {
    pub(super) relative: Option<f64>,
    #[serde(default)]
    pub(super) floor: FloorKey,
}

/// A floor between translations, or one for each kind of function.
#[derive(Clone, Copy, Default, PartialEq)]
pub(super) struct FloorKey(pub(super) StatedFloor);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FloorsOfKinds {
    yy: Option<f64>,
    ytheta: Option<f64>,
    thetatheta: Option<f64>,
}

/// By hand, for the same reason as [`ThetaTable`].
impl<'de> Deserialize<'de> for FloorKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct FloorVisitor;
        impl<'de> Visitor<'de> for FloorVisitor {
            type Value = FloorKey;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(
                    "a floor in m/N, or { yy = m/N, ytheta = rad/N, thetatheta = rad/(N·m) }",
                )
            }

            fn visit_f64<E: de::Error>(self, floor: f64) -> Result<FloorKey, E> {
                // No floor is none in any unit.
                Ok(FloorKey(if floor == 0.0 {
                    StatedFloor::all(0.0)
                } else {
                    StatedFloor {
                        yy: Some(floor),
                        ..StatedFloor::default()
                    }
                }))
            }

            fn visit_i64<E: de::Error>(self, floor: i64) -> Result<FloorKey, E> {
                self.visit_f64(floor as f64)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<FloorKey, A::Error> {
                let FloorsOfKinds {
                    yy,
                    ytheta,
                    thetatheta,
                } = FloorsOfKinds::deserialize(MapAccessDeserializer::new(map))?;
                Ok(FloorKey(StatedFloor {
                    yy,
                    ytheta,
                    thetatheta,
                }))
            }
        }
        deserializer.deserialize_any(FloorVisitor)
    }
}
