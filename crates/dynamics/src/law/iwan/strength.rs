//! What sliders of an Iwan law give whose strength changes: load, energy and heat, as sums over the straight pieces of
//! the line of their elongations.

use super::{
    Iwan,
    elongations::{Bearing, Elongations, Piece},
    reversals::{COUNT, ELONGATED, HIDDEN, OWED, PARAMETERS, PLACE, POINTS, TURN, pay},
};
use crate::{law::Law, number::Number};

/// The law, with φ_max as it is now.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strength<N> {
    /// K_T/(1+β)
    stiffness: N,
    /// χ
    exponent: N,
    /// β
    ratio: N,
    /// φ_max, zero where nothing presses.
    pub(super) span: N,
}

impl<N: Number> Strength<N> {
    pub(super) fn of(law: &Iwan<N>) -> Self {
        let one = N::from(1.0);
        let below = law.ratio + (law.exponent + one) / (law.exponent + N::from(2.0));
        let span = law.slip_force * (one + law.ratio) / (law.stiffness * below);
        Self {
            stiffness: law.stiffness / (one + law.ratio),
            exponent: law.exponent,
            ratio: law.ratio,
            span: if span.value() > 0.0 { span } else { N::ZERO },
        }
    }

    /// ∫ q r dk over a piece of the product of two functions that are straight there, by their values at both ends. The
    /// stiffness of the sliders is dk = K_T/(1+β) ((χ+1) θ^χ dθ + β δ(θ−1) dθ).
    fn integral(&self, piece: &Piece<N>, q: [N; 2], r: [N; 2]) -> N {
        let [from, to] = piece.ends.map(|knot| knot.share);
        let strongest = if piece.is_last {
            self.ratio * q[1] * r[1]
        } else {
            N::ZERO
        };
        let width = to - from;
        if width.value() <= 0.0 {
            return self.stiffness * strongest;
        }
        let one = N::from(1.0);
        let power = self.exponent + one;
        // Pⱼ = (χ+1)/(χ+1+j) θ^(χ+1+j)
        let [low, high] = [from, to].map(|share| share.powf(power));
        let zeroth = high - low;
        let first = power / (power + one) * (to * high - from * low);
        let second = power / (power + N::from(2.0)) * (to * to * high - from * from * low);
        let line = |[at_from, at_to]: [N; 2]| {
            let slope = (at_to - at_from) / width;
            [at_from - slope * from, slope]
        };
        let ([q0, q1], [r0, r1]) = (line(q), line(r));
        let spread = q0 * r0 * zeroth + (q0 * r1 + q1 * r0) * first + q1 * r1 * second;
        self.stiffness * (spread + strongest)
    }

    /// Load after a way from here: ∫ e dk.
    pub(super) fn load(&self, sliders: &Elongations<N>, way: N) -> N {
        let mut sum = N::ZERO;
        sliders.pieces(way, self.span, |piece| {
            let elongations = piece.cut(self.span).map(|knot| knot.elongation);
            sum = sum + self.integral(piece, elongations, [N::from(1.0); 2]);
        });
        sum
    }

    /// Energy in the springs after it: ½ ∫ e² dk.
    pub(super) fn stored(&self, sliders: &Elongations<N>, way: N) -> N {
        self.stored_in(self, sliders, way)
    }

    /// The same in the springs of another strength, if these sliders bear the way.
    pub(super) fn stored_in(&self, springs: &Self, sliders: &Elongations<N>, way: N) -> N {
        let mut sum = N::ZERO;
        sliders.pieces(way, self.span, |piece| {
            let elongations = piece.cut(self.span).map(|knot| knot.elongation);
            sum = sum + springs.integral(piece, elongations, elongations);
        });
        N::from(0.5) * sum
    }

    /// Load of those that slip where the joint moves on in the direction of this sign, as a positive number.
    pub(super) fn slipping(&self, sliders: &Elongations<N>, way: N, sign: f64) -> N {
        let mut sum = N::ZERO;
        sliders.pieces(way, self.span, |piece| {
            if piece.bearing == Bearing::Slips(sign) {
                let limits = piece.ends.map(|knot| self.span * knot.share);
                sum = sum + self.integral(piece, limits, [N::from(1.0); 2]);
            }
        });
        sum
    }

    /// Heat of a way at this strength: ∫ θ φ_max |Δx| dk of what slips.
    fn heat_of_way(&self, sliders: &Elongations<N>, way: N) -> N {
        let mut sum = N::ZERO;
        sliders.pieces(way, self.span, |piece| {
            if let Bearing::Slips(sign) = piece.bearing {
                let limits = piece.ends.map(|knot| self.span * knot.share);
                sum = sum + self.integral(piece, limits, piece.beyond(sign, self.span));
            }
        });
        sum
    }

    /// Heat of what can no longer be held at this strength, in place: ½ ∫ (e² − θ² φ_max²) dk.
    fn heat_of_release(&self, sliders: &Elongations<N>) -> N {
        let mut sum = N::ZERO;
        sliders.pieces(N::ZERO, self.span, |piece| {
            if let Bearing::Slips(sign) = piece.bearing {
                let sums = piece
                    .ends
                    .map(|knot| N::from(sign) * knot.elongation + self.span * knot.share);
                sum = sum + self.integral(piece, piece.beyond(sign, self.span), sums);
            }
        });
        N::from(0.5) * sum
    }
}

/// Moves the memory on to r and to the law's present strength, and returns the heat, J: a strength that grows does so
/// before the way, one that falls after it. So what slips is what slips where both change at the same pace.
pub(super) fn commit<N: Number>(
    law: &Iwan<N>,
    sliders: &Elongations<N>,
    memory: &mut [N],
    r: N,
) -> f64 {
    if memory.len() <= HIDDEN {
        return 0.0;
    }
    let place = memory[PLACE];
    let (now, way) = (Strength::of(law), r - place);
    let known: [N; 4] = std::array::from_fn(|k| memory[PARAMETERS + k]);
    let before = match Iwan::new(&known) {
        // nothing has moved yet
        known if !known.is_there() => now,
        known => Strength::of(&known),
    };
    let (mut after, heat) = if now.span.value() < before.span.value() {
        let moved = sliders.moved(way, before.span);
        let heat = before.heat_of_way(sliders, way) + now.heat_of_release(&moved);
        (moved.moved(N::ZERO, now.span), heat)
    } else {
        (sliders.moved(way, now.span), now.heat_of_way(sliders, way))
    };
    let whole = after;
    after.shorten(law);
    let gained = match after.count < whole.count {
        true => now.stored(&after, N::ZERO) - now.stored(&whole, N::ZERO),
        false => N::ZERO,
    };
    if (way * (place - memory[TURN])).value() < 0.0 {
        memory[TURN] = place;
    }
    memory[ELONGATED] = N::from(1.0);
    memory[PLACE] = r;
    memory[COUNT] = N::from(after.count as f64);
    let parameters = [law.slip_force, law.stiffness, law.exponent, law.ratio];
    memory[PARAMETERS..PARAMETERS + parameters.len()].copy_from_slice(&parameters);
    for (pair, knot) in memory[POINTS..].chunks_exact_mut(2).zip(after.own()) {
        pair.copy_from_slice(&[knot.share, knot.elongation]);
    }
    memory[OWED] = memory[OWED] + gained;
    // rounding apart, nothing gives heat back
    let heat = if heat.value() > 0.0 { heat } else { N::ZERO };
    pay(memory, heat).value()
}
