//! The laps that the tests are about.

use bolted_joint_dynamics::{Body, Lap, Linear, Polynomial};

/// m ẍ + c ẋ + k x + k3 x³ = F cos ωt.
#[derive(Clone, Copy)]
pub(crate) struct Duffing {
    pub(crate) inertia: f64,
    pub(crate) damping: f64,
    pub(crate) stiffness: f64,
    pub(crate) cubic: f64,
}

impl Duffing {
    /// As the relative motion of two like bodies: r = x_a − x_b with F on a and −F on b has
    /// (m/2) r̈ + (c/2 + c12) ṙ + (k/2 + k12) r + k3 r³ = F.
    pub(crate) fn symmetric(self) -> Lap<1> {
        let body = Body {
            inertia: [2.0 * self.inertia],
            stiffness: [0.5 * self.stiffness],
            damping: [0.5 * self.damping],
        };
        let linear = Linear {
            stiffness: [[0.75 * self.stiffness]],
            damping: [[0.75 * self.damping]],
        };
        Lap {
            joint: linear.beside([Polynomial::cubic(self.cubic)]),
            a: body,
            b: body,
        }
    }
}

/// Pirdayr's Ex.03 with another cubic stiffness, his being invisible.
pub(crate) fn pirdayr(cubic: f64) -> Lap<1> {
    let body = Body {
        inertia: [2.35],
        stiffness: [10.56e5],
        damping: [1.39],
    };
    let linear = Linear {
        stiffness: [[4.56e6]],
        damping: [[0.54]],
    };
    Lap {
        joint: linear.beside([Polynomial::cubic(cubic)]),
        a: body,
        b: body,
    }
}

/// Two unlike bodies with rotation, the joint of every term.
pub(crate) fn with_rotation() -> Lap<2> {
    let linear = Linear {
        stiffness: [[5.73e5, 5.82e3], [5.82e3, 1.29e3]],
        damping: [[30.0, -2.0], [-2.0, 0.4]],
    };
    Lap {
        joint: linear.beside([
            Polynomial::with(&[4e12, 3e19, -2e26], &[6e8, 2e15]),
            Polynomial::with(&[2e6, -4e9, 5e13], &[900.0, 5e5]),
        ]),
        a: Body {
            inertia: [1.2, 2.1e-3],
            stiffness: [8e5, 900.0],
            damping: [12.0, 0.05],
        },
        b: Body {
            inertia: [0.7, 1.3e-3],
            stiffness: [3e5, 700.0],
            damping: [9.0, 0.03],
        },
    }
}
