//! The functions of one structure over one frequency axis, looked up by pair of degrees of freedom.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Deref;

use num_complex::Complex64;

use super::coherence::relative_variance;
use super::{Coherence, Dof, Frf, FrfError};

/// Two axes agree where the standard's six printed digits cannot tell them apart …
const AXIS_PRINT_RESOLUTION: f64 = 6e-6;
/// … but never if they differ by more than this part of the distance between lines.
const AXIS_SPACING_SHARE: f64 = 0.05;
/// Rounding of `minimum + i · increment`, always allowed.
const AXIS_ROUNDING: f64 = 1e-12;

/// Receptances of one structure, all over the same frequencies.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfSet {
    frequency_hz: Vec<f64>,
    receptances: BTreeMap<(Dof, Dof), Vec<Complex64>>,
    gamma_squared: BTreeMap<(Dof, Dof), Vec<f64>>,
    averages: Option<f64>,
    /// Pairs that the file has but nobody asked for.
    left_out: BTreeSet<(Dof, Dof)>,
}

/// A receptance found in a set, with how it was found. Dereferences to its values, one for each line, SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Receptance<'set> {
    values: Cow<'set, [Complex64]>,
    measured: (Dof, Dof),
    reciprocal: bool,
}

impl Receptance<'_> {
    /// The receptance at each line, SI units.
    #[must_use]
    pub fn values(&self) -> &[Complex64] {
        &self.values
    }

    /// Response and reference of the measured function behind the values.
    #[must_use]
    pub fn measured_between(&self) -> (Dof, Dof) {
        self.measured
    }

    /// Whether the values come from the transposed function, by Maxwell's reciprocity.
    #[must_use]
    pub fn is_reciprocal(&self) -> bool {
        self.reciprocal
    }

    /// Whether the measured values were negated because one of the two directions was opposite.
    #[must_use]
    pub fn is_negated(&self) -> bool {
        matches!(self.values, Cow::Owned(_))
    }
}

