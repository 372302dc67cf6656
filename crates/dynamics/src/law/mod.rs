//! The laws of a joint. Each is a file that declares its parameters and what it remembers, and says once, for real numbers and
//! for numbers with their changes, which load it gives, what it stores and what it turns into heat.
//!
//! A new law is a file here, a line among the modules, and a line in the list of `side_by_side.rs`.

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
mod dof_laws;
mod flow;
mod iwan;
mod jenkins;
mod joint;
mod linear;
mod lugre;
mod over_preload;
mod places;
mod polynomial;
mod side_by_side;
mod slider_parameters;
#[cfg(test)]
mod trials;
mod valanis;

pub use bouc_wen::BoucWen;
pub use dahl::Dahl;
pub use declaration::{
    ActsOn, Declaration, Outside, Parameter, Quantity, Range, RateOf, Remembered, RememberedAs,
    Span, UnitRule,
};
pub use dof_laws::DofLaws;
pub use iwan::{Iwan, REVERSALS_MAX};
pub use jenkins::Jenkins;
pub use joint::{JointLaw, JointMemory};
pub use linear::{DAMPING, Linear, STIFFNESS};
pub use lugre::LuGre;
pub use over_preload::{Beyond, JointOverPreload, TableDefect};
pub use places::{
    DECLARATIONS, DOF_AT_REST, DOF_MEMORY_COUNT, DOF_PARAMETER_COUNT, DofMemory, FIRST_INNER_COUNT,
    FIRST_PARAMETER_COUNT, FIRST_REMEMBERED_COUNT, FORGETFUL_PARAMETER_COUNT, INNER_COUNT,
    INNER_PLACES, REMEMBERED_COUNT, REMEMBERED_PLACES, dof_parameters, remembered,
};
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

    /// What its sliders' elongations at the relative displacement r would store in those of `springs`, J: the same law at another
    /// preload. Springs that are not in the law's own parameters have no part of it.
    fn energy_in<M: Number + Into<N>>(&self, _springs: &Self, _memory: &[M], _r: N) -> N {
        N::ZERO
    }

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

    /// The same between this law and another one, both inside, at the share of the way that is told, where parameters go straight
    /// from one to the other. Most ranges are convex, so that no way leaves them.
    fn outside_towards(&self, _other: &Self) -> Option<(f64, Outside)> {
        None
    }

    /// Relative displacement (m, rad) at which it is no longer small beside the linear stiffness `_k` and damping `_c` of its
    /// DOF, or no longer linear itself; infinite where that never is.
    fn nonlinear_amplitude(&self, _k: f64, _c: f64) -> f64 {
        f64::INFINITY
    }
}
