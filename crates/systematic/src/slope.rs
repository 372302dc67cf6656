//! How a structure is inclined at a point, by its motion at points and bolts near by: what a sensor reads that is not where it is
//! said to be.
//!
//! Between two bolts nothing acts on a structure but its own inertia, so that a polynomial through translations, and through
//! rotations where these are known, follows it. At a bolt a force and a moment act: a polynomial across it does not.

use nalgebra::{DMatrix, DVector};

/// Places that a slope is taken through, two to each side inside.
const NEAR: usize = 5;
/// Part of the distance of the nearest place within which a point is at a bolt.
const AT_A_BOLT: f64 = 1e-9;

/// A point or a bolt of a structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// Position along the structure, m.
    pub(crate) x_m: f64,
    /// Which of all motions its translation is.
    pub(crate) translation: usize,
    pub(crate) kind: Kind,
}

/// What is known of a place beside its translation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A point, where nothing acts.
    Point,
    /// A bolt, and which of all motions its rotation is, if it has one.
    Bolt { rotation: Option<usize> },
}

/// Motions and their weights in the slope dw/dx at a position, by the polynomial through the nearest places that no bolt is between;
/// empty where one place alone is there.
pub(crate) fn slope(x_m: f64, places: &[Place]) -> Vec<(usize, f64)> {
    let mut order: Vec<&Place> = places.iter().collect();
    order.sort_by(|one, other| one.x_m.total_cmp(&other.x_m));
    let is_bolt = |place: &&Place| place.kind != Kind::Point;
    let beyond = order.partition_point(|place| place.x_m < x_m);
    // from the bolt before to the bolt behind
    let first = order[..beyond].iter().rposition(is_bolt).unwrap_or(0);
    let last = order[beyond..].iter().position(is_bolt);
    let last = last.map_or(order.len(), |behind| beyond + behind + 1);
    let span = &order[first..last];
    let rank = beyond - first;
    let from = rank
        .saturating_sub(NEAR / 2)
        .min(span.len().saturating_sub(NEAR));
    through(x_m, &span[from..(from + NEAR).min(span.len())])
}

fn through(x_m: f64, near: &[&Place]) -> Vec<(usize, f64)> {
    let length = near.iter().map(|place| (place.x_m - x_m).abs());
    let length = length.fold(0.0, f64::max);
    // rows of 1, t, t² … and of their derivatives, t = (x − x₀)/L
    let mut conditions: Vec<(usize, f64, bool)> = Vec::new();
    for place in near {
        let t = (place.x_m - x_m) / length;
        if let Kind::Bolt {
            rotation: Some(rotation),
        } = place.kind
        {
            if length == 0.0 || t.abs() < AT_A_BOLT {
                return vec![(rotation, 1.0)];
            }
            conditions.push((rotation, t, true));
        }
        conditions.push((place.translation, t, false));
    }
    let count = conditions.len();
    if count < 2 || length == 0.0 {
        return Vec::new();
    }
    let matrix = DMatrix::from_fn(count, count, |row, power| {
        let (_, t, is_rotation) = conditions[row];
        let power = power as i32;
        match (is_rotation, power) {
            (false, _) => t.powi(power),
            (true, 0) => 0.0,
            (true, _) => f64::from(power) * t.powi(power - 1) / length,
        }
    });
    // w′(x₀) = c₁/L of the coefficients c
    let mut wanted = DVector::zeros(count);
    wanted[1] = length.recip();
    match matrix.transpose().lu().solve(&wanted) {
        Some(weights) => {
            let pairs = conditions.iter().zip(weights.iter());
            pairs.map(|(&(of, ..), &weight)| (of, weight)).collect()
        }
        None => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(translation: usize, x_m: f64) -> Place {
        Place {
            x_m,
            translation,
            kind: Kind::Point,
        }
    }

    fn at(motions: &[f64], weights: &[(usize, f64)]) -> f64 {
        weights
            .iter()
            .map(|&(of, weight)| weight * motions[of])
            .sum()
    }

    #[test]
    fn slopes_are_exact_on_polynomials_through_the_nearest_points() {
        let x = [0.3_f64, 0.1, 0.25, 0.6, 0.42, 0.9];
        for count in 3..=x.len() {
            let x = &x[..count];
            let places: Vec<Place> = x.iter().enumerate().map(|(i, &x)| point(i, x)).collect();
            let degree = (count - 1).min(4) as i32;
            let motions: Vec<f64> = x.iter().map(|x| x.powi(degree)).collect();
            for &x in x {
                let found = at(&motions, &slope(x, &places));
                let exact = f64::from(degree) * x.powi(degree - 1);
                assert!(
                    (found - exact).abs() < 1e-9,
                    "{count}, {x}: {found}, not {exact}"
                );
            }
        }
        // a line through two, and nothing through one
        let places = [point(0, 0.0), point(1, 0.5)];
        assert!((at(&[0.0, 1.0], &slope(0.0, &places)) - 2.0).abs() < 1e-12);
        assert_eq!(slope(0.0, &places[..1]), []);
    }

    /// w = |x − 0.1|³ beyond a bolt at 0.1 and 0.2 (x − 0.1) before it, to which points on the other side are no guide.
    #[test]
    fn no_slope_is_taken_across_a_bolt() {
        let bolt = Place {
            x_m: 0.1,
            translation: 4,
            kind: Kind::Bolt { rotation: Some(5) },
        };
        let x = [0.0_f64, 0.05, 0.15, 0.3];
        let mut places: Vec<Place> = x.iter().enumerate().map(|(i, &x)| point(i, x)).collect();
        places.push(bolt);
        let w = |x: f64| match x < 0.1 {
            true => 0.2 * (x - 0.1),
            false => 0.2 * (x - 0.1) + (x - 0.1).powi(3),
        };
        let mut motions: Vec<f64> = x.iter().map(|&x| w(x)).collect();
        motions.extend([0.0, 0.2]);
        for (x, exact) in [(0.0, 0.2), (0.05, 0.2), (0.15, 0.2075), (0.3, 0.32)] {
            let found = at(&motions, &slope(x, &places));
            assert!((found - exact).abs() < 1e-12, "{x}: {found}, not {exact}");
        }
        // at the bolt itself its rotation
        assert_eq!(slope(0.1, &places), [(5, 1.0)]);
    }
}
