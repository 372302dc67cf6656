//! The laws of a joint. Each is a file that declares its parameters and what it remembers, and says once, for real numbers and
//! for numbers with their changes, which load it gives, what it stores and what it turns into heat.
//!
//! A new law is a file here and a line in `dof_laws!` below.

/// Makes a law of its parameters and writes them, in the order of its declaration.
macro_rules! by_numbers {
    ($($field:ident),+) => {
        #[inline]
        fn new(parameters: &[N]) -> Self {
            let mut numbers = parameters.iter().copied();
            Self { $($field: numbers.next().unwrap_or(N::ZERO)),+ }
        }

        fn write(&self, parameters: &mut [N]) {
            for (parameter, own) in parameters.iter_mut().zip([$(self.$field),+]) {
                *parameter = own;
            }
        }
    };
}

mod bouc_wen;
mod dahl;
mod declaration;
mod flow;
mod iwan;
mod jenkins;
mod joint;
mod linear;
mod lugre;
mod over_preload;
mod polynomial;
#[cfg(test)]
mod trials;
mod valanis;

pub use bouc_wen::BoucWen;
pub use dahl::Dahl;
pub use declaration::{
    ActsOn, Declaration, Outside, Parameter, Quantity, Range, RateOf, Remembered, RememberedAs,
    Span, UnitRule,
};
pub use iwan::{Iwan, REVERSALS_MAX};
pub use jenkins::Jenkins;
pub use joint::{JointLaw, JointMemory};
pub use linear::{DAMPING, Linear, STIFFNESS};
pub use lugre::LuGre;
pub use over_preload::{Beyond, JointOverPreload, TableDefect};
pub use polynomial::{DAMPER_COUNT, Polynomial, SPRING_COUNT, TERM_COUNT, Tangent, Term};
pub use valanis::Valanis;

use crate::number::Number;

/// A place at which a load is not smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Corner {
    /// The slope changes at this relative displacement, m or rad.
    Sharp(f64),
    /// It changes soon about there.
    Rounded(f64),
}

impl Corner {
    /// Relative displacement, m or rad.
    #[must_use]
    pub const fn place(self) -> f64 {
        match self {
            Self::Sharp(place) | Self::Rounded(place) => place,
        }
    }
}

/// A law of the relative motion of one DOF, which acts beside the linear one.
///
/// `memory` is what the law remembers since its last commit, [`Declaration::memory_count`] numbers, all zero before the first
/// motion. Loads and energies are those of a trial motion from there and leave it as it is; only [`Law::commit`] moves on.
pub trait Law<N: Number>: Copy {
    /// What the law says of itself.
    const DECLARATION: Declaration;

    /// The law with these parameters, in the order of its declaration.
    fn new(parameters: &[N]) -> Self;

    /// Writes its parameters in that order.
    fn write(&self, parameters: &mut [N]);

    /// Load on side b, N or N·m, at the relative displacement r (m, rad) and its rate.
    fn load<M: Number + Into<N>>(&self, memory: &[M], r: N, velocity: N) -> N;

    /// Energy stored in its springs, J.
    fn stored_energy<M: Number + Into<N>>(&self, memory: &[M], r: N) -> N;

    /// Power that it turns into heat, W.
    fn dissipated_power<M: Number + Into<N>>(&self, memory: &[M], r: N, velocity: N) -> N;

    /// Moves what it remembers on to the relative displacement r (m, rad) and its rate; returns the heat of that way (J) beside
    /// that of dampers, without its changes.
    fn commit(&self, _memory: &mut [N], _r: N, _velocity: N) -> f64 {
        0.0
    }

    /// How many of the numbers that it remembers are in use, or are after one commit: those from the first on.
    fn used(&self, memory: &[N]) -> usize {
        memory.len()
    }

    /// Whether all that a commit has written is finite.
    fn is_finite(&self, memory: &[N]) -> bool {
        // without a branch for each, so that a processor looks at several at once
        let numbers = memory.iter();
        numbers.fold(true, |all, number| all & number.is_finite())
    }

