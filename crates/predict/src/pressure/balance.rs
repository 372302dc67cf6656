//! Whether a field carries what the bolts pull.

use std::fmt;

use super::{Bolt, PressureField};

/// Force and moments of a field beside those of the bolts that make it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balance {
    /// Normal force of the field, in N.
    pub force_n: f64,
    /// Moments of the field about the x and the y axis, in N·m.
    pub moments_n_m: [f64; 2],
    /// Sum of the preloads, in N.
    pub preload_n: f64,
    /// Moments of the preloads about the x and the y axis, in N·m.
    pub preload_moments_n_m: [f64; 2],
}

impl Balance {
    /// Compares a field with the preloads of bolts.
    #[must_use]
    pub fn of(field: &PressureField, bolts: &[Bolt]) -> Self {
        let sum = |part: fn(&Bolt) -> f64| bolts.iter().map(part).sum::<f64>();
        Self {
            force_n: field.force_n(),
            moments_n_m: field.moments_n_m(),
            preload_n: sum(|bolt| bolt.preload_n),
            preload_moments_n_m: [
                sum(|bolt| bolt.preload_n * bolt.y_m),
                sum(|bolt| -bolt.preload_n * bolt.x_m),
            ],
        }
    }

    /// Force of the field less the preloads, over the preloads; 0 in balance.
    #[must_use]
    pub fn force_imbalance(&self) -> f64 {
        (self.force_n - self.preload_n) / self.preload_n
    }

    /// How far the line of action of the field's force is from that of the preloads, x and y in m; 0 in balance.
    #[must_use]
    pub fn offset_m(&self) -> [f64; 2] {
        // x = −M_y/N, y = M_x/N
        let place =
            |[about_x, about_y]: [f64; 2], force_n: f64| [-about_y, about_x].map(|m| m / force_n);
        let field = place(self.moments_n_m, self.force_n);
        let bolts = place(self.preload_moments_n_m, self.preload_n);
        [field[0] - bolts[0], field[1] - bolts[1]]
    }
}

impl fmt::Display for Balance {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Rounded before it is written, so that no zero has a sign.
        let percent = (1e4 * self.force_imbalance()).round() / 100.0 + 0.0;
        let [x_mm, y_mm] = self.offset_m().map(|metres| 1e3 * metres);
        write!(
            formatter,
            "the field carries {:.3} kN, the bolts pull {:.3} kN (imbalance {:+.2} %); its resultant lies {:.3} mm from theirs",
            1e-3 * self.force_n,
            1e-3 * self.preload_n,
            percent,
            x_mm.hypot(y_mm)
        )
    }
}
