//! The part of the joint's law that is not linear, on one relative DOF.

use bolted_joint_dynamics::JointLaw;

/// The terms of the law that are not linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Term {
    Cubic,
    Quintic,
    Septic,
    DampingQuadratic,
    DampingQuartic,
}

impl Term {
    pub(super) const ALL: [Self; 5] = [
        Self::Cubic,
        Self::Quintic,
        Self::Septic,
        Self::DampingQuadratic,
        Self::DampingQuartic,
    ];

    /// Powers of r and of ṙ.
    pub(super) fn powers(self) -> (i32, i32) {
        match self {
            Self::Cubic => (3, 0),
            Self::Quintic => (5, 0),
            Self::Septic => (7, 0),
            Self::DampingQuadratic => (2, 1),
            Self::DampingQuartic => (4, 1),
        }
    }

    /// Degree in r and ṙ together.
    pub(super) fn degree(self) -> usize {
        let (r, velocity) = self.powers();
        (r + velocity).unsigned_abs() as usize
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
                Term::Quintic => law.higher.quintic[dof],
                Term::Septic => law.higher.septic[dof],
                Term::DampingQuadratic => law.higher.damping_quadratic[dof],
                Term::DampingQuartic => law.higher.damping_quartic[dof],
            }),
        }
    }

    fn there(&self) -> impl Iterator<Item = Term> {
        let all = Term::ALL.into_iter().zip(self.coefficients);
        all.filter(|&(_, coefficient)| coefficient != 0.0)
            .map(|(term, _)| term)
    }

    /// Degree of the highest term there is; at least that of the cubic one.
    pub(super) fn degree(&self) -> usize {
        self.there()
            .map(Term::degree)
            .fold(Term::Cubic.degree(), usize::max)
    }

    /// Whether the force depends on the velocity.
    pub(super) fn has_damping(&self) -> bool {
        self.there().any(|term| term.powers().1 > 0)
    }

    #[inline]
    pub(super) fn tangent(&self, r: f64, velocity: f64) -> Tangent {
        // f = k3 r³ + k5 r⁵ + k7 r⁷ + (c2 r² + c4 r⁴) ṙ
        let [k3, k5, k7, c2, c4] = self.coefficients;
        let squared = r * r;
        let damping = squared * (c2 + squared * c4);
        Tangent {
            force: r * squared * (k3 + squared * (k5 + squared * k7)) + damping * velocity,
            stiffness: squared * (3.0 * k3 + squared * (5.0 * k5 + squared * (7.0 * k7)))
                + r * (2.0 * c2 + 4.0 * c4 * squared) * velocity,
            damping,
        }
    }
}
