//! Ticks: values that a reader expects on an axis, and how they are written.

use super::series::{TICK_ROUNDING, mantissa, one_two_five, series_at_least};

/// Ticks of a logarithmic axis are written as plain numbers if all lie within these powers of ten.
const PLAIN_EXPONENTS: std::ops::RangeInclusive<i32> = -3..=3;

/// Ticks of a linear axis are written as plain numbers with so many decimals at most, and below this magnitude.
const PLAIN_DECIMALS: usize = 4;
const PLAIN_BELOW: f64 = 1e6;

/// Labels that an axis has at least.
const FEWEST_LABELS: f64 = 2.0;

/// Text beside a tick.
#[derive(Debug, Clone, PartialEq)]
pub enum TickLabel {
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
pub struct Tick {
    /// Where it is.
    pub value: f64,
    /// What is written beside it.
    pub label: TickLabel,
}

/// The ticks of an axis in ascending order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ticks {
    /// Labelled, with a grid line.
    pub major: Vec<Tick>,
    /// Between the major ones, without a label.
    pub minor: Vec<f64>,
}

pub(super) fn phase_tick(degrees: i32) -> Tick {
    Tick {
        value: degrees.into(),
        label: TickLabel::Plain(with_minus_sign(&degrees.to_string())),
    }
}

/// Of things that are counted: every one, or every second, third … where there are more than `most`.
pub(super) fn counted_ticks(count: u32, most: u32) -> Ticks {
    let stride = count.div_ceil(most.max(1)).max(1) as usize;
    let major = (1..=count).step_by(stride).map(|number| Tick {
        value: number.into(),
        label: TickLabel::Plain(number.to_string()),
    });
    Ticks {
        major: major.collect(),
        minor: Vec::new(),
    }
}

/// The number of the step between labels: the shortest that gives `most` of them, but one that gives two at least, since one
/// alone does not say how far it is to the end of the axis.
fn labelled_step(low: f64, high: f64, most: u32) -> i32 {
    let number = series_at_least((high - low) / f64::from(most.max(1)));
    let labels = |number: &i32| {
        let step = one_two_five(*number);
        (high / step + TICK_ROUNDING).floor() - (low / step - TICK_ROUNDING).ceil() + 1.0
    };
    // two labels further apart than half of the axis may both miss it; a third and a fifth cannot
    let finer = (number - 2..=number).rev();
    finer
        .into_iter()
        .find(|number| labels(number) >= FEWEST_LABELS)
        .unwrap_or(number)
}

pub(super) fn linear_ticks(low: f64, high: f64, most: u32) -> Ticks {
    let step_of = |most: u32| labelled_step(low, high, most);
    let decimals_of = |number: i32| usize::try_from(-number.div_euclid(3)).unwrap_or(0);
    let largest = low.abs().max(high.abs());
    let is_plain = decimals_of(step_of(most)) <= PLAIN_DECIMALS && largest < PLAIN_BELOW;
    // the power of ten that all labels share, which takes room
    let power = (!is_plain && largest.is_normal()).then(|| largest.log10().floor() as i32);
    let step_number = step_of(if power.is_some() {
        most.div_ceil(2)
    } else {
        most
    });
    let step = one_two_five(step_number);
    let parts = if mantissa(step_number) == 2 { 4 } else { 5 };
    let decimals = decimals_of(step_number);
    let minor_step = step / f64::from(parts);

    let mut ticks = Ticks::default();
    let first = (low / minor_step - TICK_ROUNDING).ceil();
    let last = (high / minor_step + TICK_ROUNDING).floor();
    let mut count = first;
    while count <= last {
        let value = count * minor_step;
        if count % f64::from(parts) == 0.0 {
            // Adding zero turns −0 into 0.
            let exact = count / f64::from(parts) * step + 0.0;
            let text = match power {
                None => format!("{exact:.decimals$}"),
                Some(_) if exact == 0.0 => "0".to_owned(),
                Some(power) => {
                    let shown = usize::try_from(power - step_number.div_euclid(3)).unwrap_or(0);
                    let mantissa = exact / 10_f64.powi(power);
                    format!("{mantissa:.shown$}·10{}", raised(power))
                }
            };
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

pub(super) fn logarithmic_ticks(low: i32, high: i32, most: u32) -> Ticks {
    let most = i32::try_from(most.max(2)).unwrap_or(i32::MAX);
    let first_decade = low.div_euclid(3);
    let last_decade = high.div_euclid(3);
    let plain = PLAIN_EXPONENTS.contains(&first_decade) && PLAIN_EXPONENTS.contains(&last_decade);
    // Up to 1 … 20: the powers of ten alone would be too few.
    let between = high - low <= 4;
    let inside = |exponent: &i32| (low..=high).contains(&(3 * exponent));
    let labels = |stride: i32| {
        let all = (first_decade..=last_decade).filter(inside);
        all.filter(|exponent| exponent.rem_euclid(stride) == 0)
            .count()
    };
    let mut stride = (last_decade - first_decade) / most + 1;
    while stride > 1 && labels(stride) < 2 {
        stride -= 1;
    }

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

/// An exponent in raised digits.
fn raised(exponent: i32) -> String {
    let raise = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32(u32::from('⁰') + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
    };
    exponent.to_string().chars().map(raise).collect()
}

/// `number` with the typographic minus sign, which is as wide as a plus.
pub(crate) fn with_minus_sign(number: &str) -> String {
    number.replace('-', "−")
}
