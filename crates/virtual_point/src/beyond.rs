//! Whether the budget explains what is not rigid, or one place has to be beyond it: errors of others within their budget look
//! like a large one of a place that lies badly.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::suspects::Spread;
use crate::{Place, Role, Tolerance, VirtualPoint, VirtualPointError};

/// Noise is at least this part of the functions: below it nobody measures.
const LEAST_NOISE: f64 = 1e-3;

/// Variance of the errors of a place that may be anything, in those of the budget.
const ANYTHING: f64 = 1e6;

impl VirtualPoint {
    /// By how much χ² falls where the errors of this place may be anything instead of within the budget: by about as many as it
    /// has for a good one. With M_k = (I − R T) dR_k T and E = (I − R T) Y,
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
        place: Place,
    ) -> Result<f64, VirtualPointError> {
        let spread = self.spread(role, lines)?;
        let projection = self.projection(role);
        let rest = projection.rest();
        let places = self.set_up().places(role);
        let weighted = projection.weights() * &rest;
        // in the budget's deviations
        let parameters = places.parameters();
        let changes: Vec<DMatrix<f64>> = (places.derivatives().iter().zip(&parameters))
            .map(|(change, one)| &rest * change * projection.inverse() * tolerance.of(one.change))
            .collect();
        let count = changes.len();
        let mut information = DMatrix::zeros(count, count);
        let mut pull = DVector::zeros(count);
        for (k, change) in changes.iter().enumerate() {
            let own = projection.weights() * change * &spread.matrix;
            for (l, other) in changes.iter().enumerate() {
                information[(k, l)] = own.dot(other);
            }
            pull[k] = own.dot(&rest);
        }
        let whole = (&weighted * &spread.matrix).dot(&rest);
        let eigen = information.clone().symmetric_eigen();
        let least = 1e-9 * eigen.eigenvalues.max();
        let mut explained = 0.0;
        let mut rank = 0.0;
        for (value, vector) in eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter())
        {
            if *value > least {
                explained += vector.dot(&pull).powi(2) / value;
                rank += 1.0;
            }
        }
        // real numbers of all lines, whose squares are 1 at each line
        let columns =
            lines.first().map_or(1, |line| line.len()) as f64 / projection.rows().nrows() as f64;
        let numbers = 2.0 * columns * spread.lines();
        let degrees = (numbers * (projection.rows().nrows() as f64 - 6.0) - rank).max(1.0);
        let noise = ((whole - explained) / degrees).max(
            LEAST_NOISE.powi(2) * spread.lines() / (numbers * projection.rows().nrows() as f64),
        );
        let freed: Vec<bool> = (parameters.iter())
            .map(|one| self.is_of(role, one.place, place))
            .collect();
        let squares = |variance: &dyn Fn(usize) -> f64| {
            let mut all = &information / noise;
            for k in 0..count {
                all[(k, k)] += 1.0 / variance(k);
            }
            let right = &pull / noise;
            all.cholesky().map(|root| -right.dot(&root.solve(&right)))
        };
        let within = squares(&|_| 1.0);
        let beyond = squares(&|k| if freed[k] { ANYTHING } else { 1.0 });
        Ok(match (within, beyond) {
            (Some(within), Some(beyond)) => (within - beyond).max(0.0),
            _ => 0.0,
        })
    }

    /// Whether a parameter's place is this one, or the sensor that it is a channel of.
    fn is_of(&self, role: Role, own: Place, place: Place) -> bool {
        let places = self.set_up().places(role);
        let sensor = match place {
            Place::Channel(row) => {
                let mut each = places.rows_of_each().into_iter();
                each.position(|rows| rows.contains(&row))
                    .map(|number| places.place(number))
            }
            other => Some(other),
        };
        Some(own) == sensor
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
        for seed in 1..=30 {
            let (point, lines) = trial(1000 * seed, None);
            for number in 0..3 {
                let place = Place::Sensor(number);
                let gain = point
                    .beyond_budget(Role::Channel, &lines, &Tolerance::TYPICAL, place)
                    .unwrap();
                assert!(gain < 30.0, "{seed} {number}: {gain}");
            }
            // the second sensor's y
            let (point, lines) = trial(1000 * seed, Some((9 + 1, 0.02)));
            let place = Place::Sensor(1);
            let gain = point
                .beyond_budget(Role::Channel, &lines, &Tolerance::TYPICAL, place)
                .unwrap();
            assert!(gain > 40.0, "{seed}: {gain}");
        }
    }
}
