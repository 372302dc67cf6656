//! Axes of a diagram: which range to show, where a value lies in it, and which ticks a reader expects.

mod series;
mod ticks;

use series::{one_two_five, series_at_least, series_at_most};
pub(crate) use ticks::with_minus_sign;
pub use ticks::{Tick, TickLabel, Ticks};
use ticks::{counted_ticks, linear_ticks, logarithmic_ticks, phase_tick};

/// Magnitudes outside this range are not drawn on a logarithmic axis; inside it, no rounding step overflows.
const DRAWABLE: std::ops::RangeInclusive<f64> = 1e-300..=1e300;
/// Room between the extremes of the data and the end of a logarithmic axis, a ratio.
const LOGARITHMIC_MARGIN: f64 = 1.25;
/// A phase axis goes on beyond half a turn (degrees), so that a curve along its edge can be seen.
pub(crate) const PHASE_END: f64 = 195.0;
/// A range of values and the rule that spreads them over a length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Axis {
    /// Equal distances for equal differences.
    Linear {
        /// Value at the start.
        low: f64,
        /// Value at the end.
        high: f64,
    },
    /// Equal distances for equal ratios. Both ends lie on the series 1, 2, 5, 10, …
    Logarithmic {
        /// Number of the first value in the series, see `one_two_five`.
        low: i32,
        /// Number of the last value in the series.
        high: i32,
    },
    /// An angle in degrees over one turn, −180 to 180, and a little more.
    Phase,
    /// Things that are counted from 1, with nothing between them.
    Counted {
        /// How many there are.
        count: u32,
    },
}

impl Axis {
    /// Covers `values` exactly, but starts at zero if that costs little. Non-finite values do not count.
    pub fn linear(values: impl Iterator<Item = f64>) -> Self {
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
    pub fn logarithmic(values: impl Iterator<Item = f64>, decades: i32) -> Option<Self> {
        let (smallest, largest) = extremes(values.filter(|value| DRAWABLE.contains(value)))?;
        let high = series_at_least(largest * LOGARITHMIC_MARGIN);
        let low = series_at_most(smallest / LOGARITHMIC_MARGIN).max(high - 3 * decades);
        Some(Self::Logarithmic { low, high })
    }

    /// Where `value` lies between the start (0) and the end (1); outside of that if it is off the axis, `None`
    /// if it cannot be drawn at all.
    pub fn position(&self, value: f64) -> Option<f64> {
        match *self {
            Self::Linear { low, high } => value.is_finite().then(|| (value - low) / (high - low)),
            Self::Logarithmic { low, high } => DRAWABLE.contains(&value).then(|| {
                let (low, high) = (one_two_five(low).log10(), one_two_five(high).log10());
                (value.log10() - low) / (high - low)
            }),
            Self::Phase => value.is_finite().then(|| 0.5 + 0.5 * value / PHASE_END),
            Self::Counted { count } => {
                (value.is_finite() && count > 0).then(|| (value - 0.5) / f64::from(count))
            }
        }
    }

    /// Values at the start and the end.
    pub fn ends(&self) -> (f64, f64) {
        match *self {
            Self::Linear { low, high } => (low, high),
            Self::Logarithmic { low, high } => (one_two_five(low), one_two_five(high)),
            Self::Phase => (-PHASE_END, PHASE_END),
            Self::Counted { count } => (0.5, f64::from(count) + 0.5),
        }
    }

    /// Ticks, at most about `most` of them labelled.
    pub fn ticks(&self, most: u32) -> Ticks {
        match *self {
            Self::Linear { low, high } => linear_ticks(low, high, most),
            Self::Logarithmic { low, high } => logarithmic_ticks(low, high, most),
            Self::Counted { count } => counted_ticks(count, most),
            Self::Phase => Ticks {
                major: [-180, -90, 0, 90, 180].map(phase_tick).to_vec(),
                minor: vec![-135.0, -45.0, 45.0, 135.0],
            },
        }
    }
}

fn extremes(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |found, value| match found {
        None => Some((value, value)),
        Some((low, high)) => Some((low.min(value), high.max(value))),
    })
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
    fn small_and_large_values_share_a_power_of_ten() {
        let micro = Axis::Linear {
            low: -4e-6,
            high: 4e-6,
        };
        let expected = ["−4·10⁻⁶", "−2·10⁻⁶", "0", "2·10⁻⁶", "4·10⁻⁶"];
        assert_eq!(labels(&micro.ticks(10)), expected);
        let large = Axis::Linear {
            low: 9.5e6,
            high: 1.05e7,
        };
        let expected = ["0.96·10⁷", "0.98·10⁷", "1.00·10⁷", "1.02·10⁷", "1.04·10⁷"];
        assert_eq!(labels(&large.ticks(12)), expected);
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
    fn every_axis_has_two_labels_at_least() {
        let coherence = Axis::Linear {
            low: 0.951,
            high: 1.0,
        };
        assert_eq!(labels(&coherence.ticks(2)), ["0.96", "0.98", "1.00"]);
        for most in 1..8 {
            for (low, high) in [
                (0.95, 1.0),
                (0.951, 1.0),
                (0.1, 9.9),
                (-0.4, 0.9),
                (5.1, 9.9),
                (9.5e6, 1.05e7),
            ] {
                let ticks = Axis::Linear { low, high }.ticks(most);
                assert!(ticks.major.len() >= 2, "{low} {high} {most}");
            }
            for (low, span) in (-9..9).flat_map(|low| (1..30).map(move |span| (low, span))) {
                let axis = Axis::Logarithmic {
                    low,
                    high: low + span,
                };
                assert!(axis.ticks(most).major.len() >= 2, "{low} {span} {most}");
            }
        }
    }

    #[test]
    fn phase_has_right_angles() {
        let ticks = Axis::Phase.ticks(5);
        assert_eq!(labels(&ticks), ["−180", "−90", "0", "90", "180"]);
        assert_eq!(Axis::Phase.position(0.0), Some(0.5));
        assert_eq!(Axis::Phase.position(-PHASE_END), Some(0.0));
    }
}
