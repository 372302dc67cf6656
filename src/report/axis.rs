//! Axes of a diagram: which range to show, where a value lies in it, and which ticks a reader expects.

/// Magnitudes outside this range are not drawn on a logarithmic axis; inside it, no rounding step overflows.
const DRAWABLE: std::ops::RangeInclusive<f64> = 1e-300..=1e300;
/// Ticks of a logarithmic axis are written as plain numbers if all lie within these powers of ten.
const PLAIN_EXPONENTS: std::ops::RangeInclusive<i32> = -3..=3;
/// Room between the extremes of the data and the end of a logarithmic axis, a ratio.
const LOGARITHMIC_MARGIN: f64 = 1.25;
/// A phase axis goes on beyond half a turn (degrees), so that a curve along its edge can be seen.
pub(super) const PHASE_END: f64 = 195.0;
/// Part of a tick step that rounding may take a tick past the end of its axis.
const TICK_ROUNDING: f64 = 1e-9;

/// A range of values and the rule that spreads them over a length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Axis {
    /// Equal distances for equal differences.
    Linear {
        /// Value at the start.
        low: f64,
        /// Value at the end.
        high: f64,
    },
    /// Equal distances for equal ratios. Both ends lie on the series 1, 2, 5, 10, …
    Logarithmic {
        /// Number of the first value in the series, see [`one_two_five`].
        low: i32,
        /// Number of the last value in the series.
        high: i32,
    },
    /// An angle in degrees over one turn, −180 to 180, and a little more.
    Phase,
}

/// Text beside a tick.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum TickLabel {
    /// Text as it stands.
    Plain(String),
    /// `mantissa · 10^exponent`, the mantissa 1 being left out.
    Power {
        /// 1, 2 or 5.
        mantissa: u8,
        /// Power of ten.
        exponent: i32,
    },
}

/// A labelled tick.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    pub(super) value: f64,
    pub(super) label: TickLabel,
}

/// The ticks of an axis in ascending order.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Ticks {
    /// Labelled, with a grid line.
    pub(super) major: Vec<Tick>,
    /// Between the major ones, without a label.
    pub(super) minor: Vec<f64>,
}

impl Axis {
    /// Covers `values` exactly, but starts at zero if that costs little. Non-finite values do not count.
    pub(super) fn linear(values: impl Iterator<Item = f64>) -> Self {
        let Some((low, high)) = extremes(values.filter(|value| value.is_finite())) else {
            return Self::Linear {
                low: 0.0,
                high: 1.0,
            };
        };
        if high > low {
            let near_zero = low > 0.0 && low < 0.1 * high;
            return Self::Linear {
                low: if near_zero { 0.0 } else { low },
                high,
            };
        }
        let margin = (0.05 * low.abs()).max(0.5);
        Self::Linear {
            low: low - margin,
            high: high + margin,
        }
    }

    /// Covers `values` with some room, rounded outwards to 1, 2 or 5 times a power of ten, but no more than `decades` below
    /// the largest. `None` if no value can be drawn: zero, negative and non-finite ones cannot.
    pub(super) fn logarithmic(values: impl Iterator<Item = f64>, decades: i32) -> Option<Self> {
        let (smallest, largest) = extremes(values.filter(|value| DRAWABLE.contains(value)))?;
        let high = series_at_least(largest * LOGARITHMIC_MARGIN);
        let low = series_at_most(smallest / LOGARITHMIC_MARGIN).max(high - 3 * decades);
        Some(Self::Logarithmic { low, high })
    }

    /// Where `value` lies between the start (0) and the end (1); outside of that if it is off the axis, `None`
    /// if it cannot be drawn at all.
    pub(super) fn position(&self, value: f64) -> Option<f64> {
        match *self {
            Self::Linear { low, high } => value.is_finite().then(|| (value - low) / (high - low)),
            Self::Logarithmic { low, high } => DRAWABLE.contains(&value).then(|| {
                let (low, high) = (one_two_five(low).log10(), one_two_five(high).log10());
                (value.log10() - low) / (high - low)
            }),
            Self::Phase => value.is_finite().then(|| 0.5 + 0.5 * value / PHASE_END),
        }
    }

    /// Values at the start and the end.
    pub(super) fn ends(&self) -> (f64, f64) {
        match *self {
            Self::Linear { low, high } => (low, high),
            Self::Logarithmic { low, high } => (one_two_five(low), one_two_five(high)),
            Self::Phase => (-PHASE_END, PHASE_END),
        }
    }

