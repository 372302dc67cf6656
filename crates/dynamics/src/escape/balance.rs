//! The static balance of one DOF while the other follows, and where it ends first.

use super::{coupling, held};
use crate::{
    condensation::{condensed, following},
    law::{JointLaw, SPRING_COUNT},
    power_series::value,
};

/// Steps of the search after which it gives up: the spring then all but touches zero load, which counts as escape.
const STEPS_MAX: u32 = 200_000;

/// Square of a relative displacement (m², rad²) beyond which no joint opens.
const FARTHEST_SQUARED: f64 = 1e24;

/// First length (m², rad²) of the search's steps; they grow by doubling.
const FIRST_STEP: f64 = 1e-30;

/// Length by which the search knows its place at rest, m² or rad².
const SHORTEST_STEP: f64 = 1e-60;

/// Coefficients of the secant stiffness: the linear one and those of the polynomial.
const TERMS: usize = SPRING_COUNT + 1;

/// Load k r + k3 r³ + k5 r⁵ + … = r s(r²) of one DOF on itself, by the coefficients of the secant stiffness s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spring([f64; TERMS]);

impl Spring {
    /// Change of the spring of DOF `i` while several others follow it by `motion`.
    pub(super) fn change_of_following<const D: usize>(
        law: &JointLaw<D>,
        supports: &[f64; D],
        i: usize,
        motion: &[f64; D],
    ) -> Self {
        // what follows is where the energy is least, so that its own change adds nothing
        let mut change = Self::of(law, supports, i);
        change.0[0] = condensed(&held(law, supports), motion);
        change
    }

    /// Joint and supports together.
    pub(super) fn of<const D: usize>(law: &JointLaw<D>, supports: &[f64; D], i: usize) -> Self {
        let mut terms = [law.linear.stiffness[i][i] + supports[i]; TERMS];
        terms[1..].copy_from_slice(&law.on[i].polynomial().springs);
        Self(terms)
    }

    /// Whether some term takes stiffness away with amplitude.
    fn softens(&self) -> bool {
        self.0[1..].iter().any(|&k| k < 0.0)
    }

    /// Whether there is nothing beyond the linear and the cubic term.
    fn is_cubic(&self) -> bool {
        self.0[2..].iter().all(|&k| k == 0.0)
    }

    /// Whether there is nothing beyond the linear term.
    fn is_linear(&self) -> bool {
        self.0[1] == 0.0 && self.is_cubic()
    }

    /// s(u)
    fn secant(&self, u: f64) -> f64 {
        value(&self.0, u)
    }

    /// Coefficients of ds/du.
    fn slopes(terms: &[f64; TERMS]) -> [f64; TERMS] {
        std::array::from_fn(|j| terms.get(j + 1).map_or(0.0, |k| (j + 1) as f64 * k))
    }

    /// ds/du
    fn slope(&self, u: f64) -> f64 {
        value(&Self::slopes(&self.0), u)
    }

    /// The tangent stiffness d(r s(r²))/dr as a polynomial of u = r².
    fn tangent(&self) -> Self {
        Self(std::array::from_fn(|j| (2 * j + 1) as f64 * self.0[j]))
    }

    /// A lower bound of s over u from `low` ≥ 0 to `high`, which is off by the square of their distance.
    fn least(&self, low: f64, high: f64) -> f64 {
        // s(low + d) = s + s' d + s''/2! d² + …: what rises is least at d = 0, what falls at the upper end
        let distance = high - low;
        let (mut least, mut power) = (self.secant(low), 1.0);
        let mut terms = self.0;
        for order in 1..TERMS {
            terms = Self::slopes(&terms).map(|k| k / order as f64);
            power *= distance;
            let term = value(&terms, low);
            if term < 0.0 {
                least += term * power;
            }
        }
        least
    }
}

/// Balance of DOF `own` without a load on it, and of the other DOF that is coupled to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Balance {
    own: Spring,
    other: Option<Other>,
}

/// The DOF that follows.
#[derive(Clone, Copy, Debug)]
struct Other {
    dof: usize,
    spring: Spring,
    coupling: f64,
}

/// Where a DOF is no longer held.
#[derive(Clone, Copy, Debug)]
pub(super) struct Escape {
    /// Square of its displacement.
    squared: f64,
    /// Square of the other DOF's displacement; zero where none follows.
    other_squared: f64,
    end: End,
}

/// What ends the balance.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    /// The load that holds the DOF has fallen to zero.
    Unheld,
    /// The other DOF finds no balance beyond.
    Fold,
}

impl Escape {
    /// Displacement, m or rad.
    pub(super) fn amplitude(&self) -> f64 {
        self.squared.sqrt()
    }
}

impl Balance {
    /// `None` where DOF `i` does not soften.
    pub(super) fn of<const D: usize>(
        law: &JointLaw<D>,
        supports: &[f64; D],
        i: usize,
    ) -> Option<Self> {
        let mut own = Spring::of(law, supports, i);
        let held = held(law, supports);
        if let Some(motion) = following(&held, i) {
            own.0[0] = condensed(&held, &motion);
            return own.softens().then_some(Self { own, other: None });
        }
        let other = (0..D)
            .find(|&j| j != i && coupling(law, i, j) != 0.0)
            .map(|dof| Other {
                dof,
                spring: Spring::of(law, supports, dof),
                coupling: coupling(law, i, dof),
            });
        own.softens().then_some(Self { own, other })
    }

