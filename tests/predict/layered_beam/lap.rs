//! The equivalent lap: its modes, and damping over the amplitude.

use std::f64::consts::{PI, TAU};

use bolted_joint::predict::layered_beam::{
    AmplitudeDamping, AmplitudeRange, EquivalentLap, Route, SlipDamping,
};
use bolted_joint_testing::close;
use proptest::prelude::*;

use super::{BOUNDARIES, mode, rivets, specimen};

#[test]
fn the_lap_has_the_beams_mode() {
    for boundary in BOUNDARIES {
        for number in [1, 2, 5] {
            let (beam, rivets) = (specimen(boundary), rivets(7));
            let mode = mode(&beam, &rivets, number, Route::Classical);
            let damping = SlipDamping::new(&beam, &rivets, mode.clone(), 0.004).unwrap();
            let lap = EquivalentLap::of(&damping);
            let k = lap.stiffness_n_per_m;
            let (a, b, k_b) = (lap.a.inertia[0], lap.b.inertia[0], lap.b.stiffness[0]);
            // the lower root of (k − ω²m_a)(k + k_b − ω²m_b) − k² = 0 and its mode (1, (k − ω²m_a)/k)
            let middle = k / a + (k + k_b) / b;
            let squared = 0.5 * (middle - (middle * middle - 4.0 * k * k_b / (a * b)).sqrt());
            close(squared.sqrt(), mode.angular_frequency, 1e-12);
            // the other way, without the difference of two nearly equal numbers
            let share = k / (k + k_b - squared * b);
            close(share, lap.mount_share, 1e-9);
            assert!(share < 2e-4);
            let modal_mass = a + b * share * share;
            close(modal_mass, mode.mass_kg, 1e-12);
            let c = lap.joint_damping_n_s_per_m(damping.viscous_damping_n_s_per_m(2e-4));
            let modal_damping = c * (1.0 - share).powi(2) + lap.b.damping[0] * share * share;
            let ratio = modal_damping / (2.0 * modal_mass * squared.sqrt());
            close(ratio, damping.damping_ratio(2e-4), 1e-12);
            close(lap.damping_ratio(&damping, c), ratio, 1e-12);
            // the mount's own mode hardly shows where the beam is driven
            let other = middle - squared;
            let other_share = (k - other * a) / k;
            let other_mass = a + b * other_share * other_share;
            assert!(1.0 / (other_mass * other) < 1e-4 / (modal_mass * squared));
        }
    }
}

/// Loss over a period of r = R sin ωt, by the trapezoidal rule, which is exact for so short a Fourier series.
fn loss(damping: &AmplitudeDamping, amplitude: f64, omega: f64) -> f64 {
    const STEPS: u32 = 64;
    let at = |step: u32| {
        let (sin, cos) = (TAU * f64::from(step) / f64::from(STEPS)).sin_cos();
        let (r, rate) = (amplitude * sin, amplitude * omega * cos);
        let c = damping.constant_n_s_per_m
            + damping.quadratic_n_s_per_m3 * r * r
            + damping.quartic_n_s_per_m5 * r.powi(4);
        c * rate * rate
    };
    (0..STEPS).map(at).sum::<f64>() * TAU / omega / f64::from(STEPS)
}

proptest! {
    #[test]
    fn damping_over_the_amplitude_follows_friction(
        to in 1e-6..1e-2_f64, part in 0.02..0.98_f64, force in 1e-3..1e3_f64, omega in 1.0..1e5_f64
    ) {
        let range = AmplitudeRange::new("range", part * to, to).unwrap();
        // friction F has the loss 4 F R, a damper π ω c R²
        let coulomb = 4.0 * force / (PI * omega);
        let found = AmplitudeDamping::following(coulomb, &range);
        let error = |amplitude: f64| loss(&found, amplitude, omega) / (4.0 * force * amplitude) - 1.0;
        // of opposite sign and the same size at the ends, no larger between
        prop_assert!((error(range.from_m()) + found.worst_error).abs() < 1e-6);
        prop_assert!((error(to) - found.worst_error).abs() < 1e-6);
        for k in 0..=50 {
            let amplitude = range.from_m() + f64::from(k) / 50.0 * (to - range.from_m());
            prop_assert!(error(amplitude).abs() < found.worst_error + 1e-6);
            let equivalent = found.equivalent_n_s_per_m(amplitude);
            let expected = loss(&found, amplitude, omega) / (PI * omega * amplitude * amplitude);
            prop_assert!((equivalent / expected - 1.0).abs() < 1e-9);
        }
        // nowhere negative, in the range and beyond
        for k in 0..=400 {
            let r = 3.0 * to * f64::from(k) / 400.0;
            let c = found.constant_n_s_per_m + found.quadratic_n_s_per_m3 * r * r + found.quartic_n_s_per_m5 * r.powi(4);
            prop_assert!(c >= 0.0, "{c} at {r}");
        }
        let discriminant = found.quadratic_n_s_per_m3.powi(2) - 4.0 * found.constant_n_s_per_m * found.quartic_n_s_per_m5;
        prop_assert!(discriminant <= 0.0);
    }

    /// No other damping that is nowhere negative does better: a (s − s₀)² + b s with any scale.
    #[test]
    fn no_passive_damping_follows_friction_better(
        part in 0.05..0.95_f64, centre in 0.0..3.0_f64, further in 0.0..3.0_f64, linear in 0.0..1.0_f64, scale in 0.1..10.0_f64
    ) {
        let range = AmplitudeRange::new("range", part, 1.0).unwrap();
        let best = AmplitudeDamping::following(1.0, &range).worst_error;
        // (s − s₀)² + share·(s − s₁)² + b s
        let constant = centre * centre + linear * further * further;
        let quadratic = -2.0 * (centre + linear * further) + linear;
        let quartic = 1.0 + linear;
        let loss = |amplitude: f64| {
            let s = amplitude * amplitude;
            scale * amplitude * (constant + 0.25 * quadratic * s + 0.125 * quartic * s * s)
        };
        let ends = [loss(part), loss(1.0)];
        let worst = ends.into_iter().map(|loss| (loss - 1.0).abs()).fold(0.0, f64::max);
        prop_assert!(worst >= best - 1e-9, "{worst} {best}");
    }
}
