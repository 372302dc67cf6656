//! Numbers of several lines side by side, so that one instruction of the processor works on more than one line.
//!
//! Each lane is computed as it would be alone, so results do not depend on the processor. Of plain arrays the compiler makes vectors
//! of whatever stands side by side in memory, which often is not the lanes.

use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use num_complex::Complex64;
use wide::f64x4;

/// Lines side by side.
pub(super) const LANES: usize = 4;

/// A real number of each of several lines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Reals(f64x4);

/// A complex number of each of several lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Complexes {
    pub(super) re: Reals,
    pub(super) im: Reals,
}

/// A complex number of one line or of several.
pub(super) trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// Zero in every lane.
    const ZERO: Self;
    /// One in every lane.
    const ONE: Self;

    /// 1/z; `None` where that is not finite, in any lane.
    fn reciprocal(self) -> Option<Self>;

    /// Whether |self| > |other|, decided for all lanes together by the sum over them.
    fn outweighs(self, other: Self) -> bool;
}

impl Number for Complex64 {
    const ZERO: Self = Complex64::new(0.0, 0.0);
    const ONE: Self = Complex64::new(1.0, 0.0);

    #[inline(always)]
    fn reciprocal(self) -> Option<Self> {
        let size = self.norm_sqr();
        (size.is_finite() && size > 0.0).then(|| self.conj() / size)
    }

    #[inline(always)]
    fn outweighs(self, other: Self) -> bool {
        self.norm_sqr() > other.norm_sqr()
    }
}

impl Number for Complexes {
    const ZERO: Self = Self {
        re: Reals::ZERO,
        im: Reals::ZERO,
    };
    const ONE: Self = Self {
        re: Reals(f64x4::ONE),
        im: Reals::ZERO,
    };

    #[inline(always)]
    fn reciprocal(self) -> Option<Self> {
        let size = self.norm_sqr();
        if !size
            .lanes()
            .iter()
            .all(|size| size.is_finite() && *size > 0.0)
        {
            return None;
        }
        Some(Self {
            re: self.re / size,
            im: -(self.im / size),
        })
    }

    #[inline(always)]
    fn outweighs(self, other: Self) -> bool {
        self.norm_sqr().sum() > other.norm_sqr().sum()
    }
}

impl Reals {
    pub(super) const ZERO: Self = Self(f64x4::ZERO);

    /// The same number in every lane.
    #[inline(always)]
    pub(super) fn all(value: f64) -> Self {
        Self(f64x4::splat(value))
    }

    /// The number of each lane.
    #[inline(always)]
    pub(super) fn of(value: impl Fn(usize) -> f64) -> Self {
        Self(f64x4::new(std::array::from_fn(value)))
    }

    #[inline(always)]
    pub(super) fn lanes(self) -> [f64; LANES] {
        self.0.to_array()
    }

    /// The number of one lane.
    #[inline(always)]
    pub(super) fn lane(self, lane: usize) -> f64 {
        self.0.as_array()[lane]
    }

    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, value: f64) {
        self.0.as_mut_array()[lane] = value;
    }

    /// `yes` in the lanes where this is above zero, `no` in the others.
    #[inline(always)]
    pub(super) fn where_positive(self, yes: Self, no: Self) -> Self {
        Self(self.0.simd_gt(f64x4::ZERO).select(yes.0, no.0))
    }

    /// The larger one; in lanes where one is no number it may be either.
    #[inline(always)]
    pub(super) fn at_least(self, least: Self) -> Self {
        Self(self.0.fast_max(least.0))
    }

    /// The smaller one; in lanes where one is no number it may be either.
    #[inline(always)]
    pub(super) fn at_most(self, most: Self) -> Self {
        Self(self.0.fast_min(most.0))
    }

    /// The sum over the lanes.
    #[inline(always)]
    pub(super) fn sum(self) -> f64 {
        self.lanes().iter().sum()
    }

    #[inline(always)]
    pub(super) fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    pub(super) fn reciprocal(self) -> Self {
        Self(f64x4::ONE / self.0)
    }
}

