//! What a window of lines makes of one of them.

use num_complex::Complex64;

use super::fit::{ComplexWindow, Fit, Window};
use super::{Function, LEAST_OF_NEIGHBOURS, Order, WINDOW};

/// A value beside what its window makes of it.
#[derive(Clone, Copy)]
pub(super) struct Deviation {
    /// The value less what the other lines predict.
    pub(super) value: Complex64,
    /// Its squared deviation from the fit, as large as it would be without that value's own part in the fit.
    pub(super) power: f64,
    /// The same over its variance.
    pub(super) distance: f64,
    /// Mean |H|² of the window.
    pub(super) around: f64,
}

impl Function<'_> {
    fn variance(&self, line: usize) -> f64 {
        // A value that is next to nothing between others is not exact for that.
        let neighbour = |line: Option<usize>| line.and_then(|line| self.values.get(line));
        let beside = [line.checked_sub(1), Some(line + 1)].map(neighbour);
        let beside = beside.into_iter().flatten().map(|value| value.norm_sqr());
        let least = LEAST_OF_NEIGHBOURS * beside.fold(f64::INFINITY, f64::min);
        let power = self.values[line].norm_sqr().max(least);
        let level = self.level.relative.powi(2) * power + (self.level.floor * self.median).powi(2);
        // rounding, at least
        let level = level.max(1e-30 * power).max(1e-32 * self.median.powi(2));
        self.known
            .map_or(level, |known| level.max(known[line] * power))
    }

    /// Squared frequency, as a part of the highest one's; never zero.
    fn scale(&self, line: usize) -> f64 {
        let highest = self.frequency_hz.last().copied().unwrap_or(1.0);
        (self.frequency_hz[line] / highest).powi(2).max(1e-12)
    }

    /// Of a line beside the lines in use around it: H (1 + d₁x + …) = n₀ + n₁x + …, weighted least squares in which the weights'
    /// denominator follows from a first solution (Sanathanan and Koerner 1963). `None` where the others say nothing of it.
    pub(super) fn deviation(
        &self,
        line: usize,
        Order {
            length,
            numerator,
            denominator,
        }: Order,
    ) -> Option<Deviation> {
        let place = self.used.partition_point(|&other| other < line);
        let is_used = self.used.get(place) == Some(&line);
        let others = length - 1;
        // As many lines on either side as there are.
        let after = place + usize::from(is_used);
        let first = place
            .saturating_sub(others / 2)
            .min((self.used.len() + usize::from(!is_used)).checked_sub(length)?);
        let mut window = [line; WINDOW];
        let mut count = 0;
        let before = self.used[first..place].iter();
        for &other in before.chain(&self.used[after..]).take(others) {
            window[count] = other;
            count += 1;
        }
        if count < others {
            return None;
        }
        // The line itself stands last.
        let window = &window[..length];
        let centre = self.frequency_hz[line];
        let reach = window
            .iter()
            .map(|&other| (self.frequency_hz[other] - centre).abs())
            .fold(0.0, f64::max);
        let x: [f64; WINDOW] = std::array::from_fn(|k| match window.get(k) {
            Some(&other) => (self.frequency_hz[other] - centre) / reach,
            None => 0.0,
        });
        let plain: [f64; WINDOW] = std::array::from_fn(|k| match window.get(k) {
            Some(&other) => (self.variance(other).sqrt() * self.scale(other)).recip(),
            None => 0.0,
        });
        let own = length - 1;
        // ω²H: what moves as a whole has no pole at zero there.
        let part = |part: fn(Complex64) -> f64| {
            Window::of(length, |k| {
                part(self.values[window[k]]) * self.scale(window[k])
            })
        };
        let values = ComplexWindow {
            re: part(|value| value.re),
            im: part(|value| value.im),
        };
        let orders = [numerator, denominator];
        let places = Window::of(length, |k| x[k]);
        let fit = |weights: &dyn Fn(usize) -> f64| {
            Fit::of(&places, &values, &Window::of(length, weights), own, orders)
        };
        // The line itself has no part in its denominator: a pole and a zero beside each other would take up any single value.
        let first = fit(&|k| if k == own { 0.0 } else { plain[k] });
        let fit = fit(&|k| {
            let powers = first.solution[numerator..numerator + denominator].iter();
            let divisor = powers
                .rev()
                .fold(Complex64::ZERO, |sum, own| (sum + own) * x[k]);
            plain[k] / (1.0 + divisor).norm().max(1e-6)
        });
        let free = 1.0 - fit.leverage;
        if free < 0.02 {
            return None;
        }
        let variance = self.variance(line);
        // At the line itself x = 0, so that the divisor is 1.
        let distance = fit.residual.norm_sqr() / free;
        let powers = window.iter().map(|&other| self.values[other].norm_sqr());
        Some(Deviation {
            value: fit.residual * variance.sqrt() / free,
            power: distance * variance,
            distance,
            around: (powers.sum::<f64>() - self.values[window[own]].norm_sqr()) / own as f64,
        })
    }
}
