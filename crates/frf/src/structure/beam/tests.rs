//! The beam against closed forms and published frequencies.

use super::mesh::ELEMENTS;
use super::*;

mod timoshenko;

fn aluminium(boundary: Boundary) -> Beam {
    Beam {
        length_m: 0.221,
        width_m: 0.025,
        height_m: 0.006,
        youngs_modulus_pa: 70e9,
        density_kg_per_m3: 2700.0,
        theory: Theory::EulerBernoulli,
        boundary,
        damping: Damping::Ratios(vec![0.0]),
    }
}

#[test]
fn frequencies_are_the_roots_of_the_frequency_equations() {
    // Roots λ = βL of the frequency equations (Blevins, Formulas for Natural Frequency and Mode Shape, table 8-1).
    let clamped = [
        4.730_040_744_862_704,
        7.853_204_624_095_838,
        10.995_607_838_001_67,
    ];
    let cantilever = [
        1.875_104_068_711_961,
        4.694_091_132_974_175,
        7.854_757_438_237_613,
    ];
    let propped = [
        3.926_602_312_047_919,
        7.068_582_745_628_732,
        10.210_176_122_813_03,
    ];
    let pi = std::f64::consts::PI;
    for (boundary, roots) in [
        (Boundary::FreeFree, clamped),
        (Boundary::FixedFixed, clamped),
        (Boundary::FixedFree, cantilever),
        (Boundary::FreeFixed, cantilever),
        (Boundary::FixedPinned, propped),
        (Boundary::PinnedPinned, [pi, 2.0 * pi, 3.0 * pi]),
    ] {
        let beam = aluminium(boundary);
        let found = beam.natural_frequencies_hz().unwrap();
        let skipped = beam.rigid_body_modes();
        // f = (λ/L)² √(EI/ρA) / 2π
        let speed = (70e9_f64 / 2700.0 / 12.0).sqrt() * 0.006;
        for (found, root) in found[skipped..].iter().zip(roots) {
            let exact = (root / 0.221_f64).powi(2) * speed / std::f64::consts::TAU;
            let error = found / exact - 1.0;
            let discretisation = (root / ELEMENTS).powi(4) / 1440.0;
            assert!(
                (error - discretisation).abs() < 0.1 * discretisation + 1e-7,
                "{boundary:?}: {error} {discretisation}"
            );
        }
    }
}

#[test]
fn substructure_a_of_case_4_2_2_resonates_where_the_thesis_says() {
    // EI = 67e9 · 4.5e-10 N·m², m = 0.405 kg/m: 25 mm × 6 mm of density 2700.
    let beam = Beam {
        length_m: 0.3,
        youngs_modulus_pa: 67e9,
        damping: Damping::Ratios(vec![0.01]),
        ..aluminium(Boundary::FixedFree)
    };
    let found = beam.natural_frequencies_hz().unwrap();
    assert!((found[1] - 336.25).abs() < 0.1, "{found:?}");
}

#[test]
fn static_deflection_of_a_cantilever() {
    let beam = aluminium(Boundary::FixedFree);
    let tip = |motion| BeamPoint {
        position_m: 0.221,
        motion,
    };
    let points = [tip(Motion::Translation), tip(Motion::Rotation)];
    let found = &beam.receptances(&points, &[0.0]).unwrap()[0];
    // w = L³/3EI, L²/2EI; θ = L²/2EI, L/EI
    let (l, ei): (f64, f64) = (0.221, 70e9 * 0.025 * 0.006_f64.powi(3) / 12.0);
    let expected = [[l.powi(3) / 3.0, l * l / 2.0], [l * l / 2.0, l]];
    for p in 0..2 {
        for q in 0..2 {
            let exact = expected[p][q] / ei;
            assert!((found[(p, q)].re / exact - 1.0).abs() < 1e-6);
            assert_eq!(found[(p, q)].im, 0.0);
        }
    }
}

