//! A decay as it was recorded: what a fit sample by sample in time compares the model's motion with.

/// What was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::response) enum Quantity {
    /// m
    Displacement,
    /// m/s
    Velocity,
    /// m/s²
    Acceleration,
}

impl Quantity {
    /// The `order`-th derivative of the displacement.
    pub(super) fn of_order(order: i32) -> Self {
        match order {
            0 => Self::Displacement,
            1 => Self::Velocity,
            _ => Self::Acceleration,
        }
    }

    /// Which derivative of the displacement it is.
    pub(super) fn order(self) -> i32 {
        self as i32
    }
}

/// A record with samples at equal distances.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::response) struct Recorded {
    /// Distance of its samples.
    pub(super) interval_s: f64,
    /// Its samples less their mean, in the unit of what was measured.
    pub(super) values: Vec<f64>,
    pub(super) quantity: Quantity,
    /// Share of the relative motion in what was measured.
    pub(super) share: f64,
    /// Standard deviation of white noise of a sample, by the median of the spectrum.
    pub(super) noise: f64,
    /// The largest amplitude that is read of it, as a part of its largest value.
    pub(in crate::response) read_part: f64,
    /// Whether the study names the band of the mode, since there are others.
    pub(in crate::response) has_band: bool,
}
