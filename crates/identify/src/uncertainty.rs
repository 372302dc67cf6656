//! How well the data determine the unknowns: covariance, intervals, and what they do not determine at all.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::layout::Layout;
use super::normal::scaled_by;
use super::unknown::Unknown;

/// Smallest eigenvalue of the information, scaled to a unit diagonal, that is more than rounding.
const ROUNDING: f64 = 1e-15;

/// Stiffness that counts as none, as a fraction of the substructures' own dynamic stiffness at the joint: known better
/// than this, an unknown is determined even if it is zero.
const NEGLIGIBLE_STIFFNESS: f64 = 1e-2;
/// The same for ωc, which acts at resonances.
const NEGLIGIBLE_DAMPING: f64 = 1e-4;

/// A combination of undetermined unknowns that is known to this fraction of its size is worth naming.
const DETERMINED_TOGETHER: f64 = 0.1;

/// Covariance of the unknowns and what follows from it. Order: stiffness of each entry of the joint model, then damping.
#[derive(Clone, Debug)]
pub struct Covariance {
    /// The unknowns.
    pub unknowns: Vec<Unknown>,
    /// Their values in the free estimate.
    pub values: Vec<f64>,
    /// The matrix; every variance infinite where nothing is known of the noise.
    pub matrix: DMatrix<f64>,
    /// Half the width of an interval of 95 % in standard deviations.
    pub coverage_factor: f64,
    /// By how much the standard deviations were raised because the residual is not the assumed noise, at least 1.
    pub inflation: Vec<f64>,
    /// Which unknowns the data determine.
    pub identified: Vec<bool>,
    /// What of the others is determined together, in words.
    pub determined_together: Vec<String>,
    /// What of each unknown would have no effect.
    pub(super) negligible: Vec<f64>,
}

impl Covariance {
    /// One standard deviation of each unknown.
    #[must_use]
    pub fn standard_deviation(&self) -> Vec<f64> {
        self.matrix.diagonal().iter().map(|v| v.sqrt()).collect()
    }

    /// The same of an estimate in which the set-up's errors take part, with its values and their covariance.
    pub(super) fn with_systematic_errors(
        self,
        layout: &Layout,
        values: &[f64],
        matrix: DMatrix<f64>,
        bolts: &[String],
    ) -> Self {
        let deviation = matrix.diagonal().map(f64::sqrt);
        let sizes = sizes(layout, values, &self.negligible);
        let identified = identified(deviation.as_slice(), &sizes);
        let unknowns = self.unknowns.iter();
        let names: Vec<String> = unknowns.map(|unknown| unknown.label(bolts)).collect();
        let together = determined_together(&names, &identified, &sizes, &matrix);
        Self {
            values: values.to_vec(),
            determined_together: together,
            inflation: vec![1.0; values.len()],
            matrix,
            identified,
            ..self
        }
    }

    /// Correlation of the unknowns.
    #[must_use]
    pub fn correlation(&self) -> DMatrix<f64> {
        correlation(&self.matrix)
    }

    /// The interval of 95 % of each unknown.
    #[must_use]
    pub fn intervals(&self) -> Vec<[f64; 2]> {
        let deviation = self.standard_deviation();
        let pairs = self.values.iter().zip(deviation);
        pairs
            .map(|(value, deviation)| {
                let half = self.coverage_factor * deviation;
                [value - half, value + half]
            })
            .collect()
    }
}

/// Correlation of a covariance.
pub(super) fn correlation(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let deviation = covariance.diagonal().map(f64::sqrt);
    DMatrix::from_fn(deviation.len(), deviation.len(), |i, j| {
        if i == j {
            1.0
        } else {
            (covariance[(i, j)] / (deviation[i] * deviation[j])).clamp(-1.0, 1.0)
        }
    })
}

/// ½ (JᵀΣ⁻¹J)⁻¹: the covariance if the noise is as assumed. Directions without information get a variance that is huge but
/// finite.
pub fn unit_covariance(information: &DMatrix<f64>) -> DMatrix<f64> {
    let scale: DVector<f64> = information
        .diagonal()
        .map(|entry| entry.max(f64::MIN_POSITIVE).sqrt().recip());
    let eigen = SymmetricEigen::new(scaled_by(information, &scale));
    let inverse = eigen.eigenvalues.map(|value| value.max(ROUNDING).recip());
    let vectors = &eigen.eigenvectors;
    let covariance = vectors * DMatrix::from_diagonal(&inverse) * vectors.transpose();
    0.5 * scaled_by(&covariance, &scale)
}

/// What of each unknown would have no effect: `dynamic` is the substructures' dynamic stiffness at each of the joint's DOFs, `omega`
/// the middle of the range.
pub(super) fn negligible(layout: &Layout, dynamic: &[f64], omega: f64) -> Vec<f64> {
    let places = layout.places();
    let of_entry = |part: f64| {
        places.iter().map(move |place| {
            let (i, j) = place.first();
            part * (dynamic[i] * dynamic[j]).sqrt()
        })
    };
    let damping = of_entry(NEGLIGIBLE_DAMPING / omega);
    of_entry(NEGLIGIBLE_STIFFNESS).chain(damping).collect()
}