    /// Ticks, at most about `most` of them labelled.
    pub(super) fn ticks(&self, most: u32) -> Ticks {
        match *self {
            Self::Linear { low, high } => linear_ticks(low, high, most),
            Self::Logarithmic { low, high } => logarithmic_ticks(low, high, most),
            Self::Phase => Ticks {
                major: [-180, -90, 0, 90, 180].map(phase_tick).to_vec(),
                minor: vec![-135.0, -45.0, 45.0, 135.0],
            },
        }
    }
}

fn phase_tick(degrees: i32) -> Tick {
    Tick {
        value: degrees.into(),
        label: TickLabel::Plain(with_minus_sign(&degrees.to_string())),
    }
}

fn extremes(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |found, value| match found {
        None => Some((value, value)),
        Some((low, high)) => Some((low.min(value), high.max(value))),
    })
}

/// Number `index` of the series …, 0.5, 1, 2, 5, 10, …, where number 0 is 1.
fn one_two_five(index: i32) -> f64 {
    f64::from(mantissa(index)) * 10_f64.powi(index.div_euclid(3))
}

fn mantissa(index: i32) -> u8 {
    match index.rem_euclid(3) {
        0 => 1,
        1 => 2,
        _ => 5,
    }
}

/// The largest number of the series that is not above `value`, which must be drawable.
fn series_at_most(value: f64) -> i32 {
    let above = 3 * (decade(value) + 2);
    (above - 9..above)
        .rev()
        .find(|&index| one_two_five(index) <= value * (1.0 + TICK_ROUNDING))
        .unwrap_or(above - 9)
}