impl Deref for Receptance<'_> {
    type Target = [Complex64];

    fn deref(&self) -> &Self::Target {
        &self.values
    }
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

    /// The same set with the ordinary coherences of its functions, and the number of averages behind them if it is known.
    ///
    /// A coherence belongs to the function of the same two degrees of freedom, whatever their signs; one whose function is
    /// not in the set is left out. Lines that the set does not have (0 Hz of an accelerance) are left out of it.
    ///
    /// # Errors
    /// [`FrfError::CoherenceAxis`] if a line of the set has no coherence; [`FrfError::DuplicateCoherence`];
    /// [`FrfError::Averages`] if the number is below 1 or not finite.
    pub fn with_coherences(
        mut self,
        coherences: Vec<Coherence>,
        averages: Option<f64>,
    ) -> Result<Self, FrfError> {
        if let Some(found) = averages.filter(|n| !(n.is_finite() && *n >= 1.0)) {
            return Err(FrfError::Averages { found });
        }
        self.averages = averages;
        for coherence in coherences {
            let (response, reference) = (coherence.response(), coherence.reference());
            let Some(pair) = self.measured_pair(response, reference) else {
                continue;
            };
            let values = self.on_own_lines(&coherence)?;
            if self.gamma_squared.insert(pair, values).is_some() {
                return Err(FrfError::DuplicateCoherence {
                    response,
                    reference,
                });
            }
        }
        Ok(self)
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

    fn on_own_lines(&self, coherence: &Coherence) -> Result<Vec<f64>, FrfError> {
        let missing = |line: usize| FrfError::CoherenceAxis {
            response: coherence.response(),
            reference: coherence.reference(),
            line: line + 1,
            frequency_hz: self.frequency_hz[line],
        };
        // Only lines before the set's first one may be more: 0 Hz of a mobility or accelerance.
        let surplus = coherence
            .frequency_hz()
            .len()
            .checked_sub(self.frequency_hz.len())
            .ok_or_else(|| missing(coherence.frequency_hz().len()))?;
        match first_difference(&self.frequency_hz, &coherence.frequency_hz()[surplus..]) {
            Some(line) => Err(missing(line)),
            None => Ok(coherence.gamma_squared()[surplus..].to_vec()),
        }
    }

    /// Ordinary coherence γ² at each line of the measured function behind [`FrfSet::receptance`], if it came with the set.
    #[must_use]
    pub fn coherence(&self, response: Dof, reference: Dof) -> Option<&[f64]> {
        let measured = self
            .measured_pair(response, reference)
            .or_else(|| self.measured_pair(reference, response))?;
        self.gamma_squared.get(&measured).map(Vec::as_slice)
    }

    /// The number of averages behind the functions, where it is known.
    #[must_use]
    pub fn averages(&self) -> Option<f64> {
        self.averages
    }

    /// σ²/|H|² at each line of the measured function behind [`FrfSet::receptance`], from its coherence and the averages.
    ///
    /// σ² is that of the complex error, E|Ĥ − H|²: real and imaginary part have half of it each. See
    /// [`relative_variance`](super::relative_variance). `None` without coherence or without the number of averages.
    #[must_use]
    pub fn relative_variance(&self, response: Dof, reference: Dof) -> Option<Vec<f64>> {
        let averages = self.averages?;
        let gamma_squared = self.coherence(response, reference)?;
        Some(
            gamma_squared
                .iter()
                .map(|&gamma_squared| relative_variance(gamma_squared, averages))
                .collect(),
        )
    }

    /// Response, reference and receptance (SI units) of every measured function, sorted by response, then reference.
    pub fn functions(&self) -> impl ExactSizeIterator<Item = (Dof, Dof, &[Complex64])> {
        self.receptances
            .iter()
            .map(|(&(response, reference), values)| (response, reference, values.as_slice()))
    }

    /// The receptance (SI units) at `response` for a load at `reference`.
    ///
    /// Taken from, in this order: the measured pair itself; the pair with one or both directions reversed, negated as
    /// needed; the same two of the transposed pair, by reciprocity. The answer says which it was.
    ///
    /// # Errors
    /// [`FrfError::MissingPair`] with the pairs that are there.
    pub fn receptance(&self, response: Dof, reference: Dof) -> Result<Receptance<'_>, FrfError> {
        self.find(response, reference, false)
            .or_else(|| self.find(reference, response, true))
            .ok_or_else(|| FrfError::MissingPair {
                response,
                reference,
                present: self.present(),
            })
    }

    /// Every pair of the file, sorted, whether it was asked for or not.
    fn present(&self) -> Vec<(Dof, Dof)> {
        let pairs: BTreeSet<_> = self.receptances.keys().chain(&self.left_out).collect();
        pairs.into_iter().copied().collect()
    }

    fn find(&self, response: Dof, reference: Dof, reciprocal: bool) -> Option<Receptance<'_>> {
        let (turned_response, turned_reference) = (response.flipped(), reference.flipped());
        [
            (response, reference),
            (turned_response, turned_reference),
            (turned_response, reference),
            (response, turned_reference),
        ]
        .into_iter()
        .find_map(|measured| {
            let values = self.receptances.get(&measured)?;
            let sign = |(a, b): (Dof, Dof)| a.sign().factor() * b.sign().factor();
            let values = if sign(measured) == sign((response, reference)) {
                Cow::Borrowed(values.as_slice())
            } else {
                Cow::Owned(values.iter().map(|value| -value).collect())
            };
            Some(Receptance {
                values,
                measured,
                reciprocal,
            })
        })
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
        Ok(Self {
            frequency_hz: self.frequency_hz[start..end].to_vec(),
            receptances: self
                .receptances
                .iter()
                .map(|(&pair, values)| (pair, values[start..end].to_vec()))
                .collect(),
            gamma_squared: self
                .gamma_squared
                .iter()
                .map(|(&pair, values)| (pair, values[start..end].to_vec()))
                .collect(),
            averages: self.averages,
            left_out: self.left_out.clone(),
        })
    }
}

