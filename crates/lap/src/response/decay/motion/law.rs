//! The relative motion of a lap as an equation, and its steps: Runge–Kutta's, cut where the motion turns or the load has a corner.

use bolted_joint_dynamics::law::{Law as _, Term};
use bolted_joint_dynamics::{Number, Polynomial};

use super::Grid;
use crate::response::model::{ResponseUnknown, Values};
use crate::response::slider::FirstLoading;

/// Cuts of a step at most, part of the displacement of a corner that is none, and steps that find the place of a cut.
const CUTS: usize = 4;
const AT_CORNER: f64 = 1e-9;
const PLACED: usize = 12;
/// Part of what a number passes in a step that is none of it.
const ROUNDING: f64 = 1e-13;

/// Relative displacement and velocity, and place and load of the law's last turn.
#[derive(Clone, Copy)]
pub(super) struct Place<N> {
    pub(super) u: N,
    pub(super) v: N,
    turn: N,
    at_turn: N,
    /// Whether all slips: which changes within no step, so that what a step crosses does not disturb its changes.
    slips: bool,
}

/// The relative motion: M ü + C u̇ + K u + … + f = 0.
pub(super) struct Law<N> {
    /// 1/M
    mobility: N,
    spring: N,
    damper: N,
    terms: Option<Polynomial<N>>,
    first_loading: Option<FirstLoading<N>>,
    /// Way from a turn at which the load of the law has a corner, m.
    corner: f64,
}

impl<N: Number> Law<N> {
    /// With these values, each unknown of which `number` makes one that may change.
    pub(super) fn of(
        values: &Values,
        grid: &Grid,
        number: impl Fn(ResponseUnknown, f64) -> N,
    ) -> Self {
        use ResponseUnknown::{
            JointDamping, JointStiffness, Mass, SupportDamping, SupportStiffness,
        };
        let half = N::from(0.5);
        let slider = values.slider.as_ref();
        let logs = slider.map(|slider| {
            slider.logs_as(|parameter, log| number(ResponseUnknown::Slider(parameter), log))
        });
        let of_slider = slider.zip(logs);
        let mut terms = Polynomial::NONE;
        for term in Term::ALL {
            *terms.coefficient_mut(term) = number(ResponseUnknown::Term(term), values.term(term));
        }
        let supports = half * number(SupportStiffness, values.support_stiffness);
        let of_joint = number(JointStiffness, values.joint_stiffness);
        let sticks = of_slider.map_or(N::ZERO, |(slider, logs)| slider.stiffness_of(logs));
        // A step turns the phase by ωh (1 − (ωh)⁴/120) in place of ωh: a mass that is smaller by (ωh)⁴/60 gives ω back
        let slower = 1.0 - (grid.omega * grid.step_s).powi(4) / 60.0;
        Self {
            mobility: N::from(2.0 / slower) / number(Mass, values.mass),
            spring: supports + of_joint - sticks,
            damper: half * number(SupportDamping, values.support_damping)
                + number(JointDamping, values.joint_damping),
            terms: Term::ALL
                .iter()
                .any(|term| !terms.coefficient(*term).is_zero())
                .then_some(terms),
            first_loading: of_slider.map(|(slider, logs)| slider.first_loading_of(logs)),
            corner: slider.map_or(f64::INFINITY, |slider| 2.0 * slider.corner_m()),
        }
    }

    pub(super) fn released(&self, displacement: N) -> Place<N> {
        let sign = displacement.value().signum();
        let load = self.first_loading.as_ref();
        let load = load.map_or(N::ZERO, |load| load.at(N::from(sign) * displacement));
        Place {
            u: displacement,
            v: N::ZERO,
            turn: displacement,
            at_turn: N::from(sign) * load,
            slips: false,
        }
    }

    /// The place where a motion is that began so much later (s), of which the changes alone count.
    pub(super) fn later(&self, place: &Place<N>, time: N) -> Place<N> {
        let rate = N::from(place.v.value());
        let acceleration = N::from(self.acceleration(place, [place.u, place.v]).value());
        Place {
            u: place.u - rate * time,
            v: place.v - acceleration * time,
            ..*place
        }
    }

