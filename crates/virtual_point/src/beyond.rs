//! Whether the budget explains what is not rigid, or one place has to be beyond it: errors of others within their budget look
//! like a large one of a place that lies badly.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::diagnosis::diagnosed;
use crate::places::Places;
use crate::projection::Projection;
use crate::suspects::Spread;
use crate::{Change, Place, Role, Tolerance, VirtualPoint, VirtualPointError};

/// Noise is at least this part of the functions: below it nobody measures.
const LEAST_NOISE: f64 = 1e-3;

/// Eigenvalues below this part of the largest are none.
const NOTHING: f64 = 1e-9;

/// Variance of the errors of a place that may be anything, in those of the budget.
const ANYTHING: f64 = 1e6;

/// Steps of Gauss and Newton, and halvings of each.
const STEPS: usize = 12;
const HALVINGS: usize = 4;
/// χ² below which a step changes nothing.
const NEAR: f64 = 0.01;

impl VirtualPoint {
    /// By how much χ² falls where the errors of one place may be anything instead of within the budget, for each sensor or impact,
    /// the largest first: by about as many as it has errors for a good one. Two that differ by Δ are as likely as 1 to exp(Δ/2).
    /// With R(η) of the places displaced by errors η,
    ///
    /// χ² = min over η of ‖(I − R T) Y‖²/σ² + Σ (η_k/σ_k)²,
    ///
    /// σ² what no errors explain. A shift is not small beside the distances of the places, so that derivatives at the places of
    /// the drawing alone would name another.
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
        let spread = self.spread(role, lines)?;
        let functions = lines.first().map_or(0, DMatrix::len) as f64;
        let places = self.set_up().places(role);
        let search = Search {
            weights: self.projection(role).weights(),
            length_m: self.conditioning(role).length_m,
            spread: &spread,
            numbers: 2.0 * functions * spread.lines(),
            tolerance,
        };
        let drawn = search.told(places);
        let parameters = places.parameters();
        let beyond = |which: Option<Place>| -> Vec<f64> {
            let own = |place: &Place| match Some(*place) == which {
                true => ANYTHING.recip(),
                false => 1.0,
            };
            parameters.iter().map(|one| own(&one.place)).collect()
        };
        let all: Vec<Place> = (0..places.rows_of_each().len())
            .map(|number| places.place(number))
            .collect();
        let start = Start {
            places: places.clone(),
            errors: DVector::zeros(parameters.len()),
        };
        let fitted =
            |place: Option<Place>, noise: f64| search.fitted(&start, &beyond(place), noise);
        let first = drawn.as_ref().map_or(f64::INFINITY, |told| told.noise);
        // what stays where the errors of the one that is bad are known is less than at the places of the drawing
        let noise = all.iter().fold(first, |least, &place| {
            let own = fitted(Some(place), first);
            own.map_or(least, |own| least.min(own.noise))
        });
        let within = fitted(None, noise);
        let gain = |place: Place| {
            let Some(within) = &within else {
                return (place, 0.0);
            };
            // a search from the drawing may end in a minimum that is not the least
            let by_others = self.by_others(role, place, &search);
            let starts = [&start, &within.end].into_iter().chain(&by_others);
            let found = starts.map(|start| search.fitted(start, &beyond(Some(place)), noise));
            let least = found.flatten().map(|own| own.squares);
            (place, within.squares - least.fold(within.squares, f64::min))
        };
        let mut gains: Vec<(Place, f64)> = all.iter().map(|&place| gain(place)).collect();
        gains.sort_by(|(_, one), (_, other)| other.total_cmp(one));
        Ok(gains)
    }

    /// Where a search for errors of one place may begin: at the gain that all others tell of each of its rows, which may be far from
    /// that of the drawing, as that of a signal that is turned round.
    fn by_others(&self, role: Role, place: Place, search: &Search<'_>) -> Vec<Start> {
        let places = self.set_up().places(role);
        let first = match place {
            Place::Sensor(number) | Place::Impact(number) => places.rows_of_each()[number].start,
            Place::Channel(row) => row,
        };
        let parameters = places.parameters();
        let gains = (parameters.iter().enumerate()).filter_map(|(k, one)| match one.change {
            Change::Gain(row) if one.place == place => Some((k, first + row)),
            _ => None,
        });
        let starts = gains.filter_map(|(k, row)| {
            let (remaining, kept) = self.without(role, &[row])?;
            let told = diagnosed(places, &[row], &remaining, &kept, search.spread);
            let mut errors = DVector::zeros(parameters.len());
            errors[k] = (told.gains.first()? - 1.0) / search.tolerance.gain;
            let places = search.moved(places, &errors)?;
            Some(Start { places, errors })
        });
        starts.collect()
    }
}

/// What the functions are compared with.
struct Search<'a> {
    weights: &'a DMatrix<f64>,
    length_m: f64,
    spread: &'a Spread,
    /// Measured real numbers.
    numbers: f64,
    tolerance: &'a Tolerance,
}

/// What functions that are not rigid tell of errors, in deviations of the budget, at places.
struct Told {
    /// ‖(I − R T) Y‖²
    misfit: f64,
    information: DMatrix<f64>,
    pull: DVector<f64>,
    /// σ²
    noise: f64,
}

/// Errors, in deviations of the budget, and the places with them.
struct Start {
    places: Places,
    errors: DVector<f64>,
}

/// Errors that explain most.
struct Fitted {
    end: Start,
    /// χ²
    squares: f64,
    /// σ² there.
    noise: f64,
}

