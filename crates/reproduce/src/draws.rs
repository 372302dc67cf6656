//! Repetition of an identification over draws of the noise.

use num_complex::Complex64;

use bolted_joint_frf::structure::ComplexMatrix;
use bolted_joint_identify::parallel;
use bolted_joint_identify::{Bands, JointMatrices, JointModel, Unknown};
use bolted_joint_respond::{Generator, Pollution};

use super::outcome::{Row, Spread};

/// How often the noise is drawn, and what the thesis does not say about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Draws {
    /// Number of draws.
    pub count: u32,
    /// Seed of the noise: the same seed gives the same draws.
    pub seed: u64,
    /// Samples of each harmonic test in response pollution: one set of rows for each number.
    pub samples: Vec<u32>,
}

/// Draws under way.
#[derive(Clone, Copy)]
pub(super) struct Repetition<'a> {
    /// How many, and from which seed.
    pub(super) draws: &'a Draws,
    /// Called after each draw.
    pub(super) progress: &'a (dyn Fn() + Sync),
}

impl<'a> Repetition<'a> {
    /// Samples of each harmonic test in response pollution.
    pub(super) fn samples(self) -> &'a [u32] {
        &self.draws.samples
    }

    /// Response pollution of `level`, once for each number of samples, with what a row's case says about it.
    pub(super) fn responses(&self, level: f64) -> Vec<(String, Pollution)> {
        let noise = |&samples: &u32| {
            let named = format!(", N = {samples}");
            (named, Pollution::Response { level, samples })
        };
        self.draws.samples.iter().map(noise).collect()
    }

    /// `identify` with the noise of each draw; draws that give no joint are left out.
    pub(super) fn joints(
        &self,
        identify: impl Fn(&mut Generator) -> Option<JointMatrices> + Sync,
    ) -> Vec<JointMatrices> {
        let numbers: Vec<u64> = (0..u64::from(self.draws.count)).collect();
        let joints = parallel::map(&numbers, |&draw| {
            let joint = identify(&mut Generator::of_draw(self.draws.seed, draw));
            (self.progress)();
            joint
        });
        joints.into_iter().flatten().collect()
    }
}

/// Every entry of the matrices of all lines with noise: each entry is one measured function.
pub(super) fn polluted(
    lines: &[ComplexMatrix],
    noise: &Pollution,
    generator: &mut Generator,
) -> Vec<ComplexMatrix> {
    let mut noisy = lines.to_vec();
    let Some(first) = lines.first() else {
        return noisy;
    };
    for column in 0..first.ncols() {
        for row in 0..first.nrows() {
            let function: Vec<Complex64> = lines.iter().map(|line| line[(row, column)]).collect();
            let function = noise.applied(&function, generator);
            for (line, value) in noisy.iter_mut().zip(function) {
                line[(row, column)] = value;
            }
        }
    }
    noisy
}

/// `decouple` at the lines within any of the bands; the others are not needed.
pub(super) fn decoupled_within(
    bands: &Bands,
    frequency_hz: &[f64],
    decouple: impl Fn(usize) -> Option<ComplexMatrix>,
) -> Vec<Option<ComplexMatrix>> {
    let all = [&bands.yy, &bands.ytheta, &bands.thetatheta];
    let is_within = |hz: &f64| {
        let mut bands = all.iter().flat_map(|bands| bands.iter());
        bands.any(|band| (band[0]..=band[1]).contains(hz))
    };
    let lines = frequency_hz.iter().enumerate();
    lines
        .map(|(line, hz)| is_within(hz).then(|| decouple(line)).flatten())
        .collect()
}

/// One row for each unknown of `model`; `published` in their order, empty where there is nothing published.
pub(super) fn rows(
    case: &str,
    model: JointModel,
    truth: Option<&JointMatrices>,
    published: &[f64],
    obtained: &[JointMatrices],
) -> Vec<Row> {
    Unknown::of(model)
        .iter()
        .enumerate()
        .map(|(index, unknown)| {
            let values: Vec<f64> = obtained.iter().map(|joint| unknown.value(joint)).collect();
            Row {
                case: case.to_owned(),
                quantity: unknown.name.to_owned(),
                unit: unknown.unit,
                truth: truth.map(|truth| unknown.value(truth)),
                published: published.get(index).copied(),
                obtained: Spread::of(&values),
            }
        })
        .collect()
}
