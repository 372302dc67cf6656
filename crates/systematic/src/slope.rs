//! How a structure is inclined at a point, by its motion at points and bolts near by: what a sensor reads that is not where it is
//! said to be.
//!
//! Between two bolts nothing acts on a structure but its own inertia, so that a sum of shapes ([`super::bending_shape`]) through
//! translations, and through rotations where these are known, follows it. At a bolt a force and a moment act: a sum across it does
//! not. Where the load of a function acts at ξ, its shear force jumps, and the third derivative by 1/EI: the sum is that of
//! w − C₃(|x − ξ|)/2EI.

use nalgebra::{DMatrix, DVector};

use super::bending_shape::Waves;
use super::place::{Condition, Kind, Place};

/// Places that a slope is taken through, two to each side inside.
const NEAR: usize = 5;
/// Conditions that a cubic meets. Fewer leave open on which side of a load the third derivative is, so that a jump of it adds nothing.
const CUBIC: usize = 4;
/// Part of the distance of the nearest place within which a point is at a bolt.
const AT_A_BOLT: f64 = 1e-9;

/// The slopes at all points of an assembly.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PointSlopes {
    /// In each row the weights of the motions of all points, of A's DOFs at the joint and of B's.
    pub(crate) weights: DMatrix<f64>,
    /// In each row what a unit force at each of the points adds, rad/N.
    pub(crate) by_loads: DMatrix<f64>,
}

/// The slope dw/dx at a position.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Slope {
    /// Motions and their weights in it; none where one place alone is there.
    pub(crate) weights: Vec<(usize, f64)>,
    /// What the jump of each load adds, for a unit force and EI of one, m².
    pub(crate) by_loads: Vec<f64>,
}

/// By the sum of shapes that goes through the nearest places that no bolt is between; the loads act at these positions, m.
pub(crate) fn slope(x_m: f64, places: &[Place], loads_m: &[f64], waves: Waves) -> Slope {
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
    let near = &span[from..(from + NEAR).min(span.len())];
    let conditions = conditions(x_m, near);
    let positions = || conditions.iter().map(|condition| condition.x_m);
    let ends = positions().fold([x_m; 2], |[least, most], x| [least.min(x), most.max(x)]);
    let bending = waves.over(ends[1] - ends[0]);
    let weights = weights(x_m, &conditions, bending);
    let by_load = |load_m: &f64| {
        let reached = conditions.iter().zip(&weights);
        let of_places =
            reached.map(|(condition, weight)| weight * condition.by_load(*load_m, bending));
        let own = Condition {
            motion: 0,
            x_m,
            is_rotation: true,
        };
        own.by_load(*load_m, bending) - of_places.sum::<f64>()
    };
    Slope {
        by_loads: match weights.len() {
            ..CUBIC => vec![0.0; loads_m.len()],
            _ => loads_m.iter().map(by_load).collect(),
        },
        weights: conditions
            .iter()
            .map(|one| one.motion)
            .zip(weights)
            .collect(),
    }
}

/// The rotation alone where the position is that of a bolt.
fn conditions(x_m: f64, near: &[&Place]) -> Vec<Condition> {
    let reach = reach(x_m, near.iter().map(|place| place.x_m));
    let all = near.iter().flat_map(|place| place.conditions());
    let all: Vec<Condition> = all.collect();
    let is_own = |condition: &&Condition| {
        condition.is_rotation && (condition.x_m - x_m).abs() <= AT_A_BOLT * reach
    };
    match all.iter().find(is_own) {
        Some(rotation) => vec![*rotation],
        None => all,
    }
}

/// Distance of the furthest of some positions.
fn reach(x_m: f64, positions_m: impl Iterator<Item = f64>) -> f64 {
    positions_m.fold(0.0, |furthest, x| furthest.max((x - x_m).abs()))
}

