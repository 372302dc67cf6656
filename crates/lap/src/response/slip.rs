//! Slips of units and conventions: what data would be if one of them were undone.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use super::backbone::BackboneLine;
use super::data::SineLine;

/// m/s² in a g.
pub(super) const GRAVITY: f64 = 9.80665;

/// What a number of a table is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    Response,
    Force,
    Damping,
}

/// A slip: all numbers of a quantity are so many times what they should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slip {
    pub(super) of: Quantity,
    pub(super) times: f64,
    /// What the numbers would be.
    pub(super) words: &'static str,
}

impl Slip {
    /// The likely ones.
    pub(super) const ALL: [Self; 13] = [
        Self::new(Quantity::Response, 1e3, "responses in mm"),
        Self::new(Quantity::Response, 1e6, "responses in µm"),
        Self::new(Quantity::Response, 1.0 / GRAVITY, "responses in g"),
        Self::new(Quantity::Response, 2.0, "responses from peak to peak"),
        Self::new(
            Quantity::Response,
            FRAC_1_SQRT_2,
            "responses as r.m.s. values",
        ),
        Self::new(Quantity::Force, 1e-3, "forces in kN"),
        Self::new(Quantity::Force, 1e3, "forces in mN"),
        Self::new(Quantity::Force, 1.0 / GRAVITY, "forces in kgf"),
        Self::new(Quantity::Force, 2.0, "forces from peak to peak"),
        Self::new(Quantity::Force, FRAC_1_SQRT_2, "forces as r.m.s. values"),
        Self::new(Quantity::Damping, 100.0, "damping ratios in per cent"),
        Self::new(
            Quantity::Damping,
            TAU,
            "logarithmic decrements (2π ζ) in place of damping ratios",
        ),
        Self::new(
            Quantity::Damping,
            2.0,
            "loss factors (2 ζ) in place of damping ratios",
        ),
    ];

    const fn new(of: Quantity, times: f64, words: &'static str) -> Self {
        Self { of, times, words }
    }

    fn undone(&self, of: Quantity, value: f64) -> f64 {
        match self.of == of {
            true => value / self.times,
            false => value,
        }
    }

    /// A line without it.
    pub(super) fn undone_in_line(&self, line: &SineLine) -> SineLine {
        SineLine {
            force_n: self.undone(Quantity::Force, line.force_n),
            displacement_m: self.undone(Quantity::Response, line.displacement_m),
            ..*line
        }
    }

    /// A point of a curve without it.
    pub(super) fn undone_in_point(&self, point: &BackboneLine) -> BackboneLine {
        let ratio = point.damping_ratio;
        let force = point.force_n;
        BackboneLine {
            amplitude_m: self.undone(Quantity::Response, point.amplitude_m),
            damping_ratio: ratio.map(|ratio| self.undone(Quantity::Damping, ratio)),
            force_n: force.map(|force| self.undone(Quantity::Force, force)),
            ..*point
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2π ζ, 2 ζ, and a peak over its r.m.s. value: √2.
    #[test]
    fn what_is_undone_is_what_should_have_been_there() {
        let point = BackboneLine {
            amplitude_m: 3e-5,
            omega: 700.0,
            damping_ratio: Some(0.0628),
            force_n: Some(2.0),
            time_s: None,
        };
        let with = |words: &str| {
            let mut all = Slip::ALL.iter();
            let slip = all.find(|slip| slip.words.contains(words)).unwrap();
            slip.undone_in_point(&point)
        };
        let ratio = with("decrements").damping_ratio.unwrap();
        assert!((ratio - 0.0628 / (2.0 * std::f64::consts::PI)).abs() < 1e-12);
        assert_eq!(with("loss factors").damping_ratio, Some(0.0314));
        assert!((with("responses as r.m.s.").amplitude_m / 3e-5 - 2.0_f64.sqrt()).abs() < 1e-9);
        assert_eq!(with("forces in kN").force_n, Some(2000.0));
        assert_eq!(with("responses in mm").damping_ratio, Some(0.0628));
    }
}
