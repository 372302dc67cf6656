//! The five numbers of one bolt by name, and when they are those of a passive joint.

use crate::SpaceError;

/// `k_x` `k_rx` and `k_x_ry`² that differ by less than this share are the same.
const ROUNDING: f64 = 1e-14;

/// Stiffness (or damping) of one bolt in axes whose z is the bolt's, in the order of its model's unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoltNumbers {
    /// `k_x` = `k_y`: across the bolt, N/m
    pub k_x: f64,
    /// `k_z`: along the bolt, N/m
    pub k_z: f64,
    /// `k_rx` = `k_ry`: bending, N·m/rad
    pub k_rx: f64,
    /// `k_rz`: torsion, N·m/rad
    pub k_rz: f64,
    /// `k_x_ry` = −`k_y_rx`: force across the bolt by bending, N
    pub k_x_ry: f64,
}

impl BoltNumbers {
    /// The unknowns of the model of one bolt with mirrors.
    #[must_use]
    pub const fn unknowns(&self) -> [f64; 5] {
        [self.k_x, self.k_z, self.k_rx, self.k_rz, self.k_x_ry]
    }

    /// Refuses numbers whose matrix is not positive semidefinite.
    ///
    /// The matrix falls into `k_z`, `k_rz` and twice the block (`k_x`, `k_x_ry`; `k_x_ry`, `k_rx`), so what must hold
    /// is: `k_x`, `k_z`, `k_rx`, `k_rz` ≥ 0 and `k_x` `k_rx` ≥ `k_x_ry`².
    ///
    /// # Errors
    ///
    /// [`SpaceError::NotPassive`] with the first condition that does not hold.
    pub fn semidefinite(&self) -> Result<(), SpaceError> {
        let (own, coupled) = (self.k_x * self.k_rx, self.k_x_ry * self.k_x_ry);
        // A bolt without bending stiffness at its centre is at the limit everywhere else: rounding is not held against
        // it.
        let block = if (own - coupled).abs() <= ROUNDING * coupled {
            0.0
        } else {
            own - coupled
        };
        let conditions = [
            ("k_x", self.k_x),
            ("k_z", self.k_z),
            ("k_rx", self.k_rx),
            ("k_rz", self.k_rz),
            ("k_x k_rx - k_x_ry^2", block),
        ];
        match conditions
            .into_iter()
            .find(|(_, value)| value.is_nan() || *value < 0.0)
        {
            Some((condition, found)) => Err(SpaceError::NotPassive { condition, found }),
            None => Ok(()),
        }
    }

    /// From the bolt's point along its axis to the centre of elasticity, m; None without stiffness across.
    #[must_use]
    pub fn centre_m(&self) -> Option<f64> {
        (self.k_x > 0.0).then(|| self.k_x_ry / self.k_x)
    }

    /// Bending stiffness about that centre, which is also that of a bolt that is free to move across, N·m/rad.
    #[must_use]
    pub fn bending_at_centre(&self) -> f64 {
        self.k_rx - self.centre_m().map_or(0.0, |centre| self.k_x_ry * centre)
    }
}

impl From<[f64; 5]> for BoltNumbers {
    /// From the model's unknowns.
    fn from([k_x, k_z, k_rx, k_rz, k_x_ry]: [f64; 5]) -> Self {
        Self {
            k_x,
            k_z,
            k_rx,
            k_rz,
            k_x_ry,
        }
    }
}
