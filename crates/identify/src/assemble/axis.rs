//! The frequencies of an assembly, to which every other file of a study has to agree.

use std::path::Path;

use super::super::error::IdentifyError;

/// The assembly's frequencies within the band, to which every other file has to agree.
pub(super) struct Axis<'a> {
    pub(super) path: &'a Path,
    pub(super) frequency_hz: &'a [f64],
}

impl Axis<'_> {
    pub(super) fn first_hz(&self) -> f64 {
        self.frequency_hz[0]
    }

    pub(super) fn last_hz(&self) -> f64 {
        self.frequency_hz[self.frequency_hz.len() - 1]
    }

    /// First and last frequency, widened by what rounding in another file may have moved them.
    pub(super) fn ends(&self) -> (f64, f64) {
        (
            self.first_hz() * (1.0 - 1e-5),
            self.last_hz() * (1.0 + 1e-5),
        )
    }

    pub(super) fn compare(&self, path: &Path, other_hz: &[f64]) -> Result<(), IdentifyError> {
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-5 * a.abs().max(b.abs());
        let shared = self.frequency_hz.len().min(other_hz.len());
        let first_difference = (0..shared)
            .find(|&line| !same(self.frequency_hz[line], other_hz[line]))
            .or_else(|| (self.frequency_hz.len() != other_hz.len()).then_some(shared));
        let Some(line) = first_difference else {
            return Ok(());
        };
        let show = |axis: &[f64]| {
            axis.get(line)
                .map_or_else(|| "(no line left)".to_owned(), |hz| format!("{hz} Hz"))
        };
        Err(IdentifyError::DifferingAxes {
            first_path: self.path.to_owned(),
            second_path: path.to_owned(),
            from_hz: self.first_hz(),
            to_hz: self.last_hz(),
            line: line + 1,
            first: show(self.frequency_hz),
            second: show(other_hz),
        })
    }
}
