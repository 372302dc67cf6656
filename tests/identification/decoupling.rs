//! Coupling, then decoupling, returns the joint: all four equations, any passive joint.

use std::sync::LazyLock;

use bolted_joint::identify::{JointMatrices, from_rr, from_rs, from_sr, from_ss};
use bolted_joint::structure::{ComplexMatrix, couple};
use nalgebra::{DMatrix, dmatrix};
use proptest::prelude::*;

use crate::cases::{Pair, beams_4_2_2, joint_4_2_2};

/// Two or three points a side, as the thesis's approaches 3 and 4.
static PAIRS: LazyLock<[Pair; 2]> = LazyLock::new(|| {
    // From 60 Hz on the receptances depend on the joint (Figures 4.33 and 4.34).
    let frequency_hz = vec![60.0, 117.0, 222.0, 300.0, 415.0];
    [
        beams_4_2_2(frequency_hz.clone(), &[0.27, 0.285], &[0.195, 0.225]),
        beams_4_2_2(frequency_hz, &[0.255, 0.27, 0.285], &[0.195, 0.21, 0.225]),
    ]
});

/// Largest error of an entry of K*, relative to √(K*_ii K*_jj), so that units do not matter.
fn error(found: &ComplexMatrix, exact: &ComplexMatrix) -> f64 {
    let mut largest: f64 = 0.0;
    for i in 0..2 {
        for j in 0..2 {
            let scale = (exact[(i, i)].norm() * exact[(j, j)].norm()).sqrt();
            largest = largest.max((found[(i, j)] - exact[(i, j)]).norm() / scale);
        }
    }
    largest
}

fn largest_error(joint: &JointMatrices, pair: &Pair) -> f64 {
    let mut largest: f64 = 0.0;
    for (line, &frequency_hz) in pair.frequency_hz.iter().enumerate() {
        let (a, b) = (&pair.a[line], &pair.b[line]);
        let exact = joint.complex_stiffness(frequency_hz);
        let assembly = couple(a, b, &exact).unwrap();
        for found in [
            from_rr(a, b, &assembly.rr),
            from_rs(a, b, &assembly.rs),
            from_sr(a, b, &assembly.sr),
            from_ss(a, b, &assembly.ss),
        ] {
            largest = largest.max(error(&found.unwrap(), &exact));
        }
    }
    largest
}

#[test]
fn the_joint_of_case_4_2_2_returns_from_all_four_equations() {
    for pair in PAIRS.iter() {
        let error = largest_error(&joint_4_2_2(), pair);
        assert!(error < 1e-9, "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn any_passive_joint_returns_from_all_four_equations(
        (k, c) in (2.0..6.5_f64, 0.0..2.0_f64),
        (k_theta, c_theta) in (1.0..4.0_f64, -2.5..-0.5_f64),
        (k_coupling, c_coupling) in (-0.95..0.95_f64, -0.95..0.95_f64),
    ) {
        // K and C from logarithmic sizes and a coupling below that of a singular matrix.
        let matrix = |yy: f64, tt: f64, coupling: f64| -> DMatrix<f64> {
            let (yy, tt) = (10_f64.powf(yy), 10_f64.powf(tt));
            let yt = coupling * (yy * tt).sqrt();
            dmatrix![yy, yt; yt, tt]
        };
        let joint = JointMatrices {
            stiffness: matrix(k, k_theta, k_coupling),
            damping: matrix(c, c_theta, c_coupling),
        };
        for pair in PAIRS.iter() {
            let error = largest_error(&joint, pair);
            // A joint far stiffer than its neighbours is a small difference of large receptances: rounding grows with
            // the square of the gain K*(H_jj + H_kk).
            let mut gain: f64 = 1.0;
            for (line, &frequency_hz) in pair.frequency_hz.iter().enumerate() {
                let free = &pair.a[line].joint + &pair.b[line].joint;
                gain = gain.max((joint.complex_stiffness(frequency_hz) * free).camax());
            }
            prop_assert!(error < 1e-9 + 1e-10 * gain + 1e-13 * gain * gain, "{error} at gain {gain}");
        }
    }
}

#[test]
fn too_few_points_on_one_side_give_no_joint_and_no_panic() {
    let pair = beams_4_2_2(vec![117.0], &[0.27], &[0.195, 0.21, 0.225]);
    let (a, b) = (&pair.a[0], &pair.b[0]);
    let assembly = couple(a, b, &joint_4_2_2().complex_stiffness(117.0)).unwrap();
    assert_eq!(from_rs(a, b, &assembly.rs), None);
    assert_eq!(from_sr(a, b, &assembly.sr), None);
    // One point on both sides gives a number, as the printed equation does, though no joint.
    assert!(from_rr(a, b, &assembly.rr).is_some());
}
