//! The level of force or response at which an assembly was measured: a bolted joint softens and dissipates more as it is
//! excited harder, so that stiffness and damping hold at this level.

use std::fmt;

use serde::Deserialize;

use super::study::Study;

/// Level at which an assembly was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// What was kept at the level.
    pub quantity: LevelQuantity,
    /// Its value, in the quantity's SI unit.
    pub value: f64,
    /// What the value is of the signal.
    pub measure: LevelMeasure,
}

/// What a level is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LevelQuantity {
    /// Exciting force, N.
    Force,
    /// Displacement response, m.
    Displacement,
    /// Velocity response, m/s.
    Velocity,
    /// Acceleration response, m/s².
    Acceleration,
}

/// How a signal's level is counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LevelMeasure {
    /// Amplitude of a sine at each line.
    #[default]
    Amplitude,
    /// Root mean square over time, of random or any other excitation.
    Rms,
    /// Largest value, of a hammer's blow.
    Peak,
}

impl LevelQuantity {
    /// Its name in a study.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::Displacement => "displacement",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
        }
    }

    /// Its SI unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Force => "N",
            Self::Displacement => "m",
            Self::Velocity => "m/s",
            Self::Acceleration => "m/s²",
        }
    }
}

impl LevelMeasure {
    fn name(self) -> &'static str {
        match self {
            Self::Amplitude => "amplitude",
            Self::Rms => "r.m.s.",
            Self::Peak => "peak",
        }
    }
}

/// Such as `force 0.5 N amplitude`.
impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            quantity,
            value,
            measure,
        } = self;
        let (name, unit) = (quantity.name(), quantity.unit());
        write!(f, "{name} {value} {unit} {}", measure.name())
    }
}

/// The levels of a study's assemblies: once where all have the same, as a range where all state the same quantity, else one
/// by one.
pub(super) fn in_words(study: &Study) -> Option<String> {
    let further = study.further.iter().map(|assembly| assembly.level);
    let levels: Vec<Option<Level>> = std::iter::once(study.level).chain(further).collect();
    let known: Vec<Level> = levels.iter().copied().flatten().collect();
    let first = *known.first()?;
    let alike = |level: &Level| (level.quantity, level.measure) == (first.quantity, first.measure);
    if known.len() == levels.len() && known.iter().all(alike) {
        let values = || known.iter().map(|level| level.value);
        let lowest = values().fold(first.value, f64::min);
        let highest = values().fold(first.value, f64::max);
        if lowest == highest {
            return Some(first.to_string());
        }
        let (name, unit) = (first.quantity.name(), first.quantity.unit());
        let measure = first.measure.name();
        return Some(format!("{name} {lowest} to {highest} {unit} {measure}"));
    }
    let each = levels.iter().enumerate().map(|(number, level)| {
        let level = level.map_or_else(|| "not stated".to_owned(), |level| level.to_string());
        format!("assembly {}: {level}", number + 1)
    });
    Some(each.collect::<Vec<_>>().join("; "))
}
