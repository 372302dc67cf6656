//! Whether the budget explains what is not rigid, or one place has to be beyond it: errors of others within their budget look
//! like a large one of a place that lies badly.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::{Place, Role, Tolerance, VirtualPoint, VirtualPointError};

/// Noise is at least this part of the functions: below it nobody measures.
const LEAST_NOISE: f64 = 1e-3;

/// Eigenvalues below this part of the largest are none.
const NOTHING: f64 = 1e-9;

/// Variance of the errors of a place that may be anything, in those of the budget.
const ANYTHING: f64 = 1e6;

impl VirtualPoint {
    /// By how much χ² falls where the errors of one place may be anything instead of within the budget, for each sensor or impact,
    /// the largest first: by about as many as it has errors for a good one. Two that differ by Δ are as likely as 1 to exp(Δ/2).
    /// With M_k = (I − R T) dR_k T and E = (I − R T) Y,
    ///
    /// χ² = min over η of ‖E − Σ η_k M_k Y‖²/σ² + Σ (η_k/σ_k)²,
    ///
    /// σ² what no errors explain.
    ///
    /// # Errors
    ///
    /// Those of [`Self::consistency`].
    pub fn beyond_budget(
        &self,
        role: Role,
        lines: &[DMatrix<Complex64>],
        tolerance: &Tolerance,
    ) -> Result<Vec<(Place, f64)>, VirtualPointError> {
        let told = Told::of(self, role, lines, tolerance)?;
        let places = self.set_up().places(role);
        let parameters = places.parameters();
        let within = told.squares(|_| 1.0);
        let mut all: Vec<(Place, f64)> = (0..places.rows_of_each().len())
            .map(|number| {
                let place = places.place(number);
                let variance = |k: usize| match parameters[k].place == place {
                    true => ANYTHING,
                    false => 1.0,
                };
                let gain = within.zip(told.squares(variance));
                (place, gain.map_or(0.0, |(within, beyond)| within - beyond))
            })
            .collect();
        all.sort_by(|(_, one), (_, other)| other.total_cmp(one));
        Ok(all)
    }
}

/// What functions that are not rigid tell of errors, in deviations of the budget.
struct Told {
    information: DMatrix<f64>,
    pull: DVector<f64>,
    /// σ²
    noise: f64,
}

impl Told {
    fn of(
        point: &VirtualPoint,
        role: Role,
        lines: &[DMatrix<Complex64>],
        tolerance: &Tolerance,
    ) -> Result<Self, VirtualPointError> {
        let spread = point.spread(role, lines)?;
        let projection = point.projection(role);
        let (rest, weights) = (projection.rest(), projection.weights());
        let places = point.set_up().places(role);
        let parameters = places.parameters();
        let changes: Vec<DMatrix<f64>> = (places.derivatives().iter().zip(&parameters))
            .map(|(change, one)| &rest * change * projection.inverse() * tolerance.of(one.change))
            .collect();
        let count = changes.len();
        let mut information = DMatrix::zeros(count, count);
        let mut pull = DVector::zeros(count);
        for (k, change) in changes.iter().enumerate() {
            let own = weights * change * &spread.matrix;
            for (l, other) in changes.iter().enumerate() {
                information[(k, l)] = own.dot(other);
            }
            pull[k] = own.dot(&rest);
        }
        // what errors of any size leave
        let eigen = information.clone().symmetric_eigen();
        let least = NOTHING * eigen.eigenvalues.max();
        let mut left = (weights * &rest * &spread.matrix).dot(&rest);
        let mut rank = 0.0;
        for (value, vector) in (eigen.eigenvalues.iter()).zip(eigen.eigenvectors.column_iter()) {
            if *value > least {
                left -= vector.dot(&pull).powi(2) / value;
                rank += 1.0;
            }
        }
        let rows = projection.rows().nrows() as f64;
        let functions = lines.first().map_or(0, DMatrix::len) as f64;
        let numbers = 2.0 * functions * spread.lines();
        let degrees = (numbers * (1.0 - 6.0 / rows) - rank).max(1.0);
        // the squares of each line are 1
        let least = LEAST_NOISE.powi(2) * spread.lines() / numbers;
        Ok(Self {
            information,
            pull,
            noise: (left / degrees).max(least),
        })
    }

    /// χ² less that without errors, where these have such variances.
    fn squares(&self, variance: impl Fn(usize) -> f64) -> Option<f64> {
        let mut all = &self.information / self.noise;
        for k in 0..all.nrows() {
            all[(k, k)] += 1.0 / variance(k);
        }
        let right = &self.pull / self.noise;
        Some(-right.dot(&all.cholesky()?.solve(&right)))
    }
}

#[cfg(test)]
mod tests {
    use bolted_joint_space::Axes;
    use nalgebra::{Matrix6, Vector3};

    use super::*;
    use crate::samples::Mixed;
    use crate::{Impact, Sensor, SetUp, Weights};

    /// Sensors and impacts at random places; functions of a set-up with errors of these sizes, in deviations, and noise.
    fn trial(seed: u64, bad: Option<(usize, f64)>) -> (VirtualPoint, Vec<DMatrix<Complex64>>) {
        let mut mixed = Mixed(seed);
        let mut place = || Vector3::from_fn(|_, _| 0.03 * mixed.next());
        let sensors: Vec<_> = (0..3)
            .map(|_| Sensor::triaxial(place(), &Axes::identity(), [1.0; 3]).unwrap())
            .collect();
        let impacts: Vec<_> = (0..9)
            .map(|_| Impact::new(place(), place().normalize(), 1.0).unwrap())
            .collect();
        let set_up = SetUp::new(&sensors, &impacts).unwrap();
        let tolerance = Tolerance::TYPICAL;
        let mut errors: Vec<f64> = (set_up.parameters().iter())
            .map(|one| 1.7 * mixed.next() * tolerance.of(one.change))
            .collect();
        if let Some((parameter, size)) = bad {
            errors[parameter] = size;
        }
        let displaced = set_up.displaced(&errors).unwrap();
        let lines = (0..8).map(|_| {
            let scale = |i: usize| if i < 3 { 1.0 } else { 30.0 };
            let receptance = Matrix6::from_fn(|i, j| {
                Complex64::new(mixed.next(), mixed.next()) * scale(i) * scale(j)
            });
            displaced
                .functions(&receptance)
                .map(|value| value * (1.0 + 0.002 * mixed.next()))
        });
        let lines = lines.collect();
        let point = VirtualPoint::new(set_up, &Weights::Equal, &Weights::Equal).unwrap();
        (point, lines)
    }

    /// Of 30 set-ups within the budget no sensor gains more than its nine errors may by chance; one that is 20 mm off does.
    #[test]
    fn only_what_is_beyond_the_budget_gains() {
        let most = |trial: (VirtualPoint, Vec<DMatrix<Complex64>>)| {
            let (point, lines) = trial;
            let tolerance = Tolerance::TYPICAL;
            point
                .beyond_budget(Role::Channel, &lines, &tolerance)
                .unwrap()[0]
        };
        for seed in 1..=30 {
            let (_, gain) = most(trial(1000 * seed, None));
            assert!(gain < 30.0, "{seed}: {gain}");
            // the second sensor's y
            let (place, gain) = most(trial(1000 * seed, Some((9 + 1, 0.02))));
            assert!(
                gain > 40.0 && place == Place::Sensor(1),
                "{seed}: {place:?} {gain}"
            );
        }
    }
}
