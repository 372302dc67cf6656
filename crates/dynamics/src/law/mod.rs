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
    ActsOn, Declaration, Outside, Parameter, Quantity, Range, Remembered, RememberedAs, Span,
    UnitRule,
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

/// Where a law's numbers are among those of all laws on a DOF.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Its own bit.
    bit: u32,
    parameters: [usize; 2],
    memory: [usize; 2],
}

impl Place {
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
        }
    }
}

/// Puts the laws that act on one relative DOF together, in this order.
macro_rules! dof_laws {
    ($($name:ident: $law:ident),+ $(,)?) => {
        /// What every law of a joint says of itself, the linear one first.
        pub const DECLARATIONS: &[Declaration] = &[
            linear::DECLARATION,
            $(<$law<f64> as Law<f64>>::DECLARATION,)+
        ];

        /// The place of each law, and behind them all.
        struct Places {
            $($name: Place,)+
            end: Place,
        }

        /// The places of all of them.
        const ALL: &[Place] = &[$(PLACES.$name),+];

        /// The bits of the laws that remember.
        const REMEMBERING: u32 = $((if PLACES.$name.has_memory() { PLACES.$name.bit } else { 0 }) |)+ 0;

        const PLACES: Places = {
            let end = Place { bit: 0, parameters: [0, 0], memory: [0, 0] };
            $(
                let end = end.then(&<$law<f64> as Law<f64>>::DECLARATION);
                let $name = end;
            )+
            Places { $($name,)+ end }
        };

        impl<N: Number> DofLaws<N> {
            $(
                /// This law by itself.
                #[inline]
                #[must_use]
                pub fn $name(&self) -> $law<N> {
                    $law::new(self.of(PLACES.$name))
                }
            )+

            /// Load on side b, N or N·m, at the relative displacement r (m, rad) and its rate.
            #[inline]
            #[must_use]
            pub fn load<M: Number + Into<N>>(&self, memory: &DofMemory<M>, r: N, velocity: N) -> N {
                let mut sum = N::ZERO;
                $(if self.has(PLACES.$name) {
                    sum = sum + self.$name().load(part(memory, PLACES.$name), r, velocity);
                })+
                sum
            }

            /// Energy stored in the springs, J.
            #[inline]
            #[must_use]
            pub fn stored_energy<M: Number + Into<N>>(&self, memory: &DofMemory<M>, r: N) -> N {
                let mut sum = N::ZERO;
                $(if self.has(PLACES.$name) {
                    sum = sum + self.$name().stored_energy(part(memory, PLACES.$name), r);
                })+
                sum
            }

            /// Power turned into heat, W.
            #[inline]
            #[must_use]
            pub fn dissipated_power<M: Number + Into<N>>(&self, memory: &DofMemory<M>, r: N, velocity: N) -> N {
                let mut sum = N::ZERO;
                $(if self.has(PLACES.$name) {
                    sum = sum + self.$name().dissipated_power(part(memory, PLACES.$name), r, velocity);
                })+
                sum
            }

            /// The same of the laws that remember nothing, W: the others tell their heat where they move on.
            #[inline]
            #[must_use]
            pub fn viscous_power(&self, r: N, velocity: N) -> N {
                let mut sum = N::ZERO;
                $(if !PLACES.$name.has_memory() && self.has(PLACES.$name) {
                    sum = sum + self.$name().dissipated_power::<N>(&[], r, velocity);
                })+
                sum
            }

            /// Moves what is remembered on to the relative displacement r (m, rad) and its rate; returns the heat of that way,
            /// J, beside that of dampers and without its changes.
            pub fn commit(&self, memory: &mut DofMemory<N>, r: N, velocity: N) -> f64 {
                let mut heat = 0.0;
                $(if PLACES.$name.has_memory() && self.has(PLACES.$name) {
                    heat += self.$name().commit(part_mut(memory, PLACES.$name), r, velocity);
                })+
                heat
            }

        }

        impl DofLaws {
            /// Tells where the load may not be smooth on the straight way from where the memory is to `to`; beside the way
            /// there may be others.
            pub fn corners(&self, memory: &DofMemory, to: f64, tell: &mut dyn FnMut(Corner)) {
                $(if PLACES.$name.has_memory() && self.has(PLACES.$name) {
                    self.$name().corners(part(memory, PLACES.$name), to, tell);
                })+
            }

            /// Copies what the laws that are there remember, and nothing else.
            pub fn copy_memory(&self, from: &DofMemory, to: &mut DofMemory) {
                $(if PLACES.$name.has_memory() && self.has(PLACES.$name) {
                    part_mut(to, PLACES.$name).copy_from_slice(part(from, PLACES.$name));
                })+
            }

            /// The first parameter that is outside of the range of its law, if one is.
            #[must_use]
            pub fn outside(&self) -> Option<(&'static Declaration, Outside)> {
                let mut laws = DECLARATIONS.iter().skip(1);
                $(
                    let declaration = laws.next()?;
                    if self.has(PLACES.$name)
                        && let Some(outside) = self.$name().outside()
                    {
                        return Some((declaration, outside));
                    }
                )+
                None
            }

            /// Relative displacement (m, rad) at which the first of the laws is no longer small beside the linear stiffness `k`
            /// and damping `c`; infinite where none is there.
            pub(crate) fn nonlinear_amplitude(&self, k: f64, c: f64) -> f64 {
                let mut least = f64::INFINITY;
                $(if self.has(PLACES.$name) {
                    least = least.min(self.$name().nonlinear_amplitude(k, c));
                })+
                least
            }
        }

        $(
            impl<N: Number> From<$law<N>> for DofLaws<N> {
                /// This law alone.
                fn from(law: $law<N>) -> Self {
                    let mut parameters = Self::NONE.parameters;
                    let [start, end] = PLACES.$name.parameters;
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
pub const DOF_PARAMETER_COUNT: usize = PLACES.end.parameters[1];

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
pub const DOF_MEMORY_COUNT: usize = PLACES.end.memory[1];

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

/// The numbers in [`DofMemory`] that are variables: the place of each, with what is declared of it.
pub fn remembered() -> impl Iterator<Item = (usize, &'static Remembered)> {
    let declared = DECLARATIONS.iter().flat_map(|law| law.memory);
    REMEMBERED_PLACES.into_iter().zip(declared)
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
        let present = ALL.iter().fold(0, |present, place| {
            let [start, end] = place.parameters;
            let is_there = parameters[start..end]
                .iter()
                .any(|number| !number.is_zero());
            present | if is_there { place.bit } else { 0 }
        });
        Self {
            parameters,
            present,
        }
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
