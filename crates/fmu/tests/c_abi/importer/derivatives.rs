//! Derivatives with slices in place of pointers.

use std::ffi::c_int;

use super::Instance;
use crate::c;

impl Instance {
    /// Directional derivative, with as many results as there are unknowns.
    pub(crate) fn directional(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
    ) -> Result<Vec<f64>, c_int> {
        let mut sensitivity = vec![f64::NAN; unknowns.len()];
        // SAFETY: pointers and lengths are those of slices
        let status = unsafe {
            c::fmi3GetDirectionalDerivative(
                self.handle,
                unknowns.as_ptr(),
                unknowns.len(),
                knowns.as_ptr(),
                knowns.len(),
                seed.as_ptr(),
                seed.len(),
                sensitivity.as_mut_ptr(),
                sensitivity.len(),
            )
        };
        (status == c::OK).then_some(sensitivity).ok_or(status)
    }

    /// Adjoint derivative, with as many results as there are knowns.
    pub(crate) fn adjoint(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
    ) -> Result<Vec<f64>, c_int> {
        let mut sensitivity = vec![f64::NAN; knowns.len()];
        // SAFETY: pointers and lengths are those of slices
        let status = unsafe {
            c::fmi3GetAdjointDerivative(
                self.handle,
                unknowns.as_ptr(),
                unknowns.len(),
                knowns.as_ptr(),
                knowns.len(),
                seed.as_ptr(),
                seed.len(),
                sensitivity.as_mut_ptr(),
                sensitivity.len(),
            )
        };
        (status == c::OK).then_some(sensitivity).ok_or(status)
    }

    /// First derivatives of outputs with respect to time.
    pub(crate) fn output_derivatives(&mut self, references: &[u32]) -> Result<Vec<f64>, c_int> {
        let orders = vec![1; references.len()];
        self.derivatives_of_order(references, &orders)
    }

    /// Derivatives of outputs with respect to time.
    pub(crate) fn derivatives_of_order(
        &mut self,
        references: &[u32],
        orders: &[i32],
    ) -> Result<Vec<f64>, c_int> {
        let mut values = vec![f64::NAN; references.len()];
        // SAFETY: pointers and lengths are those of slices
        let status = unsafe {
            c::fmi3GetOutputDerivatives(
                self.handle,
                references.as_ptr(),
                references.len(),
                orders.as_ptr(),
                values.as_mut_ptr(),
                values.len(),
            )
        };
        (status == c::OK).then_some(values).ok_or(status)
    }
}
