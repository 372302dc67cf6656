//! What the samples of a record say of a model's unknowns about one place among them, in as few numbers as there are unknowns.
//!
//! χ² of thousands of samples is a square form of the unknowns there. Its rows go into the search in place of the points that
//! are read from the record, so that limits, multipliers and covariance are found as of all other data.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::response::backbone::Row;
use crate::response::model::{Model, Values};

/// Part of the largest eigenvalue of the scaled information below which there is rounding.
const ROUNDING: f64 = 1e-14;

/// A square form of the unknowns: χ²(p) = |q + R (p − p₀)|² + rest.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::response) struct Rows {
    at: Values,
    /// R
    by: DMatrix<f64>,
    /// q
    residual: DVector<f64>,
    /// √rest: what no unknown changes.
    rest: f64,
    /// Numbers that the record brings beyond its own release and offset.
    count: usize,
    released_m: f64,
    /// What draws a step back to where it begins.
    draws: DVector<f64>,
}

/// A record's part of the normal equations at one place.
pub(super) struct Normal {
    /// JᵀJ
    pub(super) information: DMatrix<f64>,
    /// Jᵀr
    pub(super) gradient: DVector<f64>,
    pub(super) chi_squared: f64,
}

impl Rows {
    /// About these values; `released_m` is the displacement that the motion begins at.
    pub(super) fn of(at: &Values, normal: &Normal, (count, released_m): (usize, f64)) -> Self {
        let scale = normal
            .information
            .diagonal()
            .map(|entry| match entry > 0.0 {
                true => entry.sqrt().recip(),
                false => 1.0,
            });
        let size = scale.len();
        let scaled = DMatrix::from_fn(size, size, |i, j| {
            normal.information[(i, j)] * scale[i] * scale[j]
        });
        let SymmetricEigen {
            eigenvectors,
            eigenvalues,
        } = SymmetricEigen::new(scaled);
        // H = D⁻¹VΛVᵀD⁻¹: R = √Λ VᵀD⁻¹, and Rᵀq = g
        let least = ROUNDING * eigenvalues.amax();
        let roots = eigenvalues.map(|value| value.max(0.0).sqrt());
        let by = DMatrix::from_fn(size, size, |i, j| {
            roots[i] * eigenvectors[(j, i)] / scale[j]
        });
        let along = eigenvectors.transpose() * normal.gradient.component_mul(&scale);
        let residual = DVector::from_fn(size, |i, _| match eigenvalues[i] > least {
            true => along[i] / roots[i],
            false => 0.0,
        });
        let rest = (normal.chi_squared - residual.norm_squared()).max(0.0);
        Self {
            at: *at,
            by,
            residual,
            rest: rest.sqrt(),
            count,
            released_m,
            draws: DVector::zeros(size),
        }
    }

    /// The same with steps that are drawn back: each unknown by this part of its own information.
    pub(super) fn damped(mut self, part: f64) -> Self {
        let lengths = self.by.column_iter().map(|column| column.norm());
        let draws = lengths.map(|length| part.sqrt() * length);
        self.draws = DVector::from_iterator(self.by.ncols(), draws);
        self
    }

    /// Numbers that it brings.
    pub(in crate::response) fn count(&self) -> usize {
        self.count
    }

    /// The displacement that the motion begins at, m.
    pub(in crate::response) fn released_m(&self) -> f64 {
        self.released_m
    }

    /// Residuals in standard deviations with their derivatives.
    pub(in crate::response) fn at(&self, model: &Model, values: &Values) -> Vec<Row> {
        let change = model.change(&self.at, values);
        let grown = &self.residual + &self.by * &change;
        let own = (0..grown.len()).map(|i| (grown[i], self.by.row(i).iter().copied().collect()));
        let none = || vec![0.0; change.len()];
        let drawn = self.draws.iter().enumerate();
        let drawn = drawn.filter(|(_, draw)| **draw > 0.0).map(|(i, &draw)| {
            let mut by = none();
            by[i] = draw;
            (draw * change[i], by)
        });
        own.chain(drawn).chain([(self.rest, none())]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::model::ResponseUnknown;
    use crate::response::study::Place;
    use crate::response::terms::TermSet;

    /// χ²(p) = χ²₀ + 2 gᵀΔ + ΔᵀHΔ, also where H tells one direction alone.
    #[test]
    fn the_rows_have_the_square_form_that_they_are_of() {
        let model = Model {
            drive: Place::Relative,
            response: Place::Relative,
            terms: TermSet::default(),
            unknowns: vec![
                ResponseUnknown::JointStiffness,
                ResponseUnknown::JointDamping,
            ],
            harmonics: 1,
        };
        let at = Values {
            mass: 2.0,
            joint_stiffness: 5e5,
            joint_damping: 2.0,
            ..Values::default()
        };
        for information in [[4.0, 3.0, 9.0], [4.0, 6.0, 9.0]] {
            let [first, both, second] = information;
            let normal = Normal {
                information: DMatrix::from_row_slice(2, 2, &[first, both, both, second]),
                gradient: DVector::from_row_slice(&[2.0, 3.0]),
                chi_squared: 50.0,
            };
            let rows = Rows::of(&at, &normal, (100, 1e-4));
            let mut moved = at;
            moved.joint_stiffness += 0.5;
            moved.joint_damping -= 0.25;
            let change = DVector::from_row_slice(&[0.5, -0.25]);
            let expected = 50.0
                + 2.0 * normal.gradient.dot(&change)
                + change.dot(&(&normal.information * &change));
            let squares = rows
                .at(&model, &moved)
                .into_iter()
                .map(|(own, _)| own * own);
            let found = squares.sum::<f64>();
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    }
}
