//! A rectangular interface and the cells that a field is computed on.

use super::PressureError;

/// A rectangle in the plane of the interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    x_m: [f64; 2],
    y_m: [f64; 2],
}

impl Rectangle {
    /// The rectangle from `x_m[0]` to `x_m[1]` and from `y_m[0]` to `y_m[1]` (m).
    ///
    /// # Errors
    /// [`PressureError::Outline`] if one of its sides is not a positive finite length.
    pub fn new(x_m: [f64; 2], y_m: [f64; 2]) -> Result<Self, PressureError> {
        let valid = |[low, high]: [f64; 2]| low.is_finite() && high.is_finite() && high > low;
        match valid(x_m) && valid(y_m) {
            true => Ok(Self { x_m, y_m }),
            false => Err(PressureError::Outline { x_m, y_m }),
        }
    }

    /// The rectangle of a width along x and a height along y (m) about the origin.
    ///
    /// # Errors
    /// As [`Rectangle::new`].
    pub fn centred(width_m: f64, height_m: f64) -> Result<Self, PressureError> {
        let half = |length: f64| [-0.5 * length, 0.5 * length];
        Self::new(half(width_m), half(height_m))
    }

    /// Its extent along x, in m.
    #[must_use]
    pub fn x_m(&self) -> [f64; 2] {
        self.x_m
    }

    /// Its extent along y, in m.
    #[must_use]
    pub fn y_m(&self) -> [f64; 2] {
        self.y_m
    }

    /// Its area, in m².
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        (self.x_m[1] - self.x_m[0]) * (self.y_m[1] - self.y_m[0])
    }

    /// Its cells in rows along x, each of them a rectangle.
    pub(super) fn cells(&self, [across, up]: [usize; 2]) -> impl Iterator<Item = Self> {
        // Edges computed in one way only, so that neighbours share them to the last bit.
        let edge = |[low, high]: [f64; 2], place: usize, count: usize| {
            let part = place as f64 / count as f64;
            low * (1.0 - part) + high * part
        };
        let (x_m, y_m) = (self.x_m, self.y_m);
        (0..up).flat_map(move |row| {
            (0..across).map(move |column| Self {
                x_m: [edge(x_m, column, across), edge(x_m, column + 1, across)],
                y_m: [edge(y_m, row, up), edge(y_m, row + 1, up)],
            })
        })
    }

    pub(super) fn centre_m(&self) -> [f64; 2] {
        [
            0.5 * (self.x_m[0] + self.x_m[1]),
            0.5 * (self.y_m[0] + self.y_m[1]),
        ]
    }

    /// Whether a disc lies within it.
    pub(super) fn holds_disc(&self, [x_m, y_m]: [f64; 2], radius_m: f64) -> bool {
        x_m - radius_m >= self.x_m[0]
            && x_m + radius_m <= self.x_m[1]
            && y_m - radius_m >= self.y_m[0]
            && y_m + radius_m <= self.y_m[1]
    }

    /// Distances of its nearest and its farthest point from a point, in m.
    pub(super) fn distances_m(&self, point_m: [f64; 2]) -> [f64; 2] {
        let along = |[low, high]: [f64; 2], at: f64| {
            let (below, above) = (low - at, at - high);
            [below.max(above).max(0.0), below.abs().max(above.abs())]
        };
        let [near_x, far_x] = along(self.x_m, point_m[0]);
        let [near_y, far_y] = along(self.y_m, point_m[1]);
        [near_x.hypot(near_y), far_x.hypot(far_y)]
    }
}
