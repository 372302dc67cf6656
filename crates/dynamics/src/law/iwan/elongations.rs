//! The sliders of an Iwan law whose strength has changed, as with the preload of a bolt: how far each of them is
//! elongated.
//!
//! A slider is told by its share θ of the displacement φ_max at which the strongest slips; it slips at θ φ_max. Sliders
//! keep their stiffness. So a change of strength scales φ_max, and of each elongation e(θ) leaves what the slider can
//! still hold. Whatever has happened, e(θ) is a continuous line of straight pieces from e(0) = 0: a motion shifts it and
//! cuts it at ± θ φ_max, and a change of strength cuts it there. Points at which the joint turned tell such a line as
//! long as φ_max stays; then its slopes are ± φ_max and 0. Else the corners of the line are what is remembered.

use super::{
    Iwan,
    reversals::{COUNT, POINTS, REVERSALS_MAX},
};
use crate::law::Corner;
use crate::number::{Number, magnitude};

/// Corners of the line that are remembered: two numbers each, in the place of reversal points.
///
/// Where there are more, those are left out that change the load least: what is then put into the springs is owed, and
/// later heat pays it.
const KNOTS_MAX: usize = REVERSALS_MAX / 2;

/// Corners that there can be until they are remembered: those of so many reversal points, and as many by a motion.
const ROOM: usize = 2 * (REVERSALS_MAX + 2);

/// Part of its strength to which a slider that slips is at its limit, but for rounding.
const ROUNDING: f64 = 1e-13;

/// A corner of the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Knot<N> {
    /// θ from 0 to 1.
    pub(super) share: N,
    /// e: m, rad.
    pub(super) elongation: N,
}

/// The line e(θ): its corners behind that at θ = 0, the last one at θ = 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Elongations<N> {
    knots: [Knot<N>; ROOM],
    pub(super) count: usize,
}

/// A straight piece of a line that was shifted and has still to be cut.
pub(super) struct Piece<N> {
    pub(super) ends: [Knot<N>; 2],
    pub(super) bearing: Bearing,
    pub(super) is_last: bool,
}

/// How the sliders of a piece bear it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Bearing {
    Sticks,
    /// Slips at the limit of this sign.
    Slips(f64),
}

impl<N: Number> Knot<N> {
    const ORIGIN: Self = Self {
        share: N::ZERO,
        elongation: N::ZERO,
    };

    fn shifted(self, way: N) -> Self {
        Self {
            elongation: self.elongation + way,
            ..self
        }
    }

    /// By how much it is beyond the limit of this sign.
    fn beyond(&self, sign: f64, span: N) -> N {
        N::from(sign) * self.elongation - span * self.share
    }

    /// The point at this part of the way to another.
    fn towards(&self, other: &Self, part: N) -> Self {
        let between = |from: N, to: N| from + part * (to - from);
        Self {
            share: between(self.share, other.share),
            elongation: between(self.elongation, other.elongation),
        }
    }
}

impl<N: Number> Elongations<N> {
    const NONE: Self = Self {
        knots: [Knot::ORIGIN; ROOM],
        count: 0,
    };

    /// Nothing is elongated.
    pub(super) fn at_rest() -> Self {
        let mut all = Self::NONE;
        all.push(Knot {
            share: N::from(1.0),
            elongation: N::ZERO,
        });
        all
    }

    /// The line after the joint has come over these points to `place`, if φ_max has always been `span`.
    pub(super) fn of_points<M: Number + Into<N>>(points: &[M], place: M, span: N) -> Self {
        let mut all = Self::NONE;
        let place: N = place.into();
        let mut end = place;
        // the weakest sliders know the latest branch alone: they slip on it up to half its length
        for &start in points.iter().rev() {
            let way = end - start.into();
            let half = N::from(0.5) * way;
            if !all.reach(magnitude(half), half + (place - end), span) {
                return all;
            }
            end = start.into();
        }
        // on the first way they slip up to all its length; stronger ones have not slipped yet
        if all.reach(magnitude(end), place, span) {
            all.push(Knot {
                share: N::from(1.0),
                elongation: place,
            });
        }
        all
    }

    /// Adds a corner at the slider that slips at this displacement; where there is none any more, the line's end. Tells
    /// whether it goes on.
    fn reach(&mut self, displacement: N, elongation: N, span: N) -> bool {
        let knot = Knot {
            share: displacement / span,
            elongation,
        };
        if knot.share.value() < 1.0 {
            if knot.share.value() > 0.0 {
                self.push(knot);
            }
            return true;
        }
        let last = self.last();
        let part = (N::from(1.0) - last.share) / (knot.share - last.share);
        self.push(Knot {
            share: N::from(1.0),
            ..last.towards(&knot, part)
        });
        false
    }

