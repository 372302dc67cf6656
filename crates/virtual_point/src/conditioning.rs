//! How well the places tell six motions apart, in a number that does not depend on units.

use std::fmt;

use nalgebra::{DMatrix, Vector6};

use crate::unseen::{UnseenMotion, plain};
use crate::words::short;
use crate::{Places, Role, VirtualPointError};

/// Above this, errors of positions and noise grow much in the motion that is seen least.
const POOR: f64 = 10.0;

/// Fewer channels or impacts than this leave little to judge them by.
const FEW: usize = 9;

/// Singular values below this share of the largest one are none: no position is known to a part in a million.
const NOTHING: f64 = 1e-6;

/// What the singular values of R s say, s = diag(1, 1, 1, 1/ℓ, 1/ℓ, 1/ℓ).
#[derive(Clone, Debug, PartialEq)]
pub struct Conditioning {
    /// Channels or impacts.
    pub role: Role,
    /// How many there are.
    pub count: usize,
    /// ℓ: root mean square of the distances from the virtual point, m.
    pub length_m: f64,
    /// Largest over smallest singular value.
    pub condition: f64,
    /// The motion with the smallest one.
    pub least_seen: UnseenMotion,
}

/// What would make an estimate better.
#[derive(Clone, Debug, PartialEq)]
pub enum Advice {
    /// The places are in a poor arrangement.
    Poor {
        /// Channels or impacts.
        role: Role,
        /// Largest over smallest singular value.
        condition: f64,
        /// The motion that they tell least of.
        least_seen: UnseenMotion,
    },
    /// There are few of them.
    Few {
        /// Channels or impacts.
        role: Role,
        /// How many there are.
        count: usize,
    },
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Poor {
                role,
                condition,
                least_seen,
            } => write!(
                f,
                "{role}s: found a condition number of {}, expected {POOR} or less: they tell little of the \
                 {least_seen}; spread them, or add one that moves with it",
                short(*condition)
            ),
            Self::Few { role, count } => write!(
                f,
                "{role}s: found {count}, 9 to 12 are better: the more there are beyond 6, the more errors show"
            ),
        }
    }
}

impl Conditioning {
    /// Judges places.
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::TooFew`] for fewer than six, [`VirtualPointError::Unseen`] if they leave a motion open.
    pub fn of(places: &Places) -> Result<Self, VirtualPointError> {
        let (role, count) = (places.role(), places.count());
        if count < 6 {
            let (found, least) = (count, 6);
            return Err(VirtualPointError::TooFew { role, found, least });
        }
        let length_m = places.length_m();
        let (values, motions) = spectrum(places.matrix(), length_m);
        let largest = values.max();
        let open: Vec<usize> = (0..6).filter(|&i| values[i] <= NOTHING * largest).collect();
        if !open.is_empty() {
            let rank = 6 - open.len();
            let basis = DMatrix::from_fn(open.len(), 6, |i, j| motions[(open[i], j)]);
            let motions = plain(&basis, length_m);
            return Err(VirtualPointError::Unseen {
                role,
                rank,
                motions,
            });
        }
        let least = values.imin();
        let motion = Vector6::from_fn(|j, _| motions[(least, j)]);
        Ok(Self {
            role,
            count,
            length_m,
            condition: largest / values[least],
            least_seen: UnseenMotion::of(&motion, length_m),
        })
    }

    /// What would make it better: nothing for nine places or more in a good arrangement.
    #[must_use]
    pub fn advice(&self) -> Vec<Advice> {
        let (role, count, condition) = (self.role, self.count, self.condition);
        let mut advice = Vec::new();
        if condition > POOR {
            let least_seen = self.least_seen;
            advice.push(Advice::Poor {
                role,
                condition,
                least_seen,
            });
        }
        if count < FEW {
            advice.push(Advice::Few { role, count });
        }
        advice
    }
}

/// Whether rows determine six motions.
pub(crate) fn is_complete(matrix: &DMatrix<f64>, length_m: f64) -> bool {
    matrix.nrows() >= 6 && {
        let (values, _) = spectrum(matrix, length_m);
        values.min() > NOTHING * values.max()
    }
}

/// Singular values of R s, and the motion (u, θ) of each as a row.
fn spectrum(matrix: &DMatrix<f64>, length_m: f64) -> (nalgebra::DVector<f64>, DMatrix<f64>) {
    let scale = |j: usize| if j < 3 { 1.0 } else { 1.0 / length_m };
    let scaled = DMatrix::from_fn(matrix.nrows(), 6, |i, j| matrix[(i, j)] * scale(j));
    // six by six, so that the decomposition has all six motions; R s = Q (upper triangle)
    let triangle = scaled.qr().r();
    let eigen = nalgebra::SVD::new(triangle, false, true);
    let rows = eigen.v_t.unwrap_or_else(|| DMatrix::identity(6, 6));
    let motions = DMatrix::from_fn(6, 6, |i, j| rows[(i, j)] * scale(j));
    (eigen.singular_values, motions)
}
