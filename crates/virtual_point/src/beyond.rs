//! Whether the budget explains what is not rigid, or one place has to be beyond it: errors of others within their budget look
//! like a large one of a place that lies badly.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::diagnosis::diagnosed;
use crate::search::{Search, Start};
use crate::{Change, Place, Role, Tolerance, VirtualPoint, VirtualPointError};

/// Variance of the errors of a place that may be anything, in those of the budget.
const ANYTHING: f64 = 1e6;

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
        let places = self.set_up().places(role);
        let search = self.search(role, lines, &spread, tolerance);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::trial;

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