    /// Those that are remembered.
    pub(super) fn remembered<M: Number + Into<N>>(memory: &[M]) -> Self {
        let mut all = Self::NONE;
        let numbers = memory.get(POINTS..).unwrap_or_default();
        let count = memory.get(COUNT).map_or(0.0, |count| count.value()) as usize;
        for pair in numbers.chunks_exact(2).take(count.min(KNOTS_MAX)) {
            all.push(Knot {
                share: pair[0].into(),
                elongation: pair[1].into(),
            });
        }
        all
    }

    pub(super) fn own(&self) -> &[Knot<N>] {
        &self.knots[..self.count]
    }

    fn last(&self) -> Knot<N> {
        self.own().last().copied().unwrap_or(Knot::ORIGIN)
    }

    fn push(&mut self, knot: Knot<N>) {
        let place = self.count.min(ROOM - 1);
        self.knots[place] = knot;
        self.count = place + 1;
    }

    /// Tells the pieces of the line after the joint has moved on by `way`, where φ_max is `span`.
    pub(super) fn pieces(&self, way: N, span: N, mut tell: impl FnMut(&Piece<N>)) {
        let mut from = Knot::ORIGIN.shifted(way);
        for (index, knot) in self.own().iter().enumerate() {
            let to = knot.shifted(way);
            let is_last = index + 1 == self.count;
            // where it passes a limit
            let mut parts = [1.0, -1.0].map(|sign| {
                let [before, after] = [from, to].map(|knot| knot.beyond(sign, span));
                (before.value() * after.value() < 0.0).then(|| before / (before - after))
            });
            if let [Some(upper), Some(lower)] = parts
                && lower.value() < upper.value()
            {
                parts.reverse();
            }
            let mut start = from;
            for part in parts.into_iter().flatten() {
                let end = from.towards(&to, part);
                tell(&Piece::new([start, end], span, false));
                start = end;
            }
            tell(&Piece::new([start, to], span, is_last));
            from = to;
        }
    }

    /// The line after that.
    pub(super) fn moved(&self, way: N, span: N) -> Self {
        let mut after = Self::NONE;
        let mut before = None;
        self.pieces(way, span, |piece| {
            // one straight piece as long as all slip the same way
            if before == Some(piece.bearing) && piece.bearing != Bearing::Sticks {
                after.count -= 1;
            }
            after.push(piece.cut(span)[1]);
            before = Some(piece.bearing);
        });
        after
    }

    /// Leaves corners out until so many are left that can be remembered.
    pub(super) fn shorten(&mut self, law: &Iwan<N>) {
        while self.count > KNOTS_MAX {
            // by how much the load shifts without a corner: by the area between the line and its short cut
            let shift = |index: usize| {
                let before = match index.checked_sub(1) {
                    Some(before) => self.knots[before],
                    None => Knot::ORIGIN,
                };
                let (own, after) = (self.knots[index], self.knots[index + 1]);
                let part = (own.share - before.share) / (after.share - before.share);
                let cut = before.towards(&after, part).elongation;
                let off = (own.elongation - cut).value().abs();
                let width = (after.share - before.share).value();
                off * width * Number::powf(own.share.value(), law.exponent.value())
            };
            let least = (0..self.count - 1)
                .map(|index| (index, shift(index)))
                .min_by(|(_, one), (_, other)| one.total_cmp(other));
            let Some((least, _)) = least else {
                return;
            };
            self.knots.copy_within(least + 1..self.count, least);
            self.count -= 1;
        }
    }
}

impl<N: Number> Piece<N> {
    fn new(ends: [Knot<N>; 2], span: N, is_last: bool) -> Self {
        let middle = ends[0].towards(&ends[1], N::from(0.5));
        let limit = (span * middle.share).value();
        let slips = |sign: f64| middle.beyond(sign, span).value() > -ROUNDING * limit;
        let bearing = match middle.elongation.value() {
            e if e > 0.0 && slips(1.0) => Bearing::Slips(1.0),
            e if e < 0.0 && slips(-1.0) => Bearing::Slips(-1.0),
            _ => Bearing::Sticks,
        };
        Self {
            ends,
            bearing,
            is_last,
        }
    }

    /// Its ends after what slips has slipped.
    pub(super) fn cut(&self, span: N) -> [Knot<N>; 2] {
        self.ends.map(|knot| match self.bearing {
            Bearing::Sticks => knot,
            Bearing::Slips(sign) => Knot {
                elongation: N::from(sign) * span * knot.share,
                ..knot
            },
        })
    }

    /// By how much it is beyond the limit at which it slips, at both ends.
    pub(super) fn beyond(&self, sign: f64, span: N) -> [N; 2] {
        self.ends.map(|knot| knot.beyond(sign, span))
    }
}

impl Elongations<f64> {
    /// Tells where a straight way begins to slip further corners of the line.
    pub(super) fn corners(&self, place: f64, to: f64, span: f64, tell: &mut dyn FnMut(Corner)) {
        let sign = if to > place { 1.0 } else { -1.0 };
        for knot in self.own() {
            tell(Corner::Sharp(place - sign * knot.beyond(sign, span)));
        }
    }
}

#[cfg(test)]
mod tests;