/// The smallest number of the series that is not below `value`, which must be drawable.
fn series_at_least(value: f64) -> i32 {
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

fn linear_ticks(low: f64, high: f64, most: u32) -> Ticks {
    let step_number = series_at_least((high - low) / f64::from(most.max(1)));
    let step = one_two_five(step_number);
    let parts = if mantissa(step_number) == 2 { 4 } else { 5 };
    let decimals = usize::try_from(-step_number.div_euclid(3)).unwrap_or(0);
    let minor_step = step / f64::from(parts);

    let mut ticks = Ticks::default();
    let first = (low / minor_step - TICK_ROUNDING).ceil();
    let last = (high / minor_step + TICK_ROUNDING).floor();
    let mut count = first;
    while count <= last {
        let value = count * minor_step;
        if count % f64::from(parts) == 0.0 {
            // Adding zero turns −0 into 0.
            let text = format!("{:.decimals$}", count / f64::from(parts) * step + 0.0);
            ticks.major.push(Tick {
                value,
                label: TickLabel::Plain(with_minus_sign(&text)),
            });
        } else {
            ticks.minor.push(value);
        }
        count += 1.0;
    }
    ticks
}

fn logarithmic_ticks(low: i32, high: i32, most: u32) -> Ticks {
    let most = i32::try_from(most.max(2)).unwrap_or(i32::MAX);
    let first_decade = low.div_euclid(3);
    let last_decade = high.div_euclid(3);
    let plain = PLAIN_EXPONENTS.contains(&first_decade) && PLAIN_EXPONENTS.contains(&last_decade);
    // Up to 1 … 20: the powers of ten alone would be too few.
    let between = high - low <= 4;
    let stride = (last_decade - first_decade) / most + 1;

    let mut ticks = Ticks::default();
    for exponent in first_decade..=last_decade {
        for digit in 1..=9_u8 {
            let series = match digit {
                1 => Some(3 * exponent),
                2 => Some(3 * exponent + 1),
                5 => Some(3 * exponent + 2),
                _ => None,
            };
            let value = f64::from(digit) * 10_f64.powi(exponent);
            let inside = series.map_or_else(
                || value > one_two_five(low) && value < one_two_five(high),
                |index| (low..=high).contains(&index),
            );
            if !inside {
                continue;
            }
            let labelled = if between {
                series.is_some()
            } else {
                digit == 1 && exponent.rem_euclid(stride) == 0
            };
            if labelled {
                ticks.major.push(Tick {
                    value,
                    label: logarithmic_label(digit, exponent, plain),
                });
            } else if digit == 1 || stride == 1 {
                ticks.minor.push(value);
            }
        }
    }
    ticks
}

fn logarithmic_label(mantissa: u8, exponent: i32, plain: bool) -> TickLabel {
    if plain {
        let decimals = usize::try_from(-exponent).unwrap_or(0);
        let value = f64::from(mantissa) * 10_f64.powi(exponent);
        TickLabel::Plain(format!("{value:.decimals$}"))
    } else {
        TickLabel::Power { mantissa, exponent }
    }
}

/// `number` with the typographic minus sign, which is as wide as a plus.
pub(super) fn with_minus_sign(number: &str) -> String {
    number.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &Ticks) -> Vec<String> {
        let text = |tick: &Tick| match &tick.label {
            TickLabel::Plain(text) => text.clone(),
            TickLabel::Power { mantissa, exponent } => format!("{mantissa}e{exponent}"),
        };
        ticks.major.iter().map(text).collect()
    }

    fn log_axis(values: &[f64]) -> Axis {
        Axis::logarithmic(values.iter().copied(), 15).expect("drawable")
    }

    #[test]
    fn frequencies_from_5_to_512_start_at_zero_and_tick_at_hundreds() {
        let axis = Axis::linear([5.0, 100.0, 512.0].into_iter());
        assert_eq!(
            axis,
            Axis::Linear {
                low: 0.0,
                high: 512.0
            }
        );
        let ticks = axis.ticks(6);
        assert_eq!(labels(&ticks), ["0", "100", "200", "300", "400", "500"]);
        assert_eq!(&ticks.minor[..5], [20.0, 40.0, 60.0, 80.0, 120.0]);
        assert_eq!(labels(&axis.ticks(4)), ["0", "200", "400"]);
    }

    #[test]
    fn a_narrow_band_keeps_its_own_start_and_shows_the_decimals_it_needs() {
        let axis = Axis::linear([114.2, 114.9].into_iter());
        assert_eq!(
            axis,
            Axis::Linear {
                low: 114.2,
                high: 114.9
            }
        );
        assert_eq!(labels(&axis.ticks(4)), ["114.2", "114.4", "114.6", "114.8"]);
    }

    #[test]
    fn negative_ticks_have_a_minus_sign_and_zero_has_none() {
        let ticks = Axis::Linear {
            low: -1.0,
            high: 1.0,
        }
        .ticks(5);
        assert_eq!(labels(&ticks), ["−1.0", "−0.5", "0.0", "0.5", "1.0"]);
        let minor = [-0.9, -0.8, -0.7, -0.6, -0.4, -0.3, -0.2, -0.1];
        for (found, expected) in ticks.minor.iter().zip(minor) {
            assert!((found - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn axes_without_extent_are_widened() {
        assert_eq!(
            Axis::linear([].into_iter()),
            Axis::Linear {
                low: 0.0,
                high: 1.0
            }
        );
        assert_eq!(
            Axis::linear([100.0].into_iter()),
            Axis::Linear {
                low: 95.0,
                high: 105.0
            }
        );
        let all_equal = log_axis(&[1e-6, 1e-6]);
        assert_eq!(labels(&all_equal.ticks(8)), ["5e-7", "1e-6", "2e-6"]);
        let middle = all_equal.position(1e-6).expect("drawable");
        assert!((middle - 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_logarithmic_axis_ends_at_one_two_or_five() {
        let axis = log_axis(&[3e-7, 0.0, f64::NAN, -4.0, 1.2e-3]);
        assert_eq!(labels(&axis.ticks(8)), ["1e-6", "1e-5", "1e-4", "1e-3"]);
        let at = |value| axis.position(value).expect("drawable");
        assert!(at(2e-7).abs() < 1e-12);
        assert!((at(2e-3) - 1.0).abs() < 1e-12);
        assert!((at(2e-5) - 0.5).abs() < 1e-12);
        let minor = axis.ticks(8).minor;
        assert_eq!(minor.len(), 8 + 3 * 8 + 1);
        assert!((minor[0] / 2e-7 - 1.0).abs() < 1e-12);
    }

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

    #[test]
    fn many_decades_are_thinned_and_few_are_filled() {
        assert_eq!(
            labels(&log_axis(&[1e-12, 1.0]).ticks(5)),
            ["1e-12", "1e-9", "1e-6", "1e-3", "1e0"]
        );
        assert_eq!(
            labels(&log_axis(&[1.3, 7.0]).ticks(5)),
            ["1", "2", "5", "10"]
        );
        assert_eq!(
            labels(&log_axis(&[0.04, 30.0]).ticks(5)),
            ["0.1", "1", "10"]
        );
    }

    #[test]
    fn a_logarithmic_axis_shows_no_more_decades_than_asked() {
        let axis = Axis::logarithmic([1e-30, 1.0].into_iter(), 6).expect("drawable");
        assert_eq!(axis, Axis::Logarithmic { low: -17, high: 1 });
        assert!(Axis::logarithmic([0.0, f64::INFINITY].into_iter(), 6).is_none());
    }

    #[test]
    fn phase_has_right_angles() {
        let ticks = Axis::Phase.ticks(5);
        assert_eq!(labels(&ticks), ["−180", "−90", "0", "90", "180"]);
        assert_eq!(Axis::Phase.position(0.0), Some(0.5));
        assert_eq!(Axis::Phase.position(-PHASE_END), Some(0.0));
    }
}
