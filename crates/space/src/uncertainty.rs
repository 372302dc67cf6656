//! How well the 21 numbers of a matrix are known, so that nothing is said of what their deviations blur.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::{Entry, SpaceError};

/// Two of a pair of equal eigenvalues differ by more than this many deviations of their difference in one case of
/// twenty: noise parts them by √(e₁² + e₂²) of two independent numbers, so this is √χ²₂(95 %) = √(−2 ln 0.05).
pub(crate) const APART: f64 = 2.447_746_830_680_816;

/// What is known of the errors of a symmetric matrix, its numbers in the order of [`Entry::ALL`].
#[derive(Clone, Debug, PartialEq)]
pub enum Uncertainty {
    /// The matrix is exact, up to rounding.
    None,
    /// Standard deviations, with errors that are independent.
    Deviations([f64; 21]),
    /// Covariance, 21 × 21.
    Covariance(DMatrix<f64>),
}

impl Uncertainty {
    /// Refuses what is no deviation or covariance.
    pub(crate) fn checked(&self) -> Result<(), SpaceError> {
        let (what, least) = match self {
            Self::None => return Ok(()),
            Self::Deviations(deviations) => (
                "deviation of the joint's matrix",
                deviations.iter().copied().fold(0.0, least),
            ),
            Self::Covariance(covariance) => {
                let wrong = [covariance.nrows(), covariance.ncols()]
                    .into_iter()
                    .find(|&size| size != 21);
                if let Some(found) = wrong {
                    let what = "rows and columns of the covariance";
                    return Err(SpaceError::Size {
                        what,
                        found,
                        expected: 21,
                    });
                }
                if !covariance.iter().all(|number| number.is_finite()) {
                    return Err(SpaceError::NotFinite {
                        what: "the covariance",
                    });
                }
                let variances = covariance.diagonal();
                (
                    "variance of the joint's matrix",
                    variances.iter().copied().fold(0.0, least),
                )
            }
        };
        if least >= 0.0 {
            return Ok(());
        }
        Err(SpaceError::Value {
            what,
            found: least,
            expected: "a finite number that is not negative",
        })
    }

    /// Standard deviation of what has these derivatives by the 21 numbers.
    pub(crate) fn deviation(&self, by_numbers: &[f64; 21]) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Deviations(deviations) => {
                let parts = deviations
                    .iter()
                    .zip(by_numbers)
                    .map(|(deviation, by)| (deviation * by).powi(2));
                Some(parts.sum::<f64>().sqrt())
            }
            Self::Covariance(covariance) => {
                let gradient = DVector::from_row_slice(by_numbers);
                Some(gradient.dot(&(covariance * &gradient)).max(0.0).sqrt())
            }
        }
    }
}

/// The smaller one; what is no finite number is smallest.
fn least(one: f64, other: f64) -> f64 {
    if other.is_finite() {
        one.min(other)
    } else {
        f64::NEG_INFINITY
    }
}

/// Derivatives of wᵀ K w by the 21 numbers of K.
pub(crate) fn of_square(w: &Vector6<f64>) -> [f64; 21] {
    Entry::ALL.map(|Entry { row, column }| {
        let product = w[row.index()] * w[column.index()];
        if row == column {
            product
        } else {
            2.0 * product
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::scattered;
    use bolted_joint_testing::close;

    #[test]
    fn independent_errors_are_a_diagonal_covariance() {
        let deviations = scattered::<21>(3).map(f64::abs);
        let gradient = of_square(&Vector6::from(scattered::<6>(4)));
        let squares = DVector::from_iterator(21, deviations.iter().map(|d| d * d));
        let covariance = Uncertainty::Covariance(DMatrix::from_diagonal(&squares));
        let independent = Uncertainty::Deviations(deviations);
        close(
            covariance.deviation(&gradient).unwrap(),
            independent.deviation(&gradient).unwrap(),
            1e-14,
        );
        assert_eq!(Uncertainty::None.deviation(&gradient), None);
        close(APART, (-2.0 * 0.05_f64.ln()).sqrt(), 1e-15);
    }

    #[test]
    fn derivatives_of_a_square_are_its_differences() {
        let w = Vector6::from(scattered::<6>(5));
        for (entry, by) in Entry::ALL.iter().zip(of_square(&w)) {
            close(w.dot(&(entry.unit() * w)), by, 1e-14);
        }
    }

    #[test]
    fn what_is_no_deviation_is_refused() {
        assert_eq!(Uncertainty::None.checked(), Ok(()));
        assert_eq!(Uncertainty::Deviations([0.0; 21]).checked(), Ok(()));
        for wrong in [-1.0, f64::NAN, f64::INFINITY] {
            let mut deviations = [1.0; 21];
            deviations[7] = wrong;
            assert!(matches!(
                Uncertainty::Deviations(deviations).checked(),
                Err(SpaceError::Value { .. })
            ));
        }
        let small = Uncertainty::Covariance(DMatrix::zeros(21, 20));
        assert!(matches!(
            small.checked(),
            Err(SpaceError::Size {
                found: 20,
                expected: 21,
                ..
            })
        ));
        let negative = Uncertainty::Covariance(-DMatrix::identity(21, 21));
        assert!(matches!(negative.checked(), Err(SpaceError::Value { .. })));
        let broken = Uncertainty::Covariance(DMatrix::from_element(21, 21, f64::NAN));
        assert!(matches!(
            broken.checked(),
            Err(SpaceError::NotFinite { .. })
        ));
    }
}
