//! Whether bands of the frequency range agree on the joint.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::estimate::Estimate;

/// Directions with less than this part of the information of the best one say nothing.
const NOTHING: f64 = 1e-6;

/// Estimates by band, and how far they are from the common one.
#[derive(Clone, Debug, PartialEq)]
pub struct BandConsistency {
    /// Q = Σ g_bᵀ N_b⁻¹ g_b over the bands: χ² with `freedom` degrees of freedom where all bands have the same joint.
    pub q: f64,
    /// Degrees of freedom.
    pub freedom: usize,
    /// The bands.
    pub bands: Vec<BandEstimate>,
}

/// The joint as one band of the range sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct BandEstimate {
    /// First and last line of the band.
    pub lines: (usize, usize),
    /// The unknowns that one step from the common estimate leads to; `None` where the band does not determine all of them.
    pub unknowns: Option<Vec<f64>>,
}

/// Tests an estimate over so many bands with equally many lines; `None` with fewer lines than bands.
#[must_use]
pub fn consistency(estimate: &Estimate, bands: usize) -> Option<BandConsistency> {
    let (lines, shares) = (&estimate.found.lines, &estimate.found.shares);
    if bands < 2 || lines.len() < bands {
        return None;
    }
    let size = estimate.unknowns.len();
    let (mut q, mut directions) = (0.0, 0);
    let mut found = Vec::with_capacity(bands);
    for band in 0..bands {
        let own = band * lines.len() / bands..(band + 1) * lines.len() / bands;
        let mut information = DMatrix::zeros(size, size);
        let mut gradient = DVector::zeros(size);
        for share in &shares[own.clone()] {
            information += share.information.view((0, 0), (size, size));
            gradient += share.gradient.rows(0, size);
        }
        let scale = information.diagonal().map(|value| value.sqrt().recip());
        let scaled = DMatrix::from_fn(size, size, |i, j| information[(i, j)] * scale[i] * scale[j]);
        if !scaled.iter().all(|value| value.is_finite()) {
            return None;
        }
        let eigen = SymmetricEigen::new(scaled);
        let largest = eigen.eigenvalues.max();
        let right = eigen.eigenvectors.transpose() * gradient.component_mul(&scale);
        let mut step = DVector::zeros(size);
        let mut determined = 0;
        for (index, &value) in eigen.eigenvalues.iter().enumerate() {
            if value > NOTHING * largest {
                q += right[index] * right[index] / value;
                step += eigen.eigenvectors.column(index) * (right[index] / value);
                determined += 1;
            }
        }
        directions += determined;
        let values = (determined == size).then(|| {
            let step = step.component_mul(&scale);
            estimate
                .unknowns
                .iter()
                .zip(step.iter())
                .map(|(value, step)| value + step)
                .collect()
        });
        found.push(BandEstimate {
            lines: (lines[own.start], lines[own.end - 1]),
            unknowns: values,
        });
    }
    Some(BandConsistency {
        q,
        freedom: directions
            .checked_sub(size)
            .filter(|&freedom| freedom > 0)?,
        bands: found,
    })
}
