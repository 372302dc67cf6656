//! The lap with one DOF, written down once more, for results to compare with.

use std::fmt::Display;

use crate::importer::vr;

/// The lap's equations with one DOF, written down once more: m, k, c of both bodies; k12, c12, k3; F of both.
#[derive(Clone, Copy)]
pub(crate) struct Equations {
    pub(crate) m: f64,
    pub(crate) k: f64,
    pub(crate) c: f64,
    pub(crate) k12: f64,
    pub(crate) c12: f64,
    pub(crate) k3: f64,
    pub(crate) force: [f64; 2],
}

/// The lap of most tests: the bodies of the tests' start files, with k3 = 5e12.
pub(crate) const EQUATIONS: Equations = Equations {
    m: 2.0,
    k: 8e5,
    c: 1.0,
    k12: 4e6,
    c12: 8.0,
    k3: 5e12,
    force: [30.0, -20.0],
};
/// A motion of it, and its states in that order.
pub(crate) const START: [f64; 4] = [1e-4, 0.1, -2e-4, 0.0];
pub(crate) const STATES: [u32; 4] = [vr::A_Y, vr::A_V, vr::B_Y, vr::B_V];

/// Each number agrees with the one that is expected but for this part of it.
#[track_caller]
pub(crate) fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_close_at("", found, expected, tolerance);
}

/// The same, for the case that is told.
#[track_caller]
pub(crate) fn assert_close_at(case: impl Display, found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    let is_close =
        |(found, expected): (&f64, &f64)| (found - expected).abs() <= tolerance * expected.abs();
    assert!(
        found.iter().zip(expected).all(is_close),
        "{case}: {found:?} {expected:?}"
    );
}

impl Equations {
    /// Rate of (y_a, v_a, y_b, v_b).
    pub(crate) fn rate(&self, x: [f64; 4]) -> [f64; 4] {
        let [ya, va, yb, vb] = x;
        let joint = self.k12 * (ya - yb) + self.c12 * (va - vb) + self.k3 * (ya - yb).powi(3);
        [
            va,
            (self.force[0] - self.k * ya - self.c * va - joint) / self.m,
            vb,
            (self.force[1] - self.k * yb - self.c * vb + joint) / self.m,
        ]
    }

    /// A classical Runge–Kutta step of length `h`, with the equations at its beginning, middle and end.
    pub(crate) fn step([start, middle, end]: [Self; 3], x: [f64; 4], h: f64) -> [f64; 4] {
        let shifted = |factor: f64, k: [f64; 4]| -> [f64; 4] {
            std::array::from_fn(|i| x[i] + factor * k[i])
        };
        let k1 = start.rate(x);
        let k2 = middle.rate(shifted(h / 2.0, k1));
        let k3 = middle.rate(shifted(h / 2.0, k2));
        let k4 = end.rate(shifted(h, k3));
        std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
    }

    /// `n` of them.
    pub(crate) fn runge_kutta(&self, x: [f64; 4], h: f64, n: usize) -> [f64; 4] {
        (0..n).fold(x, |x, _| Self::step([*self; 3], x, h))
    }

    /// Force in the joint, stored energy, dissipated power.
    pub(crate) fn outputs(&self, [ya, va, yb, vb]: [f64; 4]) -> [f64; 3] {
        let (r, v) = (ya - yb, va - vb);
        [
            self.k12 * r + self.c12 * v + self.k3 * r.powi(3),
            0.5 * self.m * (va * va + vb * vb)
                + 0.5 * self.k * (ya * ya + yb * yb)
                + 0.5 * self.k12 * r * r
                + 0.25 * self.k3 * r.powi(4),
            self.c * (va * va + vb * vb) + self.c12 * v * v,
        ]
    }
}
