//! One frequency response function: a receptance over frequency, between two degrees of freedom.

use num_complex::Complex64;

use super::{Dof, FrfError, Quantity};

/// A receptance from one load to one response over its own frequency axis.
///
/// Values are SI: m/N, rad/N, m/(N·m) or rad/(N·m), by the kinds of the two degrees of freedom.
/// Frequencies are finite, not negative and strictly increasing, values are finite, and there is at least one line.
#[derive(Debug, Clone, PartialEq)]
pub struct Frf {
    response: Dof,
    reference: Dof,
    frequency_hz: Vec<f64>,
    receptance: Vec<Complex64>,
}

impl Frf {
    /// A function from a receptance in SI units, one value for each frequency in Hz.
    ///
    /// # Errors
    /// [`FrfError::LengthsDiffer`], [`FrfError::NoLines`], [`FrfError::FrequencyNotAllowed`],
    /// [`FrfError::FrequencyNotIncreasing`] or [`FrfError::ValueNotFinite`].
    pub fn new(
        response: Dof,
        reference: Dof,
        frequency_hz: Vec<f64>,
        receptance: Vec<Complex64>,
    ) -> Result<Self, FrfError> {
        let function = Self {
            response,
            reference,
            frequency_hz,
            receptance,
        };
        function.check()?;
        Ok(function)
    }

    /// A function from `values` of a measured `quantity` in SI units (m/N, m/(s·N) or m/(s²·N), rad and N·m likewise).
    ///
    /// A line at 0 Hz of a mobility or an accelerance is left out: the static receptance cannot be had from it.
    ///
    /// # Errors
    /// As [`Frf::new`]; [`FrfError::NoLines`] also if the only line was at 0 Hz.
    pub fn from_measured(
        response: Dof,
        reference: Dof,
        quantity: Quantity,
        frequency_hz: Vec<f64>,
        values: Vec<Complex64>,
    ) -> Result<Self, FrfError> {
        let measured = Self::new(response, reference, frequency_hz, values)?;
        let (frequency_hz, receptance) = measured
            .frequency_hz
            .iter()
            .zip(&measured.receptance)
            .filter_map(|(&hz, &value)| Some((hz, quantity.to_receptance(value, hz)?)))
            .unzip();
        Self::new(response, reference, frequency_hz, receptance)
    }

    fn check(&self) -> Result<(), FrfError> {
        let (response, reference) = (self.response, self.reference);
        if self.frequency_hz.len() != self.receptance.len() {
            return Err(FrfError::LengthsDiffer {
                response,
                reference,
                frequencies: self.frequency_hz.len(),
                values: self.receptance.len(),
            });
        }
        if self.frequency_hz.is_empty() {
            return Err(FrfError::NoLines {
                response,
                reference,
            });
        }
        let mut previous_hz = None;
        for (index, (&hz, value)) in self.frequency_hz.iter().zip(&self.receptance).enumerate() {
            let line = index + 1;
            if !hz.is_finite() || hz < 0.0 {
                return Err(FrfError::FrequencyNotAllowed {
                    response,
                    reference,
                    line,
                    found_hz: hz,
                });
            }
            if let Some(previous_hz) = previous_hz.filter(|previous| *previous >= hz) {
                return Err(FrfError::FrequencyNotIncreasing {
                    response,
                    reference,
                    line,
                    previous_hz,
                    found_hz: hz,
                });
            }
            if !value.is_finite() {
                return Err(FrfError::ValueNotFinite {
                    response,
                    reference,
                    line,
                    frequency_hz: hz,
                    found: *value,
                });
            }
            previous_hz = Some(hz);
        }
        Ok(())
    }

    /// Where and along what the structure responds.
    #[must_use]
    pub fn response(&self) -> Dof {
        self.response
    }

    /// Where and along what it is loaded.
    #[must_use]
    pub fn reference(&self) -> Dof {
        self.reference
    }

    /// The frequency of each line, Hz.
    #[must_use]
    pub fn frequency_hz(&self) -> &[f64] {
        &self.frequency_hz
    }

    /// The receptance at each line, SI units.
    #[must_use]
    pub fn receptance(&self) -> &[Complex64] {
        &self.receptance
    }

    pub(super) fn into_parts(self) -> (Vec<f64>, Vec<Complex64>) {
        (self.frequency_hz, self.receptance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dof(text: &str) -> Dof {
        text.parse().unwrap()
    }

    fn function(frequency_hz: &[f64], values: &[Complex64]) -> Result<Frf, FrfError> {
        Frf::new(
            dof("1:Y"),
            dof("2:Y"),
            frequency_hz.to_vec(),
            values.to_vec(),
        )
    }

    const ONE: Complex64 = Complex64::new(1.0, 0.0);

    #[test]
    fn each_broken_rule_is_named_with_its_line() {
        assert!(matches!(
            function(&[1.0], &[]).unwrap_err(),
            FrfError::LengthsDiffer {
                frequencies: 1,
                values: 0,
                ..
            }
        ));
        assert!(matches!(
            function(&[], &[]).unwrap_err(),
            FrfError::NoLines { .. }
        ));
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                function(&[0.5, bad], &[ONE, ONE]).unwrap_err(),
                FrfError::FrequencyNotAllowed { line: 2, .. }
            ));
        }
        for second in [1.0, 0.5] {
            assert!(matches!(
                function(&[1.0, second], &[ONE, ONE]).unwrap_err(),
                FrfError::FrequencyNotIncreasing {
                    line: 2,
                    previous_hz: 1.0,
                    ..
                }
            ));
        }
        let error = function(&[1.0, 2.0], &[ONE, Complex64::new(0.0, f64::NAN)]).unwrap_err();
        assert!(matches!(error, FrfError::ValueNotFinite { line: 2, .. }));
        assert!(error.to_string().contains("1:+Y") && error.to_string().contains("2 Hz"));
    }

    #[test]
    fn conversion_leaves_out_zero_frequency_unless_it_is_receptance() {
        let measured = |quantity| {
            Frf::from_measured(
                dof("1:Y"),
                dof("2:Y"),
                quantity,
                vec![0.0, 1.0],
                vec![ONE, ONE],
            )
        };
        assert_eq!(
            measured(Quantity::Receptance).unwrap().frequency_hz(),
            [0.0, 1.0]
        );
        let from_accelerance = measured(Quantity::Accelerance).unwrap();
        assert_eq!(from_accelerance.frequency_hz(), [1.0]);
        // −1/(2π)²
        assert!((from_accelerance.receptance()[0].re + 0.025_330_295_910_584_444).abs() < 1e-17);
        let only_static = Frf::from_measured(
            dof("1:Y"),
            dof("2:Y"),
            Quantity::Mobility,
            vec![0.0],
            vec![ONE],
        );
        assert!(matches!(only_static.unwrap_err(), FrfError::NoLines { .. }));
    }
}
