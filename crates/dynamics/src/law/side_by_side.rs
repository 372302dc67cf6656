//! The laws side by side on one DOF: the list of their kinds, and what they are together.
//!
//! A new law is a line in `dof_laws!` below. A law that is not there costs a bit that is looked at.

use super::places::{ALL, DofMemory, INNER_COUNT, INNER_PLACES, Place, part, part_mut, places_of};
use super::{
    BoucWen, Corner, Dahl, Declaration, DofLaws, Iwan, Jenkins, Law, LuGre, Outside, Polynomial,
    Valanis, linear,
};
use crate::number::Number;

/// Farther than any joint goes, m or rad.
const FAR_AWAY: f64 = 1e300;

/// Part of its place by which rounding may put a corner before the joint that has just come to it.
const ROUNDING: f64 = 1e-10;

/// Saves what is in use of a law's memory; what is left of the room, `None` where it is too small.
#[inline]
fn saved<'t>(law: &impl Law<f64>, own: &[f64], to: &'t mut [f64]) -> Option<&'t mut [f64]> {
    let (saved, rest) = to.split_at_mut_checked(law.used(own))?;
    saved.copy_from_slice(&own[..saved.len()]);
    Some(rest)
}

/// Puts back what was saved of a law's memory; what is left of it.
fn put_back<'f>(law: &impl Law<f64>, own: &mut [f64], from: &'f [f64]) -> &'f [f64] {
    // by what was saved: its numbers tell how many they are
    let used = law.used(from).min(own.len());
    let (saved, rest) = from.split_at(used);
    own[..used].copy_from_slice(saved);
    rest
}

