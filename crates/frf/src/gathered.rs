//! One function's lines as they come out of a file, with those outside the wanted band left behind at once.

use num_complex::Complex64;

use super::{Dof, Frf, FrfError, Quantity, Selection};

/// Lines of one function, in the file's units.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Gathered {
    pub(super) frequency_hz: Vec<f64>,
    pub(super) values: Vec<Complex64>,
    /// First and last frequency of all lines met, Hz.
    ends_hz: Option<[f64; 2]>,
}

impl Gathered {
    /// Lines that are in the band already, of a function that has lines at `all_hz`.
    pub(super) fn of_band(frequency_hz: Vec<f64>, values: Vec<Complex64>, all_hz: &[f64]) -> Self {
        Self {
            frequency_hz,
            values,
            ends_hz: all_hz
                .first()
                .copied()
                .zip(all_hz.last().copied())
                .map(<[f64; 2]>::from),
        }
    }

    /// Keeps a line if it is wanted.
    pub(super) fn push(&mut self, selection: &Selection, hz: f64, value: Complex64) {
        self.ends_hz = Some([self.ends_hz.map_or(hz, |[first, _]| first), hz]);
        if selection.wants_line(hz) {
            self.frequency_hz.push(hz);
            self.values.push(value);
        }
    }

    /// The lines as a receptance in SI units; they were of `quantity`, and one of their units is `to_si` SI units.
    pub(super) fn into_frf(
        self,
        (response, reference): (Dof, Dof),
        quantity: Quantity,
        to_si: f64,
        selection: &Selection,
    ) -> Result<Frf, FrfError> {
        self.check_band(selection)?;
        let values = self.values.into_iter().map(|value| value * to_si).collect();
        Frf::from_measured(response, reference, quantity, self.frequency_hz, values)
    }

    /// Lines that there are, but none of them in the band.
    fn check_band(&self, selection: &Selection) -> Result<(), FrfError> {
        match (self.values.is_empty(), selection.band_hz(), self.ends_hz) {
            (true, Some([from_hz, to_hz]), Some([first_hz, last_hz])) => Err(FrfError::EmptyBand {
                from_hz,
                to_hz,
                first_hz,
                last_hz,
            }),
            _ => Ok(()),
        }
    }
}
