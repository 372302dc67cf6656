//! Complex numbers, as far as eigenvalues and modes need them.

use crate::elementary::hypotenuse;

/// A complex number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Complex {
    pub(crate) re: f64,
    pub(crate) im: f64,
}

impl Complex {
    pub(crate) const ZERO: Self = Self { re: 0.0, im: 0.0 };

    pub(crate) fn real(re: f64) -> Self {
        Self { re, im: 0.0 }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            re: self.re + other.re,
            im: self.im + other.im,
        }
    }

    pub(crate) fn minus(self, other: Self) -> Self {
        self.plus(other.scaled(-1.0))
    }

    pub(crate) fn times(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }

    pub(crate) fn scaled(self, factor: f64) -> Self {
        Self {
            re: self.re * factor,
            im: self.im * factor,
        }
    }

    pub(crate) fn conjugate(self) -> Self {
        Self {
            re: self.re,
            im: -self.im,
        }
    }

    /// 1/z; not finite where z is zero.
    pub(crate) fn reciprocal(self) -> Self {
        self.conjugate()
            .scaled((self.re * self.re + self.im * self.im).recip())
    }

    /// e^z, z over a power of two first: e^2z − 1 = 2g + g² of g = e^z − 1 keeps the digits of what is small.
    pub(crate) fn exponential(self) -> Self {
        let mut reduced = self;
        let mut halvings = 0;
        while reduced.modulus() > 0.0625 && halvings < 1024 {
            reduced = reduced.scaled(0.5);
            halvings += 1;
        }
        // Σ zᵏ/k!, k = 1 to 10
        let sum = |sum: Self, k: i32| {
            Self::real(1.0).plus(sum.times(reduced).scaled(f64::from(k).recip()))
        };
        let series = (2..=10).rev().fold(Self::real(1.0), sum);
        let mut growth = series.times(reduced);
        for _ in 0..halvings {
            growth = growth.times(growth).plus(growth.scaled(2.0));
        }
        growth.plus(Self::real(1.0))
    }

    pub(crate) fn modulus(self) -> f64 {
        hypotenuse(self.re, self.im)
    }

    pub(crate) fn square_root(self) -> Self {
        // the larger part first: the other one by a difference of nearly equal numbers would lose its digits
        let larger = (0.5 * (self.modulus() + self.re.abs())).sqrt();
        if larger == 0.0 {
            return Self::ZERO;
        }
        let smaller = 0.5 * self.im.abs() / larger;
        let [re, im] = match self.re >= 0.0 {
            true => [larger, smaller],
            false => [smaller, larger],
        };
        Self {
            re,
            im: im.copysign(self.im),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_keep_the_digits_of_their_smaller_part() {
        for (re, im) in [
            (3.0, 4.0),
            (-1.0, 1e-12),
            (1.0, -1e-12),
            (-4.0, 0.0),
            (0.0, -2.0),
            (-1e8, 1e-3),
        ] {
            let root = Complex { re, im }.square_root();
            let square = root.times(root);
            assert!(
                (square.re - re).abs() <= 4e-16 * square.modulus(),
                "{re} {im}"
            );
            assert!((square.im - im).abs() <= 4e-16 * im.abs(), "{re} {im}");
            assert!(root.re >= 0.0);
        }
    }

    #[test]
    fn the_exponential_is_a_decaying_rotation() {
        for (re, im) in [(0.0, 1e-9), (-0.3, 0.7), (-2.0, 50.0), (1.0, -3.0)] {
            let found = Complex { re, im }.exponential();
            let (sine, cosine) = f64::sin_cos(im);
            let expected = Complex {
                re: cosine,
                im: sine,
            }
            .scaled(f64::exp(re));
            let error = found.minus(expected).modulus() / expected.modulus();
            // an angle is known to its last bit
            assert!(error < 4e-16 * (2.0 + im.abs()), "{re} {im}: {error}");
        }
    }
}
