//! Noise of the substructures' functions: as the study states it, or else as the functions show it from line to line.

use bolted_joint_files::number;
use bolted_joint_identify::ShownLevel;
use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::level::root_mean_square;
use crate::odd::median;
use crate::problem::{Level, Problem};
use crate::side::Side;

/// What noise of a substructure is said by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SaidBy {
    /// One number for all values: of the study, or as the functions show it from line to line.
    OneLevel,
    /// The coherence of each function, line by line: [`Side`] has it.
    Coherence,
}

/// Noise of the functions of a substructure.
#[derive(Clone, Debug, PartialEq)]
pub struct PartNoise {
    /// In parts of each value; where coherence tells it, of the r.m.s. of the median function.
    pub relative: f64,
    /// By what it is said.
    pub(crate) by: SaidBy,
    /// Beside it, m/N, of each response and reference.
    pub(crate) floors: Option<DMatrix<f64>>,
}

impl PartNoise {
    /// Of exact functions.
    pub const NONE: Self = Self {
        relative: 0.0,
        by: SaidBy::OneLevel,
        floors: None,
    };

    /// In parts of each value.
    pub(crate) fn of_values(relative: f64) -> Self {
        Self {
            relative,
            ..Self::NONE
        }
    }

    /// As coherence tells it, if it does.
    pub(crate) fn of_coherence(side: &Side) -> Option<Self> {
        let (rows, columns) = side.noise.first()?.shape();
        let of = |at: (usize, usize)| {
            let noise = side.noise.iter().map(|line| line[at] * line[at]);
            let values = side.lines.iter().map(|line| line[at].norm_sqr());
            root_mean_square(noise) / root_mean_square(values)
        };
        let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let relative = median(places.map(of).collect()).filter(|&own| own > 0.0);
        relative.map(|relative| Self {
            relative,
            by: SaidBy::Coherence,
            floors: None,
        })
    }

    /// How much of what.
    pub(crate) fn in_words(&self) -> String {
        let part = percent(self.relative);
        match self.by {
            _ if self.is_none() => "none".to_owned(),
            SaidBy::OneLevel => format!("{part} of each value"),
            SaidBy::Coherence => format!("as coherence tells it line by line, about {part}"),
        }
    }

    pub(crate) fn is_none(&self) -> bool {
        *self == Self::NONE
    }

    /// Floor of a function, m/N.
    pub(crate) fn floor(&self, response: usize, reference: usize) -> f64 {
        let floor = self.floors.as_ref();
        floor.map_or(0.0, |floors| floors[(response, reference)])
    }
}

/// Noise that functions show where the study states none.
pub(crate) struct Shown {
    pub(crate) level: Level,
    pub(crate) noise: [PartNoise; 2],
    pub(crate) note: String,
}

impl Shown {
    /// Beside the level that is stated, of the substructures whose noise `may_show`. `None` where these are exact, or their lines do not
    /// show it.
    pub(crate) fn of(problem: &Problem, level: Level, may_show: [bool; 2]) -> Option<Self> {
        let of_side = |n: usize| {
            let shown = may_show[n].then(|| of_side(&problem.sides[n], &problem.frequency_hz));
            shown.flatten()
        };
        let sides = [of_side(0), of_side(1)];
        if sides.iter().all(Option::is_none) {
            return None;
        }
        let level = match level {
            Level::Relative(_) | Level::OfCoherence => level,
            Level::OfResiduals => Level::Relative(of_assembly(problem)?.typical),
        };
        let named = std::iter::zip(["a", "b"], &sides).filter_map(|(name, shown)| {
            let (level, _) = shown.as_ref()?;
            let floor = match level.floor > 0.1 * level.relative {
                true => format!(" and {} of their median", percent(level.floor)),
                false => String::new(),
            };
            Some(format!(
                "those of {name} of {} of each value{floor}",
                percent(level.relative)
            ))
        });
        let named = named.collect::<Vec<_>>().join(", ");
        let note = format!(
            "the functions show noise from line to line, which takes part: {named}; noise.relative, noise.a and noise.b state another \
             one, and noise.a = 0 that those of a are exact"
        );
        let noise = sides.map(|shown| shown.map_or(PartNoise::NONE, |(_, noise)| noise));
        Some(Self { level, noise, note })
    }
}

/// A part in per cent; noise is not known better.
pub(crate) fn percent(part: f64) -> String {
    format!("{} %", number(100.0 * part, 3))
}

/// Of a substructure.
fn of_side(side: &Side, frequency_hz: &[f64]) -> Option<(ShownLevel, PartNoise)> {
    let (rows, columns) = (side.responses.len(), side.references.len());
    let function = |row: usize, column: usize| -> Vec<Complex64> {
        side.lines.iter().map(|line| line[(row, column)]).collect()
    };
    let places = (0..columns).flat_map(|column| (0..rows).map(move |row| (row, column)));
    let functions: Vec<_> = places.map(|(row, column)| function(row, column)).collect();
    let shown = ShownLevel::of(frequency_hz, &functions).filter(|shown| shown.is_noise)?;
    let floor = |values: &Vec<Complex64>| {
        let middle = median(values.iter().map(|value| value.norm()).collect());
        shown.floor * middle.unwrap_or(0.0)
    };
    let floors = functions.iter().map(floor);
    let noise = PartNoise {
        relative: shown.relative,
        by: SaidBy::OneLevel,
        floors: Some(DMatrix::from_iterator(rows, columns, floors)),
    };
    Some((shown, noise))
}

/// Of the assembly; more than it has where lines are too far from each other.
pub(crate) fn of_assembly(problem: &Problem) -> Option<ShownLevel> {
    let functions = problem.observed.iter().map(|one| one.values.clone());
    ShownLevel::of(&problem.frequency_hz, &functions.collect::<Vec<_>>())
}