/// The index of the first line at which two frequency axes (Hz) differ, over the shorter of the two.
fn first_difference(first_hz: &[f64], second_hz: &[f64]) -> Option<usize> {
    let lines = first_hz.len().min(second_hz.len());
    (0..lines).find(|&index| {
        let (hz, other_hz) = (first_hz[index], second_hz[index]);
        let spacing_hz = match first_hz.get(index + 1) {
            Some(next_hz) => next_hz - hz,
            None => match index.checked_sub(1) {
                Some(before) => hz - first_hz[before],
                None => hz,
            },
        };
        let printed_hz = (AXIS_PRINT_RESOLUTION * hz).min(AXIS_SPACING_SHARE * spacing_hz);
        (hz - other_hz).abs() > printed_hz.max(AXIS_ROUNDING * hz)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dof(text: &str) -> Dof {
        text.parse().unwrap()
    }

    fn function(response: &str, reference: &str, frequency_hz: &[f64], scale: f64) -> Frf {
        let values = frequency_hz
            .iter()
            .map(|hz| Complex64::new(scale * hz, scale))
            .collect();
        Frf::new(dof(response), dof(reference), frequency_hz.to_vec(), values).unwrap()
    }

    const AXIS: [f64; 3] = [1.0, 2.0, 4.0];

    fn small_set() -> FrfSet {
        FrfSet::new(vec![
            function("11:-Y", "2:+Y", &AXIS, 3.0),
            function("2:Y", "2:Y", &AXIS, 5.0),
            function("3:RZ", "2:-Y", &AXIS, 7.0),
        ])
        .unwrap()
    }

    #[test]
    fn a_measured_pair_is_found_as_it_is() {
        let set = small_set();
        let found = set.receptance(dof("11:-Y"), dof("2:Y")).unwrap();
        assert_eq!(found[2], Complex64::new(12.0, 3.0));
        assert_eq!(found.measured_between(), (dof("11:-Y"), dof("2:Y")));
        assert!(!found.is_reciprocal() && !found.is_negated());
        assert_eq!((set.line_count(), set.functions().len()), (3, 3));
    }

    #[test]
    fn a_reversed_direction_negates_and_two_reversed_ones_do_not() {
        let set = small_set();
        let once = set.receptance(dof("11:Y"), dof("2:Y")).unwrap();
        assert_eq!(
            once.values(),
            AXIS.map(|hz| Complex64::new(-3.0 * hz, -3.0))
        );
        assert!(once.is_negated() && !once.is_reciprocal());
        let twice = set.receptance(dof("3:-RZ"), dof("2:Y")).unwrap();
        assert_eq!(twice[0], Complex64::new(7.0, 7.0));
        assert!(!twice.is_negated());
    }

    #[test]
    fn reciprocity_serves_the_transposed_pair_with_its_signs() {
        let set = small_set();
        let found = set.receptance(dof("2:Y"), dof("11:Y")).unwrap();
        assert_eq!(found[1], Complex64::new(-6.0, -3.0));
        assert!(found.is_reciprocal() && found.is_negated());
        assert_eq!(found.measured_between(), (dof("11:-Y"), dof("2:Y")));
    }

    #[test]
    fn the_measured_pair_wins_over_its_transpose_and_its_reverse() {
        let set = FrfSet::new(vec![
            function("1:-Y", "2:Y", &AXIS, 1.0),
            function("2:Y", "1:Y", &AXIS, 2.0),
            function("1:Y", "2:Y", &AXIS, 3.0),
        ])
        .unwrap();
        let at = |response, reference| set.receptance(dof(response), dof(reference)).unwrap()[0].im;
        assert_eq!(at("1:Y", "2:Y"), 3.0);
        assert_eq!(at("2:Y", "1:Y"), 2.0);
        assert_eq!(at("1:-Y", "2:Y"), 1.0);
    }

    #[test]
    fn a_missing_pair_is_named_with_those_present() {
        let error = small_set()
            .receptance(dof("11:Y"), dof("3:RZ"))
            .unwrap_err();
        let message = error.to_string();
        for part in ["11:+Y", "3:+RZ", "2:+Y / 2:+Y", "11:-Y / 2:+Y"] {
            assert!(message.contains(part), "{part} in {message}");
        }
        let many = (1..60)
            .map(|node| function(&format!("{node}:X"), "1:X", &AXIS, 1.0))
            .collect();
        let message = FrfSet::new(many)
            .unwrap()
            .receptance(dof("99:X"), dof("1:X"))
            .unwrap_err()
            .to_string();
        assert!(message.contains("and 47 more"), "{message}");
        assert!(message.contains("12:+X / 1:+X") && !message.contains("13:+X / 1:+X"));
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
    fn axes_agree_within_printed_digits_but_not_within_a_line() {
        let agree = |first: &[f64], second: &[f64]| first_difference(first, second).is_none();
        assert!(agree(&[100.123456, 101.0], &[100.123, 101.0]));
        assert!(!agree(&[100.123456, 101.0], &[100.12, 101.0]));
        // At 12 kHz the sixth digit is 0.1 Hz, far more than the distance between these lines.
        assert!(!agree(&[12_000.0, 12_000.03], &[12_000.02, 12_000.05]));
        assert!(agree(&[0.1 + 0.2], &[0.3]));
        assert!(!agree(&[0.0, 1.0], &[1e-6, 1.0]));
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
