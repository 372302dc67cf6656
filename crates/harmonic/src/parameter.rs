//! What a periodic response depends on, one number at a time.

use bolted_joint_dynamics::law::Term;

/// One side of the joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Body a.
    A,
    /// Body b.
    B,
}

/// A number of the model or of its loading with respect to which a response is differentiated.
///
/// DOFs count from 0: translation, then rotation. The model has each body's own numbers; where both bodies share one, such as
/// Pirdayr's m, k and c, the derivative is the sum of both bodies'.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Parameter {
    /// Inertia of a body, kg or kg·m².
    Inertia(Side, usize),
    /// Stiffness of a body's support, N/m or N·m/rad.
    SupportStiffness(Side, usize),
    /// Damping of a body's support, N·s/m or N·m·s/rad.
    SupportDamping(Side, usize),
    /// Entry of the joint's K; off the diagonal both symmetric entries together.
    JointStiffness(usize, usize),
    /// Entry of the joint's C; off the diagonal both symmetric entries together.
    JointDamping(usize, usize),
    /// Coefficient of a term of the polynomial law on a relative DOF.
    Term(Term, usize),
    /// Factor by which all harmonic loads are changed, 1 as they are.
    LoadFactor,
    /// Angular frequency of the loads, rad/s.
    AngularFrequency,
}
