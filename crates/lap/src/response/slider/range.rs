//! Where among all numbers the unknowns of a law that slips are searched: within what numbers can hold, about the amplitude that
//! data have, and at first where their effects are told apart.

use super::{MOST, Slider, SliderValues};

/// Within which the unknowns of Iwan's law are searched, as logarithms: of the lost stiffness in N/m, of χ + 1, of φ_max over the
/// reference, and of β. Beyond, numbers of the law are no longer finite, and nothing that is measured tells one from another.
const RANGE_OF_IWAN: [[f64; 2]; MOST] = [[-60.0, 60.0], [-7.0, 3.4], [-9.2, 9.2], [-30.0, 30.0]];

/// The same of one slider: of K_T in N/m and F_S in N.
const RANGE_OF_JENKINS: [[f64; 2]; MOST] = [[-60.0, 60.0], [-60.0, 60.0], [0.0, 0.0], [0.0, 0.0]];

/// Unknowns of Iwan's law, as logarithms in their order, whose effects on a motion are told apart.
const MODERATE: [[f64; 2]; MOST] = [[-60.0, 60.0], [-0.9, 0.1], [-0.5, 0.5], [-1.6, 0.5]];

impl SliderValues {
    /// Brings the unknowns back into the range that they are searched in.
    pub(in crate::response) fn keep_in_range(&mut self) {
        let range = match self.slider {
            Slider::Jenkins => RANGE_OF_JENKINS,
            Slider::MicroSlip | Slider::Iwan => RANGE_OF_IWAN,
        };
        for (log, [least, most]) in self.logs.iter_mut().zip(range) {
            // no number is as far from all data as can be
            *log = if log.is_nan() {
                most
            } else {
                log.clamp(least, most)
            };
        }
    }

    /// The same with unknowns whose effects are told apart.
    pub(in crate::response) fn moderate(&self) -> Self {
        let mut own = *self;
        for (log, [least, most]) in own.logs.iter_mut().zip(MODERATE) {
            *log = log.clamp(least, most);
        }
        own
    }

    /// The same law by unknowns about a larger amplitude, m. That of small motion then ends farther out.
    pub(in crate::response) fn about(&self, reference_m: f64) -> Self {
        let mut own = *self;
        if reference_m <= self.reference_m {
            return own;
        }
        let farther = (reference_m / self.reference_m).ln();
        own.reference_m = reference_m;
        if self.slider != Slider::Jenkins {
            // K_l ∝ A^(χ+1), φ_max/A
            own.logs[0] += self.logs[1].exp() * farther;
            own.logs[2] -= farther;
        }
        own
    }
}