#[test]
fn a_free_beam_moves_like_a_rigid_body_at_low_frequency() {
    let beam = aluminium(Boundary::FreeFree);
    let end = BeamPoint {
        position_m: 0.0,
        motion: Motion::Translation,
    };
    let found = beam.receptances(&[end], &[0.1]).unwrap()[0][(0, 0)];
    // H = −(1/m + (L/2)²/J)/ω² = −4/(m ω²)
    let mass = 2700.0 * 0.221 * 0.025 * 0.006;
    let omega = std::f64::consts::TAU * 0.1;
    assert!((found.re * mass * omega * omega / -4.0 - 1.0).abs() < 1e-5);
}

#[test]
fn structural_damping_limits_the_resonance() {
    let beam = Beam {
        damping: Damping::LossFactor(0.05),
        ..aluminium(Boundary::PinnedPinned)
    };
    let middle = BeamPoint {
        position_m: 0.1105,
        motion: Motion::Translation,
    };
    let resonance = beam.natural_frequencies_hz().unwrap()[0];
    let found = beam.receptances(&[middle], &[resonance]).unwrap()[0][(0, 0)];
    // φ² at mid-span is 2/(ρAL): H ≈ 2/(ρAL · jη ω²)
    let omega = std::f64::consts::TAU * resonance;
    let exact = 2.0 / (2700.0 * 0.025 * 0.006 * 0.221 * 0.05 * omega * omega);
    assert!((-found.im / exact - 1.0).abs() < 1e-3, "{found} {exact}");
}

#[test]
fn points_that_all_but_coincide_leave_the_modes_alone() {
    // Exact frequencies do not depend on where the points are; a node of its own for each would.
    for theory in [Theory::EulerBernoulli, Theory::default()] {
        let beam = Beam {
            theory,
            ..aluminium(Boundary::FixedFree)
        };
        modes_stay(&beam);
    }
}

fn modes_stay(beam: &Beam) {
    let at = |position_m, motion| BeamPoint { position_m, motion };
    let alone = [
        at(0.1, Motion::Translation),
        at(0.1, Motion::Rotation),
        at(0.221, Motion::Translation),
    ];
    let frequency_hz = [0.0, 60.0, 250.0, 900.0];
    let reference = beam.receptances(&alone, &frequency_hz).unwrap();
    for gap in [1e-11, 1e-7, 1e-6, 1e-5] {
        let mut points = alone.to_vec();
        points.push(at(0.1 + gap, Motion::Translation));
        points.push(at(0.1 + gap, Motion::Rotation));
        points.push(at(0.221 - gap, Motion::Translation));
        let found = beam.receptances(&points, &frequency_hz).unwrap();
        for (found, reference) in found.iter().zip(&reference) {
            for p in 0..3 {
                for q in 0..3 {
                    let exact = reference[(p, q)];
                    let same = (found[(p, q)] - exact).norm() / exact.norm();
                    assert!(same < 1e-8, "gap {gap}, ({p}, {q}): {same}");
                }
            }
            // w(x + gap) = w(x) + gap ∂w/∂x + …, where ∂w/∂x is θ without shear
            if beam.theory != Theory::EulerBernoulli {
                continue;
            }
            let taylor = reference[(0, 2)] + gap * reference[(1, 2)];
            let error = (found[(3, 2)] - taylor).norm() / taylor.norm();
            assert!(
                error < 1e-8 + 100.0 * gap * gap / 0.01,
                "gap {gap}: {error}"
            );
        }
    }
}

#[test]
fn a_receptance_without_a_value_is_an_error() {
    let end = [BeamPoint {
        position_m: 0.0,
        motion: Motion::Translation,
    }];
    let free = aluminium(Boundary::FreeFree);
    let message = free.receptances(&end, &[5.0, 0.0]).unwrap_err().to_string();
    assert!(
        message.contains("0 Hz") && message.contains("free ends"),
        "{message}"
    );
    assert!(
        aluminium(Boundary::FreeFixed)
            .receptances(&end, &[0.0])
            .is_ok()
    );
}

