//! The receptance of an interface from functions that were measured near it (virtual point transformation, van der
//! Seijs, van den Bosch, Rixen and de Klerk 2013).

use nalgebra::{DMatrix, Matrix6};
use num_complex::Complex64;

use crate::projection::Projection;
use crate::{Conditioning, Role, SetUp, VirtualPointError, Weights};

/// A virtual point: six motions found in the channels, six loads made of the impacts; or those of a plane, and zero for the others.
#[derive(Clone, Debug, PartialEq)]
pub struct VirtualPoint {
    set_up: SetUp,
    conditionings: [Conditioning; 2],
    motions: Projection,
    loads: Projection,
}

impl VirtualPoint {
    /// Least squares in the channels and in the impacts, with weights.
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::TooFew`] for fewer channels or impacts than motions, [`VirtualPointError::Unseen`] if they
    /// leave a motion or load open, and what is wrong with the weights: [`VirtualPointError::Size`],
    /// [`VirtualPointError::NotSymmetric`], [`VirtualPointError::NotPositive`], [`VirtualPointError::NotFinite`].
    pub fn new(
        set_up: SetUp,
        channels: &Weights,
        impacts: &Weights,
    ) -> Result<Self, VirtualPointError> {
        let (seen, motions) = projected(&set_up, Role::Channel, channels)?;
        let (driven, loads) = projected(&set_up, Role::Impact, impacts)?;
        let conditionings = [seen, driven];
        Ok(Self {
            set_up,
            conditionings,
            motions,
            loads,
        })
    }

    /// Sensors and impacts.
    #[must_use]
    pub fn set_up(&self) -> &SetUp {
        &self.set_up
    }

    /// How many motions it has.
    pub(crate) fn motion_count(&self) -> usize {
        self.set_up.motions().count()
    }

    /// How well the channels tell motions apart, or the impacts loads.
    #[must_use]
    pub fn conditioning(&self, role: Role) -> &Conditioning {
        let [channels, impacts] = &self.conditionings;
        match role {
            Role::Channel => channels,
            Role::Impact => impacts,
        }
    }

    /// T_u = (R_uᵀ W R_u)⁻¹ R_uᵀ W, 6 × channels: motions of the virtual point from those of the channels.
    #[must_use]
    pub fn motions_of_channels(&self) -> &DMatrix<f64> {
        self.motions.inverse()
    }

    /// T_f = W_f R_f (R_fᵀ W_f R_f)⁻¹, impacts × 6: forces of the impacts that make a load on the virtual point.
    #[must_use]
    pub fn forces_of_loads(&self) -> DMatrix<f64> {
        self.loads.inverse().transpose()
    }

    /// Y_qm = T_u Y T_f at one line, Y being channels × impacts in m/N (or accelerances in m/s²/N: whatever is handed
    /// over comes back, with rad for m and N·m for N in the last three rows and columns).
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::Size`] for functions of other channels or impacts, [`VirtualPointError::Function`] for a
    /// value that is no number.
    pub fn receptance(
        &self,
        functions: &DMatrix<Complex64>,
    ) -> Result<Matrix6<Complex64>, VirtualPointError> {
        self.checked(0, functions)?;
        let product = self.motions(&self.responses(functions)?)?;
        Ok(Matrix6::from_fn(|i, j| product[(i, j)]))
    }

    /// [`Self::receptance`] at each line.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn receptances(
        &self,
        lines: &[DMatrix<Complex64>],
    ) -> Result<Vec<Matrix6<Complex64>>, VirtualPointError> {
        self.all_checked(lines)?;
        lines.iter().map(|line| self.receptance(line)).collect()
    }

    /// T_u Y, 6 × any: motions of the virtual point by excitations anywhere.
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::Size`] unless there is a row for each channel.
    pub fn motions(
        &self,
        functions: &DMatrix<Complex64>,
    ) -> Result<DMatrix<Complex64>, VirtualPointError> {
        sized(
            "rows of the functions",
            functions.nrows(),
            self.count(Role::Channel),
        )?;
        Ok(complex(self.motions.inverse()) * functions)
    }

    /// Y T_f, any × 6: responses anywhere to loads on the virtual point.
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::Size`] unless there is a column for each impact.
    pub fn responses(
        &self,
        functions: &DMatrix<Complex64>,
    ) -> Result<DMatrix<Complex64>, VirtualPointError> {
        sized(
            "columns of the functions",
            functions.ncols(),
            self.count(Role::Impact),
        )?;
        Ok(functions * complex(self.loads.inverse()).transpose())
    }

    /// Y T_f of functions that are checked.
    pub(crate) fn responses_checked(
        &self,
        functions: &DMatrix<Complex64>,
    ) -> Result<DMatrix<Complex64>, VirtualPointError> {
        self.checked(0, functions)?;
        self.responses(functions)
    }

    /// The least squares of one role.
    pub(crate) fn projection(&self, role: Role) -> &Projection {
        match role {
            Role::Channel => &self.motions,
            Role::Impact => &self.loads,
        }
    }

    pub(crate) fn count(&self, role: Role) -> usize {
        self.set_up.places(role).count()
    }

    pub(crate) fn all_checked(
        &self,
        lines: &[DMatrix<Complex64>],
    ) -> Result<(), VirtualPointError> {
        let mut numbered = lines.iter().enumerate();
        numbered.try_for_each(|(number, line)| self.checked(number, line))
    }

    fn checked(
        &self,
        line: usize,
        functions: &DMatrix<Complex64>,
    ) -> Result<(), VirtualPointError> {
        sized(
            "rows of the functions",
            functions.nrows(),
            self.count(Role::Channel),
        )?;
        sized(
            "columns of the functions",
            functions.ncols(),
            self.count(Role::Impact),
        )?;
        for channel in 0..functions.nrows() {
            for impact in 0..functions.ncols() {
                if !functions[(channel, impact)].is_finite() {
                    return Err(VirtualPointError::Function {
                        line,
                        channel,
                        impact,
                    });
                }
            }
        }
        Ok(())
    }
}

