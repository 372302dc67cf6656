//! The lap model of Pirdayr, with rotation where the joint has it: two supported bodies and the joint between them.

use crate::joint::{JointLaw, Motion};

/// One side of the lap: a rigid body on its own support.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<const D: usize> {
    /// Mass in kg, moment of inertia in kg·m².
    pub inertia: [f64; D],
    /// Support stiffness in N/m, N·m/rad.
    pub stiffness: [f64; D],
    /// Support damping in N·s/m, N·m·s/rad.
    pub damping: [f64; D],
}

/// Two bodies and the joint between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lap<const D: usize> {
    /// Law of the joint between the bodies.
    pub joint: JointLaw<D>,
    /// Body on side a.
    pub a: Body<D>,
    /// Body on side b.
    pub b: Body<D>,
}

/// State of the lap model: motion of both bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapState<const D: usize> {
    /// Motion of body a.
    pub a: Motion<D>,
    /// Motion of body b.
    pub b: Motion<D>,
}

/// External loads on the two bodies, N and N·m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapLoads<const D: usize> {
    /// Load on body a.
    pub a: [f64; D],
    /// Load on body b.
    pub b: [f64; D],
}
