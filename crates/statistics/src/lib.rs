//! Quantiles, medians and functions of statistics that intervals and tests need, so that those who identify and those who predict take the
//! same ones.
//!
//! The distributions are those of `statrs`. Where its inverses are short of twelve digits, this crate makes up for it; its tests hold
//! every function against SciPy.
#![forbid(unsafe_code)]

mod median;

pub use median::{median, upper_median};
use statrs::distribution::{ChiSquared, Continuous as _, ContinuousCDF as _, StudentsT};
use statrs::function::gamma::{digamma, ln_gamma};

/// 97.5 % quantile of the standard normal distribution: half an interval of 95 % in standard deviations.
pub const NORMAL_975: f64 = 1.959_963_984_540_054;

/// From so many degrees of freedom on Student's quantile is that of its expansion to within 2e-12. The inverse of `statrs` is 3e-6
/// off at a hundred thousand, and measurements have more lines than that.
const MANY: usize = 1000;

/// 97.5 % quantile of Student's distribution; infinite without degrees of freedom.
///
/// ```
/// // Half an interval of 95 % from four degrees of freedom, in standard deviations: SciPy's t.ppf(0.975, 4).
/// assert!((bolted_joint_statistics::student_975(4) - 2.776_445_105_197_793).abs() < 1e-12);
/// ```
#[must_use]
pub fn student_975(degrees_of_freedom: usize) -> f64 {
    let n = degrees_of_freedom as f64;
    if degrees_of_freedom < MANY {
        return StudentsT::new(0.0, 1.0, n)
            .map_or(f64::INFINITY, |student| student.inverse_cdf(0.975));
    }
    // Abramowitz and Stegun 26.7.5
    let z = NORMAL_975;
    let [z3, z5, z7] = [3, 5, 7].map(|power| z.powi(power));
    z + (z3 + z) / (4.0 * n)
        + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n)
        + (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n)
}

/// χ² that is exceeded with a probability of 5 %; zero without degrees of freedom.
#[must_use]
pub fn chi_squared_95(degrees_of_freedom: usize) -> f64 {
    ChiSquared::new(degrees_of_freedom as f64).map_or(0.0, |distribution| {
        // The inverse ends its iteration up to 2e-10 from the quantile: one step more of Newton's.
        let found = distribution.inverse_cdf(0.95);
        found - (distribution.cdf(found) - 0.95) / distribution.pdf(found)
    })
}

/// Probability that χ² with so many degrees of freedom exceeds a value; 1 without degrees of freedom.
///
/// ```
/// // SciPy's chi2.sf(58.1, 42)
/// assert!((bolted_joint_statistics::chi_squared_tail(58.1, 42) - 0.050_218_571_201_709).abs() < 1e-12);
/// ```
#[must_use]
pub fn chi_squared_tail(value: f64, degrees_of_freedom: usize) -> f64 {
    ChiSquared::new(degrees_of_freedom as f64).map_or(1.0, |distribution| distribution.sf(value))
}

/// Γ(x)/Γ(y) for x, y > 0, and how it grows where both grow.
///
/// ```
/// // SciPy's gamma and digamma
/// let [ratio, growth] = bolted_joint_statistics::gamma_ratio(1.9, 3.4);
/// assert!((ratio - 0.3226096063855614).abs() < 1e-13 && (growth + 0.2301444266591912).abs() < 1e-13);
/// ```
#[must_use]
pub fn gamma_ratio(x: f64, y: f64) -> [f64; 2] {
    let ratio = (ln_gamma(x) - ln_gamma(y)).exp();
    [ratio, ratio * (digamma(x) - digamma(y))]
}

/// ψ(x) − ln x for x > 0: the mean of the logarithm of a gamma variable of shape x and mean 1.
#[must_use]
pub fn digamma_less_log(x: f64) -> f64 {
    digamma(x) - x.ln()
}

/// ψ′(x) for x > 0, the variance of that logarithm; `statrs` does not have it.
#[must_use]
pub fn trigamma(x: f64) -> f64 {
    // Abramowitz and Stegun 6.4.6 and 6.4.12
    let (mut shifted, mut sum) = (x, 0.0);
    while shifted < 10.0 {
        sum += 1.0 / (shifted * shifted);
        shifted += 1.0;
    }
    let square = 1.0 / (shifted * shifted);
    let series = 1.0 / 6.0
        - square
            * (1.0 / 30.0 - square * (1.0 / 42.0 - square * (1.0 / 30.0 - square * 5.0 / 66.0)));
    sum + 1.0 / shifted + 0.5 * square + series * square / shifted
}

/// Quantile of ascending values, linear between order statistics (type 7 of Hyndman and Fan, as NumPy has it); NaN of none.
#[must_use]
pub fn quantile(ascending: &[f64], share: f64) -> f64 {
    let last = ascending.len().saturating_sub(1);
    // h = (n − 1) p
    let place = share * last as f64;
    let low = place.floor() as usize;
    match (ascending.get(low), ascending.get((low + 1).min(last))) {
        (Some(low_value), Some(high_value)) => {
            low_value + (place - low as f64) * (high_value - low_value)
        }
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests;
