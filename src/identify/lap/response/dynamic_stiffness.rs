//! Force over relative motion as a function of the amplitude of that motion, with exact derivatives.

use num_complex::Complex64;

use super::model::Values;
use super::terms::Term;

/// z_r: amplitude of half the difference of the bodies' loads over that of the relative motion's fundamental.
#[derive(Clone, Copy, Debug)]
pub(super) struct DynamicStiffness {
    /// N/m
    pub(super) value: Complex64,
    /// Derivative by the logarithm of the amplitude.
    pub(super) by_log_amplitude: Complex64,
    /// Derivatives by the terms, in the order of [`Term::ALL`].
    pub(super) by_term: [Complex64; 5],
}

impl DynamicStiffness {
    /// Of one harmonic, in closed form.
    pub(super) fn of(values: &Values, amplitude_m: f64, omega: f64) -> Self {
        // z_r = k/2 + k₁₂ − ω² m/2 + jω (c/2 + c₁₂) + Σ terms
        let mut value = Complex64::new(
            0.5 * values.support_stiffness + values.joint_stiffness
                - 0.5 * values.mass * omega * omega,
            omega * (0.5 * values.support_damping + values.joint_damping),
        );
        let mut by_log_amplitude = Complex64::ZERO;
        let by_term = Term::ALL.map(|term| {
            let share = term.describing() * amplitude_m.powi(term.power());
            match term.is_damping() {
                false => Complex64::new(share, 0.0),
                true => Complex64::new(0.0, omega * share),
            }
        });
        for (term, by) in Term::ALL.into_iter().zip(by_term) {
            let part = by * values.term(term);
            value += part;
            by_log_amplitude += part * f64::from(term.power());
        }
        Self {
            value,
            by_log_amplitude,
            by_term,
        }
    }
}
