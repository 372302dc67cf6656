//! The passive joint that is nearest to a free estimate in the metric of its information: a joint cannot feed energy, and noise
//! must not say otherwise.
//!
//! min ½ (θ − θ̂)ᵀ F (θ − θ̂) with K(θ) ⪰ 0 and C(θ) ⪰ 0, by Newton steps with the barrier −μ (log det K + log det C), μ → 0
//! (Boyd and Vandenberghe, *Convex Optimization*, 11.6).

use bolted_joint_space::Parametrisation;
use nalgebra::{DMatrix, DVector, Matrix6};

/// First and last weight of the barrier, and by what it falls.
const BARRIERS: [f64; 3] = [1e3, 1e-10, 0.1];

/// Newton steps at one weight.
const STEPS_MAX: usize = 40;

/// Decrement of a Newton step that was the last one.
const SETTLED: f64 = 1e-12;

/// Diagonal of the start where the free estimate has less, in parts of its largest.
const LEAST_DIAGONAL: f64 = 1e-6;

/// Whether K and C of these unknowns are positive definite where the model has anything.
pub(crate) fn is_passive(model: &Parametrisation, unknowns: &DVector<f64>) -> bool {
    Cone::of(model, unknowns).is_some()
}

/// The nearest passive unknowns; `None` where no start inside is found.
pub(crate) fn nearest(
    model: &Parametrisation,
    free: &DVector<f64>,
    information: &DMatrix<f64>,
    length_m: f64,
) -> Option<DVector<f64>> {
    let mut at = inside(model, free, length_m)?;
    let scale = information.diagonal().map(|own| own.sqrt().recip());
    let [mut weight, last, falls] = BARRIERS;
    while weight >= last {
        for _ in 0..STEPS_MAX {
            let cone = Cone::of(model, &at)?;
            let difference = &at - free;
            let gradient = information * &difference - weight * cone.gradient(model);
            let hessian = information + weight * cone.hessian(model);
            let scaled = DMatrix::from_fn(at.len(), at.len(), |i, j| {
                hessian[(i, j)] * scale[i] * scale[j]
            });
            let right = gradient.component_mul(&scale);
            let step = -scaled.cholesky()?.solve(&right).component_mul(&scale);
            let decrement = -gradient.dot(&step);
            let value = |at: &DVector<f64>| {
                let cone = Cone::of(model, at)?;
                let difference = at - free;
                Some(0.5 * difference.dot(&(information * &difference)) - weight * cone.log_det)
            };
            let before = value(&at)?;
            let mut part = 1.0;
            // back into the cone, and downhill
            let moved = loop {
                let trial = &at + part * &step;
                let found = value(&trial);
                if found.is_some_and(|found| found <= before - 1e-4 * part * decrement) {
                    break Some(trial);
                }
                part *= 0.5;
                if part < 1e-12 {
                    break None;
                }
            };
            let Some(moved) = moved else { break };
            at = moved;
            if decrement < SETTLED {
                break;
            }
        }
        weight *= falls;
    }
    Some(at)
}

/// A diagonal of the size of the free estimate's.
fn inside(model: &Parametrisation, free: &DVector<f64>, length_m: f64) -> Option<DVector<f64>> {
    let count = model.count();
    let mut all = DVector::zeros(2 * count);
    for part in 0..2 {
        let own = &free.as_slice()[part * count..(part + 1) * count];
        let matrix = model.matrix(own).ok()?;
        let length = |i: usize| if i < 3 { 1.0 } else { length_m };
        let size = |i: usize| matrix[(i, i)].abs() / (length(i) * length(i));
        let largest = (0..6).map(size).fold(0.0, f64::max);
        let diagonal = Matrix6::from_fn(|i, j| match i == j {
            true => size(i).max(LEAST_DIAGONAL * largest) * length(i) * length(i),
            false => 0.0,
        });
        let nearest = model.nearest(&diagonal, length_m).ok()?;
        all.rows_mut(part * count, count)
            .copy_from_slice(&nearest.unknowns);
    }
    is_passive(model, &all).then_some(all)
}

/// A point inside, with the inverses of K and C on the motions that the model has.
struct Cone {
    inverses: [DMatrix<f64>; 2],
    rows: Vec<usize>,
    log_det: f64,
}

