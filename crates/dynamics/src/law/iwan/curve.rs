//! The curve of first loading of the Iwan law, with what it stores and what it turns into heat.
//!
//! All of it is written by the power v^(χ+2) of v = u/φ_max alone, so that nothing is the difference of almost equal
//! numbers where the motion is small.

use super::Iwan;
use crate::number::{Number, magnitude};

/// What the parameters give.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve<N> {
    /// The parameters: F_S, K_T, χ, β.
    pub(super) parameters: [N; 4],
    slip_force: N,
    stiffness: N,
    /// χ + 2
    power: N,
    /// φ_max
    pub(super) span: N,
    /// 1/φ_max
    per_span: N,
    /// 1/((1+β)(χ+2))
    softening: N,
    /// Whether what was committed holds for it.
    pub(super) is_known: bool,
}

/// A place on the curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct At<N> {
    /// |u|
    u: N,
    /// φ_max v^(χ+2), the only power that load and energies need; `None` where all slips.
    pub(super) bent: Option<N>,
}

impl<N: Number> Curve<N> {
    #[inline]
    pub(super) fn new(law: &Iwan<N>) -> Self {
        let one = N::from(1.0);
        let power = law.exponent + N::from(2.0);
        // φ_max = F_S (1+β)/(K_T (β + (χ+1)/(χ+2)))   (Segalman 2005, eq. 25 and 26)
        let below = law.ratio + (law.exponent + one) / power;
        let span = law.slip_force * (one + law.ratio) / (law.stiffness * below);
        let softening = one / ((one + law.ratio) * power);
        Self {
            is_known: false,
            ..Self::from_derived(law, [span, one / span, softening])
        }
    }

    /// The curve of which [`Curve::derived`] is known.
    #[inline]
    pub(super) fn from_derived(law: &Iwan<N>, [span, per_span, softening]: [N; 3]) -> Self {
        Self {
            parameters: law.parameters(),
            slip_force: law.slip_force,
            stiffness: law.stiffness,
            power: law.exponent + N::from(2.0),
            span,
            per_span,
            softening,
            is_known: true,
        }
    }

    /// What takes divisions to find.
    #[inline]
    pub(super) fn derived(&self) -> [N; 3] {
        [self.span, self.per_span, self.softening]
    }

    /// A place on the curve.
    #[inline]
    pub(super) fn at(&self, u: N) -> At<N> {
        let u = magnitude(u);
        let sticks = u.value() < self.span.value();
        At {
            u,
            // φ_max v^(χ+2) with v = u/φ_max
            bent: sticks.then(|| self.span * (u * self.per_span).powf(self.power)),
        }
    }

    /// A place of which the power is known.
    #[inline]
    pub(super) fn known(&self, u: N, bent: N) -> At<N> {
        let u = magnitude(u);
        let sticks = u.value() < self.span.value();
        At {
            u,
            bent: sticks.then_some(bent),
        }
    }

    /// Load there.
    #[inline]
    pub(super) fn load(&self, at: &At<N>) -> N {
        match at.bent {
            // F = K_T u − R u^(χ+2)/((χ+1)(χ+2)) = K_T (u − φ_max v^(χ+2)/((1+β)(χ+2)))
            Some(bent) => self.stiffness * (at.u - self.softening * bent),
            None => self.slip_force,
        }
    }

    /// Change of the load on a way of this length from a reversal.
    #[inline]
    pub(super) fn masing(&self, way: N) -> N {
        // 2 F(x/2), F odd
        N::from(2.0) * towards(way, self.load(&self.at(N::from(0.5) * way)))
    }

    /// Energy in the springs on the way from the origin.
    #[inline]
    pub(super) fn stored(&self, at: &At<N>) -> N {
        match at.bent {
            Some(bent) => self.stored_at(at.u, bent),
            None => self.stored_at(self.span, self.span),
        }
    }

    /// W = ½ K_T u² (1 − 2 v^(χ+1)/((1+β)(χ+3)))
    #[inline]
    fn stored_at(&self, u: N, bent: N) -> N {
        let one = N::from(1.0);
        let part = self.softening * self.power / (self.power + one);
        self.stiffness * u * (N::from(0.5) * u - part * bent)
    }

    /// Heat on the way from the origin: a quarter of what the cycle of this amplitude costs.
    #[inline]
    pub(super) fn heat(&self, at: &At<N>) -> N {
        match at.bent {
            Some(bent) => self.heat_at(at.u, bent),
            // all slips at F_S from φ_max on
            None => self.heat_at(self.span, self.span) + self.slip_force * (at.u - self.span),
        }
    }

    /// D/4 = R u^(χ+3)/((χ+2)(χ+3)) = K_T u φ_max v^(χ+2) (χ+1)/((1+β)(χ+2)(χ+3))
    #[inline]
    fn heat_at(&self, u: N, bent: N) -> N {
        let one = N::from(1.0);
        let part = self.softening * (self.power - one) / (self.power + one);
        self.stiffness * part * u * bent
    }

    /// How that heat grows with u, N or N·m.
    #[inline]
    pub(super) fn heat_slope(&self, at: &At<N>) -> N {
        match at.bent {
            // d(D/4)/du = K_T (χ+1) φ_max v^(χ+2)/((1+β)(χ+2))
            Some(bent) => self.stiffness * self.softening * (self.power - N::from(1.0)) * bent,
            None => self.slip_force,
        }
    }

    /// Change of the stored energy on a way from a reversal at which this load acts and this much is stored; `half` is the place
    /// at half of the way.
    #[inline]
    pub(super) fn masing_stored(&self, load: N, stored: N, way: N, half: &At<N>) -> N {
        let two = N::from(2.0);
        match half.bent {
            // work less heat: f_r x + 4 ∫F − D(x/2)/2 with ∫F = W + D/4
            Some(bent) => {
                load * way + two * (two * self.stored_at(half.u, bent) + self.heat_at(half.u, bent))
            }
            // every slider has slipped since: W(φ_max)
            None => self.stored_at(self.span, self.span) - stored,
        }
    }
}

/// A load in the direction of a way.
#[inline]
pub(super) fn towards<N: Number>(way: N, load: N) -> N {
    if way.value() < 0.0 { -load } else { load }
}