impl Complexes {
    /// The number of each lane.
    #[inline(always)]
    pub(super) fn of(value: impl Fn(usize) -> Complex64) -> Self {
        let values: [Complex64; LANES] = std::array::from_fn(value);
        Self {
            re: Reals::of(|lane| values[lane].re),
            im: Reals::of(|lane| values[lane].im),
        }
    }

    /// The number of one lane.
    #[inline(always)]
    pub(super) fn lane(self, lane: usize) -> Complex64 {
        Complex64::new(self.re.lane(lane), self.im.lane(lane))
    }

    #[inline(always)]
    pub(super) fn norm_sqr(self) -> Reals {
        self.re * self.re + self.im * self.im
    }

    #[inline(always)]
    pub(super) fn conj(self) -> Self {
        Self {
            re: self.re,
            im: -self.im,
        }
    }

    /// conj(self) other
    #[inline(always)]
    pub(super) fn conj_times(self, other: Self) -> Self {
        Self {
            re: self.re * other.re + self.im * other.im,
            im: self.re * other.im - self.im * other.re,
        }
    }

    #[inline(always)]
    pub(super) fn scaled(self, by: Reals) -> Self {
        Self {
            re: self.re * by,
            im: self.im * by,
        }
    }
}

impl Add for Reals {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Reals {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Mul for Reals {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl std::ops::Div for Reals {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self(self.0 / other.0)
    }
}

impl Neg for Reals {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl AddAssign for Reals {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Add for Complexes {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            re: self.re + other.re,
            im: self.im + other.im,
        }
    }
}

impl Sub for Complexes {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            re: self.re - other.re,
            im: self.im - other.im,
        }
    }
}

impl Mul for Complexes {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }
}

impl Neg for Complexes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            re: -self.re,
            im: -self.im,
        }
    }
}

impl AddAssign for Complexes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Complexes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_lane_is_computed_as_it_would_be_alone() {
        let a = |lane: usize| Complex64::new(1.5 - lane as f64, 0.25 * lane as f64 + 0.1);
        let b = |lane: usize| Complex64::new(-0.7 * lane as f64, 3.0 + lane as f64);
        let (many_a, many_b) = (Complexes::of(a), Complexes::of(b));
        let inverse = many_b.reciprocal().unwrap();
        for lane in 0..LANES {
            let (a, b) = (a(lane), b(lane));
            assert_eq!((many_a + many_b).lane(lane), a + b);
            assert_eq!((many_a - many_b).lane(lane), a - b);
            assert_eq!((many_a * many_b).lane(lane), a * b);
            assert_eq!((-many_a).lane(lane), -a);
            assert_eq!(many_a.conj().lane(lane), a.conj());
            assert_eq!(many_a.conj_times(many_b).lane(lane), a.conj() * b);
            assert_eq!(many_a.norm_sqr().lane(lane), a.norm_sqr());
            assert_eq!(inverse.lane(lane), b.reciprocal().unwrap());
        }
    }

    #[test]
    fn each_lane_has_its_own_choice() {
        let a = Reals::of(|lane| lane as f64 - 1.0);
        let (yes, no) = (
            Reals::of(|lane| [f64::NAN, f64::NAN, 3.0, 4.0][lane]),
            Reals::all(7.0),
        );
        assert_eq!(a.where_positive(yes, no).lanes(), [7.0, 7.0, 3.0, 4.0]);
        assert_eq!(a.at_least(Reals::all(0.5)).lanes(), [0.5, 0.5, 1.0, 2.0]);
        assert_eq!(a.at_most(Reals::all(0.5)).lanes(), [-1.0, 0.0, 0.5, 0.5]);
    }

    #[test]
    fn one_lane_without_a_reciprocal_is_none() {
        let last_is_zero = |lane: usize| Complex64::from(if lane + 1 == LANES { 0.0 } else { 1.0 });
        assert_eq!(Complexes::of(last_is_zero).reciprocal(), None);
    }
}
