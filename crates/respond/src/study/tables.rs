//! The tables of a response study as they stand in its TOML file, before anything is checked.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use bolted_joint_joint::DofName;
use serde::Deserialize;

use bolted_joint_study::{Method, OneOrMore};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyFile {
    pub(super) method: Method,
    pub(super) kind: Kind,
    pub(super) name: String,
    #[serde(default)]
    pub(super) lap: Vec<LapTable>,
    pub(super) motions: Option<Vec<String>>,
    #[serde(default)]
    pub(super) quantity: QuantityName,
    pub(super) scale: Option<ScaleName>,
    pub(super) frequency: Option<FrequencyTable>,
    pub(super) load: Option<LoadTable>,
    pub(super) response: Option<ResponseTable>,
    pub(super) harmonics: Option<HarmonicsTable>,
    pub(super) time: Option<TimeTable>,
    pub(super) start: Option<BTreeMap<String, f64>>,
}

/// What is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Kind {
    Linear,
    HarmonicBalance,
    ConstantAmplitude,
    Backbone,
    PhaseResonance,
    SteppedSine,
    Sweep,
    Dwell,
    FreeDecay,
    Hysteresis,
}

impl fmt::Display for Kind {
    /// As a study names it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Linear => "linear",
            Self::HarmonicBalance => "harmonic-balance",
            Self::ConstantAmplitude => "constant-amplitude",
            Self::Backbone => "backbone",
            Self::PhaseResonance => "phase-resonance",
            Self::SteppedSine => "stepped-sine",
            Self::Sweep => "sweep",
            Self::Dwell => "dwell",
            Self::FreeDecay => "free-decay",
            Self::Hysteresis => "hysteresis",
        })
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum QuantityName {
    #[default]
    Displacement,
    Velocity,
    Acceleration,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum ScaleName {
    Linear,
    Logarithmic,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LapTable {
    pub(super) joint: PathBuf,
    pub(super) name: Option<String>,
    pub(super) preload: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FrequencyTable {
    pub(super) from: Option<f64>,
    pub(super) to: Option<f64>,
    pub(super) at: Option<f64>,
    pub(super) lines: Option<usize>,
    #[serde(default)]
    pub(super) direction: Direction,
}

#[derive(Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Direction {
    #[default]
    Up,
    Down,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LoadTable {
    #[serde(default)]
    pub(super) on: Place,
    #[serde(default)]
    pub(super) dof: DofName,
    pub(super) amplitude: Option<OneOrMore>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Place {
    A,
    #[default]
    B,
    Opposed,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ResponseTable {
    pub(super) of: Option<String>,
    pub(super) amplitude: Option<OneOrMore>,
    pub(super) from: Option<f64>,
    pub(super) to: Option<f64>,
    #[serde(default)]
    pub(super) undamped: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct HarmonicsTable {
    pub(super) highest: Option<usize>,
    #[serde(default)]
    pub(super) even: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TimeTable {
    pub(super) duration: Option<f64>,
    pub(super) interval: Option<f64>,
    pub(super) settle: Option<f64>,
    pub(super) steps_per_period: Option<f64>,
}
