//! The functions of one structure over one frequency axis, looked up by pair of degrees of freedom.

mod axis;
mod coherence;
mod receptance;

use std::collections::{BTreeMap, BTreeSet};

use num_complex::Complex64;

use super::{Dof, Frf, FrfError};
use axis::first_difference;
pub use receptance::Receptance;

/// Receptances of one structure, all over the same frequencies.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfSet {
    frequency_hz: Vec<f64>,
    receptances: BTreeMap<(Dof, Dof), Vec<Complex64>>,
    gamma_squared: BTreeMap<(Dof, Dof), Vec<f64>>,
    /// σ²/|H|² as these tell it, with lines beside them that are not in this set any more.
    relative_variances: BTreeMap<(Dof, Dof), Vec<f64>>,
    averages: Option<f64>,
    /// Pairs that the file has but nobody asked for.
    left_out: BTreeSet<(Dof, Dof)>,
}

impl FrfSet {
    /// A set from functions that share their frequency axis; the first function's axis is kept.
    ///
    /// Axes agree if no line differs by more than what the six digits of a universal file can show
    /// (6·10⁻⁶ of the frequency) and by at most a twentieth of the distance to the next line.
    ///
    /// # Errors
    /// [`FrfError::NoFunctions`], [`FrfError::DifferingFrequencyAxes`], [`FrfError::DifferingLineCounts`] or
    /// [`FrfError::DuplicatePair`].
    pub fn new(functions: Vec<Frf>) -> Result<Self, FrfError> {
        let mut functions = functions.into_iter();
        let first = functions.next().ok_or(FrfError::NoFunctions)?;
        let first_pair = (first.response(), first.reference());
        let (frequency_hz, values) = first.into_parts();
        let mut receptances = BTreeMap::from([(first_pair, values)]);
        for function in functions {
            let pair = (function.response(), function.reference());
            let (axis_hz, values) = function.into_parts();
            if let Some(index) = first_difference(&frequency_hz, &axis_hz) {
                return Err(FrfError::DifferingFrequencyAxes {
                    first: first_pair,
                    second: pair,
                    line: index + 1,
                    first_hz: frequency_hz[index],
                    second_hz: axis_hz[index],
                });
            }
            if frequency_hz.len() != axis_hz.len() {
                return Err(FrfError::DifferingLineCounts {
                    first: first_pair,
                    second: pair,
                    first_lines: frequency_hz.len(),
                    second_lines: axis_hz.len(),
                });
            }
            if receptances.insert(pair, values).is_some() {
                return Err(FrfError::DuplicatePair {
                    response: pair.0,
                    reference: pair.1,
                });
            }
        }
        Ok(Self {
            frequency_hz,
            receptances,
            gamma_squared: BTreeMap::new(),
            relative_variances: BTreeMap::new(),
            averages: None,
            left_out: BTreeSet::new(),
        })
    }

    /// The frequency of each line, Hz: not negative, strictly increasing.
    #[must_use]
    pub fn frequency_hz(&self) -> &[f64] {
        &self.frequency_hz
    }

    /// The number of lines, at least one.
    #[must_use]
    pub fn line_count(&self) -> usize {
        self.frequency_hz.len()
    }

    pub(super) fn knowing_of(mut self, left_out: BTreeSet<(Dof, Dof)>) -> Self {
        self.left_out = left_out;
        self
    }

    /// The pair of a measured function between these two, whatever the signs of either.
    fn measured_pair(&self, response: Dof, reference: Dof) -> Option<(Dof, Dof)> {
        let (turned, other) = (response.flipped(), reference.flipped());
        [
            (response, reference),
            (turned, other),
            (turned, reference),
            (response, other),
        ]
        .into_iter()
        .find(|pair| self.receptances.contains_key(pair))
    }

    /// Response, reference and receptance (SI units) of every measured function, sorted by response, then reference.
    pub fn functions(&self) -> impl ExactSizeIterator<Item = (Dof, Dof, &[Complex64])> {
        self.receptances
            .iter()
            .map(|(&(response, reference), values)| (response, reference, values.as_slice()))
    }

    /// The same functions between `from_hz` and `to_hz` (Hz), both included.
    ///
    /// # Errors
    /// [`FrfError::EmptyBand`] if no line lies in the band.
    pub fn restricted_to(&self, from_hz: f64, to_hz: f64) -> Result<Self, FrfError> {
        let start = self.frequency_hz.partition_point(|&hz| hz < from_hz);
        let end = self.frequency_hz.partition_point(|&hz| hz <= to_hz);
        // `partition_point` with a NaN bound gives 0, so the band is then empty or starts at the first line.
        if from_hz.is_nan() || start >= end {
            return Err(FrfError::EmptyBand {
                from_hz,
                to_hz,
                first_hz: self.frequency_hz[0],
                last_hz: self.frequency_hz[self.frequency_hz.len() - 1],
            });
        }
        let lines: Vec<usize> = (start..end).collect();
        Ok(self.at(&lines))
    }

