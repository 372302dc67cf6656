//! Where among all numbers the unknowns of a law that slips are searched: within what numbers can hold, about the amplitude that
//! data have, and at first where their effects are told apart.

use super::{MOST, Slider, SliderValues};

/// Within which the unknowns of Iwan's law are searched, as logarithms: of the lost stiffness in N/m, of χ + 1, of φ_max over the
/// reference, and of β. Beyond, numbers of the law are no longer finite, and nothing that is measured tells one from another.
const RANGE_OF_IWAN: [[f64; 2]; MOST] = [[-60.0, 60.0], [-7.0, 3.4], [-9.2, 9.2], [-30.0, 30.0]];

/// The same of one slider: of K_T in N/m and F_S/K_T in m.
const RANGE_OF_JENKINS: [[f64; 2]; MOST] = [[-60.0, 60.0], [-60.0, 60.0], [0.0, 0.0], [0.0, 0.0]];

/// Unknowns of Iwan's law, as logarithms in their order, whose effects on a motion are told apart.
const MODERATE: [[f64; 2]; MOST] = [[-60.0, 60.0], [-0.9, 0.1], [-0.5, 0.5], [-1.6, 0.5]];

/// β of Iwan's law that shows nothing, and one that does.
const NEXT_TO_NONE: f64 = 1e-3;
const SOME: f64 = 0.2;

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

    /// Iwan's law of the same stiffness with a part of it that slips last, where that is next to nothing; `None` of others.
    pub(in crate::response) fn with_a_last_slider(&self) -> Option<Self> {
        let is_next_to_none = self.slider == Slider::Iwan && self.logs[3] < NEXT_TO_NONE.ln();
        is_next_to_none.then(|| {
            let mut own = *self;
            own.logs[3] = SOME.ln();
            // K_T = K_l (1 + β)
            own.logs[0] -= SOME.ln_1p();
            own
        })
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

    /// Displacement from which on all of it slips, m.
    pub(in crate::response) fn slips_at_m(&self) -> f64 {
        match self.slider {
            Slider::Jenkins => self.logs[1].exp(),
            Slider::MicroSlip | Slider::Iwan => self.reference_m * self.logs[2].exp(),
        }
    }

    /// The law that slips from there on; one slider with the heat that it had at the largest displacement.
    pub(in crate::response) fn slipping_at(&self, kink_m: f64, largest_m: f64) -> Self {
        let mut own = *self;
        match self.slider {
            Slider::Jenkins => {
                // D = 4 F_S (A − F_S/K_T)
                let of = |at_m: f64| at_m * (largest_m - at_m);
                own.logs[0] += (of(self.slips_at_m()) / of(kink_m)).abs().ln();
                own.logs[1] = kink_m.ln();
            }
            Slider::MicroSlip | Slider::Iwan => own.logs[2] = (kink_m / self.reference_m).ln(),
        }
        own.keep_in_range();
        own
    }
}
