//! Which laws are on one DOF, by their parameters: what is there costs a bit that is looked at, what is not costs nothing else.

use super::places::{
    ALL, DOF_PARAMETER_COUNT, FIRST_PARAMETER_COUNT, FURTHER, INNER, Place, REMEMBERING,
    dof_parameters, present,
};
use super::side_by_side::KINDS;
use super::{Declaration, Parameter};
use crate::number::Number;

/// The laws on one relative DOF, by their parameters in the order of [`DECLARATIONS`](super::DECLARATIONS).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DofLaws<N = f64> {
    parameters: [N; DOF_PARAMETER_COUNT],
    /// The bits of those that are there.
    present: u32,
}

impl<N: Number> DofLaws<N> {
    /// No law there.
    pub const NONE: Self = Self {
        parameters: [N::ZERO; DOF_PARAMETER_COUNT],
        present: 0,
    };

    /// The laws with these parameters, in the order of [`DECLARATIONS`](super::DECLARATIONS).
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

    /// Their parameters, in the order of [`DECLARATIONS`](super::DECLARATIONS).
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

    /// These laws, with parameters at this share of the way to those of others; a law that either has is there.
    #[must_use]
    pub fn towards(&self, others: &Self, share: N) -> Self {
        let rest = N::from(1.0) - share;
        Self {
            parameters: std::array::from_fn(|n| {
                rest * self.parameters[n] + share * others.parameters[n]
            }),
            present: self.present | others.present,
        }
    }

    /// Change of the parameters per unit on the way to those of others, of which there are `per_unit` ways.
    #[must_use]
    pub fn secant(&self, others: &Self, per_unit: N) -> Self {
        Self {
            parameters: std::array::from_fn(|n| {
                per_unit * (others.parameters[n] - self.parameters[n])
            }),
            present: self.present | others.present,
        }
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
    pub(super) fn own<'a>(&'a self, places: &'a [Place]) -> impl Iterator<Item = Place> + 'a {
        places.iter().copied().filter(|&place| self.has(place))
    }

    /// The same without the first of a kind.
    #[inline]
    pub(super) fn further<'a>(&'a self, places: &'a [Place]) -> impl Iterator<Item = Place> + 'a {
        self.own(&places[1..])
    }

    /// Whether there is a law beside another of its kind.
    #[inline]
    pub(super) const fn has_further(&self) -> bool {
        self.present & FURTHER != 0
    }

    #[inline]
    pub(super) fn of(&self, place: Place) -> &[N] {
        let [start, end] = place.parameters;
        &self.parameters[start..end]
    }

    #[inline]
    pub(super) const fn has(&self, place: Place) -> bool {
        self.present & place.bit != 0
    }
}
