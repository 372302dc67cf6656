//! The numbers that laws compute with: real ones, and real ones with their changes, so that a law is written once and its
//! tangents follow from it.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::elementary;

/// A number that a law can be evaluated with.
pub trait Number:
    Copy
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Nought.
    const ZERO: Self;

    /// The number without its changes.
    fn value(self) -> f64;

    /// Whether it is nought, and does not change.
    fn is_zero(self) -> bool;

    /// Whether it is a finite number, and its changes are.
    fn is_finite(self) -> bool;

    /// A function of it, by the function's value and slope there.
    fn chain(self, value: f64, slope: f64) -> Self;

    /// eˣ
    #[inline]
    fn exp(self) -> Self {
        let value = elementary::exp(self.value());
        self.chain(value, value)
    }

    /// eˣ − 1, as precise as x where x is small.
    #[inline]
    fn exp_m1(self) -> Self {
        let value = elementary::exp_m1(self.value());
        self.chain(value, value + 1.0)
    }

    /// x^y for x ≥ 0, with the limits of its changes at x = 0 where y > 1.
    #[inline]
    fn powf(self, exponent: Self) -> Self {
        let (x, y) = (self.value(), exponent.value());
        if x == 0.0 {
            // d(x^y) = y x^(y−1) dx + x^y ln x dy, both of which vanish with x where y > 1
            return Self::from(if y == 0.0 { 1.0 } else { 0.0 });
        }
        let logarithm = elementary::ln(x);
        let value = elementary::exp(y * logarithm);
        // the sum of both partial changes; each carries the value, which counts once
        self.chain(value, y * value / x)
            + (exponent.chain(value, value * logarithm) - Self::from(value))
    }
}

/// |x|
#[inline]
pub(crate) fn magnitude<N: Number>(x: N) -> N {
    if x.value() < 0.0 { -x } else { x }
}

impl Number for f64 {
    const ZERO: Self = 0.0;

    #[inline]
    fn value(self) -> f64 {
        self
    }

    #[inline]
    fn is_zero(self) -> bool {
        self == 0.0
    }

    #[inline]
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }

    #[inline]
    fn chain(self, value: f64, _: f64) -> Self {
        value
    }
}

/// A number and its first-order changes along `K` directions, by forward differentiation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const K: usize> {
    /// The number.
    pub value: f64,
    /// Its change along each direction.
    pub change: [f64; K],
}

impl<const K: usize> Dual<K> {
    /// A number with its changes.
    #[inline]
    #[must_use]
    pub const fn new(value: f64, change: [f64; K]) -> Self {
        Self { value, change }
    }

    /// The number that is itself the direction with this index.
    #[inline]
    #[must_use]
    pub fn along(value: f64, direction: usize) -> Self {
        let change = std::array::from_fn(|k| if k == direction { 1.0 } else { 0.0 });
        Self { value, change }
    }

    /// d(x y) = dx y + x dy
    #[inline]
    fn product(&self, other: &Self) -> Self {
        Self::changed(self.value * other.value, |k| {
            self.change[k] * other.value + self.value * other.change[k]
        })
    }

    /// d(x/y) = (dx − (x/y) dy)/y
    #[inline]
    fn quotient(&self, other: &Self) -> Self {
        let value = self.value / other.value;
        Self::changed(value, |k| {
            (self.change[k] - value * other.change[k]) / other.value
        })
    }

    #[inline]
    fn changed(value: f64, change: impl Fn(usize) -> f64) -> Self {
        Self {
            value,
            change: std::array::from_fn(change),
        }
    }
}

impl<const K: usize> From<f64> for Dual<K> {
    #[inline]
    fn from(value: f64) -> Self {
        Self {
            value,
            change: [0.0; K],
        }
    }
}

impl<const K: usize> Number for Dual<K> {
    const ZERO: Self = Self {
        value: 0.0,
        change: [0.0; K],
    };

    #[inline]
    fn value(self) -> f64 {
        self.value
    }

    #[inline]
    fn is_zero(self) -> bool {
        self.value == 0.0 && self.change == [0.0; K]
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.value.is_finite() && self.change.iter().all(|change| change.is_finite())
    }

    #[inline]
    fn chain(self, value: f64, slope: f64) -> Self {
        Self::changed(value, |k| slope * self.change[k])
    }
}

impl<const K: usize> Add for Dual<K> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self::changed(self.value + other.value, |k| {
            self.change[k] + other.change[k]
        })
    }
}

impl<const K: usize> Sub for Dual<K> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::changed(self.value - other.value, |k| {
            self.change[k] - other.change[k]
        })
    }
}

impl<const K: usize> Mul for Dual<K> {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        self.product(&other)
    }
}

impl<const K: usize> Div for Dual<K> {
    type Output = Self;

    #[inline]
    fn div(self, other: Self) -> Self {
        self.quotient(&other)
    }
}

impl<const K: usize> Neg for Dual<K> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self::changed(-self.value, |k| -self.change[k])
    }
}

#[cfg(test)]
mod tests {
    use super::{Dual, Number};

    /// x³/(1 + x y) − y
    fn function<N: Number>(x: N, y: N) -> N {
        x * x * x / (N::from(1.0) + x * y) - y
    }

    #[test]
    fn changes_are_the_partial_derivatives() {
        let (x, y): (f64, f64) = (1.3, -0.4);
        let found = function(Dual::<2>::along(x, 0), Dual::along(y, 1));
        let below = 1.0 + x * y;
        let by_x = (3.0 * x * x * below - x.powi(3) * y) / (below * below);
        let by_y = -x.powi(4) / (below * below) - 1.0;
        assert_eq!(found.value, function(x, y));
        assert!((found.change[0] - by_x).abs() < 1e-14);
        assert!((found.change[1] - by_y).abs() < 1e-14);
        assert_eq!((-found).change[0], -found.change[0]);
    }

    #[test]
    fn elementary_functions_change_as_their_differences() {
        let [x, y] = [Dual::<2>::along(0.7, 0), Dual::along(1.6, 1)];
        let found = x.powf(y) + (x * y).exp_m1() - (y - x).exp();
        let at = |x: f64, y: f64| x.powf(y) + (x * y).exp_m1() - (y - x).exp();
        let h = 1e-6;
        let expected = [
            (at(0.7 + h, 1.6) - at(0.7 - h, 1.6)) / (2.0 * h),
            (at(0.7, 1.6 + h) - at(0.7, 1.6 - h)) / (2.0 * h),
        ];
        assert!((found.value - at(0.7, 1.6)).abs() < 1e-14);
        for (found, expected) in found.change.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-8, "{found} {expected}");
        }
        assert_eq!(Dual::<1>::along(0.0, 0).powf(1.3.into()), Dual::ZERO);
    }

    #[test]
    fn what_changes_is_not_nought() {
        assert!(!Dual::<1>::along(0.0, 0).is_zero());
        assert!(Dual::<1>::from(-0.0).is_zero());
        assert!(!Dual::new(1.0, [f64::NAN]).is_finite());
    }
}
