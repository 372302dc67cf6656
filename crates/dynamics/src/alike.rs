//! Laps of two bodies that are alike, for tests.

use crate::lap::{Body, Lap};
use crate::law::{Linear, Polynomial};

/// Inertia, stiffness and damping of either body; stiffness and damping of the joint; its cubic springs.
pub(crate) fn alike<const D: usize>(
    [inertia, stiffness, damping]: [[f64; D]; 3],
    joint: [[[f64; D]; D]; 2],
    cubic: [f64; D],
) -> Lap<D> {
    let body = Body {
        inertia,
        stiffness,
        damping,
    };
    let [stiffness, damping] = joint;
    Lap {
        joint: Linear { stiffness, damping }.beside(cubic.map(Polynomial::cubic)),
        a: body,
        b: body,
    }
}
