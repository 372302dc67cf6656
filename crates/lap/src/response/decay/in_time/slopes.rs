//! How what a motion leaves of a record grows with the model's unknowns and with its release.
//!
//! The release follows the unknowns, so that what is left of both is the information of the unknowns alone.

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

use super::release::Course;
use super::rows::Normal;
use super::search::{Run, Search};
use crate::response::decay::motion::Direction;
use crate::response::model::Values;

/// How the residual of a record grows with the unknowns and with its release.
pub(super) struct Slopes {
    by_unknown: DMatrix<f64>,
    pub(super) by_release: DMatrix<f64>,
    /// Information of the release, and of it (rows) with the unknowns.
    pub(super) of_release: Matrix2<f64>,
    pub(super) between: DMatrix<f64>,
    /// Of the unknowns, the release following.
    information: DMatrix<f64>,
}

impl Slopes {
    /// About a place; `None` where a motion near it is none of a decay.
    pub(super) fn about(
        search: &Search<'_>,
        values: &Values,
        run: &Run<'_>,
        course: &Course,
    ) -> Option<Self> {
        let of_unknowns = search
            .model
            .unknowns
            .iter()
            .copied()
            .map(Direction::Unknown);
        let of_release = [Direction::Displacement, Direction::Time];
        let directions: Vec<Direction> = of_release.into_iter().chain(of_unknowns).collect();
        let changes = search.changes(values, course.release, run, &directions)?;
        let (of_release, of_unknowns) = changes.columns_range_pair(..2, 2..);
        Self::of(of_unknowns.into_owned(), of_release.into_owned())
    }

    fn of(by_unknown: DMatrix<f64>, by_release: DMatrix<f64>) -> Option<Self> {
        let square = by_release.transpose() * &by_release;
        let of_release = Matrix2::from_fn(|i, j| square[(i, j)]);
        let between = by_release.transpose() * &by_unknown;
        let inverse = of_release.try_inverse()?;
        let inverse = DMatrix::from_fn(2, 2, |i, j| inverse[(i, j)]);
        // H = JᵀJ − JᵀK (KᵀK)⁻¹ KᵀJ
        let information =
            by_unknown.transpose() * &by_unknown - between.transpose() * inverse * &between;
        let is_finite = information.iter().all(|entry| entry.is_finite());
        is_finite.then_some(Self {
            by_unknown,
            by_release,
            of_release,
            between,
            information,
        })
    }

    /// With the residual of a course.
    pub(super) fn normal(&self, course: &Course) -> Normal {
        let of_release = self.by_release.transpose() * &course.residual;
        let right = Vector2::new(of_release[0], of_release[1]);
        let solved = self.of_release.lu().solve(&right).unwrap_or_default();
        let solved = DVector::from_column_slice(&[solved[0], solved[1]]);
        Normal {
            information: self.information.clone(),
            gradient: self.by_unknown.transpose() * &course.residual
                - self.between.transpose() * &solved,
            chi_squared: course.chi_squared() - of_release.dot(&solved),
        }
    }
}
