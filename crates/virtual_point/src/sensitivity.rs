//! What errors of the set-up make of the receptance of the virtual point.

use nalgebra::{DMatrix, Matrix6};
use num_complex::Complex64;

use crate::{Role, VirtualPoint, VirtualPointError};

impl VirtualPoint {
    /// dT_u by each parameter of the channels, 6 × channels; or dT_fᵀ by each of the impacts, 6 × impacts. The weights
    /// stay.
    ///
    /// dT_u = (R_uᵀ W R_u)⁻¹ dR_uᵀ W (I − R_u T_u) − T_u dR_u T_u, and the same of R_f and W_f.
    #[must_use]
    pub fn transformation_derivatives(&self, role: Role) -> Vec<DMatrix<f64>> {
        let changes = self.set_up().places(role).derivatives();
        let projection = self.projection(role);
        changes
            .iter()
            .map(|change| projection.change(change))
            .collect()
    }

    /// dY_qm = dT_u Y T_f + T_u Y dT_f by each parameter of the set-up: of the channels, then of the impacts. On exact
    /// functions of a rigid interface it is −T_u dR_u Y_qm − Y_qm dR_fᵀ T_f.
    ///
    /// # Errors
    ///
    /// Those of [`Self::receptance`].
    pub fn derivatives(
        &self,
        functions: &DMatrix<Complex64>,
    ) -> Result<Vec<Matrix6<Complex64>>, VirtualPointError> {
        let responses = self.responses_checked(functions)?;
        let motions = self.motions(functions)?;
        let by_channels = self.transformation_derivatives(Role::Channel).into_iter();
        let by_impacts = self.transformation_derivatives(Role::Impact).into_iter();
        let of_channels = by_channels.map(|change| {
            let product = change.map(Complex64::from) * &responses;
            Matrix6::from_fn(|i, j| product[(i, j)])
        });
        let of_impacts = by_impacts.map(|change| {
            let product = &motions * change.map(Complex64::from).transpose();
            Matrix6::from_fn(|i, j| product[(i, j)])
        });
        Ok(of_channels.chain(of_impacts).collect())
    }
}
