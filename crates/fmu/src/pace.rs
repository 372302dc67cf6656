//! How regular the communication steps are: that decides whether it pays to prepare for steps of one length.

/// Equal steps in a row that make a pace steady. What is prepared then costs a few steps at most, so that even an
/// importer with steps of ever new lengths loses little.
const STEADY: u8 = 8;

/// Length of the latest communication step, and how often it came in a row.
///
/// It is part of the FMU state: a simulation that goes on from there takes the same way, to the last bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pace {
    interval_s: f64,
    count: u8,
}

impl Pace {
    /// Before the first step.
    pub(crate) const NONE: Self = Self {
        interval_s: 0.0,
        count: 0,
    };

    /// Number of bytes of a serialised pace.
    pub(crate) const SIZE: usize = 9;

    /// Pace after one more step, of `interval_s` (s).
    #[inline]
    pub(crate) fn followed_by(self, interval_s: f64) -> Self {
        let count = if self.interval_s == interval_s {
            self.count.saturating_add(1).min(STEADY)
        } else {
            1
        };
        Self { interval_s, count }
    }

    /// Whether many equal steps came in a row.
    #[inline]
    pub(crate) fn is_steady(self) -> bool {
        self.count >= STEADY
    }

    /// Whether it is steady, and one more step of `interval_s` (s) leaves it as it is.
    #[inline]
    pub(crate) fn is_kept_by(self, interval_s: f64) -> bool {
        self.is_steady() && self.interval_s == interval_s
    }

    /// The pace in bytes, little endian.
    pub(crate) fn to_bytes(self) -> [u8; Self::SIZE] {
        let [a, b, c, d, e, f, g, h] = self.interval_s.to_le_bytes();
        [a, b, c, d, e, f, g, h, self.count]
    }

    /// Inverse of [`Pace::to_bytes`]; `None` for what no pace can be.
    pub(crate) fn from_bytes(bytes: [u8; Self::SIZE]) -> Option<Self> {
        let [a, b, c, d, e, f, g, h, count] = bytes;
        let interval_s = f64::from_le_bytes([a, b, c, d, e, f, g, h]);
        let possible = interval_s.is_finite() && interval_s >= 0.0 && count <= STEADY;
        possible.then_some(Self { interval_s, count })
    }
}

#[cfg(test)]
mod tests {
    use super::{Pace, STEADY};

    #[test]
    fn a_pace_is_steady_after_equal_steps_and_until_another() {
        let mut pace = Pace::NONE;
        for n in 1..=300_u32 {
            pace = pace.followed_by(1e-3);
            assert_eq!(pace.is_steady(), n >= u32::from(STEADY));
            let kept = pace.followed_by(1e-3) == pace;
            assert_eq!(pace.is_kept_by(1e-3), kept);
            assert_eq!(Pace::from_bytes(pace.to_bytes()), Some(pace));
        }
        let other_s = 1e-3 + 1e-18;
        assert!(!pace.is_kept_by(other_s) && !pace.followed_by(other_s).is_steady());
    }

    #[test]
    fn impossible_bytes_are_no_pace() {
        let mut bytes = Pace::NONE.followed_by(1e-3).to_bytes();
        bytes[8] = STEADY + 1;
        assert_eq!(Pace::from_bytes(bytes), None);
        bytes[8] = 1;
        bytes[..8].copy_from_slice(&f64::NAN.to_le_bytes());
        assert_eq!(Pace::from_bytes(bytes), None);
    }
}
