//! What a test is worth, to be compared with others.

use nalgebra::DMatrix;

use super::trial::Test;
use crate::error::SpatialError;
use crate::fit::covariance;
use crate::normal::Normal;

/// Deviations that are known before, in parts of what couples the motions at most: nothing is known of a number but its size.
const BEFORE: f64 = 1.0;

impl Test {
    /// ln det of the information on the joints, in parts of their sizes, with what is known before; or the sum of the relative
    /// variances of some of the unknowns. With all lines, of which these are some.
    pub(super) fn worth(&self, chosen: &[usize], lines: usize) -> Result<f64, SpatialError> {
        let problem = &self.problem;
        let (count, errors) = (problem.joint_count(), problem.error_count());
        let mut level = self.level.clone();
        let fewer = problem.frequency_hz.len() as f64 / lines as f64;
        for level in &mut level {
            *level *= fewer.sqrt();
        }
        let mut information = Normal::of(problem, &self.truth, &level)?.information;
        for (n, own) in self.before(BEFORE)?.into_iter().enumerate() {
            information[(n, n)] += own;
        }
        let all = covariance(&information).ok_or(SpatialError::NotDetermined)?;
        let sizes = problem.links.sizes(self.truth.0.as_slice())?;
        if !chosen.is_empty() {
            return Ok(chosen
                .iter()
                .map(|&n| all[(n, n)] / (sizes[n] * sizes[n]))
                .sum());
        }
        // the marginal information on the joints has det F/det F_ηη
        let of_errors = information
            .view((count, count), (errors, errors))
            .into_owned();
        let marginal = log_det(&information).zip(log_det(&of_errors));
        let (whole, of_errors) = marginal.ok_or(SpatialError::NotDetermined)?;
        let of_sizes: f64 = sizes.iter().map(|size| 2.0 * size.ln()).sum();
        Ok(whole - of_errors + of_sizes)
    }
}

/// ln det of a positive definite matrix.
fn log_det(matrix: &DMatrix<f64>) -> Option<f64> {
    let scale = matrix.diagonal().map(|own| own.sqrt().recip());
    let scaled = DMatrix::from_fn(scale.len(), scale.len(), |i, j| {
        matrix[(i, j)] * scale[i] * scale[j]
    });
    let factor = scaled.cholesky()?;
    let of_factor: f64 = factor
        .l_dirty()
        .diagonal()
        .iter()
        .map(|own| 2.0 * own.ln())
        .sum();
    Some(of_factor - scale.iter().map(|own| 2.0 * own.ln()).sum::<f64>())
}
