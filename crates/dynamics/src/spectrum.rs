//! Eigenvalues of the lap model about rest: they set the step and tell whether motion dies out.

use crate::eigenvalues::{self, MAX_ORDER, Square};
use crate::elementary;
use crate::lap::Lap;
use crate::rk4;

/// One eigenvalue λ of the state equations, 1/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eigenvalue {
    /// Growth rate, 1/s: negative where the mode decays.
    pub real: f64,
    /// Damped angular frequency, rad/s.
    pub imaginary: f64,
}

impl Eigenvalue {
    pub(crate) const ZERO: Self = Self {
        real: 0.0,
        imaginary: 0.0,
    };

    /// |λ|, 1/s.
    #[must_use]
    pub fn modulus(&self) -> f64 {
        elementary::hypotenuse(self.real, self.imaginary)
    }
}

/// The eigenvalues of a lap model, linearised about rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum {
    eigenvalues: [Eigenvalue; MAX_ORDER],
    order: usize,
}

impl Spectrum {
    /// All eigenvalues, four for each DOF of a side, in no particular order.
    #[must_use]
    pub fn eigenvalues(&self) -> &[Eigenvalue] {
        &self.eigenvalues[..self.order]
    }

    /// Largest |λ|, 1/s.
    #[must_use]
    pub fn largest_modulus(&self) -> f64 {
        self.eigenvalues()
            .iter()
            .fold(0.0, |largest, eigenvalue| largest.max(eigenvalue.modulus()))
    }

    /// Longest RK4 step (s) that follows the fastest mode within [`rk4::PHASE_ERROR_PER_PERIOD`], or `None` where
    /// nothing moves by itself.
    #[must_use]
    pub fn accurate_step_s(&self) -> Option<f64> {
        let largest = self.largest_modulus();
        (largest > 0.0).then(|| rk4::accurate_h_lambda() / largest)
    }

    /// Whether RK4 with steps of `step_s` (s) keeps every decaying mode from growing.
    #[must_use]
    pub fn is_stable_with(&self, step_s: f64) -> bool {
        // |R(hλ)| ≤ 1 for each λ with Re λ ≤ 0. Rounding moves eigenvalues on the imaginary axis off it by about
        // ε|λ|max, and the double zeros of a free body by √ε|λ|max: what grows more slowly counts as held.
        let slack = f64::EPSILON.sqrt() * self.largest_modulus();
        self.eigenvalues().iter().all(|eigenvalue| {
            let real = step_s * eigenvalue.real;
            let growth = rk4::amplification_squared(real, step_s * eigenvalue.imaginary).sqrt();
            growth <= 1.0 + step_s * slack
                || eigenvalue.real > slack && growth <= elementary::exponential(real) + 1e-6
        })
    }
}

impl<const D: usize> Lap<D> {
    /// Eigenvalues about rest, or `None` where the model cannot be integrated ([`Lap::defect`]) or has more DOFs than there are in space.
    #[must_use]
    pub fn spectrum(&self) -> Option<Spectrum> {
        let order = 4 * D;
        if self.defect().is_some() || order > MAX_ORDER {
            return None;
        }
        let size = 2 * D;
        let joint = self.joint.linearised_about(&[0.0; D]).linear;
        let mut stiffness = [[0.0; MAX_ORDER]; MAX_ORDER];
        let mut damping = [[0.0; MAX_ORDER]; MAX_ORDER];
        self.assemble(
            &joint.stiffness,
            |body, i| body.stiffness[i],
            &mut stiffness,
        );
        self.assemble(&joint.damping, |body, i| body.damping[i], &mut damping);

        // State (s x, ẋ) in mass-normalised coordinates x ← √m x with s² = ‖M⁻½ K M⁻½‖, so that both halves of the
        // companion matrix [[0, sI], [−K̃/s, −C̃]] have entries of one size.
        let largest = stiffness
            .iter()
            .flatten()
            .fold(0.0, |m: f64, k| m.max(k.abs()));
        let scale = if largest > 0.0 { largest.sqrt() } else { 1.0 };
        let mut companion: Square = [[0.0; MAX_ORDER]; MAX_ORDER];
        for i in 0..size {
            companion[i][size + i] = scale;
            for j in 0..size {
                companion[size + i][j] = -stiffness[i][j] / scale;
                companion[size + i][size + j] = -damping[i][j];
            }
        }
        let eigenvalues = eigenvalues::eigenvalues(&companion, order)?;
        Some(Spectrum { eigenvalues, order })
    }