    /// The DOF that follows.
    pub(super) fn other_dof(&self) -> Option<usize> {
        self.other.map(|other| other.dof)
    }

    /// Where the balance ends first on the way from rest; `None` if it does not.
    pub(super) fn escape(&self) -> Option<Escape> {
        self.closed_form().or_else(|| self.search())
    }

    /// The end of a cubic spring beside a linear one.
    fn closed_form(&self) -> Option<Escape> {
        // k r + κ s + k3 r³ = 0 with κ r + k' s = 0: r² = (k − κ²/k')/(−k3)
        let condensed = match &self.other {
            None => self.own.0[0],
            Some(Other {
                spring, coupling, ..
            }) => {
                let k = spring.0[0];
                if !spring.is_linear() || k <= 0.0 {
                    return None;
                }
                self.own.0[0] - coupling * coupling / k
            }
        };
        if !self.own.is_cubic() {
            return None;
        }
        let squared = condensed.max(0.0) / -self.own.0[1];
        let other_squared = self.other.map_or(0.0, |other| {
            let ratio = other.coupling / other.spring.0[0];
            ratio * ratio * squared
        });
        Some(Escape {
            squared,
            other_squared,
            end: End::Unheld,
        })
    }

    /// Goes from rest in steps over which the balance is proven to hold, doubling or halving them, to where no step can be
    /// proven any more.
    ///
    /// The way is measured by u = r², or where another DOF follows by u = s² of that: its balance κ r + s t(s²) = 0 gives
    /// r² = u t(u)²/κ², which grows with u as long as the tangent stiffness of the other DOF is positive. On it the first
    /// DOF's k r + κ s + k3 r³ + … = 0 divided by r is g = own(r²) − κ²/t(u).
    fn search(&self) -> Option<Escape> {
        let (mut u, mut step) = (0.0, FIRST_STEP);
        let mut end = match self.ends_within(0.0, 0.0) {
            Some(end) => return Some(self.escape_at(0.0, end)),
            None => End::Unheld,
        };
        for _ in 0..STEPS_MAX {
            match self.ends_within(u, u + step) {
                None => {
                    u += step;
                    step *= 2.0;
                    if u > FARTHEST_SQUARED || self.own_squared(u) > FARTHEST_SQUARED {
                        return None;
                    }
                }
                Some(why) => {
                    end = why;
                    step *= 0.5;
                    if u + step == u || step < SHORTEST_STEP {
                        break;
                    }
                }
            }
        }
        Some(self.escape_at(u, end))
    }

    fn escape_at(&self, u: f64, end: End) -> Escape {
        Escape {
            squared: self.own_squared(u),
            other_squared: self.other.map_or(0.0, |_| u),
            end,
        }
    }

    /// r² at u.
    fn own_squared(&self, u: f64) -> f64 {
        self.other.as_ref().map_or(u, |other| {
            let ratio = other.spring.secant(u) / other.coupling;
            u * ratio * ratio
        })
    }

    /// What may end the balance between `low` and `high`; `None` if it is proven to last.
    fn ends_within(&self, low: f64, high: f64) -> Option<End> {
        // what is not a number proves nothing
        let unless_held = |load: f64| {
            if load > 0.0 { None } else { Some(End::Unheld) }
        };
        let Some(Other {
            spring, coupling, ..
        }) = &self.other
        else {
            return unless_held(self.own.least(low, high));
        };
        let secant = spring.least(low, high);
        if !(secant > 0.0 && spring.tangent().least(low, high) > 0.0) {
            return Some(End::Fold);
        }
        let own = self
            .own
            .least(self.own_squared(low), self.own_squared(high));
        // g t > 0 where both factors are positive
        unless_held(own.min(own * secant - coupling * coupling))
    }

    /// Change of the amplitude with the springs and the coupling, by the implicit function theorem.
    pub(super) fn tangent(
        &self,
        escape: &Escape,
        change: &Spring,
        other_change: Option<(Spring, f64)>,
    ) -> f64 {
        let r = escape.amplitude();
        if r == 0.0 {
            return 0.0;
        }
        let squared = escape.squared;
        let (Some(other), Some((other_change, coupling_change))) = (&self.other, other_change)
        else {
            // s(r²) = 0: dr = −ds/(2 r s')
            return -change.secant(squared) / (2.0 * r * self.own.slope(squared));
        };
        // κ r + s t(s²) = 0 with s on the side that the coupling pushes it to
        let s = -escape.other_squared.sqrt() * other.coupling.signum();
        let of_own = r * change.secant(squared) + coupling_change * s;
        let of_other = s * other_change.secant(escape.other_squared) + coupling_change * r;
        match escape.end {
            // at the fold the other DOF's balance does not depend on s: κ dr + df_other = 0
            End::Fold => -of_other / other.coupling,
            // [k_t κ; κ t_t] (dr, ds) = −(df_own, df_other)
            End::Unheld => {
                let own_tangent = self.own.tangent().secant(squared);
                let other_tangent = other.spring.tangent().secant(escape.other_squared);
                let determinant = own_tangent * other_tangent - other.coupling * other.coupling;
                (other.coupling * of_other - other_tangent * of_own) / determinant
            }
        }
    }
}