    /// Takes its inner state, if it has one, as that at the relative displacement r (m, rad) and this rate: where somebody
    /// else integrates it.
    fn settle(&self, _memory: &mut [N], _r: N, _velocity: N) {}

    /// Rate of its inner state, if it has one, at this rate of the relative displacement.
    fn inner_rate(&self, _memory: &[N], _velocity: N) -> N {
        N::ZERO
    }

    /// Tells where its load may not be smooth on the straight way from where the memory is to `to`; beside the way there may be
    /// others.
    fn corners(&self, _memory: &[f64], _to: f64, _tell: &mut dyn FnMut(Corner)) {}

    /// The first of its parameters that is outside of the law's range, such that it is not passive or gives no load.
    fn outside(&self) -> Option<Outside> {
        None
    }

    /// Relative displacement (m, rad) at which it is no longer small beside the linear stiffness `_k` and damping `_c` of its
    /// DOF, or no longer linear itself; infinite where that never is.
    fn nonlinear_amplitude(&self, _k: f64, _c: f64) -> f64 {
        f64::INFINITY
    }
}

/// Farther than any joint goes, m or rad.
const FAR_AWAY: f64 = 1e300;

/// Part of its place by which rounding may put a corner before the joint that has just come to it.
const ROUNDING: f64 = 1e-10;

/// Where a law's numbers are among those of all laws on a DOF.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Its own bit.
    bit: u32,
    parameters: [usize; 2],
    memory: [usize; 2],
    /// Whether the law there has an inner state.
    is_inner: bool,
}

impl Place {
    /// Before all laws.
    const FRONT: Self = Self {
        bit: 0,
        parameters: [0, 0],
        memory: [0, 0],
        is_inner: false,
    };

    /// Whether the law there remembers anything.
    const fn has_memory(self) -> bool {
        self.memory[0] < self.memory[1]
    }

    /// The place of a law behind this one.
    const fn then(self, declaration: &Declaration) -> Self {
        let ([_, parameters], [_, memory]) = (self.parameters, self.memory);
        Self {
            bit: if self.bit == 0 { 1 } else { self.bit << 1 },
            parameters: [parameters, parameters + declaration.parameters.len()],
            memory: [memory, memory + declaration.memory_count()],
            is_inner: declaration.inner_count() > 0,
        }
    }

    /// The law there; the linear one, which is the first, has no place.
    const fn law(self) -> &'static Declaration {
        &DECLARATIONS[self.bit.trailing_zeros() as usize + 1]
    }
}

/// Number of laws that there can be, the linear one among them.
const LAW_COUNT: usize = {
    let (mut count, mut kind) = (0, 0);
    while kind < KINDS.len() {
        count += KINDS[kind].at_most;
        kind += 1;
    }
    count
};

/// The laws in their order, each with its kind: first one of each kind, then the second of each that there can be two of, and so
/// on. So those of which a kind has more cost nothing where it has one.
const LAWS: [(usize, Declaration); LAW_COUNT] = {
    let mut laws = [(0, KINDS[0]); LAW_COUNT];
    let (mut law, mut number) = (0, 1);
    while law < LAW_COUNT {
        let mut kind = 0;
        while kind < KINDS.len() {
            if KINDS[kind].at_most >= number {
                laws[law] = (kind, KINDS[kind].numbered(number));
                law += 1;
            }
            kind += 1;
        }
        number += 1;
    }
    laws
};

/// What every law of a joint says of itself: first one of each kind, the linear one before all.
pub const DECLARATIONS: &[Declaration] = &{
    let mut declarations = [KINDS[0]; LAW_COUNT];
    let mut law = 0;
    while law < LAW_COUNT {
        declarations[law] = LAWS[law].1;
        law += 1;
    }
    declarations
};

/// The places of the laws on a DOF: of all but the linear one, in their order.
const ALL: [Place; LAW_COUNT - 1] = {
    let mut places = [Place::FRONT; LAW_COUNT - 1];
    let mut place = Place::FRONT;
    let mut law = 1;
    while law < LAW_COUNT {
        place = place.then(&LAWS[law].1);
        places[law - 1] = place;
        law += 1;
    }
    places
};

