//! Roots and shapes against 40 digits, finite elements against SciPy and against the roots.

use bolted_joint::predict::layered_beam::{BeamMode, ModeShape, Route, StoredEnergy, root};
use bolted_joint::structure::Boundary;
use bolted_joint_testing::{close, near};

use super::{BOUNDARIES, mode, references, rivets, specimen};

fn boundary(name: &str) -> Boundary {
    serde_json::from_value(name.into()).unwrap()
}

#[test]
fn roots_are_those_of_the_textbooks() {
    #[rustfmt::skip]
    let cases = [
        (Boundary::FixedFixed, [4.730_040_744_862_704, 7.853_204_624_095_838, 10.995_607_838_001_67]),
        (Boundary::FixedFree, [1.875_104_068_711_961, 4.694_091_132_974_175, 7.854_757_438_237_613]),
        (Boundary::FixedPinned, [3.926_602_312_047_919, 7.068_582_745_628_732, 10.210_176_122_813_03]),
        (Boundary::PinnedPinned, [std::f64::consts::PI, 2.0 * std::f64::consts::PI, 3.0 * std::f64::consts::PI]),
    ];
    for (boundary, expected) in cases {
        for (mode, expected) in (1..).zip(expected) {
            close(root(boundary, mode), expected, 4.0 * f64::EPSILON);
        }
    }
}

#[test]
fn roots_and_shapes_agree_with_forty_digits() {
    let references = references();
    assert_eq!(references.shapes.len(), 5);
    for (name, rows) in &references.shapes {
        let boundary = boundary(name);
        for row in rows {
            close(root(boundary, row.mode), row.lambda, 2.0 * f64::EPSILON);
            let shape = ModeShape::new(boundary, row.mode);
            for (place, &xi) in references.points.iter().enumerate() {
                // λ has a rounding of its own, which the phase λξ takes on
                let rounding = 1e-15 * (2.0 + row.lambda);
                let deflection = shape.deflection(xi) - row.deflection[place];
                near(deflection, 0.0, 4.0 * rounding);
                let slope = (shape.slope(xi) - row.slope[place]) / row.lambda;
                near(slope, 0.0, 4.0 * rounding);
            }
        }
    }
}

/// Gauss's rule of ten points on so many parts that every half wave has four.
fn integral(mode: usize, integrand: impl Fn(f64) -> f64) -> f64 {
    const GAUSS: [(f64, f64); 5] = [
        (0.148_874_338_981_631_2, 0.295_524_224_714_752_9),
        (0.433_395_394_129_247_2, 0.269_266_719_309_996_4),
        (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
        (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
        (0.973_906_528_517_171_7, 0.066_671_344_308_688_1),
    ];
    let parts = 4 * (mode + 2);
    let half = 0.5 / parts as f64;
    let of_part = |part: usize| {
        let middle = (2 * part + 1) as f64 * half;
        let both = |(point, weight): &(f64, f64)| {
            weight * (integrand(middle - half * point) + integrand(middle + half * point))
        };
        half * GAUSS.iter().map(both).sum::<f64>()
    };
    (0..parts).map(of_part).sum()
}

#[test]
fn shapes_are_orthogonal_and_bend_as_their_roots_say() {
    for boundary in BOUNDARIES {
        #[rustfmt::skip]
        let pairs = [(1, 1), (1, 2), (1, 3), (2, 5), (4, 4), (6, 7), (30, 30), (30, 31), (90, 90)];
        for (a, b) in pairs {
            let (first, second) = (ModeShape::new(boundary, a), ModeShape::new(boundary, b));
            let same = f64::from(u8::from(a == b));
            let mass = integral(b, |xi| first.deflection(xi) * second.deflection(xi));
            assert!((mass - same).abs() < 1e-12, "{boundary:?} {a} {b}: {mass}");
            // ∫φ_i″φ_j″ dξ = λ⁴ δ_ij
            let scale = (first.lambda() * second.lambda()).powi(2);
            let bending = integral(b, |xi| first.curvature(xi) * second.curvature(xi)) / scale;
            near(bending, same, 1e-12);
        }
    }
}

#[test]
fn high_modes_keep_their_supports() {
    for boundary in BOUNDARIES {
        for mode in [60, 300, 1000] {
            let shape = ModeShape::new(boundary, mode);
            let lambda = shape.lambda();
            // the phase at the far end is rounded to λ times the machine's precision
            let small = 4.0 * lambda * f64::EPSILON;
            let name = format!("{boundary:?}");
            let is_at = |support| [name.starts_with(support), name.ends_with(support)];
            let (fixed, free) = (is_at("Fixed"), is_at("Free"));
            for (end, xi) in [0.0, 1.0].into_iter().enumerate() {
                let w = shape.deflection(xi).abs();
                near(w, if free[end] { 2.0 } else { 0.0 }, small);
                // slope of a clamp, moment of the others
                let other = match fixed[end] {
                    true => shape.slope(xi) / lambda,
                    false => shape.curvature(xi) / (lambda * lambda),
                };
                near(other, 0.0, small);
            }
        }
    }
}

#[test]
fn the_largest_deflection_is_found() {
    for (boundary, mode, expected, tolerance) in [
        (Boundary::FixedFixed, 1, 0.5, 1e-8),
        (Boundary::FixedPinned, 1, 0.580_852_847_647_770_7, 1e-8),
        (Boundary::PinnedPinned, 3, 1.0 / 6.0, 1e-8),
        (Boundary::FixedFree, 2, 1.0, 1e-15),
    ] {
        let found = ModeShape::new(boundary, mode).antinode();
        close(found, expected, tolerance);
    }
    assert_eq!(ModeShape::new(Boundary::FreeFixed, 2).antinode(), 0.0);
    assert_eq!(ModeShape::new(Boundary::FreeFree, 3).antinode(), 0.0);
}

#[test]
fn finite_elements_agree_with_the_frequency_equations() {
    for boundary in BOUNDARIES {
        let (beam, rivets) = (specimen(boundary), rivets(5));
        for number in 1..=10 {
            let [exact, elements] = [Route::Classical, Route::FiniteElements]
                .map(|route| mode(&beam, &rivets, number, route));
            close(elements.angular_frequency, exact.angular_frequency, 1e-5);
            close(elements.mass_kg, exact.mass_kg, 1e-4);
        }
    }
}

#[test]
fn elements_are_scipys() {
    let references = references();
    assert_eq!(references.elements.len(), 12);
    for case in &references.elements {
        let (beam, rivets) = (case.beam(), case.rivets());
        close(beam.bending_stiffness_n_m2(), case.bending, 1e-12);
        close(beam.mass_per_length_kg_per_m(), case.mass_per_length, 1e-12);
        let found = beam.static_stiffness_n_per_m(case.drive_point);
        assert_eq!(found.is_some(), case.static_stiffness.is_some());
        // the cubic elements are exact under a load at a node
        if let (Some(found), Some(expected)) = (found, case.static_stiffness) {
            close(found, expected, 1e-7);
        }
        for (number, expected) in (1..).zip(&case.modes) {
            for route in [Route::Classical, Route::FiniteElements] {
                let drive = Some(case.drive_point);
                let mode = BeamMode::new(&beam, &rivets, number, drive, route, StoredEnergy::Modal);
                let mode = mode.unwrap();
                close(mode.frequency_hz(), expected.frequency_hz, 2e-6);
                close(mode.mass_kg, expected.mass_kg, 1e-4);
            }
        }
    }
}
