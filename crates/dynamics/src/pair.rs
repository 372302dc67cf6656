//! Numbers of the two bodies side by side: the same arithmetic on both, which processors do in one instruction.

use std::ops::{Add, Mul, Sub};

/// One number of body a and one of body b.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(16))]
pub(crate) struct Pair {
    pub(crate) a: f64,
    pub(crate) b: f64,
}

impl Pair {
    #[inline]
    pub(crate) fn new(a: f64, b: f64) -> Self {
        Self { a, b }
    }

    /// The same number twice.
    #[inline]
    pub(crate) fn both(number: f64) -> Self {
        Self::new(number, number)
    }

    /// Each body's number as seen from the other: a − b and b − a.
    #[inline]
    pub(crate) fn relative(self) -> Self {
        self - Self::new(self.b, self.a)
    }
}

impl Add for Pair {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.a + other.a, self.b + other.b)
    }
}

impl Sub for Pair {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.a - other.a, self.b - other.b)
    }
}

impl Mul for Pair {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        Self::new(self.a * other.a, self.b * other.b)
    }
}

impl Mul<f64> for Pair {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f64) -> Self {
        self * Self::both(factor)
    }
}
