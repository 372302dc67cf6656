//! A damped step of the search that keeps to limits: a small quadratic programme, solved by its active set.

use nalgebra::{DMatrix, DVector};

use super::passive::Bound;

/// Limits at most of which every combination is tried.
const MOST: usize = 12;
/// Part by which a limit may be exceeded, or a multiplier be negative, by rounding.
const ROUNDING: f64 = 1e-9;

/// A step, and what the limits push with, in the order of the bounds: the derivative of ½χ² by each.
pub(super) struct Step {
    pub(super) change: DVector<f64>,
    pub(super) multipliers: Vec<f64>,
}

/// argmin ½dᵀ(H + λ diag H)d + gᵀd with value + gradient·d ≥ 0 for each bound. `None` where H is not definite.
///
/// Limits that curve add their part to H, which the multipliers scale: so the search converges as fast as a free one.
pub(super) fn damped_step(
    information: &DMatrix<f64>,
    gradient: &DVector<f64>,
    bounds: &[Bound],
    damping: f64,
) -> Option<Step> {
    let straight = solved(information, gradient, bounds, damping)?;
    let mut curved = information.clone();
    let mut is_curved = false;
    for (bound, &multiplier) in bounds.iter().zip(&straight.multipliers) {
        if let Some(curvature) = bound.curvature.as_ref().filter(|_| multiplier > 0.0) {
            // ∇²(½χ² − μ value) = H + μ v vᵀ
            curved.ger(multiplier, curvature, curvature, 1.0);
            is_curved = true;
        }
    }
    match is_curved {
        true => solved(&curved, gradient, bounds, damping),
        false => Some(straight),
    }
}

fn solved(
    information: &DMatrix<f64>,
    gradient: &DVector<f64>,
    bounds: &[Bound],
    damping: f64,
) -> Option<Step> {
    // scaled to a unit diagonal
    let scale = information.diagonal().map(|entry| match entry > 0.0 {
        true => entry.sqrt().recip(),
        false => 1.0,
    });
    let size = gradient.len();
    let scaled = DMatrix::from_fn(size, size, |i, j| {
        let own = information[(i, j)] * scale[i] * scale[j];
        if i == j { own + damping } else { own }
    });
    let factor = scaled.cholesky()?;
    let free = factor.solve(&-gradient.component_mul(&scale));
    // a·d ≥ b with |a| = 1
    let rows: Vec<(DVector<f64>, f64, f64)> = bounds
        .iter()
        .map(|bound| {
            let row = bound.gradient.component_mul(&scale);
            let length = row.norm().max(f64::MIN_POSITIVE);
            (row / length, -bound.value / length, length)
        })
        .collect();
    let slack = |step: &DVector<f64>, (row, limit, _): &(DVector<f64>, f64, f64)| {
        row.dot(step) - limit + ROUNDING * (limit.abs() + step.norm())
    };
    let reach = |step: &DVector<f64>| rows.iter().all(|row| slack(step, row) >= 0.0);
    let told = |step: DVector<f64>, multipliers: Vec<f64>| Step {
        change: step.component_mul(&scale),
        multipliers,
    };
    if reach(&free) {
        return Some(told(free, vec![0.0; rows.len()]));
    }
    // H⁻¹aᵀ of each
    let columns: Vec<DVector<f64>> = rows.iter().map(|(row, ..)| factor.solve(row)).collect();
    let count = rows.len().min(MOST);
    let mut combinations: Vec<usize> = (1..1_usize << count).collect();
    combinations.sort_by_key(|set| set.count_ones());
    for set in combinations {
        let active: Vec<usize> = (0..count).filter(|n| set >> n & 1 == 1).collect();
        if active.len() > size {
            break;
        }
        // d = d₀ + H⁻¹Aᵀμ with A d = b
        let normal = DMatrix::from_fn(active.len(), active.len(), |i, j| {
            rows[active[i]].0.dot(&columns[active[j]])
        });
        let right = DVector::from_fn(active.len(), |i, _| {
            let (row, limit, _) = &rows[active[i]];
            limit - row.dot(&free)
        });
        let Some(found) = normal.cholesky().map(|normal| normal.solve(&right)) else {
            continue;
        };
        if found.iter().any(|&multiplier| multiplier < 0.0) {
            continue;
        }
        let mut step = free.clone();
        for (&n, &multiplier) in active.iter().zip(found.iter()) {
            step.axpy(multiplier, &columns[n], 1.0);
        }
        if reach(&step) {
            let mut multipliers = vec![0.0; rows.len()];
            for (&n, &multiplier) in active.iter().zip(found.iter()) {
                multipliers[n] = multiplier / rows[n].2;
            }
            return Some(told(step, multipliers));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::passive::Limit;

    /// The nearest point to (−1, −2, 3) of x ≥ 0, y ≥ 0, x + y ≥ ½, z ≤ 2 in the metric of diag(1, 4, 1): by hand.
    #[test]
    fn the_step_is_that_of_the_conditions_of_karush_kuhn_and_tucker() {
        let information = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 4.0, 1.0]));
        let gradient = DVector::from_vec(vec![1.0, 8.0, -3.0]);
        let bound = |row: [f64; 3], value: f64| Bound {
            limit: Limit::JointStiffness,
            value,
            gradient: DVector::from_row_slice(&row),
            curvature: None,
        };
        let bounds = [
            bound([1.0, 0.0, 0.0], 0.0),
            bound([0.0, 1.0, 0.0], 0.0),
            bound([1.0, 1.0, 0.0], -0.5),
            bound([0.0, 0.0, -1.0], 2.0),
        ];
        let step = damped_step(&information, &gradient, &bounds, 0.0).unwrap();
        // on x + y = ½: x + 1 = μ, 4y + 8 = μ + ν; y = 0, so x = ½, μ = 1.5, ν = 6.5; z = 2 with a multiplier of 1
        for (found, expected) in step.change.iter().zip([0.5, 0.0, 2.0]) {
            assert!((found - expected).abs() < 1e-12, "{:?}", step.change);
        }
        for (found, expected) in step.multipliers.iter().zip([0.0, 6.5, 1.5, 1.0]) {
            assert!((found - expected).abs() < 1e-12, "{:?}", step.multipliers);
        }
    }
}