impl Search<'_> {
    fn told(&self, places: &Places) -> Option<Told> {
        let projection = Projection::new(
            places.matrix().clone(),
            self.weights.clone(),
            self.length_m,
            places.motions(),
        )?;
        let rest = projection.rest();
        let parameters = places.parameters();
        // (I − R T) dR_k T
        let changes: Vec<DMatrix<f64>> = (places.derivatives().iter().zip(&parameters))
            .map(|(change, one)| {
                &rest * change * projection.inverse() * self.tolerance.of(one.change)
            })
            .collect();
        let count = changes.len();
        let mut information = DMatrix::zeros(count, count);
        let mut pull = DVector::zeros(count);
        for (k, change) in changes.iter().enumerate() {
            let own = self.weights * change * &self.spread.matrix;
            for (l, other) in changes.iter().enumerate() {
                information[(k, l)] = own.dot(other);
            }
            pull[k] = own.dot(&rest);
        }
        let misfit = (self.weights * &rest * &self.spread.matrix).dot(&rest);
        // what errors of any size leave
        let eigen = information.clone().symmetric_eigen();
        let least = NOTHING * eigen.eigenvalues.max();
        let (mut left, mut rank) = (misfit, 0.0);
        for (value, vector) in (eigen.eigenvalues.iter()).zip(eigen.eigenvectors.column_iter()) {
            if *value > least {
                left -= vector.dot(&pull).powi(2) / value;
                rank += 1.0;
            }
        }
        let rows = projection.rows().nrows() as f64;
        let degrees =
            (self.numbers * (1.0 - places.motions().count() as f64 / rows) - rank).max(1.0);
        // the squares of each line are 1
        let least = LEAST_NOISE.powi(2) * self.spread.lines() / self.numbers;
        Some(Told {
            misfit,
            information,
            pull,
            noise: (left / degrees).max(least),
        })
    }

    /// By Gauss and Newton, with such 1/σ_k² in those of the budget.
    fn fitted(&self, start: &Start, precision: &[f64], noise: f64) -> Option<Fitted> {
        let priors = DVector::from_column_slice(precision);
        let prior = |errors: &DVector<f64>| errors.component_mul(errors).dot(&priors);
        let mut places = start.places.clone();
        let mut errors = start.errors.clone();
        let mut told = self.told(&places)?;
        let mut squares = told.misfit / noise + prior(&errors);
        for _ in 0..STEPS {
            let matrix = &told.information / noise + DMatrix::from_diagonal(&priors);
            let right = &told.pull / noise - priors.component_mul(&errors);
            let mut step = matrix.cholesky()?.solve(&right);
            let mut better = None;
            for _ in 0..HALVINGS {
                better = self.moved(&places, &step).and_then(|places| {
                    let told = self.told(&places)?;
                    let own = told.misfit / noise + prior(&(&errors + &step));
                    (own < squares).then_some((places, told, own))
                });
                if better.is_some() {
                    break;
                }
                step *= 0.5;
            }
            let Some(next) = better else { break };
            errors += step;
            let gained = squares - next.2;
            (places, told, squares) = next;
            if gained < NEAR {
                break;
            }
        }
        Some(Fitted {
            end: Start { places, errors },
            squares,
            noise: told.noise,
        })
    }

    /// Places moved by further errors, in deviations.
    fn moved(&self, places: &Places, step: &DVector<f64>) -> Option<Places> {
        let parameters = places.parameters();
        let errors = parameters.iter().zip(step.iter());
        let errors: Vec<f64> = errors
            .map(|(one, part)| part * self.tolerance.of(one.change))
            .collect();
        places.displaced(&errors).ok()
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

    /// Within the budget no sensor gains much more than its nine errors may by chance. One that lies badly is named or left open,
    /// and no other is ever named in its place.
    #[test]
    fn only_what_is_beyond_the_budget_gains() {
        let gains = |trial: (VirtualPoint, Vec<DMatrix<Complex64>>)| {
            let (point, lines) = trial;
            let tolerance = Tolerance::TYPICAL;
            point
                .beyond_budget(Role::Channel, &lines, &tolerance)
                .unwrap()
        };
        let mut named = 0;
        for seed in 1..=30 {
            let [(_, gain), ..] = gains(trial(1000 * seed, None))[..] else {
                panic!("three sensors")
            };
            assert!(gain < 30.0, "{seed}: {gain}");
            // the second sensor's y
            for size_m in [0.003, 0.006, 0.01, 0.02] {
                let all = gains(trial(1000 * seed, Some((9 + 1, size_m))));
                let [(place, first), (_, second), ..] = all[..] else {
                    panic!("three sensors")
                };
                if first > 40.0 && first > second + 20.0 {
                    assert_eq!(place, Place::Sensor(1), "{seed}, {size_m}: {all:?}");
                    named += usize::from(size_m == 0.02);
                }
            }
        }
        assert!(named > 20, "{named} of 30");
    }

    /// A signal that is turned round is far from the drawing, and no shift of another impact takes its place.
    #[test]
    fn a_turned_impact_is_named_among_errors_of_the_budget() {
        let tolerance = Tolerance::TYPICAL;
        let (point, _) = trial(1, None);
        let parameters = point.set_up().parameters();
        for impact in 0..9 {
            let place = Place::Impact(impact);
            let is_gain = |one: &crate::Parameter| {
                one.place == place && matches!(one.change, Change::Gain(_))
            };
            let parameter = parameters.iter().position(is_gain).unwrap();
            for seed in [3, 5, 7] {
                let (point, lines) = trial(1000 * seed, Some((parameter, -2.0)));
                let gains = point.beyond_budget(Role::Impact, &lines, &tolerance);
                let [(named, first), (_, second), ..] = gains.unwrap()[..] else {
                    panic!("nine impacts")
                };
                assert_eq!(named, place, "{seed}: {first} {second}");
                assert!(first > second + 20.0, "{seed}, {impact}: {first} {second}");
            }
        }
    }
}
