//! What is said about the differences of Tables 4.6 to 4.9.

use super::tables::APPROACH_2;
use super::*;
use crate::draws::Draws;

fn values(joint: &JointMatrices) -> [f64; 4] {
    let (k, c) = (&joint.stiffness, &joint.damping);
    [k[(0, 0)], k[(1, 1)], c[(0, 0)], c[(1, 1)]]
}

fn spreads(case: &Case, approach: Approach, noise: Pollution, count: u32) -> [Spread; 4] {
    let draws = Draws {
        count,
        seed: 1,
        samples: Vec::new(),
    };
    let draws = Repetition {
        draws: &draws,
        progress: &|| (),
    };
    let joints = case.joints(draws, approach, noise).unwrap();
    std::array::from_fn(|i| {
        let of: Vec<f64> = joints.iter().map(|joint| values(joint)[i]).collect();
        Spread::of(&of).unwrap()
    })
}

#[test]
fn approaches_1_3_and_4_are_exact_without_noise() {
    let case = Case::new(END_TO_END).unwrap();
    for (approach, inverse) in [
        (Approach::One, Inverse::AsPrinted),
        (Approach::Three, Inverse::AsPrinted),
        (Approach::Four, Inverse::LeastSquares),
    ] {
        let measured = case.measured(approach);
        let found = case
            .average(inverse, &case.b_at(approach), &measured)
            .unwrap();
        for (found, exact) in values(&found).into_iter().zip(values(&truth())) {
            assert!((found / exact - 1.0).abs() < 1e-3, "{found} {exact}");
        }
    }
}

#[test]
fn the_published_answer_of_approach_2_is_that_of_lapped_beams() {
    let lapped = Case::new(LAPPED).unwrap();
    let found = values(&lapped.single_point()[0]);
    // NumPy: 9.499e4, 892.7, 4.312, 0.04885.
    for (found, reference) in found.into_iter().zip([9.499e4, 892.7, 4.312, 0.04885]) {
        assert!(
            (found / reference - 1.0).abs() < 1e-3,
            "{found} {reference}"
        );
    }
    for (found, (published, tolerance)) in found
        .into_iter()
        .zip(APPROACH_2.into_iter().zip([0.01, 0.02, 0.06, 0.12]))
    {
        assert!(
            (found / published - 1.0).abs() < tolerance,
            "{found} {published}"
        );
    }
    for (found, published) in lapped.resonances_hz().iter().zip([20.4, 123.8, 312.5]) {
        assert!((found / published - 1.0).abs() < 0.04, "{found}");
    }
    let end_to_end = Case::new(END_TO_END).unwrap();
    for (found, published) in end_to_end.resonances_hz().iter().zip([20.4, 123.8, 312.5]) {
        assert!(found / published < 0.88, "{found}");
    }
}

#[test]
fn more_points_help_where_noise_is_low_enough() {
    // The noise of N = 2²⁴ and 1 %, and a hundredth of it.
    let case = Case::new(END_TO_END).unwrap();
    let rotation = |approach, level| {
        let noise = Pollution::Response {
            level,
            samples: 1 << 24,
        };
        spreads(&case, approach, noise, 24)[1].mean
    };
    let [two, three, four] =
        [Approach::Two, Approach::Three, Approach::Four].map(|a| rotation(a, 1e-4));
    for (found, said) in [(two, 731.0), (three, 736.0), (four, 844.0)] {
        assert!((found / said - 1.0).abs() < 0.01, "{two} {three} {four}");
    }
    let [two, four] = [Approach::Two, Approach::Four].map(|a| rotation(a, 1e-2));
    assert!((four / two - 1.0).abs() < 0.02, "{two} {four}");
}

#[test]
fn the_number_of_samples_tells_which_procedure_disturbs_more() {
    let case = Case::new(END_TO_END).unwrap();
    let level = 0.01;
    let deviations = |noise| {
        let spreads = spreads(&case, Approach::Four, noise, 12);
        spreads.map(|spread| spread.standard_deviation)
    };
    let frf = deviations(Pollution::Frf { level });
    let [few, many] = [1 << 12, 1 << 30].map(|samples| {
        let noise = Pollution::Response { level, samples };
        deviations(noise)
    });
    for i in 0..4 {
        assert!(
            few[i] > frf[i] && frf[i] > many[i],
            "{i}: {few:?} {frf:?} {many:?}"
        );
    }
}

#[test]
fn rotational_damping_falls_as_response_pollution_rises_and_grows_with_frf_pollution() {
    let case = Case::new(END_TO_END).unwrap();
    // Over 1000 draws: 0.0455 and 0.004.
    let median = |level, samples| {
        let noise = Pollution::Response { level, samples };
        spreads(&case, Approach::Four, noise, 40)[3].median
    };
    let [low, high] = [median(0.01, 1 << 24), median(0.1, 1 << 16)];
    assert!((low - 0.0455).abs() < 3e-3, "{low}");
    assert!((high - 0.004).abs() < 0.025, "{high}");
    let frf = [0.01, 0.03, 0.1]
        .map(|level| spreads(&case, Approach::Four, Pollution::Frf { level }, 40)[3].median);
    assert!(frf[0] < frf[1] && frf[1] < frf[2], "{frf:?}");
    assert!(frf[1] > 0.05 && frf[2] > 2.0 * 0.05, "{frf:?}");
}
