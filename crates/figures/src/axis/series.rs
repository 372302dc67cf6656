//! The series 1, 2, 5, 10, … that ends of axes and ticks are taken from.

/// Part of a tick step that rounding may take a tick past the end of its axis.
pub(super) const TICK_ROUNDING: f64 = 1e-9;

/// Number `index` of the series …, 0.5, 1, 2, 5, 10, …, where number 0 is 1.
pub(super) fn one_two_five(index: i32) -> f64 {
    f64::from(mantissa(index)) * 10_f64.powi(index.div_euclid(3))
}

pub(super) fn mantissa(index: i32) -> u8 {
    match index.rem_euclid(3) {
        0 => 1,
        1 => 2,
        _ => 5,
    }
}

/// The largest number of the series that is not above `value`, which must be drawable.
pub(super) fn series_at_most(value: f64) -> i32 {
    let above = 3 * (decade(value) + 2);
    (above - 9..above)
        .rev()
        .find(|&index| one_two_five(index) <= value * (1.0 + TICK_ROUNDING))
        .unwrap_or(above - 9)
}

/// The smallest number of the series that is not below `value`, which must be drawable.
pub(super) fn series_at_least(value: f64) -> i32 {
    let below = 3 * (decade(value) - 1);
    (below..below + 9)
        .find(|&index| one_two_five(index) >= value * (1.0 - TICK_ROUNDING))
        .unwrap_or(below + 9)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "powers of ten of f64 lie within ±308"
)]
fn decade(value: f64) -> i32 {
    value.log10().floor() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_on_the_series_are_not_rounded_away() {
        for exponent in -299..300 {
            for digit in [1, 2, 5] {
                let value: f64 = format!("{digit}e{exponent}").parse().expect("number");
                let index = series_at_most(value);
                assert_eq!(index, series_at_least(value), "{value:e}");
                assert!((one_two_five(index) / value - 1.0).abs() < 1e-12);
            }
        }
    }
}
