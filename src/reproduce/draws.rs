//! Repetition of an identification over draws of the noise.

use num_complex::Complex64;

use crate::identify::{Bands, JointMatrices, JointModel, Unknown, band_average};
use crate::respond::{Generator, Pollution};
use crate::structure::ComplexMatrix;

use super::outcome::{Row, Spread};

/// How often the noise is drawn, and what the thesis does not say about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draws {
    /// Number of draws.
    pub count: u32,
    /// Seed of the first one.
    pub seed: u64,
    /// Samples of each harmonic test in response pollution.
    pub samples: u32,
}

impl Draws {
    /// Response pollution of `level`.
    pub(super) fn response(&self, level: f64) -> Pollution {
        Pollution::Response {
            level,
            samples: self.samples,
        }
    }

    /// The generators of all draws.
    pub(super) fn generators(&self) -> impl Iterator<Item = Generator> + use<> {
        let seed = self.seed;
        (0..u64::from(self.count)).map(move |draw| Generator::new(seed.wrapping_add(draw)))
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

/// Averages of a decoupled joint over bands, one set of values a draw.
pub(super) struct Averages {
    model: JointModel,
    values: Vec<Vec<f64>>,
}

impl Averages {
    pub(super) fn new(model: JointModel) -> Self {
        Self {
            model,
            values: vec![Vec::new(); model.unknowns()],
        }
    }

    /// Adds a draw; one without any line to average is left out.
    pub(super) fn add(
        &mut self,
        frequency_hz: &[f64],
        decoupled: &[Option<ComplexMatrix>],
        bands: &Bands,
    ) {
        if let Some(joint) = band_average(self.model, frequency_hz, decoupled, bands) {
            self.add_joint(&joint);
        }
    }

    pub(super) fn add_joint(&mut self, joint: &JointMatrices) {
        for (values, unknown) in self.values.iter_mut().zip(Unknown::of(self.model)) {
            values.push(unknown.value(joint));
        }
    }

    /// One row for each unknown; `published` in the order of [`Unknown::of`].
    pub(super) fn rows(&self, case: &str, truth: &JointMatrices, published: &[f64]) -> Vec<Row> {
        Unknown::of(self.model)
            .iter()
            .enumerate()
            .map(|(index, unknown)| Row {
                case: case.to_owned(),
                quantity: unknown.name.to_owned(),
                unit: unknown.unit,
                truth: Some(unknown.value(truth)),
                published: published.get(index).copied(),
                obtained: Spread::of(&self.values[index]),
            })
            .collect()
    }
}