    /// The same functions at the lines within `bands_hz` (Hz, ends included; all lines where there is no band), and of these at
    /// the first and then every so many.
    ///
    /// # Errors
    /// [`FrfError::EmptyBand`] for a band without a line.
    pub fn thinned(&self, bands_hz: &[[f64; 2]], every: usize) -> Result<Self, FrfError> {
        for &[from_hz, to_hz] in bands_hz {
            self.restricted_to(from_hz, to_hz)?;
        }
        let is_within = |&line: &usize| {
            let hz = self.frequency_hz[line];
            bands_hz.is_empty() || bands_hz.iter().any(|&[from, to]| (from..=to).contains(&hz))
        };
        let lines = (0..self.frequency_hz.len()).filter(is_within);
        let lines: Vec<usize> = lines.step_by(every.max(1)).collect();
        Ok(self.at(&lines))
    }

    fn at(&self, lines: &[usize]) -> Self {
        fn chosen<T: Copy>(values: &[T], lines: &[usize]) -> Vec<T> {
            lines.iter().map(|&line| values[line]).collect()
        }
        type OfPairs<T> = BTreeMap<(Dof, Dof), Vec<T>>;
        fn of_pairs<T: Copy>(all: &OfPairs<T>, lines: &[usize]) -> OfPairs<T> {
            let all = all.iter();
            all.map(|(&pair, own)| (pair, chosen(own, lines))).collect()
        }
        Self {
            frequency_hz: chosen(&self.frequency_hz, lines),
            receptances: of_pairs(&self.receptances, lines),
            gamma_squared: of_pairs(&self.gamma_squared, lines),
            relative_variances: of_pairs(&self.relative_variances, lines),
            averages: self.averages,
            left_out: self.left_out.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn dof(text: &str) -> Dof {
        text.parse().unwrap()
    }

    pub(super) fn function(
        response: &str,
        reference: &str,
        frequency_hz: &[f64],
        scale: f64,
    ) -> Frf {
        let values = frequency_hz
            .iter()
            .map(|hz| Complex64::new(scale * hz, scale))
            .collect();
        Frf::new(dof(response), dof(reference), frequency_hz.to_vec(), values).unwrap()
    }

    pub(super) const AXIS: [f64; 3] = [1.0, 2.0, 4.0];

    pub(super) fn small_set() -> FrfSet {
        FrfSet::new(vec![
            function("11:-Y", "2:+Y", &AXIS, 3.0),
            function("2:Y", "2:Y", &AXIS, 5.0),
            function("3:RZ", "2:-Y", &AXIS, 7.0),
        ])
        .unwrap()
    }

    #[test]
    fn differing_axes_are_refused_with_both_functions_and_the_line() {
        let error = FrfSet::new(vec![
            function("1:Y", "2:Y", &AXIS, 1.0),
            function("3:Y", "2:Y", &[1.0, 2.5, 4.0], 1.0),
        ])
        .unwrap_err();
        assert!(matches!(
            error,
            FrfError::DifferingFrequencyAxes {
                line: 2,
                first_hz: 2.0,
                second_hz: 2.5,
                ..
            }
        ));
        let error = FrfSet::new(vec![
            function("1:Y", "2:Y", &AXIS, 1.0),
            function("3:Y", "2:Y", &AXIS[..2], 1.0),
        ])
        .unwrap_err();
        assert!(matches!(
            error,
            FrfError::DifferingLineCounts {
                first_lines: 3,
                second_lines: 2,
                ..
            }
        ));
    }

    #[test]
    fn duplicates_and_emptiness_are_refused() {
        let twice = vec![function("1:Y", "2:Y", &AXIS, 1.0); 2];
        assert!(matches!(
            FrfSet::new(twice).unwrap_err(),
            FrfError::DuplicatePair { response, .. } if response == dof("1:Y")
        ));
        assert!(matches!(
            FrfSet::new(vec![]).unwrap_err(),
            FrfError::NoFunctions
        ));
    }

    #[test]
    fn a_band_includes_its_ends() {
        let band = small_set().restricted_to(2.0, 4.0).unwrap();
        assert_eq!(band.frequency_hz(), [2.0, 4.0]);
        let found = band.receptance(dof("2:Y"), dof("2:Y")).unwrap();
        assert_eq!(
            found.values(),
            [Complex64::new(10.0, 5.0), Complex64::new(20.0, 5.0)]
        );
        let thin = small_set().thinned(&[[1.0, 1.0], [2.0, 4.0]], 2).unwrap();
        assert_eq!(thin.frequency_hz(), [1.0, 4.0]);
        let found = thin.receptance(dof("2:Y"), dof("2:Y")).unwrap();
        assert_eq!(found.values()[1], Complex64::new(20.0, 5.0));
        assert!(small_set().thinned(&[[2.5, 3.5]], 1).is_err());
        for (from, to) in [
            (2.5, 3.5),
            (4.0, 2.0),
            (5.0, 9.0),
            (f64::NAN, 2.0),
            (1.0, f64::NAN),
        ] {
            let error = small_set().restricted_to(from, to).unwrap_err();
            assert!(matches!(
                error,
                FrfError::EmptyBand {
                    first_hz: 1.0,
                    last_hz: 4.0,
                    ..
                }
            ));
        }
    }
}