impl Cone {
    fn of(model: &Parametrisation, unknowns: &DVector<f64>) -> Option<Self> {
        let rows: Vec<usize> = (0..6)
            .filter(|&i| model.bases().iter().any(|basis| basis[(i, i)] != 0.0))
            .collect();
        let count = model.count();
        let mut log_det = 0.0;
        let mut inverse = |part: usize| {
            let own = &unknowns.as_slice()[part * count..(part + 1) * count];
            let matrix = sub(&model.matrix(own).ok()?, &rows);
            let cholesky = matrix.cholesky()?;
            log_det += 2.0 * cholesky.l().diagonal().map(f64::ln).sum();
            let inverse = cholesky.inverse();
            inverse.iter().all(|x| x.is_finite()).then_some(inverse)
        };
        let inverses = [inverse(0)?, inverse(1)?];
        log_det.is_finite().then_some(Self {
            inverses,
            rows,
            log_det,
        })
    }

    /// K⁻¹ ∂K of each unknown.
    fn products(&self, model: &Parametrisation) -> Vec<DMatrix<f64>> {
        let of = |inverse: &DMatrix<f64>| -> Vec<DMatrix<f64>> {
            let bases = model.bases().iter();
            bases
                .map(|basis| inverse * sub(basis, &self.rows))
                .collect()
        };
        let [stiffness, damping] = &self.inverses;
        [of(stiffness), of(damping)].concat()
    }

    /// ∂ log det = tr(K⁻¹ ∂K)
    fn gradient(&self, model: &Parametrisation) -> DVector<f64> {
        let products = self.products(model);
        DVector::from_iterator(products.len(), products.iter().map(DMatrix::trace))
    }

    /// −∂² log det = tr(K⁻¹ ∂K K⁻¹ ∂K)
    fn hessian(&self, model: &Parametrisation) -> DMatrix<f64> {
        let products = self.products(model);
        let count = model.count();
        DMatrix::from_fn(2 * count, 2 * count, |i, j| match i / count == j / count {
            true => products[i].dot(&products[j].transpose()),
            false => 0.0,
        })
    }
}

fn sub(matrix: &Matrix6<f64>, rows: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), rows.len(), |i, j| matrix[(rows[i], rows[j])])
}

#[cfg(test)]
mod tests {
    use bolted_joint_space::JointModel;

    use super::*;

    /// With F = I over the entries and weight 2 off the diagonal, the metric is that of Frobenius, in which the nearest
    /// semidefinite matrix has its negative eigenvalues cut off (Higham 1988).
    #[test]
    fn in_the_metric_of_frobenius_negative_eigenvalues_are_cut_off() {
        let model = JointModel::Full.parametrisation().unwrap();
        let mut matrix = Matrix6::from_fn(|i, j| 1.0 / (1.0 + (i as f64 - j as f64).abs()));
        matrix[(2, 2)] = -0.4;
        matrix[(5, 5)] = 0.1;
        let count = model.count();
        let free = model.nearest(&matrix, 1.0).unwrap().unknowns;
        let both = DVector::from_iterator(2 * count, free.iter().chain(&free).copied());
        let weights = model
            .entries()
            .iter()
            .map(|entry| match entry.row == entry.column {
                true => 1.0,
                false => 2.0,
            });
        let weights: Vec<f64> = weights.collect();
        let information = DMatrix::from_diagonal(&DVector::from_iterator(
            2 * count,
            weights.iter().chain(&weights).copied(),
        ));
        assert!(!is_passive(&model, &both));
        let found = nearest(&model, &both, &information, 1.0).unwrap();
        let eigen = matrix.symmetric_eigen();
        let kept = Matrix6::from_diagonal(&eigen.eigenvalues.map(|own| own.max(0.0)));
        let expected = eigen.eigenvectors * kept * eigen.eigenvectors.transpose();
        for part in 0..2 {
            let own = &found.as_slice()[part * count..(part + 1) * count];
            let difference = (model.matrix(own).unwrap() - expected).abs().max();
            assert!(difference < 1e-6, "{difference}");
        }
        assert!(is_passive(&model, &found));
    }

    #[test]
    fn what_the_model_does_not_have_needs_no_stiffness() {
        let model = JointModel::Translations.parametrisation().unwrap();
        let free = DVector::from_vec(vec![3.0, -1.0, 2.0, 1.0, 1.0, 1.0]);
        let information = DMatrix::identity(6, 6);
        let found = nearest(&model, &free, &information, 1.0).unwrap();
        assert!((found - DVector::from_vec(vec![3.0, 0.0, 2.0, 1.0, 1.0, 1.0])).norm() < 1e-4);
    }
}