/// Of each condition its weight in the slope, with κ⁴; none where they do not determine one.
fn weights(x_m: f64, conditions: &[Condition], bending: f64) -> Vec<f64> {
    if let [only] = conditions
        && only.is_rotation
    {
        return vec![1.0];
    }
    let length = reach(x_m, conditions.iter().map(|condition| condition.x_m));
    let count = conditions.len();
    if count < 2 || length == 0.0 {
        return Vec::new();
    }
    // rows of C_n(t) and of their derivatives, t = (x − x₀)/L
    let matrix = DMatrix::from_fn(count, count, |row, n| {
        conditions[row].of_shape(n, x_m, length, bending)
    });
    // w′(x₀) = c₁/L of the coefficients c
    let mut wanted = DVector::zeros(count);
    wanted[1] = length.recip();
    let solved = matrix.transpose().lu().solve(&wanted);
    solved.map_or_else(Vec::new, |weights| weights.iter().copied().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const AT_REST: Waves = Waves::new(0.0, 1.0);

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
                let found = at(&motions, &slope(x, &places, &[], AT_REST).weights);
                let exact = f64::from(degree) * x.powi(degree - 1);
                assert!(
                    (found - exact).abs() < 1e-9,
                    "{count}, {x}: {found}, not {exact}"
                );
            }
        }
        // a line through two, and nothing through one
        let places = [point(0, 0.0), point(1, 0.5)];
        assert!((at(&[0.0, 1.0], &slope(0.0, &places, &[], AT_REST).weights) - 2.0).abs() < 1e-12);
        let alone = slope(0.0, &places[..1], &[0.0], AT_REST);
        assert_eq!((alone.weights, alone.by_loads), (vec![], vec![0.0]));
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
            let found = at(&motions, &slope(x, &places, &[], AT_REST).weights);
            assert!((found - exact).abs() < 1e-12, "{x}: {found}, not {exact}");
        }
        // at the bolt itself its rotation
        let at_bolt = slope(0.1, &places, &[0.3], AT_REST);
        assert_eq!(
            (at_bolt.weights, at_bolt.by_loads),
            (vec![(5, 1.0)], vec![0.0])
        );
    }

    /// A free wave of a beam, and where it is measured: at four points and beside a bolt with its rotation.
    #[test]
    fn a_beam_that_vibrates_has_its_own_slope() {
        let kappa: f64 = 4.0;
        let w = |x: f64| {
            (kappa * x).sin() + 0.3 * (kappa * x).cos() - 0.2 * (-kappa * x).exp()
                + 0.01 * (kappa * x).exp()
        };
        let slope_of = |x: f64| {
            let (s, c) = ((kappa * x).sin(), (kappa * x).cos());
            kappa * (c - 0.3 * s + 0.2 * (-kappa * x).exp() + 0.01 * (kappa * x).exp())
        };
        let x = [0.2_f64, 0.3, 0.45, 0.6];
        let mut places: Vec<Place> = x.iter().enumerate().map(|(i, &x)| point(i, x)).collect();
        places.push(Place {
            x_m: 0.1,
            translation: 4,
            kind: Kind::Bolt { rotation: Some(5) },
        });
        let mut motions: Vec<f64> = x.iter().map(|&x| w(x)).collect();
        motions.extend([w(0.1), slope_of(0.1)]);
        let error = |waves: Waves| {
            let of = |&x: &f64| at(&motions, &slope(x, &places, &[], waves).weights) - slope_of(x);
            x.iter()
                .map(of)
                .fold(0.0, |largest: f64, error| largest.max(error.abs()))
        };
        let (own, at_rest) = (error(Waves::new(kappa.powi(4), 1.0)), error(AT_REST));
        assert!(own < 1e-11 && at_rest > 1e-3, "{own}, {at_rest}");
    }

    /// A beam of EI = 7 with a force at ξ: a cubic and (x − ξ)³₊/6EI.
    #[test]
    fn a_load_between_the_points_makes_no_error() {
        let (stiffness, load) = (7.0, 0.42);
        let x = [0.1_f64, 0.25, 0.42, 0.6, 0.9];
        let places: Vec<Place> = x.iter().enumerate().map(|(i, &x)| point(i, x)).collect();
        let beyond = |x: f64| (x - load).max(0.0);
        let w = |x: f64| 1.0 - x + x.powi(3) + beyond(x).powi(3) / (6.0 * stiffness);
        let motions: Vec<f64> = x.iter().map(|&x| w(x)).collect();
        for x in x {
            let exact = 3.0 * x * x - 1.0 + beyond(x).powi(2) / (2.0 * stiffness);
            let slope = slope(x, &places, &[load], AT_REST);
            let found = at(&motions, &slope.weights) + slope.by_loads[0] / stiffness;
            assert!((found - exact).abs() < 1e-12, "{x}: {found}, not {exact}");
        }
    }
}
