//! Normal forces, energies and damping ratios of both routes.

use std::f64::consts::PI;

use bolted_joint::predict::layered_beam::{
    BeamMode, Fasteners, Layer, LayeredBeam, NormalForceRule, Route, SlipDamping, StoredEnergy,
    normal_force_ratio,
};
use bolted_joint::structure::Boundary;
use bolted_joint_testing::close;

use super::{BOUNDARIES, mode, references, rivets, specimen};

fn damping(beam: &LayeredBeam, rivets: &Fasteners, number: usize, route: Route) -> SlipDamping {
    SlipDamping::new(beam, rivets, mode(beam, rivets, number, route), 0.004).unwrap()
}

#[test]
fn normal_forces_are_the_integrated_pressure() {
    for [ratio, expected] in references().normal_forces {
        close(normal_force_ratio(ratio).unwrap(), expected, 1e-13);
    }
    // linear in between, nothing beyond
    let middle = normal_force_ratio(1.25).unwrap();
    let [low, high] = [1.0, 1.5].map(|ratio| normal_force_ratio(ratio).unwrap());
    close(2.0 * middle, low + high, 1e-13);
    assert_eq!(normal_force_ratio(2.1), None);
    assert_eq!(normal_force_ratio(0.9), None);
    assert_eq!(normal_force_ratio(f64::NAN), None);
}

#[test]
fn damping_is_that_of_independent_finite_elements() {
    for case in &references().elements {
        let (beam, rivets) = (case.beam(), case.rivets());
        for (number, expected) in (1..).zip(&case.modes) {
            for route in [Route::Classical, Route::FiniteElements] {
                let drive = Some(case.drive_point);
                let mode = BeamMode::new(&beam, &rivets, number, drive, route, StoredEnergy::Modal);
                let found = SlipDamping::new(&beam, &rivets, mode.unwrap(), case.alpha_mu).unwrap();
                let ratio = found.damping_ratio(case.amplitude);
                close(ratio, expected.damping_ratio, 1e-4);
            }
        }
    }
}

#[test]
fn both_routes_have_the_same_damping() {
    for boundary in BOUNDARIES {
        for count in [1, 4, 7] {
            for number in 1..=5 {
                let (beam, rivets) = (specimen(boundary), rivets(count));
                let [exact, elements] = [Route::Classical, Route::FiniteElements]
                    .map(|route| mode(&beam, &rivets, number, route));
                // equal parts have their middles where this mode has no slope
                if boundary == Boundary::PinnedPinned && number == count
                    || count == 1 && exact.check_slip().is_err()
                {
                    assert_eq!(exact.slope_sum_per_m(), 0.0);
                    assert_eq!(elements.slope_sum_per_m(), 0.0);
                    continue;
                }
                close(elements.slope_sum_per_m(), exact.slope_sum_per_m(), 1e-3);
                let of = |mode| SlipDamping::new(&beam, &rivets, mode, 0.004).unwrap();
                let [exact, elements] = [exact, elements].map(|mode| of(mode).damping_ratio(1e-4));
                close(elements, exact, 1e-3);
            }
        }
    }
}

/// A pinned–pinned beam has everything in closed form.
#[test]
fn a_pinned_beam_by_hand() {
    let (beam, rivets) = (specimen(Boundary::PinnedPinned), rivets(6));
    let found = damping(&beam, &rivets, 1, Route::Classical);
    let (length, amplitude) = (0.37_f64, 2e-4);
    // w = a sin(πx/L): Y = a (π/L) Σ|cos(πx_i/L)|, E_n = ½ a² π⁴EI/(2L³)
    let bending = 196e9 * 0.04125 * 0.006_f64.powi(3) / 12.0;
    let slopes = (0..6).map(|i| (PI * (f64::from(i) + 0.5) / 6.0).cos().abs());
    let y = amplitude * PI / length * slopes.sum::<f64>();
    let normal = 0.895_201_290_841_567_7 * 100e6 * PI * 0.004 * 0.004;
    let dissipated = 2.0 * 0.004 * normal * 0.003 * y;
    let stored = 0.25 * amplitude * amplitude * PI.powi(4) * bending / length.powi(3);
    close(found.dissipated_energy_j(amplitude), dissipated, 1e-12);
    close(found.stored_energy_j(amplitude), stored, 1e-12);
    let decrement = found.logarithmic_decrement(amplitude);
    close(decrement, 0.5 * dissipated / stored, 1e-12);
    let ratio = found.damping_ratio(amplitude);
    close(ratio, dissipated / (4.0 * PI * stored), 1e-12);
}

#[test]
fn damping_falls_with_the_amplitude_and_grows_with_the_layers() {
    let rivets = rivets(6);
    let layered = |count: usize| {
        let layer = Layer {
            thickness_m: 0.006 / count as f64,
            youngs_modulus_pa: 196e9,
            density_kg_per_m3: 7850.0,
        };
        let layers = vec![layer; count];
        let beam = LayeredBeam::new(0.37, 0.04125, layers, Boundary::FixedFixed, 1.0).unwrap();
        damping(&beam, &rivets, 1, Route::Classical)
    };
    let two = layered(2);
    let at_100_um = two.damping_ratio(1e-4);
    close(two.damping_ratio(3e-4), at_100_um / 3.0, 1e-14);
    for count in [3, 4, 8] {
        // (m − 1) interfaces with 2h = H/m each
        let expected = 2.0 * (count as f64 - 1.0) / count as f64;
        let found = layered(count).damping_ratio(1e-4);
        close(found / at_100_um, expected, 1e-13);
    }
}

#[test]
fn a_balanced_normal_force_is_the_tension() {
    let beam = specimen(Boundary::FixedFixed);
    let balanced = rivets(6).with_rule(NormalForceRule::Tension);
    let forces = balanced.normal_forces_n(&beam).unwrap();
    assert_eq!(forces, [balanced.tension_n()]);
    close(balanced.tension_n(), 100e6 * PI * 16e-6, 1e-14);
}

#[test]
fn static_stiffness_is_less_than_the_modes() {
    // 192 EI/L³ and 48 EI/L³ at mid span
    for (boundary, factor, modal) in [
        (Boundary::FixedFixed, 192.0, 198.462_534_669_478_8),
        (Boundary::PinnedPinned, 48.0, 0.5 * PI.powi(4)),
    ] {
        let (beam, rivets) = (specimen(boundary), rivets(6));
        let unit = beam.bending_stiffness_n_m2() / 0.37_f64.powi(3);
        let of = |stored| {
            let mode = BeamMode::new(&beam, &rivets, 1, Some(0.185), Route::Classical, stored);
            mode.unwrap().stiffness_n_per_m / unit
        };
        close(of(StoredEnergy::Static), factor, 1e-13);
        close(of(StoredEnergy::Modal), modal, 1e-13);
    }
}

#[test]
fn calibration_comes_back() {
    for boundary in BOUNDARIES {
        let (beam, rivets) = (specimen(boundary), rivets(6));
        let mode = mode(&beam, &rivets, 1, Route::Classical);
        let found = SlipDamping::calibrated(&beam, &rivets, mode.clone(), 0.0123, 1.7e-4).unwrap();
        close(found.damping_ratio(1.7e-4), 0.0123, 1e-14);
        let again = SlipDamping::new(&beam, &rivets, mode, found.alpha_mu).unwrap();
        assert_eq!(again, found);
    }
}
