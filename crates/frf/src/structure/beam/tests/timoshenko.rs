//! Shear and rotary inertia against the exact beam, statics, the frequency equation, and the limit of a thin beam.

use super::*;

const KAPPA: f64 = 5.0 / 6.0;
const YOUNG_PA: f64 = 70e9;

fn thick(boundary: Boundary, height_m: f64) -> Beam {
    Beam {
        height_m,
        theory: Theory::Timoshenko {
            poissons_ratio: 0.33,
        },
        ..aluminium(boundary)
    }
}

fn at(position_m: f64, motion: Motion) -> BeamPoint {
    BeamPoint { position_m, motion }
}

/// A frequency in Hz, and receptances of the upper triangle row by row.
type Exact = (f64, [(f64, f64); 6]);

fn like_the_exact_beam(beam: &Beam, joint_m: f64, far_m: f64, exact: &[Exact]) {
    let points = [
        at(joint_m, Motion::Translation),
        at(joint_m, Motion::Rotation),
        at(far_m, Motion::Translation),
    ];
    let places = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
    for (frequency_hz, exact) in exact {
        let found = &beam.receptances(&points, &[*frequency_hz]).unwrap()[0];
        for (place, (re, im)) in places.into_iter().zip(exact) {
            let exact = Complex64::new(*re, *im);
            let error = (found[place] - exact).norm() / exact.norm();
            assert!(error < 1e-4, "{frequency_hz} Hz, {place:?}: {error:.1e}");
        }
    }
}

// Exact receptances are those of tests/systematic/rig.py: the transfer matrix of the beam's four first-order equations, with
// complex moduli. receptances(2πf, [Body("A", [0.285, 0.1])], [("A", 0.285, 0), ("A", 0.285, 1), ("A", 0.1, 0)]), and for B
// with 0.015 and 0.2. Without shear and rotary inertia they are up to 4 % (A) and 9 % (B) away.

#[test]
#[rustfmt::skip]
fn a_clamped_beam_is_the_exact_one() {
    let beam = Beam {
        length_m: 0.3,
        damping: Damping::LossFactor(6e-3),
        ..thick(Boundary::FixedFree, 0.006)
    };
    like_the_exact_beam(&beam, 0.285, 0.1, &[
        (20.0, [
            (2.819902527e-04, -1.947679287e-06),
            (1.471425445e-03, -1.008935338e-05),
            (4.653516285e-05, -3.246219647e-07),
            (9.949430110e-03, -6.593528537e-05),
            (1.908590025e-04, -1.367783055e-06),
            (1.178929449e-05, -7.887687346e-08),
        ]),
        (200.0, [
            (-1.291258196e-05, -6.860132297e-08),
            (5.322183389e-05, -1.349112300e-06),
            (-7.909643363e-06, 3.971463270e-08),
            (3.692319836e-03, -3.380119614e-05),
            (-1.025892172e-04, 8.111198104e-07),
            (3.677140980e-06, -3.778528372e-08),
        ]),
        (450.0, [
            (-8.798423037e-06, -5.116219456e-08),
            (-1.128199922e-04, -1.157815195e-06),
            (4.236726772e-06, 3.275149665e-08),
            (-9.350367211e-04, -3.173510533e-05),
            (1.077349918e-04, 6.121257630e-07),
            (-2.861786537e-06, -3.342373522e-08),
        ]),
    ]);
}

#[test]
#[rustfmt::skip]
fn a_free_beam_is_the_exact_one() {
    let beam = Beam {
        damping: Damping::LossFactor(2e-3),
        ..thick(Boundary::FreeFree, 0.006)
    };
    like_the_exact_beam(&beam, 0.015, 0.2, &[
        (20.0, [
            (-2.290352641e-03, -2.765319073e-09),
            (1.654271373e-02, 9.210396448e-08),
            (7.781899136e-04, -2.021075276e-09),
            (-1.715673318e-01, -4.275685864e-06),
            (-1.557551046e-02, 5.807663318e-08),
            (-2.098022140e-03, -1.802719009e-09),
        ]),
        (450.0, [
            (-1.891353550e-06, -1.020806728e-08),
            (-5.172161170e-05, 3.199798220e-07),
            (3.562257730e-06, -8.073959868e-09),
            (2.987723408e-03, -1.130933750e-05),
            (-9.059121558e-05, 2.419730296e-07),
            (-2.409148899e-06, -6.769748044e-09),
        ]),
        (1500.0, [
            (-3.877528278e-07, -2.316311334e-09),
            (-1.102032562e-05, 1.655877113e-07),
            (-2.619682131e-07, 1.106792745e-09),
            (1.859790196e-03, -1.308384365e-05),
            (1.635740477e-05, -8.564417385e-08),
            (-4.588011666e-07, -7.974193769e-10),
        ]),
    ]);
}

