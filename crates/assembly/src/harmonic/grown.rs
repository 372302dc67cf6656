//! The first motion of a forced response where it is far from small ones: followed from small loads on, through folds of the
//! motion over the load, which steps of the load alone do not pass.

use nalgebra::{DMatrix, DVector};

use super::Balance;
use super::follow::{Curve, follow, point};
use super::forced::Forced;

/// Share of the loads under which the motion is nearly the linear one.
const SMALL: f64 = 1e-3;

/// Forced motion at one frequency: unknowns are the motion and the share of the loads.
pub(super) struct Grown<'f, 'p, 'm> {
    forced: &'f Forced<'p, 'm>,
    omega: f64,
}

impl<'f, 'p, 'm> Grown<'f, 'p, 'm> {
    pub(super) fn new(forced: &'f Forced<'p, 'm>, omega: f64) -> Self {
        Self { forced, omega }
    }

    /// The first motion under the whole loads on the way from small ones, with the frequency behind it. `on_the_way` is called again
    /// and again.
    pub(super) fn to_full_load(&self, on_the_way: &dyn Fn()) -> Option<DVector<f64>> {
        let size = self.forced.problem.size();
        let mut start = self.forced.at_load(SMALL).linear(self.omega)?;
        start[size] = SMALL;
        let start = point(self, &start, size)?;
        let points = follow(self, start, size, 1.0, &|_| on_the_way()).ok()?;
        let mut last = points.into_iter().next_back()?;
        let is_there = last[size] == 1.0;
        last[size] = self.omega;
        is_there.then_some(last)
    }
}

impl Curve for Grown<'_, '_, '_> {
    fn at(&self, unknowns: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let problem = self.forced.problem;
        let (motion, share) = unknowns.as_slice().split_at(problem.size());
        let own = self.forced.at_load(*share.first()?);
        let linear = problem.linear(self.omega, 0.0, &own.loads)?;
        let Balance {
            residual,
            mut derivatives,
            ..
        } = problem.balance(&linear, motion, self.omega);
        // the loads come in as Z r + f − p: what is left without a motion is −p
        let rest = vec![0.0; problem.size()];
        let whole = problem.linear(self.omega, 0.0, &self.forced.loads)?;
        let by_share = problem.residual(&whole, &rest);
        derivatives.column_mut(problem.size()).copy_from(&by_share);
        Some((residual, derivatives))
    }

    fn scale(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let problem = self.forced.problem;
        let size = problem.size();
        let mut scale = DVector::from_element(size + 1, problem.amplitude(unknowns));
        scale[size] = unknowns[size].abs().max(SMALL);
        scale
    }
}
