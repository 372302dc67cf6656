//! All numbers of two joints together: whether any of them differs, correlations taken.

use bolted_joint_dynamics::law::{DAMPING, STIFFNESS};
use bolted_joint_joint::JointFile;
use bolted_joint_statistics::chi_squared_tail;
use nalgebra::{DMatrix, DVector};

/// Whether two joints are the same but for their deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Together {
    /// dᵀ(Σ₁ + Σ₂)⁻¹d of the differences d of all unknowns.
    pub chi_squared: f64,
    /// How many unknowns.
    pub unknowns: usize,
    /// Probability of so much or more if the joints were the same.
    pub probability: f64,
}

/// Below this a probability is as good as none; what it is rests on tails of distributions that nobody has seen.
pub const UNLIKELY: f64 = 1e-10;

impl Together {
    /// The probability; `None` below [`UNLIKELY`].
    #[must_use]
    pub fn likely(&self) -> Option<f64> {
        Some(self.probability).filter(|own| *own >= UNLIKELY)
    }

    /// `None` unless both files have deviations and correlations of the same unknowns, each an entry of K or C.
    pub(crate) fn of(first: &JointFile, second: &JointFile) -> Option<Self> {
        let (names, one, one_covariance) = estimate(first)?;
        let (other_names, other, other_covariance) = estimate(second)?;
        if names != other_names {
            return None;
        }
        let difference = other - one;
        // scaled by the deviations, as N/m and N·m·s/rad are worlds apart
        let sum = one_covariance + other_covariance;
        let scale = sum.diagonal().map(f64::sqrt);
        let correlation = DMatrix::from_fn(sum.nrows(), sum.ncols(), |i, j| {
            sum[(i, j)] / (scale[i] * scale[j])
        });
        let difference = difference.component_div(&scale);
        let solved = correlation.cholesky()?.solve(&difference);
        let chi_squared = difference.dot(&solved);
        chi_squared.is_finite().then(|| Self {
            chi_squared,
            unknowns: names.len(),
            probability: chi_squared_tail(chi_squared, names.len()),
        })
    }
}

/// Names, values and covariance of the unknowns.
fn estimate(file: &JointFile) -> Option<(Vec<String>, DVector<f64>, DMatrix<f64>)> {
    if file.joint.over_preload.is_some() {
        return None;
    }
    let own = file.uncertainty.as_ref()?;
    let correlation = own.correlation.as_ref()?;
    let dofs = file.joint.dofs;
    let mut values = Vec::new();
    let mut deviations = Vec::new();
    for unknown in &correlation.unknowns {
        let [value, deviation] = [
            (
                STIFFNESS.symbol,
                &file.joint.stiffness,
                &own.standard_deviation.stiffness,
            ),
            (
                DAMPING.symbol,
                &file.joint.damping,
                &own.standard_deviation.damping,
            ),
        ]
        .into_iter()
        .find_map(|(symbol, matrix, deviation)| {
            let place = dofs.entries().find(|&[i, j]| {
                *unknown == format!("{symbol}_{}{}", dofs.row(i).name, dofs.row(j).name)
            });
            place.map(|[i, j]| {
                let at = |all: &Vec<Vec<f64>>| all.get(i).and_then(|row| row.get(j)).copied();
                [at(matrix), at(deviation)]
            })
        })?;
        values.push(value?);
        deviations.push(deviation.filter(|own| *own > 0.0)?);
    }
    let size = values.len();
    let entry = |i: usize, j: usize| {
        let own = correlation
            .matrix
            .get(i)
            .and_then(|row| row.get(j))
            .copied();
        own.unwrap_or(f64::NAN) * deviations[i] * deviations[j]
    };
    let covariance = DMatrix::from_fn(size, size, entry);
    Some((
        correlation.unknowns.clone(),
        DVector::from_vec(values),
        covariance,
    ))
}
