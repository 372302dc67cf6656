//! Motion under loads of one frequency: unknowns are the motion and the frequency.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::follow::{Curve, point};
use super::{Balance, ForcedPoint, OF_FREQUENCY, Problem, VARIED};

/// Loads of the first point come in so many parts.
const PARTS: u32 = 20;

/// Forced motion: unknowns are the motion and ω.
pub(super) struct Forced<'p, 'm> {
    pub(super) problem: &'p Problem<'m>,
    pub(super) loads: DVector<Complex64>,
}

impl Forced<'_, '_> {
    /// The motion without the laws.
    pub(super) fn linear(&self, omega: f64) -> Option<DVector<f64>> {
        let problem = self.problem;
        let linear = problem.linear(omega, 0.0, &self.loads)?;
        let first = linear.at.first()?;
        let r = first.stiffness.clone().lu().solve(&first.load)?;
        let mut start = DVector::zeros(problem.size() + 1);
        for dof in 0..r.len() {
            let place = problem.place(dof, 0);
            start[place] = r[dof].re;
            start[place + 1] = -r[dof].im;
        }
        start[problem.size()] = omega;
        Some(start)
    }

    /// The motion at a frequency (rad/s), which grows with the loads in equal parts.
    pub(super) fn in_parts(&self, omega: f64) -> Option<DVector<f64>> {
        let size = self.problem.size();
        let mut start = self.at_load(f64::from(PARTS).recip()).linear(omega)?;
        for part in 1..=PARTS {
            let share = f64::from(part) / f64::from(PARTS);
            if part > 1 {
                start *= share / (share - 1.0 / f64::from(PARTS));
                start[size] = omega;
            }
            start = point(&self.at_load(share), &start, size)?;
        }
        Some(start)
    }

    /// The same under a part of the loads.
    pub(super) fn at_load(&self, share: f64) -> Self {
        Self {
            problem: self.problem,
            loads: &self.loads * Complex64::from(share),
        }
    }

    pub(super) fn outputs(&self, unknowns: &DVector<f64>) -> Option<ForcedPoint> {
        let problem = self.problem;
        let omega = unknowns[problem.size()];
        let motion = unknowns.as_slice().get(..problem.size())?;
        let linear = problem.linear(omega, 0.0, &self.loads)?;
        let forces = problem.balance(&linear, motion, omega).forces;
        let harmonics = problem.sampling.orders().len();
        let all: Vec<DVector<Complex64>> = (0..harmonics)
            .map(|own| problem.outputs(&linear, &forces, own))
            .collect();
        let first = all.first()?;
        let largest = (0..first.len()).map(|output| {
            let pairs = all.iter().flat_map(|own| [own[output].re, -own[output].im]);
            let coefficients: Vec<f64> = pairs.collect();
            problem.sampling.largest(&coefficients)
        });
        Some(ForcedPoint {
            frequency_hz: omega / TAU,
            largest: largest.collect(),
            fundamental: first.iter().copied().collect(),
        })
    }
}

impl Curve for Forced<'_, '_> {
    fn at(&self, unknowns: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let problem = self.problem;
        let (motion, omega) = unknowns.as_slice().split_at(problem.size());
        let omega = *omega.first()?;
        let change = VARIED * omega;
        let linear = problem.linear(omega, 0.0, &self.loads)?;
        let next = problem.linear(omega + change, 0.0, &self.loads)?;
        let Balance {
            residual,
            mut derivatives,
            ..
        } = problem.balance(&linear, motion, omega);
        let mut by_omega = derivatives.column_mut(problem.size());
        by_omega += problem.by_change([&linear, &next], motion, change);
        Some((residual, derivatives))
    }

    fn scale(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let size = self.problem.size();
        let mut scale = DVector::from_element(size + 1, self.problem.amplitude(unknowns));
        scale[size] = OF_FREQUENCY * unknowns[size];
        scale
    }
}
