//! The equivalent lap: its modes, and its friction.

use std::f64::consts::{PI, TAU};

use bolted_joint::predict::layered_beam::{
    AmplitudeRange, DrySlider, EquivalentLap, Route, SlipDamping,
};
use bolted_joint_testing::close;

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

/// Heat of a cycle r = R cos ωt and fundamental of the load in phase with it, by return mapping in small steps.
fn cycle(stiffness: f64, slip_force: f64, amplitude: f64) -> (f64, f64) {
    const STEPS: u32 = 200_000;
    let (mut slider, mut heat, mut in_phase) = (0.0, 0.0, 0.0);
    // the second of two cycles is steady
    for step in 0..2 * STEPS {
        let r = amplitude * (TAU * f64::from(step) / f64::from(STEPS)).cos();
        let trial = stiffness * (r - slider);
        let load = trial.clamp(-slip_force, slip_force);
        let place = r - load / stiffness;
        if step >= STEPS {
            heat += slip_force * (place - slider).abs();
            in_phase += 2.0 / f64::from(STEPS) * load * r / amplitude;
        }
        slider = place;
    }
    (heat, in_phase)
}

#[test]
fn the_slider_has_the_heat_of_dry_friction() {
    let (force, omega) = (3.5, 271.0);
    let range = AmplitudeRange::new("range", 1e-4, 3e-4).unwrap();
    // friction F has the heat 4 F R, a damper π ω c R²
    let found = DrySlider::following(4.0 * force / (PI * omega), omega, &range);
    let (k, h) = (found.law.stiffness, found.law.slip_force);
    close(h, force, 1e-14);
    for amplitude in [1e-4, 1.7e-4, 3e-4] {
        let (heat, in_phase) = cycle(k, h, amplitude);
        // h/k is a thousandth of the smallest amplitude
        close(heat, 4.0 * force * (amplitude - 1e-7), 1e-6);
        assert!((heat / (4.0 * force * amplitude) - 1.0).abs() <= found.worst_error * (1.0 + 1e-6));
        let equivalent = heat / (PI * omega * amplitude * amplitude);
        close(found.equivalent_n_s_per_m(amplitude), equivalent, 1e-6);
        close(found.secant_n_per_m(amplitude), in_phase / amplitude, 1e-4);
    }
}

#[test]
fn the_lap_s_slider_has_the_damping_of_the_beam() {
    let (beam, rivets) = (specimen(BOUNDARIES[0]), rivets(7));
    let mode = mode(&beam, &rivets, 1, Route::Classical);
    let damping = SlipDamping::new(&beam, &rivets, mode.clone(), 0.004).unwrap();
    let lap = EquivalentLap::of(&damping);
    let range = AmplitudeRange::new("range", 1e-4, 5e-4).unwrap();
    let slider = lap.slider_over(&damping, &range).unwrap();
    for amplitude in [1e-4, 2e-4, 5e-4] {
        let r = lap.relative(amplitude);
        let (heat, _) = cycle(slider.law.stiffness, slider.law.slip_force, r);
        // ζ = D/(2π m ω² X²) at the drive point, the mount's damper beside; but for what sticks
        let stored =
            2.0 * PI * mode.mass_kg * mode.angular_frequency.powi(2) * amplitude * amplitude;
        let sticks = 1.0 - 1e-3 * lap.relative(1e-4) / r;
        let mount = lap.b.damping[0] * lap.mount_share.powi(2)
            / (2.0 * mode.mass_kg * mode.angular_frequency);
        let expected = damping.damping_ratio(amplitude);
        // the mount's share was taken off where its part is least
        assert!(mount < 1e-3 * expected, "{mount} of {expected}");
        assert!(
            (heat / stored / (expected * sticks) - 1.0).abs() < 2e-3,
            "{amplitude}"
        );
        let c = slider.equivalent_n_s_per_m(r);
        close(lap.damping_ratio(&damping, c), expected * sticks, 2e-3);
    }
}
