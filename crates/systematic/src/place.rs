//! Where a structure's motions are known along it, and what a shape that it may bend in has there.

use super::bending_shape::{shape, slope_of_shape};

/// A point or a bolt of a structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// Position along the structure, m.
    pub(crate) x_m: f64,
    /// Which of all motions its translation is.
    pub(crate) translation: usize,
    pub(crate) kind: Kind,
}

/// What is known of a place beside its translation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A point, where nothing acts.
    Point,
    /// A bolt, and which of all motions its rotation is, if it has one.
    Bolt { rotation: Option<usize> },
}

/// One motion at a place: what a sum of shapes has to meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Condition {
    /// Which of all motions it is.
    pub(crate) motion: usize,
    /// Position along the structure, m.
    pub(crate) x_m: f64,
    pub(crate) is_rotation: bool,
}

impl Place {
    /// Its translation, and its rotation if that is known.
    pub(crate) fn conditions(&self) -> impl Iterator<Item = Condition> {
        let condition = |motion: usize, is_rotation: bool| Condition {
            motion,
            x_m: self.x_m,
            is_rotation,
        };
        let rotation = match self.kind {
            Kind::Bolt { rotation } => rotation,
            Kind::Point => None,
        };
        let rotation = rotation.map(|rotation| condition(rotation, true));
        std::iter::once(condition(self.translation, false)).chain(rotation)
    }
}

impl Condition {
    /// What C_n(t) has there, t = (x − `from_m`)/L, with κ⁴ (1/m⁴).
    pub(crate) fn of_shape(&self, n: usize, from_m: f64, length_m: f64, bending: f64) -> f64 {
        let t = (self.x_m - from_m) / length_m;
        let bending = bending * length_m.powi(4);
        match self.is_rotation {
            false => shape(n, t, bending),
            true => slope_of_shape(n, t, bending) / length_m,
        }
    }

    /// What a unit force at `load_m` does there, for EI of one: C₃(|d|)/2, whose third derivative jumps by one, and |d|³/12 where
    /// nothing moves; of a rotation the derivative of that.
    pub(crate) fn by_load(&self, load_m: f64, bending: f64) -> f64 {
        let distance = self.x_m - load_m;
        let of = match self.is_rotation {
            false => shape(3, distance.abs(), bending),
            true => distance.signum() * slope_of_shape(3, distance.abs(), bending),
        };
        of / 2.0
    }
}
