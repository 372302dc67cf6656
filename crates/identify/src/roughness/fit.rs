//! A rational function of a few coefficients through the lines of one window, and what it leaves of the last of them.
//!
//! Lines stand side by side. The numerator's columns are real, which takes a quarter of the work of complex ones.

use num_complex::Complex64;

use super::{DENOMINATOR, NUMERATOR, UNKNOWNS, WINDOW};
use crate::lanes::{LANES, Reals};

/// Vectors of lanes that a window fills.
const VECTORS: usize = WINDOW.div_ceil(LANES);
/// A direction of the fit that is smaller than this part of its column tells nothing new.
const NEGLIGIBLE: f64 = 1e-11;

/// A number for each line of a window, with zeros where it is shorter.
#[derive(Clone, Copy)]
pub(super) struct Window([Reals; VECTORS]);

impl Window {
    const ZERO: Self = Self([Reals::ZERO; VECTORS]);

    /// Of the first `length` lines.
    pub(super) fn of(length: usize, value: impl Fn(usize) -> f64) -> Self {
        Self(std::array::from_fn(|vector| {
            Reals::of(|lane| match vector * LANES + lane {
                line if line < length => value(line),
                _ => 0.0,
            })
        }))
    }

    fn line(&self, line: usize) -> f64 {
        self.0[line / LANES].lane(line % LANES)
    }

    fn times(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|vector| {
            self.0[vector] * other.0[vector]
        }))
    }

    fn scaled(&self, factor: f64) -> Self {
        Self(self.0.map(|own| own * Reals::all(factor)))
    }

    fn dot(&self, other: &Self) -> f64 {
        let Self(products) = self.times(other);
        let [first, others @ ..] = products;
        others.into_iter().fold(first, |sum, own| sum + own).sum()
    }

    fn subtract(&mut self, part: f64, other: &Self) {
        let part = Reals::all(part);
        for (own, other) in self.0.iter_mut().zip(other.0) {
            *own = *own - part * other;
        }
    }
}

/// A complex number for each line.
#[derive(Clone, Copy)]
pub(super) struct ComplexWindow {
    pub(super) re: Window,
    pub(super) im: Window,
}

impl ComplexWindow {
    const ZERO: Self = Self {
        re: Window::ZERO,
        im: Window::ZERO,
    };

    fn line(&self, line: usize) -> Complex64 {
        Complex64::new(self.re.line(line), self.im.line(line))
    }

    fn times(&self, other: &Window) -> Self {
        Self {
            re: self.re.times(other),
            im: self.im.times(other),
        }
    }

    fn norm(&self) -> f64 {
        (self.re.dot(&self.re) + self.im.dot(&self.im)).sqrt()
    }

    /// qᵀ x of real q.
    fn along(&self, real: &Window) -> Complex64 {
        Complex64::new(real.dot(&self.re), real.dot(&self.im))
    }

    /// qᴴ x
    fn along_complex(&self, other: &Self) -> Complex64 {
        Complex64::new(
            other.re.dot(&self.re) + other.im.dot(&self.im),
            other.re.dot(&self.im) - other.im.dot(&self.re),
        )
    }

    fn subtract(&mut self, part: Complex64, real: &Window) {
        self.re.subtract(part.re, real);
        self.im.subtract(part.im, real);
    }

    fn subtract_complex(&mut self, part: Complex64, other: &Self) {
        self.re.subtract(part.re, &other.re);
        self.re.subtract(-part.im, &other.im);
        self.im.subtract(part.re, &other.im);
        self.im.subtract(part.im, &other.re);
    }
}

/// A weighted linear fit H (1 + d₁x + …) = n₀ + n₁x + …: what it leaves of the last line.
pub(super) struct Fit {
    /// n₀, n₁ …, d₁, d₂ …
    pub(super) solution: [Complex64; UNKNOWNS],
    /// What is left of the last line, weighted.
    pub(super) residual: Complex64,
    /// The last line's part in its own fit, from 0 to 1.
    pub(super) leverage: f64,
}

impl Fit {
    /// By Gram and Schmidt, twice for each column; columns that add nothing are left out.
    ///
    /// `orders` are the numbers of coefficients of numerator and denominator, beside the leading 1 of this.
    pub(super) fn of(
        x: &Window,
        values: &ComplexWindow,
        weights: &Window,
        last: usize,
        orders: [usize; 2],
    ) -> Self {
        let [numerator, denominator] = orders;
        let unknowns = numerator + denominator;
        let mut r = [[Complex64::ZERO; UNKNOWNS]; UNKNOWNS];
        let mut right = [Complex64::ZERO; UNKNOWNS];
        let target = values.times(weights);
        let mut rest = target;
        let mut leverage = 0.0;
        let mut real = [Window::ZERO; NUMERATOR];
        let mut power = *weights;
        for column in 0..numerator {
            let mut own = power;
            power = power.times(x);
            let before = own.dot(&own).sqrt();
            for _ in 0..2 {
                for earlier in 0..column {
                    let part = real[earlier].dot(&own);
                    r[earlier][column].re += part;
                    own.subtract(part, &real[earlier]);
                }
            }
            let size = own.dot(&own).sqrt();
            if size <= NEGLIGIBLE * before {
                continue;
            }
            r[column][column] = Complex64::from(size);
            let unit = own.scaled(size.recip());
            right[column] = rest.along(&unit);
            rest.subtract(right[column], &unit);
            leverage += unit.line(last).powi(2);
            real[column] = unit;
        }
        let mut complex = [ComplexWindow::ZERO; DENOMINATOR];
        let mut power = target;
        for number in 0..denominator {
            power = power.times(x);
            let column = numerator + number;
            let mut own = ComplexWindow {
                re: power.re.scaled(-1.0),
                im: power.im.scaled(-1.0),
            };
            let before = own.norm();
            for _ in 0..2 {
                for earlier in 0..numerator {
                    let part = own.along(&real[earlier]);
                    r[earlier][column] += part;
                    own.subtract(part, &real[earlier]);
                }
                for earlier in 0..number {
                    let part = own.along_complex(&complex[earlier]);
                    r[numerator + earlier][column] += part;
                    own.subtract_complex(part, &complex[earlier]);
                }
            }
            let size = own.norm();
            if size <= NEGLIGIBLE * before {
                continue;
            }
            r[column][column] = Complex64::from(size);
            let unit = ComplexWindow {
                re: own.re.scaled(size.recip()),
                im: own.im.scaled(size.recip()),
            };
            right[column] = rest.along_complex(&unit);
            rest.subtract_complex(right[column], &unit);
            leverage += unit.line(last).norm_sqr();
            complex[number] = unit;
        }
        let mut solution = [Complex64::ZERO; UNKNOWNS];
        for row in (0..unknowns).rev() {
            if r[row][row] != Complex64::ZERO {
                let later: Complex64 = (row + 1..unknowns).map(|c| r[row][c] * solution[c]).sum();
                solution[row] = (right[row] - later) / r[row][row];
            }
        }
        Self {
            solution,
            residual: rest.line(last),
            leverage,
        }
    }
}
