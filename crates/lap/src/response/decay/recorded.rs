//! A decay as it was recorded: what a fit sample by sample in time compares the model's motion with.

use std::borrow::Cow;

use nalgebra::DMatrix;

use super::others::{NUMBERS, Other, basis, without};

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
    /// The other modes; `None` where they are not known.
    pub(super) others: Option<Vec<Other>>,
}

impl Recorded {
    /// The same record without the other modes; `None` where they are not known.
    pub(super) fn alone(&self) -> Option<Cow<'_, Self>> {
        let others = self.others.as_ref()?;
        if others.is_empty() {
            return Some(Cow::Borrowed(self));
        }
        Some(Cow::Owned(Self {
            values: without(&self.values, others, self.interval_s),
            ..self.clone()
        }))
    }

    /// An orthonormal basis of what errors of the other modes are in so many samples; `None` where there are none.
    pub(super) fn beside(&self, samples: usize) -> Option<DMatrix<f64>> {
        let others = self.others.as_ref().filter(|others| !others.is_empty())?;
        Some(basis(others, samples, self.interval_s))
    }

    /// Numbers of the other modes that a fit takes.
    pub(super) fn beside_count(&self) -> usize {
        self.others
            .as_ref()
            .map_or(0, |others| NUMBERS * others.len())
    }
}