/// The size of each unknown, or what would have no effect if that is more. A coupling may be zero: it counts beside the largest
/// that a passive joint has, √(A_ii A_jj). What is negative on the diagonal has no size: no joint pushes back.
pub(super) fn sizes(layout: &Layout, values: &[f64], negligible: &[f64]) -> Vec<f64> {
    let entries: Vec<(usize, usize)> = layout.places().iter().map(|place| place.first()).collect();
    let size = |index: usize| {
        let matrix = index / entries.len() * entries.len();
        let (i, j) = entries[index % entries.len()];
        let of = |i: usize, j: usize| {
            let entry = entries.iter().position(|&entry| entry == (i, j));
            entry.map_or(0.0, |entry| values[matrix + entry].max(0.0))
        };
        let bound = (of(i, i) * of(j, j)).sqrt();
        // on the diagonal the bound is the value itself
        let coupling = if i == j { 0.0 } else { values[index].abs() };
        coupling.max(bound).max(negligible[index])
    };
    (0..values.len()).map(size).collect()
}

/// Which unknowns are determined: those whose standard deviation is below their size.
pub(super) fn identified(deviation: &[f64], sizes: &[f64]) -> Vec<bool> {
    let pairs = deviation.iter().zip(sizes);
    pairs.map(|(deviation, size)| deviation <= size).collect()
}

/// Combinations of the unknowns that are not `identified` which the data do determine, in words.
pub(super) fn determined_together(
    names: &[String],
    identified: &[bool],
    sizes: &[f64],
    covariance: &DMatrix<f64>,
) -> Vec<String> {
    let open: Vec<usize> = (0..identified.len()).filter(|&i| !identified[i]).collect();
    if open.len() < 2 || covariance.iter().any(|value| !value.is_finite()) {
        return Vec::new();
    }
    let relative = DMatrix::from_fn(open.len(), open.len(), |i, j| {
        covariance[(open[i], open[j])] / (sizes[open[i]] * sizes[open[j]])
    });
    let eigen = SymmetricEigen::new(relative);
    let mut combinations = Vec::new();
    for (index, variance) in eigen.eigenvalues.iter().enumerate() {
        if variance.max(0.0).sqrt() > DETERMINED_TOGETHER {
            continue;
        }
        let vector = eigen.eigenvectors.column(index);
        let largest = vector.iamax();
        let parts: Vec<String> = open
            .iter()
            .enumerate()
            .filter(|&(i, _)| vector[i].abs() > 0.1 * vector[largest].abs())
            .map(|(i, &unknown)| {
                let share = vector[i] / vector[largest] * sizes[open[largest]] / sizes[unknown];
                format!("{share:+.3e} {}", names[unknown])
            })
            .collect();
        if parts.len() > 1 {
            combinations.push(parts.join(" "));
        }
    }
    combinations
}

#[cfg(test)]
mod tests {
    use super::super::layout::Bolts;
    use super::super::model::JointModel;
    use super::*;
    use nalgebra::dmatrix;

    #[test]
    fn a_direction_without_information_has_a_variance_beyond_belief() {
        let covariance = unit_covariance(&dmatrix![4.0, 0.0; 0.0, 1e6]);
        assert!((covariance - dmatrix![0.125, 0.0; 0.0, 5e-7]).amax() < 1e-16);
        let dependent = unit_covariance(&dmatrix![4.0, 2e3; 2e3, 1e6]);
        assert!(dependent[(0, 0)] > 1e12 && dependent[(1, 1)] > 1e6);
    }

    #[test]
    fn a_stiffness_that_pushes_back_is_not_determined() {
        let layout = Layout::of_bolts(JointModel::Full, &Bolts::One, 2);
        let of = |k_yy: f64| {
            let values = [k_yy, 0.0, 1e3, 10.0, 0.0, 0.1];
            let sizes = sizes(&layout, &values, &[1e4, 100.0, 10.0, 1.0, 0.1, 1e-3]);
            identified(&[5e5, 10.0, 10.0, 0.5, 0.01, 1e-3], &sizes)[0]
        };
        assert!(of(1e6));
        assert!(!of(-1e6) && !of(4e5));
    }

    #[test]
    fn what_is_determined_together_is_named() {
        // k_yy + 100 k_thetatheta is known, each of them is not.
        let information = dmatrix![1.0, 100.0; 100.0, 10_000.0 + 1e-9];
        let covariance = unit_covariance(&information);
        let unknowns = ["k_yy", "k_thetatheta"].map(str::to_owned);
        let names = determined_together(&unknowns, &[false, false], &[100.0, 1.0], &covariance);
        assert_eq!(names.len(), 1);
        assert!(
            names[0].contains("k_yy") && names[0].contains("k_thetatheta"),
            "{names:?}"
        );
    }
}
