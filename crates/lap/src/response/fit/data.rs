//! What a model is fitted to, and where a fit starts.

use super::Fit;
use crate::response::backbone::{BackboneLine, BackboneRun};
use crate::response::data::SineLine;
use crate::response::model::{Model, Values};

/// What a model is fitted to.
#[derive(Clone, Copy, Debug)]
pub(in crate::response) struct Data<'a> {
    pub(in crate::response) lines: &'a [SineLine],
    pub(in crate::response) backbones: &'a [&'a BackboneRun],
}

impl<'a> Data<'a> {
    /// Numbers beyond the amplitudes.
    pub(in crate::response) fn count(&self) -> usize {
        let of_curves = self.backbones.iter().map(|run| run.count());
        2 * self.lines.len() + of_curves.sum::<usize>()
    }

    /// Points of all backbones and decays.
    pub(in crate::response) fn points(&self) -> impl Iterator<Item = &'a BackboneLine> + use<'a> {
        self.backbones.iter().flat_map(|run| &run.lines)
    }
}

/// Where a fit starts.
#[derive(Clone, Copy, Debug)]
pub(in crate::response) struct Start<'a> {
    pub(super) values: &'a Values,
    /// The relative amplitude of each line, m, where an earlier fit to the same lines found them.
    pub(super) amplitudes_m: Option<&'a [f64]>,
}

impl<'a> From<&'a Values> for Start<'a> {
    fn from(values: &'a Values) -> Self {
        Self {
            values,
            amplitudes_m: None,
        }
    }
}

/// A fit goes on with the amplitudes that it has: a line may have two of them, of which another guess could be the worse one.
impl<'a> From<&'a Fit> for Start<'a> {
    fn from(fit: &'a Fit) -> Self {
        Self {
            values: &fit.values,
            amplitudes_m: Some(&fit.amplitudes_m),
        }
    }
}

impl Start<'_> {
    /// The relative amplitude of each line, m.
    pub(super) fn amplitudes_m(&self, model: &Model, data: Data<'_>) -> Vec<f64> {
        match self.amplitudes_m {
            Some(found) if found.len() == data.lines.len() => found.to_vec(),
            _ => {
                let lines = data.lines.iter();
                lines
                    .map(|line| model.relative_amplitude(self.values, line))
                    .collect()
            }
        }
    }

    /// Largest displacement that it makes of the data, m.
    pub(super) fn largest_m(&self, model: &Model, data: Data<'_>) -> f64 {
        let of_curves = data.backbones.iter().map(|run| run.largest_m());
        let of_lines = self.amplitudes_m(model, data).into_iter();
        of_lines.chain(of_curves).fold(f64::MIN_POSITIVE, f64::max)
    }
}