    /// M⁻½ (supports + joint) M⁻½ in the order of body a's DOFs, then body b's.
    fn assemble(
        &self,
        joint: &[[f64; D]; D],
        support: impl Fn(&crate::lap::Body<D>, usize) -> f64,
        result: &mut Square,
    ) {
        let bodies = [&self.a, &self.b];
        for (m, row_body) in bodies.iter().enumerate() {
            for (n, column_body) in bodies.iter().enumerate() {
                let sign = if m == n { 1.0 } else { -1.0 };
                for i in 0..D {
                    for j in 0..D {
                        let mut entry = sign * joint[i][j];
                        if m == n && i == j {
                            entry += support(row_body, i);
                        }
                        let inertia = row_body.inertia[i] * column_body.inertia[j];
                        result[m * D + i][n * D + j] = entry / inertia.sqrt();
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alike::alike;

    fn pirdayr(k: f64, c: f64, m: f64, k12: f64, c12: f64) -> Lap<1> {
        alike([[m], [k], [c]], [[[k12]], [[c12]]], [0.0])
    }

    #[test]
    fn the_symmetric_lap_has_its_two_closed_form_modes() {
        let (k, c, m, k12, c12) = (10.56e5, 1.39, 2.35, 4.56e6, 0.54);
        let spectrum = pirdayr(k, c, m, k12, c12).spectrum().unwrap();
        // in phase: √(k/m), c/(2m); out of phase: √((k + 2k12)/m), (c + 2c12)/(2m)
        for (stiffness, damping) in [(k, c), (k + 2.0 * k12, c + 2.0 * c12)] {
            let omega: f64 = f64::sqrt(stiffness / m);
            let decay: f64 = damping / (2.0 * m);
            let damped = (omega * omega - decay * decay).sqrt();
            let found = spectrum.eigenvalues().iter().any(|z| {
                (z.real + decay).abs() < 1e-9 * omega
                    && (z.imaginary - damped).abs() < 1e-11 * omega
            });
            assert!(found, "ω = {omega}: {spectrum:?}");
        }
        // The 670 rad/s of Table 4 (there printed as Hz).
        let slowest = spectrum
            .eigenvalues()
            .iter()
            .map(Eigenvalue::modulus)
            .fold(f64::MAX, f64::min);
        assert!((slowest - 670.35).abs() < 0.01, "{slowest}");
    }

    #[test]
    fn stability_ends_where_the_fastest_mode_reaches_the_limit() {
        let lap = pirdayr(10.56e5, 0.0, 2.35, 4.56e6, 0.0);
        let spectrum = lap.spectrum().unwrap();
        let limit = rk4::STABILITY_LIMIT_IMAGINARY / spectrum.largest_modulus();
        assert!(spectrum.is_stable_with(0.999 * limit));
        assert!(!spectrum.is_stable_with(1.001 * limit));
    }

    #[test]
    fn a_free_lap_is_not_taken_for_unstable() {
        let spectrum = pirdayr(0.0, 0.0, 0.0122, 5.73e5, 10.83).spectrum().unwrap();
        assert!(spectrum.is_stable_with(spectrum.accurate_step_s().unwrap()));
    }

    #[test]
    fn nothing_that_cannot_be_integrated_has_a_spectrum() {
        assert!(pirdayr(1.0, 0.0, 0.0, 1.0, 0.0).spectrum().is_none());
        assert!(pirdayr(1.0, f64::NAN, 1.0, 1.0, 0.0).spectrum().is_none());
    }
}
