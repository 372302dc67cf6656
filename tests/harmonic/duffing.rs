//! The Duffing oscillator as a lap: the formula of one harmonic.

use std::f64::consts::TAU;

use bolted_joint::harmonic::{HarmonicBalance, HarmonicLoads, Harmonics, Observed};

use super::laps::Duffing;

pub(crate) const HARDENING: Duffing = Duffing {
    inertia: 1.3,
    damping: 0.4,
    stiffness: 52.0,
    cubic: 700.0,
};
pub(crate) const SOFTENING: Duffing = Duffing {
    cubic: -300.0,
    ..HARDENING
};

/// Residual of the amplitude's equation: X²((k − ω²m + ¾ k3 X²)² + c²ω²) − F².
fn formula(duffing: Duffing, omega: f64, amplitude: f64, force: f64) -> f64 {
    let Duffing {
        inertia,
        damping,
        stiffness,
        cubic,
    } = duffing;
    let squared = amplitude * amplitude;
    let elastic = stiffness - omega * omega * inertia + 0.75 * cubic * squared;
    squared * (elastic * elastic + (damping * omega).powi(2)) / (force * force) - 1.0
}

#[test]
fn one_harmonic_is_the_formula() {
    for duffing in [HARDENING, SOFTENING] {
        let balance =
            HarmonicBalance::new(&duffing.symmetric(), Harmonics::odd(1).unwrap()).unwrap();
        for force in [0.01, 0.3, 1.0] {
            let loads = HarmonicLoads::opposed(force);
            for n in 1..40 {
                let omega = 0.4 * f64::from(n);
                let solution = balance.forced(omega, &loads, None).unwrap();
                let amplitude = balance.amplitude_of(&solution, Observed::Relative(0), 1);
                let rest = formula(duffing, omega, amplitude.norm(), force);
                assert!(rest.abs() < 1e-12, "{omega}: {rest}");
                assert!((solution.frequency_hz() - omega / TAU).abs() < 1e-15 * omega);
            }
        }
    }
}
