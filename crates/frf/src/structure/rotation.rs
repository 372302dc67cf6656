//! Rotational receptances from translations measured at neighbouring points.

use std::fmt;

use num_complex::Complex64;
use serde::{Deserialize, Serialize};

use super::coupling::ComplexMatrix;

/// On which side of the joint the neighbouring points lie (Tol Table 3.1); the axis along which θ = ∂w/∂x decides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Difference {
    /// On both sides; the joint is the middle one of three points, and θ is positive towards the last.
    #[default]
    Central,
    /// At larger x; the joint is the last point, the farthest comes first, and θ is positive towards the first.
    Forward,
    /// At smaller x; the joint is the last point, the farthest comes first, and θ is positive towards the last.
    Backward,
}

/// How many points a difference takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Two points: exact for a straight line.
    First,
    /// Three points: exact for a parabola.
    Second,
}

/// A finite difference over equally spaced points (Tol Table 3.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiniteDifference {
    difference: Difference,
    order: Order,
    spacing_m: f64,
}

impl FiniteDifference {
    /// A difference over points `spacing_m` apart, m. `None` for the central difference of first order: there is none.
    #[must_use]
    pub fn new(difference: Difference, order: Order, spacing_m: f64) -> Option<Self> {
        (difference != Difference::Central || order == Order::Second).then_some(Self {
            difference,
            order,
            spacing_m,
        })
    }

    /// The central difference (Tol 3.53).
    #[must_use]
    pub fn central(spacing_m: f64) -> Self {
        Self {
            difference: Difference::Central,
            order: Order::Second,
            spacing_m,
        }
    }

    /// On which side of the joint its points lie.
    #[must_use]
    pub fn side(&self) -> Difference {
        self.difference
    }

    /// Distance of neighbouring points, m.
    #[must_use]
    pub fn spacing_m(&self) -> f64 {
        self.spacing_m
    }

    /// Number of points.
    #[must_use]
    pub fn points(&self) -> usize {
        match self.order {
            Order::First => 2,
            Order::Second => 3,
        }
    }

    /// Which of the points is the joint.
    #[must_use]
    pub fn joint_point(&self) -> usize {
        match self.difference {
            Difference::Central => 1,
            Difference::Forward | Difference::Backward => self.points() - 1,
        }
    }

    /// T (2 × points) with (w, θ) = T (w₁, w₂, …).
    ///
    /// Receptances at the joint are T H Tᵀ (Tol 3.54), those between it and other points T H.
    #[must_use]
    pub fn transformation(&self) -> ComplexMatrix {
        let (whole, half) = (1.0 / self.spacing_m, 0.5 / self.spacing_m);
        // Tol Table 3.1; the second row of T
        let slope: &[f64] = match (self.difference, self.order) {
            (Difference::Central, _) => &[-half, 0.0, half],
            (Difference::Forward, Order::First) => &[whole, -whole],
            (Difference::Backward, Order::First) => &[-whole, whole],
            (Difference::Forward, Order::Second) => &[-half, 4.0 * half, -3.0 * half],
            (Difference::Backward, Order::Second) => &[half, -4.0 * half, 3.0 * half],
        };
        let joint = self.joint_point();
        ComplexMatrix::from_fn(2, slope.len(), |row, point| {
            Complex64::from(match row {
                0 => f64::from(u8::from(point == joint)),
                _ => slope[point],
            })
        })
    }
}

impl fmt::Display for FiniteDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = match self.difference {
            Difference::Central => "central",
            Difference::Forward => "forward",
            Difference::Backward => "backward",
        };
        let order = match self.order {
            Order::First => "first",
            Order::Second => "second",
        };
        let spacing_m = self.spacing_m;
        write!(
            f,
            "{side} difference of {order} order, points {spacing_m} m apart"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Positions of the points of a difference, m; the joint is at x = 0.
    fn positions(difference: &FiniteDifference) -> Vec<f64> {
        let s = difference.spacing_m;
        match (difference.difference, difference.order) {
            (Difference::Central, _) => vec![-s, 0.0, s],
            (Difference::Forward, Order::First) => vec![s, 0.0],
            (Difference::Backward, Order::First) => vec![-s, 0.0],
            (Difference::Forward, Order::Second) => vec![2.0 * s, s, 0.0],
            (Difference::Backward, Order::Second) => vec![-2.0 * s, -s, 0.0],
        }
    }

    fn all() -> Vec<FiniteDifference> {
        [
            Difference::Central,
            Difference::Forward,
            Difference::Backward,
        ]
        .into_iter()
        .flat_map(|difference| {
            [Order::First, Order::Second]
                .into_iter()
                .filter_map(move |order| FiniteDifference::new(difference, order, 0.015))
        })
        .collect()
    }

    #[test]
    fn polynomials_of_their_order_are_differentiated_exactly() {
        let all = all();
        assert_eq!(all.len(), 5);
        for difference in all {
            // w(x) = 3 + 2x (+ 5x²) has w = 3 and ∂w/∂x = 2 at x = 0.
            let curved = if difference.order == Order::Second {
                5.0
            } else {
                0.0
            };
            let field = |x: f64| 3.0 + 2.0 * x + curved * x * x;
            let w: Vec<f64> = positions(&difference).into_iter().map(field).collect();
            let measured =
                ComplexMatrix::from_fn(w.len(), w.len(), |p, q| Complex64::from(w[p] * w[q]));
            let transformation = difference.transformation();
            let found = &transformation * measured * transformation.transpose();
            for (place, expected) in [((0, 0), 9.0), ((0, 1), 6.0), ((1, 0), 6.0), ((1, 1), 4.0)] {
                let error = (found[place].re - expected).abs();
                assert!(error < 1e-10, "{difference:?} {place:?}");
            }
        }
    }

    #[test]
    fn their_errors_are_those_of_taylors_theorem() {
        // w = x³ has θ = 0 at x = 0: s² by the central difference, −2s² and by the one-sided ones of second order.
        let s = 0.015;
        for (difference, expected) in [
            (Difference::Central, s * s),
            (Difference::Forward, -2.0 * s * s),
            (Difference::Backward, -2.0 * s * s),
        ] {
            let difference = FiniteDifference::new(difference, Order::Second, s).unwrap();
            let transformation = difference.transformation();
            let slope: f64 = positions(&difference)
                .iter()
                .enumerate()
                .map(|(point, x)| transformation[(1, point)].re * x.powi(3))
                .sum();
            assert!((slope - expected).abs() < 1e-15, "{difference:?} {slope}");
        }
    }
}
