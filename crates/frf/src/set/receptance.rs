//! A receptance found in a set, and how it was found.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::ops::Deref;

use num_complex::Complex64;

use super::FrfSet;
use crate::{Dof, FrfError};

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
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use crate::FrfSet;
    use crate::set::tests::{AXIS, dof, function, small_set};

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
}