/// The places of a kind.
const fn places_of<const COUNT: usize>(kind: usize) -> [Place; COUNT] {
    let mut places = [Place::FRONT; COUNT];
    let mut law = 1;
    while law < LAW_COUNT {
        if LAWS[law].0 == kind {
            places[LAWS[law].1.number - 1] = ALL[law - 1];
        }
        law += 1;
    }
    places
}

/// The place of the last law that is the first of its kind.
const LAST_FIRST: Place = ALL[KINDS.len() - 2];

/// The bits of all laws that are not the first of their kind.
const FURTHER: u32 = !((LAST_FIRST.bit << 1) - 1);

/// The bits of the laws that remember.
const REMEMBERING: u32 = {
    let (mut bits, mut law) = (0, 0);
    while law < ALL.len() {
        if ALL[law].has_memory() {
            bits |= ALL[law].bit;
        }
        law += 1;
    }
    bits
};

/// The bits of the laws with an inner state.
const INNER: u32 = {
    let (mut bits, mut law) = (0, 0);
    while law < ALL.len() {
        if ALL[law].is_inner {
            bits |= ALL[law].bit;
        }
        law += 1;
    }
    bits
};

/// Puts the kinds of laws that act on one relative DOF together, in this order.
macro_rules! dof_laws {
    ($($name:ident: $law:ident),+ $(,)?) => {
        /// What the kinds of laws say of themselves, the linear one first.
        const KINDS: &[Declaration] = &[
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
            fn save(&self, memory: &DofMemory, to: &mut [f64]) -> bool {
                let mut to = to;
                $(for place in self.own(&PLACES.$name).filter(|place| place.has_memory()) {
                    let own = part(memory, place);
                    let used = $law::new(self.of(place)).used(own);
                    let Some((saved, rest)) = to.split_at_mut_checked(used) else {
                        return false;
                    };
                    saved.copy_from_slice(&own[..used]);
                    to = rest;
                })+
                let _ = to;
                true
            }

            /// Puts back what was saved.
            fn put_back(&self, memory: &mut DofMemory, from: &[f64]) {
                let mut from = from;
                $(for place in self.own(&PLACES.$name).filter(|place| place.has_memory()) {
                    let own = part_mut(memory, place);
                    // by what was saved: its numbers tell how many they are
                    let used = $law::new(self.of(place)).used(from).min(own.len());
                    let (saved, rest) = from.split_at(used);
                    own[..used].copy_from_slice(saved);
                    from = rest;
                })+
                let _ = from;
            }

            /// Whether all that the laws that are there have committed is finite.
            #[must_use]
            pub fn is_memory_finite(&self, memory: &DofMemory) -> bool {
                let mut all = true;
                $(for place in self.own(&PLACES.$name).filter(|place| place.has_memory()) {
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
                    let mut parameters = Self::NONE.parameters;
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

/// Number of parameters that the laws have on each DOF.
pub const DOF_PARAMETER_COUNT: usize = ALL[ALL.len() - 1].parameters[1];

/// Number of the first of those, of the first law of each kind.
pub const FIRST_PARAMETER_COUNT: usize = LAST_FIRST.parameters[1];

/// Number of the first of those, of laws that remember nothing: they stand before all others.
pub const FORGETFUL_PARAMETER_COUNT: usize = {
    let mut count = 0;
    let mut law = 1;
    while law < DECLARATIONS.len() && !DECLARATIONS[law].remembers() {
        count += DECLARATIONS[law].parameters.len();
        law += 1;
    }
    while law < DECLARATIONS.len() {
        assert!(DECLARATIONS[law].remembers());
        law += 1;
    }
    count
};

/// What the laws on each DOF declare of their parameters, each with its law, in the order of [`DofLaws::parameters`].
pub fn dof_parameters() -> impl Iterator<Item = (&'static Declaration, &'static Parameter)> {
    let laws = DECLARATIONS.iter().skip(1);
    laws.flat_map(|law| law.parameters.iter().map(move |parameter| (law, parameter)))
}

/// Number of numbers that the laws remember on each DOF.
pub const DOF_MEMORY_COUNT: usize = ALL[ALL.len() - 1].memory[1];

/// The laws on one relative DOF, by their parameters in the order of [`DECLARATIONS`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DofLaws<N = f64> {
    parameters: [N; DOF_PARAMETER_COUNT],
    /// The bits of those that are there.
    present: u32,
}

/// What the laws on one relative DOF remember, in the order of [`DECLARATIONS`]: of each law first what is a variable.
pub type DofMemory<N = f64> = [N; DOF_MEMORY_COUNT];

/// Nothing has moved yet.
pub const DOF_AT_REST: DofMemory = [0.0; DOF_MEMORY_COUNT];

/// Number of the numbers in [`DofMemory`] that are variables.
pub const REMEMBERED_COUNT: usize = {
    let (mut count, mut law) = (0, 0);
    while law < DECLARATIONS.len() {
        count += DECLARATIONS[law].memory.len();
        law += 1;
    }
    count
};

/// Number of the first of those, of the first law of each kind.
pub const FIRST_REMEMBERED_COUNT: usize = {
    let (mut count, mut law) = (0, 0);
    while law < KINDS.len() {
        count += KINDS[law].memory.len();
        law += 1;
    }
    count
};

/// Places in [`DofMemory`] of the numbers that are variables, in the order of [`DECLARATIONS`].
pub const REMEMBERED_PLACES: [usize; REMEMBERED_COUNT] = {
    let mut places = [0; REMEMBERED_COUNT];
    let (mut count, mut law, mut start) = (0, 0, 0);
    while law < DECLARATIONS.len() {
        let mut own = 0;
        while own < DECLARATIONS[law].memory.len() {
            places[count] = start + own;
            own += 1;
            count += 1;
        }
        start += DECLARATIONS[law].memory_count();
        law += 1;
    }
    places
};

/// Number of the inner states on each DOF.
pub const INNER_COUNT: usize = {
    let (mut count, mut law) = (0, 0);
    while law < DECLARATIONS.len() {
        let own = DECLARATIONS[law].inner_count();
        // a law gives the rate of one
        assert!(own <= 1);
        count += own;
        law += 1;
    }
    count
};

/// Number of the first of those, of the first law of each kind.
pub const FIRST_INNER_COUNT: usize = {
    let (mut count, mut law) = (0, 0);
    while law < KINDS.len() {
        count += KINDS[law].inner_count();
        law += 1;
    }
    count
};

/// Places in [`DofMemory`] of the inner states, in the order of [`DECLARATIONS`].
pub const INNER_PLACES: [usize; INNER_COUNT] = {
    let mut places = [0; INNER_COUNT];
    let (mut count, mut law, mut start) = (0, 0, 0);
    while law < DECLARATIONS.len() {
        let mut own = 0;
        while own < DECLARATIONS[law].memory.len() {
            if DECLARATIONS[law].memory[own].rate.is_some() {
                places[count] = start + own;
                count += 1;
            }
            own += 1;
        }
        start += DECLARATIONS[law].memory_count();
        law += 1;
    }
    places
};

/// The numbers in [`DofMemory`] that are variables: the place of each, with its law and what that declares of it.
pub fn remembered() -> impl Iterator<Item = (usize, &'static Declaration, &'static Remembered)> {
    let laws = DECLARATIONS.iter();
    let declared = laws.flat_map(|law| law.memory.iter().map(move |number| (law, number)));
    let places = REMEMBERED_PLACES.into_iter().zip(declared);
    places.map(|(place, (law, number))| (place, law, number))
}

#[inline]
fn part<N>(memory: &DofMemory<N>, place: Place) -> &[N] {
    let [start, end] = place.memory;
    &memory[start..end]
}

#[inline]
fn part_mut<N>(memory: &mut DofMemory<N>, place: Place) -> &mut [N] {
    let [start, end] = place.memory;
    &mut memory[start..end]
}

/// The bits of those of these places at which a law is: one of its parameters is not zero.
#[inline]
fn present<'p, N: Number>(
    places: impl Iterator<Item = &'p Place>,
    parameters: &[N; DOF_PARAMETER_COUNT],
) -> u32 {
    places.fold(0, |present, place| {
        let [start, end] = place.parameters;
        let mut own = parameters[start..end].iter();
        let is_there = own.any(|number| !number.is_zero());
        present | if is_there { place.bit } else { 0 }
    })
}

impl<N: Number> DofLaws<N> {
    /// No law there.
    pub const NONE: Self = Self {
        parameters: [N::ZERO; DOF_PARAMETER_COUNT],
        present: 0,
    };

    /// The laws with these parameters, in the order of [`DECLARATIONS`].
    #[inline]
    #[must_use]
    pub fn new(parameters: [N; DOF_PARAMETER_COUNT]) -> Self {
        Self {
            parameters,
            present: present(ALL.iter(), &parameters),
        }
    }

    /// The laws with these parameters, of which none has another of its kind beside it.
    #[inline]
    #[must_use]
    pub fn of_each_kind(first: &[N; FIRST_PARAMETER_COUNT]) -> Self {
        let mut parameters = [N::ZERO; DOF_PARAMETER_COUNT];
        parameters[..FIRST_PARAMETER_COUNT].copy_from_slice(first);
        let firsts = ALL.iter().take(KINDS.len() - 1);
        Self {
            parameters,
            present: present(firsts, &parameters),
        }
    }

    /// The laws that are there.
    pub fn present(&self) -> impl Iterator<Item = &'static Declaration> {
        self.own(&ALL).map(Place::law)
    }

    /// Their parameters, in the order of [`DECLARATIONS`].
    #[inline]
    #[must_use]
    pub const fn parameters(&self) -> &[N; DOF_PARAMETER_COUNT] {
        &self.parameters
    }

    /// Whether no law is there: all parameters are zero.
    #[inline]
    #[must_use]
    pub const fn are_none(&self) -> bool {
        self.present == 0
    }

    /// Whether a law that is there remembers the motion.
    #[inline]
    #[must_use]
    pub const fn have_memory(&self) -> bool {
        self.present & REMEMBERING != 0
    }

    /// Whether a law that is there has an inner state.
    #[inline]
    #[must_use]
    pub const fn have_inner(&self) -> bool {
        self.present & INNER != 0
    }

    /// The laws with what grows as the preload does times this share of it.
    #[must_use]
    pub fn at_share_of_preload(&self, share: N) -> Self {
        let mut own = *self;
        for (value, (_, parameter)) in own.parameters.iter_mut().zip(dof_parameters()) {
            if parameter.grows_with_preload {
                *value = share * *value;
            }
        }
        own
    }

    /// The laws with these parameters alone, the others zero.
    #[must_use]
    pub fn with_only(&self, stays: impl Fn(&Parameter) -> bool) -> Self {
        let mut only = self.parameters;
        for (value, (_, parameter)) in only.iter_mut().zip(dof_parameters()) {
            if !stays(parameter) {
                *value = N::ZERO;
            }
        }
        Self::new(only)
    }

    /// These laws and others, of which none is of the same kind.
    #[must_use]
    pub fn beside(&self, others: &Self) -> Self {
        Self {
            parameters: std::array::from_fn(|n| self.parameters[n] + others.parameters[n]),
            present: self.present | others.present,
        }
    }

    /// Those of these places at which a law is.
    #[inline]
    fn own<'a>(&'a self, places: &'a [Place]) -> impl Iterator<Item = Place> + 'a {
        places.iter().copied().filter(|&place| self.has(place))
    }

    /// The same without the first of a kind.
    #[inline]
    fn further<'a>(&'a self, places: &'a [Place]) -> impl Iterator<Item = Place> + 'a {
        self.own(&places[1..])
    }

    /// Whether there is a law beside another of its kind.
    #[inline]
    const fn has_further(&self) -> bool {
        self.present & FURTHER != 0
    }

    #[inline]
    fn of(&self, place: Place) -> &[N] {
        let [start, end] = place.parameters;
        &self.parameters[start..end]
    }

    #[inline]
    const fn has(&self, place: Place) -> bool {
        self.present & place.bit != 0
    }
}