    /// Load of the law that slips at a displacement behind the last turn: f_r + 2 F((u − u_r)/2), F odd.
    #[inline]
    fn load(&self, first_loading: &FirstLoading<N>, place: &Place<N>, u: N) -> N {
        let way = u - place.turn;
        let sign = way.value().signum();
        place.at_turn
            + times(
                2.0 * sign,
                first_loading.on_branch(times(0.5 * sign, way), place.slips),
            )
    }

    #[inline]
    pub(super) fn acceleration(&self, place: &Place<N>, [u, v]: [N; 2]) -> N {
        let mut load = self.spring * u + self.damper * v;
        if let Some(terms) = &self.terms {
            load = load + terms.load::<N>(&[], u, v);
        }
        if let Some(first_loading) = &self.first_loading {
            load = load + self.load(first_loading, place, u);
        }
        -(load * self.mobility)
    }

    /// One step of the classical Runge–Kutta method behind the last turn.
    #[inline]
    fn stepped(&self, place: &Place<N>, h: f64) -> Place<N> {
        let Place { u, v, .. } = *place;
        let a1 = self.acceleration(place, [u, v]);
        let v2 = v + times(0.5 * h, a1);
        let a2 = self.acceleration(place, [u + times(0.5 * h, v), v2]);
        let v3 = v + times(0.5 * h, a2);
        let a3 = self.acceleration(place, [u + times(0.5 * h, v2), v3]);
        let v4 = v + times(h, a3);
        let a4 = self.acceleration(place, [u + times(h, v3), v4]);
        Place {
            u: u + times(h / 6.0, v + times(2.0, v2 + v3) + v4),
            v: v + times(h / 6.0, a1 + times(2.0, a2 + a3) + a4),
            ..*place
        }
    }

    /// A step that is cut where the motion turns or the load has a corner: between them all is smooth.
    pub(super) fn advance(&self, place: &mut Place<N>, step_s: f64) {
        let mut left_s = step_s;
        let beyond = |at: &Place<N>| (at.u - at.turn).value().abs() - self.corner;
        for _ in 0..CUTS {
            place.slips = beyond(place) >= -AT_CORNER * self.corner;
            let next = self.stepped(place, left_s);
            let Some(first_loading) = &self.first_loading else {
                *place = next;
                return;
            };
            let forward = next.v.value().signum();
            let turns = place.v.value() * next.v.value() < 0.0;
            let turned =
                turns.then(|| self.placed(place, (left_s, next), &|at| at.v.value() * forward));
            let end = turned.unwrap_or((left_s, next));
            let is_cornered = !place.slips && beyond(&end.1) > AT_CORNER * self.corner;
            if is_cornered {
                let (at_s, at) = self.placed(place, end, &beyond);
                *place = at;
                left_s -= at_s;
                continue;
            }
            *place = end.1;
            let Some((at_s, at)) = turned else {
                return;
            };
            *place = Place {
                u: at.u,
                // at rest, but for how that changes
                v: at.v - N::from(at.v.value()),
                turn: at.u,
                at_turn: self.load(first_loading, place, at.u),
                slips: false,
            };
            left_s -= at_s;
        }
        place.slips = beyond(place) >= -AT_CORNER * self.corner;
        *place = self.stepped(place, left_s);
    }

    /// When on the way to its last place a number of the motion passes zero upwards, and the motion then: regula falsi, after Illinois.
    fn placed(
        &self,
        from: &Place<N>,
        last: (f64, Place<N>),
        of: &dyn Fn(&Place<N>) -> f64,
    ) -> (f64, Place<N>) {
        let (mut low, mut high) = ((0.0, of(from)), (last.0, of(&last.1)));
        let near = ROUNDING * (high.1 - low.1);
        let mut found = last;
        for _ in 0..PLACED {
            let at_s = low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
            if !(at_s > low.0 && at_s < high.0) {
                break;
            }
            let at = self.stepped(from, at_s);
            let value = of(&at);
            found = (at_s, at);
            if value.abs() <= near {
                break;
            }
            if value < 0.0 {
                low = (at_s, value);
                high.1 *= 0.5;
            } else {
                high = (at_s, value);
                low.1 *= 0.5;
            }
        }
        found
    }
}

/// c x
#[inline]
fn times<N: Number>(c: f64, x: N) -> N {
    x.chain(c * x.value(), c)
}