fn projected(
    set_up: &SetUp,
    role: Role,
    weights: &Weights,
) -> Result<(Conditioning, Projection), VirtualPointError> {
    let places = set_up.places(role);
    let weights = weights.matrix(role, places.count())?;
    let conditioning = Conditioning::of(places)?;
    let projection = Projection::new(
        places.matrix().clone(),
        weights,
        conditioning.length_m,
        places.motions(),
    );
    let what = "rows and weights, of which the inverse is too large";
    let projection = projection.ok_or(VirtualPointError::NotFinite { what })?;
    Ok((conditioning, projection))
}

pub(crate) fn sized(
    what: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), VirtualPointError> {
    if found == expected {
        return Ok(());
    }
    Err(VirtualPointError::Size {
        what,
        found,
        expected,
    })
}

pub(crate) fn complex(matrix: &DMatrix<f64>) -> DMatrix<Complex64> {
    matrix.map(Complex64::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::*;

    #[test]
    fn functions_that_do_not_belong_here_are_refused() {
        let point = equal(check_set_up());
        let size = |error: VirtualPointError| matches!(error, VirtualPointError::Size { .. });
        assert!(size(point.receptance(&DMatrix::zeros(8, 7)).unwrap_err()));
        assert!(size(point.derivatives(&DMatrix::zeros(9, 6)).unwrap_err()));
        assert!(size(point.motions(&DMatrix::zeros(7, 7)).unwrap_err()));
        assert!(size(point.responses(&DMatrix::zeros(7, 9)).unwrap_err()));
        let mut broken = check_functions();
        broken[(3, 1)].im = f64::NAN;
        let lines = [check_functions(), broken];
        let error = point.receptances(&lines).unwrap_err();
        assert_eq!(
            error.to_string(),
            "functions: found a value that is not finite in line 2, channel 4, impact 2: leave that line out"
        );
        for role in [Role::Channel, Role::Impact] {
            assert_eq!(point.consistency(role, &lines), Err(error.clone()));
            assert_eq!(point.suspects(role, &lines), Err(error.clone()));
            let none = VirtualPointError::Nothing { what: "lines" };
            assert_eq!(point.consistency(role, &[]), Err(none.clone()));
            assert_eq!(point.suspects(role, &[]), Err(none.clone()));
            assert_eq!(point.noise_test(role, &[], &[]), Err(none));
        }
    }
}