/// Puts the kinds of laws that act on one relative DOF together, in this order.
macro_rules! dof_laws {
    ($($name:ident: $law:ident),+ $(,)?) => {
        /// What the kinds of laws say of themselves, the linear one first.
        pub(super) const KINDS: &[Declaration] = &[
            linear::DECLARATION,
            $(<$law<f64> as Law<f64>>::DECLARATION,)+
        ];

        /// The places of each kind.
        struct Places {
            $($name: [Place; <$law<f64> as Law<f64>>::DECLARATION.at_most],)+
        }

        const PLACES: Places = {
            let mut kind = 0;
            $(
                kind += 1;
                let $name = places_of(kind);
            )+
            Places { $($name,)+ }
        };

        impl<N: Number> DofLaws<N> {
            $(
                /// This law by itself, or the first of its kind.
                #[inline]
                #[must_use]
                pub fn $name(&self) -> $law<N> {
                    $law::new(self.of(PLACES.$name[0]))
                }
            )+

            /// Load on side b, N or N·m, at the relative displacement r (m, rad) and its rate.
            #[inline]
            #[must_use]
            pub fn load<M: Number + Into<N>>(&self, memory: &DofMemory<M>, r: N, velocity: N) -> N {
                let mut sum = N::ZERO;
                $(if self.has(PLACES.$name[0]) {
                    sum = sum + self.$name().load(part(memory, PLACES.$name[0]), r, velocity);
                })+
                if self.has_further() {
                    sum = sum + self.further_load(memory, r, velocity);
                }
                sum
            }

            /// That of the laws that are not the first of their kind.
            #[inline(never)]
            fn further_load<M: Number + Into<N>>(&self, memory: &DofMemory<M>, r: N, velocity: N) -> N {
                let mut sum = N::ZERO;
                $(for place in self.further(&PLACES.$name) {
                    let law = $law::new(self.of(place));
                    sum = sum + law.load(part(memory, place), r, velocity);
                })+
                sum
            }

            /// Energy stored in the springs, J.
            #[inline]
            #[must_use]
            pub fn stored_energy<M: Number + Into<N>>(&self, memory: &DofMemory<M>, r: N) -> N {
                let mut sum = N::ZERO;
                $(if self.has(PLACES.$name[0]) {
                    sum = sum + self.$name().stored_energy(part(memory, PLACES.$name[0]), r);
                })+
                if self.has_further() {
                    sum = sum + self.further_stored_energy(memory, r);
                }
                sum
            }

            /// That of the laws that are not the first of their kind.
            #[inline(never)]
            fn further_stored_energy<M: Number + Into<N>>(&self, memory: &DofMemory<M>, r: N) -> N {
                let mut sum = N::ZERO;
                $(for place in self.further(&PLACES.$name) {
                    let law = $law::new(self.of(place));
                    sum = sum + law.stored_energy(part(memory, place), r);
                })+
                sum
            }

            /// What the elongations of the laws that remember would store in the springs of these laws, J: the same ones at
            /// another preload.
            #[must_use]
            pub fn energy_in<M: Number + Into<N>>(&self, springs: &Self, memory: &DofMemory<M>, r: N) -> N {
                let mut sum = N::ZERO;
                $(for place in self.own(&PLACES.$name) {
                    let [law, springs] = [self, springs].map(|laws| $law::new(laws.of(place)));
                    sum = sum + law.energy_in(&springs, part(memory, place), r);
                })+
                sum
            }

            /// Power turned into heat, W.
            #[inline]
            #[must_use]
            pub fn dissipated_power<M: Number + Into<N>>(&self, memory: &DofMemory<M>, r: N, velocity: N) -> N {
                let mut sum = N::ZERO;
                $(if self.has(PLACES.$name[0]) {
                    sum = sum + self.$name().dissipated_power(part(memory, PLACES.$name[0]), r, velocity);
                })+
                if self.has_further() {
                    sum = sum + self.further_dissipated_power(memory, r, velocity);
                }
                sum
            }

            /// That of the laws that are not the first of their kind.
            #[inline(never)]
            fn further_dissipated_power<M: Number + Into<N>>(&self, memory: &DofMemory<M>, r: N, velocity: N) -> N {
                let mut sum = N::ZERO;
                $(for place in self.further(&PLACES.$name) {
                    let law = $law::new(self.of(place));
                    sum = sum + law.dissipated_power(part(memory, place), r, velocity);
                })+
                sum
            }

            /// The same of the laws that remember nothing, W: the others tell their heat where they move on.
            #[inline]
            #[must_use]
            pub fn viscous_power(&self, r: N, velocity: N) -> N {
                let mut sum = N::ZERO;
                $(if !PLACES.$name[0].has_memory() && self.has(PLACES.$name[0]) {
                    sum = sum + self.$name().dissipated_power::<N>(&[], r, velocity);
                })+
                sum
            }

            /// Moves what is remembered on to the relative displacement r (m, rad) and its rate; returns the heat of that way,
            /// J, beside that of dampers and without its changes.
            pub fn commit(&self, memory: &mut DofMemory<N>, r: N, velocity: N) -> f64 {
                let mut heat = 0.0;
                $(if PLACES.$name[0].has_memory() && self.has(PLACES.$name[0]) {
                    heat += self.$name().commit(part_mut(memory, PLACES.$name[0]), r, velocity);
                })+
                if self.has_further() {
                    heat += self.further_commit(memory, r, velocity);
                }
                heat
            }

            /// That of the laws that are not the first of their kind.
            #[inline(never)]
            fn further_commit(&self, memory: &mut DofMemory<N>, r: N, velocity: N) -> f64 {
                let mut heat = 0.0;
                $(for place in self.further(&PLACES.$name) {
                    heat += $law::new(self.of(place)).commit(part_mut(memory, place), r, velocity);
                })+
                heat
            }

            /// Moves the inner states alone on to the relative displacement r (m, rad) and its rate.
            pub fn commit_inner(&self, memory: &mut DofMemory<N>, r: N, velocity: N) {
                $(for place in self.own(&PLACES.$name).filter(|place| place.is_inner) {
                    $law::new(self.of(place)).commit(part_mut(memory, place), r, velocity);
                })+
            }

            /// Takes the inner states as those at the relative displacement r (m, rad) and this rate: where somebody else
            /// integrates them.
            pub fn settle(&self, memory: &mut DofMemory<N>, r: N, velocity: N) {
                $(for place in self.own(&PLACES.$name).filter(|place| place.is_inner) {
                    $law::new(self.of(place)).settle(part_mut(memory, place), r, velocity);
                })+
            }

            /// Rates of the inner states, in the order of [`INNER_PLACES`], at this rate of the relative displacement.
            #[must_use]
            pub fn inner_rates(&self, memory: &DofMemory<N>, velocity: N) -> [N; INNER_COUNT] {
                let mut rates = [N::ZERO; INNER_COUNT];
                $(for place in self.own(&PLACES.$name).filter(|place| place.is_inner) {
                    let own = INNER_PLACES.iter().position(|&state| state == place.memory[0]);
                    if let Some(own) = own {
                        let law = $law::new(self.of(place));
                        rates[own] = law.inner_rate(part(memory, place), velocity);
                    }
                })+
                rates
            }
        }

        impl DofLaws {
            /// The nearest place (m, rad) before r in this direction, 1 or -1, at which the load is not smooth if the joint goes on
            /// from there.
            #[must_use]
            pub fn next_corner(&self, memory: &DofMemory, r: f64, direction: f64) -> Option<f64> {
                let mut nearest: Option<f64> = None;
                self.corners(memory, direction * FAR_AWAY, &mut |corner| {
                    let Corner::Sharp(corner) = corner else {
                        return;
                    };
                    let way = (corner - r) * direction;
                    let is_ahead = way > ROUNDING * (r.abs() + corner.abs());
                    if is_ahead && nearest.is_none_or(|nearest| way < (nearest - r) * direction) {
                        nearest = Some(corner);
                    }
                });
                nearest
            }

            /// Tells where the load may not be smooth on the straight way from where the memory is to `to`; beside the way
            /// there may be others.
            pub fn corners(&self, memory: &DofMemory, to: f64, tell: &mut dyn FnMut(Corner)) {
                $(for place in self.own(&PLACES.$name) {
                    $law::new(self.of(place)).corners(part(memory, place), to, tell);
                })+
            }

            /// Saves what is in use of what the laws that are there remember; says no where `to` is too small for it.
            #[inline]
            pub(super) fn save(&self, memory: &DofMemory, to: &mut [f64]) -> bool {
                let mut to = to;
                $(if PLACES.$name[0].has_memory() && self.has(PLACES.$name[0]) {
                    let Some(rest) = saved(&self.$name(), part(memory, PLACES.$name[0]), to) else {
                        return false;
                    };
                    to = rest;
                })+
                !self.has_further() || self.save_further(memory, to)
            }

            /// Those of the laws that are not the first of their kind.
            #[inline(never)]
            fn save_further(&self, memory: &DofMemory, to: &mut [f64]) -> bool {
                let mut to = to;
                $(for place in self.further(&PLACES.$name) {
                    let Some(rest) = saved(&$law::new(self.of(place)), part(memory, place), to) else {
                        return false;
                    };
                    to = rest;
                })+
                let _ = to;
                true
            }

            /// Puts back what was saved.
            pub(super) fn put_back(&self, memory: &mut DofMemory, from: &[f64]) {
                let mut from = from;
                $(for place in self.own(&PLACES.$name[..1]).filter(|place| place.has_memory()) {
                    from = put_back(&$law::new(self.of(place)), part_mut(memory, place), from);
                })+
                $(for place in self.further(&PLACES.$name) {
                    from = put_back(&$law::new(self.of(place)), part_mut(memory, place), from);
                })+
                let _ = from;
            }

            /// Whether all that the laws that are there have committed is finite.
            #[inline]
            #[must_use]
            pub fn is_memory_finite(&self, memory: &DofMemory) -> bool {
                let mut all = true;
                $(if PLACES.$name[0].has_memory() && self.has(PLACES.$name[0]) {
                    all &= self.$name().is_finite(part(memory, PLACES.$name[0]));
                })+
                all && (!self.has_further() || self.is_further_memory_finite(memory))
            }

            /// That of the laws that are not the first of their kind.
            #[inline(never)]
            fn is_further_memory_finite(&self, memory: &DofMemory) -> bool {
                let mut all = true;
                $(for place in self.further(&PLACES.$name) {
                    all &= $law::new(self.of(place)).is_finite(part(memory, place));
                })+
                all
            }

            /// Copies what the laws that are there remember, and nothing else.
            pub fn copy_memory(&self, from: &DofMemory, to: &mut DofMemory) {
                for place in self.own(&ALL) {
                    part_mut(to, place).copy_from_slice(part(from, place));
                }
            }

            /// The first parameter that is outside of the range of its law, if one is.
            #[must_use]
            pub fn outside(&self) -> Option<(&'static Declaration, Outside)> {
                $(for place in self.own(&PLACES.$name) {
                    if let Some(outside) = $law::new(self.of(place)).outside() {
                        return Some((place.law(), outside));
                    }
                })+
                None
            }

            /// The first parameter that leaves the range of its law on the straight way to those of other laws, with the share of
            /// the way.
            #[must_use]
            pub fn outside_towards(&self, others: &Self) -> Option<(f64, &'static Declaration, Outside)> {
                $(for place in self.own(&PLACES.$name) {
                    let [law, other] = [self, others].map(|laws| $law::new(laws.of(place)));
                    if let Some((share, outside)) = law.outside_towards(&other) {
                        return Some((share, place.law(), outside));
                    }
                })+
                None
            }

            /// Relative displacement (m, rad) at which the first of the laws is no longer small beside the linear stiffness `k`
            /// and damping `c`; infinite where none is there.
            pub(crate) fn nonlinear_amplitude(&self, k: f64, c: f64) -> f64 {
                let mut least = f64::INFINITY;
                $(for place in self.own(&PLACES.$name) {
                    least = least.min($law::new(self.of(place)).nonlinear_amplitude(k, c));
                })+
                least
            }
        }

        $(
            impl<N: Number> From<$law<N>> for DofLaws<N> {
                /// This law alone.
                fn from(law: $law<N>) -> Self {
                    let mut parameters = *Self::NONE.parameters();
                    let [start, end] = PLACES.$name[0].parameters;
                    law.write(&mut parameters[start..end]);
                    Self::new(parameters)
                }
            }
        )+
    };
}

dof_laws! {
    polynomial: Polynomial,
    jenkins: Jenkins,
    iwan: Iwan,
    valanis: Valanis,
    dahl: Dahl,
    lugre: LuGre,
    bouc_wen: BoucWen,
}
