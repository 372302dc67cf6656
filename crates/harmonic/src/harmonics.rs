//! Which harmonics a periodic motion is made of, and where the coefficients of each stand in a list.

use super::HarmonicError;

/// The harmonics of a periodic motion r(t) = a₀ + Σ (a_h cos hωt + b_h sin hωt).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Harmonics {
    has_constant: bool,
    /// Ascending.
    orders: Vec<usize>,
}

impl Harmonics {
    /// More harmonics than this are not accepted.
    pub const MOST: usize = 1000;

    /// The constant term and all harmonics up to the `highest`.
    ///
    /// # Errors
    /// [`HarmonicError::Harmonics`] if that is none or more than [`Harmonics::MOST`].
    pub fn all(highest: usize) -> Result<Self, HarmonicError> {
        Self::checked(true, highest, 1)
    }

    /// The odd harmonics up to the `highest`: enough where the loads are purely harmonic, since the joint's law is odd,
    /// unless the motion breaks that symmetry.
    ///
    /// # Errors
    /// As [`Harmonics::all`].
    pub fn odd(highest: usize) -> Result<Self, HarmonicError> {
        Self::checked(false, highest, 2)
    }

    fn checked(has_constant: bool, highest: usize, step: usize) -> Result<Self, HarmonicError> {
        if !(1..=Self::MOST).contains(&highest) {
            return Err(HarmonicError::Harmonics {
                found: highest,
                most: Self::MOST,
            });
        }
        Ok(Self {
            has_constant,
            orders: (1..=highest).step_by(step).collect(),
        })
    }

    /// Whether the constant term is among them.
    #[must_use]
    pub fn has_constant(&self) -> bool {
        self.has_constant
    }

    /// Orders of the harmonics, ascending from 1; the constant term is not among them.
    #[must_use]
    pub fn orders(&self) -> &[usize] {
        &self.orders
    }

    /// Highest order.
    #[must_use]
    pub fn highest(&self) -> usize {
        self.orders.last().copied().unwrap_or(1)
    }

    /// Whether all orders are odd and there is no constant term, so that half a period tells everything.
    pub(super) fn are_odd(&self) -> bool {
        !self.has_constant && self.orders.iter().all(|order| order % 2 == 1)
    }

    /// Number of real coefficients of one DOF: the constant, then cosine and sine of each harmonic.
    pub(super) fn slots(&self) -> usize {
        usize::from(self.has_constant) + 2 * self.orders.len()
    }

    /// Each harmonic's order and the place of its cosine coefficient, after which comes that of the sine.
    pub(super) fn places(&self) -> impl Iterator<Item = (usize, usize)> + Clone + '_ {
        let first = usize::from(self.has_constant);
        let orders = self.orders.iter().enumerate();
        orders.map(move |(n, &order)| (order, first + 2 * n))
    }

    /// Place of the fundamental's cosine coefficient.
    pub(super) fn fundamental(&self) -> usize {
        usize::from(self.has_constant)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odd_harmonics_have_no_constant_term() {
        let harmonics = Harmonics::odd(6).unwrap();
        assert_eq!(harmonics.orders(), [1, 3, 5]);
        assert_eq!(harmonics.slots(), 6);
        assert!(harmonics.are_odd());
        let all = Harmonics::all(3).unwrap();
        assert_eq!(all.places().collect::<Vec<_>>(), [(1, 1), (2, 3), (3, 5)]);
        assert!(!all.are_odd());
    }

    #[test]
    fn no_harmonics_are_refused() {
        assert!(Harmonics::all(0).is_err());
        assert!(Harmonics::odd(Harmonics::MOST + 1).is_err());
    }
}