#[test]
fn impossible_beams_are_refused() {
    let thin = Beam {
        height_m: 0.0,
        ..aluminium(Boundary::FreeFree)
    };
    let refused = |beam: Beam| beam.natural_frequencies_hz().unwrap_err().to_string();
    assert_eq!(
        refused(thin),
        "beam.height: found 0, expected a positive number in SI units"
    );
    let point = BeamPoint {
        position_m: 0.3,
        motion: Motion::Translation,
    };
    assert!(matches!(
        aluminium(Boundary::FreeFree).receptances(&[point], &[1.0]),
        Err(StructureError::OffTheBeam { .. })
    ));
    let undamped = Beam {
        damping: Damping::Ratios(Vec::new()),
        ..aluminium(Boundary::FreeFree)
    };
    assert_eq!(
        refused(undamped),
        "beam.damping_ratio: found an empty list, expected one number or a number for each mode"
    );
}

/// What a shift of a point does, by differences on one mesh and by meshes of their own.
#[test]
fn a_point_beside_a_node_moves_as_with_a_mesh_of_its_own() {
    for theory in [Theory::EulerBernoulli, Theory::default()] {
        let beam = Beam {
            theory,
            damping: Damping::LossFactor(2e-3),
            ..aluminium(Boundary::FreeFree)
        };
        let points = |by: f64| {
            let at = |position_m, motion| BeamPoint { position_m, motion };
            let joint = 0.080 + by;
            [
                at(joint, Motion::Translation),
                at(joint, Motion::Rotation),
                at(0.213, Motion::Translation),
            ]
        };
        let frequency_hz = [40.0, 610.0, 1900.0];
        let modal = beam.modal(&points(0.0)).unwrap();
        let step = 1e-5;
        let difference = |of: &dyn Fn(f64) -> Vec<DMatrix<Complex64>>| -> Vec<DMatrix<Complex64>> {
            let pairs = of(step).into_iter().zip(of(-step));
            pairs.map(|(above, below)| above - below).collect()
        };
        let near = difference(&|by| modal.receptances(&points(by), &frequency_hz).unwrap());
        let far = difference(&|by| beam.receptances(&points(by), &frequency_hz).unwrap());
        for (near, far) in near.iter().zip(&far) {
            for (near, far) in near.iter().zip(far) {
                let error = (near - far).norm();
                assert!(
                    error <= 0.005 * far.norm() + 1e-12,
                    "{theory:?}: {near} {far}"
                );
            }
        }
    }
}

/// A node of its own beside the end once left an element of 20 µm, and rounding in place of the low modes.
#[test]
fn a_point_that_is_almost_at_the_end_leaves_the_frequencies_alone() {
    let beam = aluminium(Boundary::FixedFree);
    let at = |position_m| BeamPoint {
        position_m,
        motion: Motion::Translation,
    };
    // ω = λ² √(EI/ρA)/L²
    let speed = (70e9_f64 / 2700.0 / 12.0).sqrt() * 0.006;
    let roots = [1.875_104_068_711_961, 4.694_091_132_974_175];
    for part in [1e-5, 1e-4, 2e-4, 5e-4, 1.1e-3, 2e-3] {
        let point = at(beam.length_m * (1.0 - part));
        let modes = beam.modes_at(&[point], NonZeroU16::new(60).unwrap());
        let modes = modes.unwrap();
        for (found, root) in modes.angular_frequency.iter().zip(roots) {
            let off = found / ((root / 0.221_f64).powi(2) * speed) - 1.0;
            assert!(off.abs() < 2e-4, "{part}: {off}");
        }
    }
}

/// At a resonance of a beam that hardly dissipates, twice the damping leaves half of the motion.
#[test]
fn a_resonance_falls_as_its_damping_grows() {
    for damping in [
        Damping::Ratios(vec![0.0, 0.0, 1e-3]),
        Damping::LossFactor(2e-3),
    ] {
        let beam = Beam {
            damping: damping.clone(),
            ..aluminium(Boundary::FreeFree)
        };
        let hz = [beam.natural_frequencies_hz().unwrap()[beam.rigid_body_modes()]];
        let tip = [BeamPoint {
            position_m: beam.length_m,
            motion: Motion::Translation,
        }];
        let modal = beam.modal(&tip).unwrap();
        let of = |modal: &ModalBeam| modal.receptances(&tip, &hz).unwrap()[0][(0, 0)].im;
        let twice = modal.with_damping(damping.times(2.0));
        let ratio = of(&twice) / of(&modal);
        assert!((ratio - 0.5).abs() < 1e-5, "{damping:?}: {ratio}");
    }
}