#[test]
fn a_cantilever_bends_and_shears_as_statics_say() {
    let height_m = 0.05;
    let beam = thick(Boundary::FixedFree, height_m);
    let length = beam.length_m;
    let area = beam.width_m * height_m;
    let bending = YOUNG_PA * area * height_m * height_m / 12.0;
    let shear = KAPPA * area * YOUNG_PA / (2.0 * 1.33);
    // Within 1e-4 of the length of the node at 0.1 m: moved by the static shape of an element.
    let between_m = 0.1 + 2e-5;
    let points = [
        at(length, Motion::Translation),
        at(length, Motion::Rotation),
        at(0.1, Motion::Translation),
        at(0.1, Motion::Rotation),
        at(between_m, Motion::Translation),
        at(between_m, Motion::Rotation),
    ];
    // Force at the tip: w = x²(3L − x)/6EI + x/κGA, θ = x(2L − x)/2EI. Moment there: w = x²/2EI, θ = x/EI.
    let expected = points.map(|point| {
        let x = point.position_m;
        match point.motion {
            Motion::Translation => [
                x * x * (3.0 * length - x) / (6.0 * bending) + x / shear,
                x * x / (2.0 * bending),
            ],
            Motion::Rotation => [x * (2.0 * length - x) / (2.0 * bending), x / bending],
        }
    });
    for elements in [1, 6] {
        let modes = beam
            .modes_at(&points, NonZeroU16::new(elements).unwrap())
            .unwrap();
        let flexibility = modes.angular_frequency.map(|omega| omega.powi(-2));
        let receptance =
            &modes.amplitudes * DMatrix::from_diagonal(&flexibility) * modes.amplitudes.transpose();
        for (p, expected) in expected.iter().enumerate() {
            for (q, expected) in expected.iter().enumerate() {
                let error = (receptance[(p, q)] / expected - 1.0).abs();
                assert!(
                    error < 1e-10,
                    "{elements} elements, ({p}, {q}): {error:.1e}"
                );
            }
        }
    }
}

/// Frequencies of a beam that is pinned at both ends, Hz: W = sin kx with k = nπ/L, and
/// (ρ²I/κG) ω⁴ − (ρA + ρI k²(1 + E/κG)) ω² + EI k⁴ = 0   (Timoshenko 1922)
fn pinned_hz(beam: &Beam, mode: f64) -> f64 {
    let area = beam.width_m * beam.height_m;
    let inertia = area * beam.height_m * beam.height_m / 12.0;
    let density = beam.density_kg_per_m3;
    let k = mode * std::f64::consts::PI / beam.length_m;
    let shear_pa = KAPPA * YOUNG_PA / (2.0 * 1.33);
    let a = density * density * inertia / shear_pa;
    let b = density * area + density * inertia * k * k * (1.0 + YOUNG_PA / shear_pa);
    let c = YOUNG_PA * inertia * k.powi(4);
    (2.0 * c / (b + (b * b - 4.0 * a * c).sqrt())).sqrt() / std::f64::consts::TAU
}

#[test]
fn a_pinned_beam_has_the_frequencies_of_its_equation() {
    for height_m in [0.006, 0.05] {
        let beam = thick(Boundary::PinnedPinned, height_m);
        let found = beam.natural_frequencies_hz().unwrap();
        for (mode, found) in (1..).map(f64::from).zip(&found[..3]) {
            let error = found / pinned_hz(&beam, mode) - 1.0;
            // Theory, section 4.3: (λ/60)⁴/1440 + (E/κG) (h/L)² λ² (λ/60)²/288; less where the beam is thick for the mode.
            let root = mode * std::f64::consts::PI;
            let thickness = root * height_m / beam.length_m;
            let step = (root / ELEMENTS).powi(2);
            let discretisation =
                step * step / 1440.0 + 2.0 * 1.33 / KAPPA * thickness * thickness * step / 288.0;
            let least = if thickness < 0.3 { 0.9 } else { 0.0 };
            assert!(
                (least * discretisation..1.01 * discretisation).contains(&error),
                "{height_m} m, mode {mode}: {error:.3e} {discretisation:.3e}"
            );
        }
    }
}

#[test]
fn a_thin_beam_has_neither_shear_nor_rotary_inertia() {
    let lowest = |height_m, theory| {
        let beam = Beam {
            theory,
            ..thick(Boundary::FreeFree, height_m)
        };
        beam.natural_frequencies_hz().unwrap()[2..5].to_vec()
    };
    let difference = |height_m| -> Vec<f64> {
        let with = lowest(height_m, Theory::default());
        let without = lowest(height_m, Theory::EulerBernoulli);
        let pairs = with.iter().zip(&without);
        pairs.map(|(with, without)| 1.0 - with / without).collect()
    };
    // The difference falls with (h/L)².
    let (thicker, thinner) = (difference(4e-4), difference(1e-4));
    for (thicker, thinner) in thicker.into_iter().zip(thinner) {
        assert!(thinner > 0.0 && thinner < 1e-4, "{thinner:.1e}");
        assert!(
            (thicker / thinner / 16.0 - 1.0).abs() < 0.02,
            "{thicker:.1e} {thinner:.1e}"
        );
    }
}

#[test]
fn poissons_ratio_is_that_of_a_material() {
    for (poissons_ratio, is_one) in [
        (0.0, true),
        (0.499, true),
        (0.5, false),
        (-0.1, false),
        (f64::NAN, false),
    ] {
        let beam = Beam {
            theory: Theory::Timoshenko { poissons_ratio },
            ..aluminium(Boundary::FixedFree)
        };
        let found = beam.natural_frequencies_hz();
        assert_eq!(found.is_ok(), is_one, "{poissons_ratio}");
        if let Err(error) = found {
            let expected = format!(
                "beam.poissons_ratio: found {poissons_ratio}, expected a number from 0 and below 0.5"
            );
            assert_eq!(error.to_string(), expected);
        }
    }
}
