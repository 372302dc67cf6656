//! The part of the joint's law that is not linear, on one relative DOF.

use bolted_joint_dynamics::JointLaw;

/// The terms of the law that are not linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Term {
    Cubic,
}

impl Term {
    pub(super) const ALL: [Self; 1] = [Self::Cubic];

    /// Powers of r and of ṙ.
    pub(super) fn powers(self) -> (i32, i32) {
        match self {
            Self::Cubic => (3, 0),
        }
    }
}

/// f(r, ṙ) on one relative DOF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Terms {
    /// In the order of [`Term::ALL`].
    coefficients: [f64; Term::ALL.len()],
}

/// f with its derivatives at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tangent {
    /// f, N or N·m.
    pub(super) force: f64,
    /// ∂f/∂r
    pub(super) stiffness: f64,
    /// ∂f/∂ṙ
    pub(super) damping: f64,
}

impl Terms {
    pub(super) fn of<const D: usize>(law: &JointLaw<D>, dof: usize) -> Self {
        Self {
            coefficients: Term::ALL.map(|term| match term {
                Term::Cubic => law.cubic[dof],
            }),
        }
    }

    /// Degree of the highest term there is; at least that of the cubic one.
    pub(super) fn degree(&self) -> usize {
        let there = Term::ALL.iter().zip(self.coefficients);
        there
            .filter(|&(_, coefficient)| coefficient != 0.0)
            .map(|(term, _)| {
                let (r, v) = term.powers();
                (r + v).unsigned_abs() as usize
            })
            .fold(3, usize::max)
    }

    /// Whether the force depends on the velocity.
    pub(super) fn has_damping(&self) -> bool {
        let there = Term::ALL.iter().zip(self.coefficients);
        there
            .into_iter()
            .any(|(term, coefficient)| term.powers().1 > 0 && coefficient != 0.0)
    }

    #[inline]
    pub(super) fn tangent(&self, r: f64, _velocity: f64) -> Tangent {
        // f = k3 r³
        let [k3] = self.coefficients;
        let squared = r * r;
        Tangent {
            force: k3 * squared * r,
            stiffness: 3.0 * k3 * squared,
            damping: 0.0,
        }
    }
}
