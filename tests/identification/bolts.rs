//! Several bolts between two beams (Tol 3.27): one joint for all of them, or one each.

use bolted_joint::identify::{
    Bolts, JointMatrices, JointModel, Lines, LinesEstimate, Noise, NoiseLevel, Options,
    Receptances, identify_lines,
};
use bolted_joint::structure::{BeamPoint, Boundary, ComplexMatrix, Motion, Partition, couple};
use nalgebra::{DMatrix, dmatrix};
use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

use crate::cases::{axis, beam_4_2_2};

/// Where the bolts are, m from the tip of A and from the first end of B.
const AT_M: [f64; 2] = [0.02, 0.08];

fn bolt(factor: f64) -> JointMatrices {
    JointMatrices {
        stiffness: dmatrix![1e5, 2e3; 2e3, 1e3] * factor,
        damping: dmatrix![5.0, 0.1; 0.1, 0.05] * factor,
    }
}

fn names() -> Vec<String> {
    ["tip", "root"].map(str::to_owned).to_vec()
}

/// Two beams that overlap by 0.1 m, bolted at two places and measured at points of B with this noise.
fn lines(joints: &[JointMatrices; 2], points_m: &[f64], relative: f64, seed: u64) -> Lines {
    let frequency_hz = axis(500.0, 1.0);
    let at = |positions_m: &[f64]| -> Vec<BeamPoint> {
        let of_bolt = |&position_m: &f64| {
            [Motion::Translation, Motion::Rotation].map(|motion| BeamPoint { position_m, motion })
        };
        positions_m.iter().flat_map(of_bolt).collect()
    };
    // A's coordinate runs from the clamp to the tip at 0.3 m; B begins 0.1 m before it.
    let on_a = at(&AT_M.map(|x| 0.2 + x));
    let translations = points_m.iter().map(|&position_m| BeamPoint {
        position_m,
        motion: Motion::Translation,
    });
    let on_b: Vec<BeamPoint> = at(&AT_M).into_iter().chain(translations).collect();
    let a = beam_4_2_2(0.3, Boundary::FixedFree)
        .receptances(&on_a, &frequency_hz)
        .unwrap();
    let b = beam_4_2_2(0.3, Boundary::FreeFree)
        .receptances(&on_b, &frequency_hz)
        .unwrap();
    let a_parts: Vec<Partition> = a.iter().map(|h| Partition::of(h, 4)).collect();
    let b_parts: Vec<Partition> = b.iter().map(|h| Partition::of(h, 4)).collect();
    let whole = JointMatrices::of_bolts(joints);
    let count = points_m.len();
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut generator) };
    let assembly = (0..frequency_hz.len())
        .map(|line| {
            let stiffness = whole.complex_stiffness(frequency_hz[line]);
            let exact = couple(&a_parts[line], &b_parts[line], &stiffness)
                .unwrap()
                .ss;
            ComplexMatrix::from_fn(count, count, |p, q| {
                let error = Complex64::new(normal(), normal()) * (relative / 2.0_f64.sqrt());
                exact[(p, q)] * (1.0 + error)
            })
        })
        .collect();
    Lines {
        frequency_hz,
        a: Receptances::Exact(a),
        b: Receptances::Exact(b),
        assembly,
        points: (0..count)
            .map(|p| format!("{}:+Y", p + 1).parse().unwrap())
            .collect(),
        measured: (0..count)
            .flat_map(|q| (0..count).map(move |p| (p, q)))
            .collect(),
        relative_variance: None,
        repeats: None,
    }
}

fn identified(lines: &Lines, bolts: Bolts, noise: Noise) -> LinesEstimate {
    let options = Options {
        bolts,
        noise,
        ..Options::default()
    };
    identify_lines(std::slice::from_ref(lines), JointModel::Full, &options).unwrap()
}

fn deviation(found: &JointMatrices, exact: &JointMatrices) -> f64 {
    let of = |found: &DMatrix<f64>, exact: &DMatrix<f64>| {
        let error = (found - exact)
            .map_with_location(|i, j, error| error.abs() / (exact[(i, i)] * exact[(j, j)]).sqrt());
        error.max()
    };
    of(&found.stiffness, &exact.stiffness).max(of(&found.damping, &exact.damping))
}

#[test]
fn exact_data_give_one_joint_for_both_bolts() {
    // All points beyond the bolts: single lines tell two numbers there, all lines together tell the joint.
    let joint = bolt(1.0);
    let lines = lines(&[joint.clone(), joint.clone()], &[0.15, 0.22, 0.3], 0.0, 1);
    let found = identified(&lines, Bolts::Alike(names()), Noise::default());
    assert_eq!(found.bolts().len(), 1);
    let error = deviation(found.joint(), &joint);
    assert!(error < 1e-7, "{error}");
    assert_eq!(
        found.whole().bolts(2),
        [found.joint().clone(), found.joint().clone()]
    );
}

#[test]
fn exact_data_give_each_bolt_its_own_joint() {
    let joints = [bolt(1.0), bolt(2.5)];
    let lines = lines(&joints, &[0.0, 0.05, 0.15, 0.22, 0.3], 0.0, 1);
    let found = identified(&lines, Bolts::Different(names()), Noise::default());
    assert_eq!(found.bolts().len(), 2);
    for (found, exact) in found.bolts().iter().zip(&joints) {
        let error = deviation(found, exact);
        assert!(error < 1e-6, "{error}");
    }
    // With points between the bolts single lines do, too.
    let averages = found.joints[0].band_averages.as_ref().unwrap();
    for (average, exact) in averages.iter().zip(&joints) {
        let error = deviation(average, exact);
        assert!(error < 1e-2, "{error}");
    }
    let labels: Vec<String> = found
        .covariance()
        .unknowns
        .iter()
        .map(|unknown| unknown.label(&names()))
        .collect();
    assert_eq!(
        labels[..4],
        ["tip k_yy", "tip k_ytheta", "tip k_thetatheta", "root k_yy"]
    );
    assert_eq!(labels.len(), 12);
}

#[test]
fn with_noise_the_intervals_hold_the_joints_of_two_bolts() {
    let joints = [bolt(1.0), bolt(2.5)];
    let noise = Noise::stated(NoiseLevel {
        relative: 0.01,
        floor: 0.0,
    });
    let (mut squares, mut numbers) = (0.0, 0.0);
    for seed in 0..6 {
        let lines = lines(&joints, &[0.0, 0.05, 0.15, 0.22, 0.3], 0.01, seed);
        let found = identified(&lines, Bolts::Different(names()), noise);
        let covariance = found.covariance();
        let deviations = covariance.standard_deviation();
        for (index, unknown) in covariance.unknowns.iter().enumerate() {
            let exact = unknown.value(&joints[unknown.joint]);
            squares += ((covariance.values[index] - exact) / deviations[index]).powi(2);
            numbers += 1.0;
        }
        assert!(found.assessment.fits(), "{:?}", found.assessment);
    }
    // Squares of standardised errors are χ² with as many degrees; errors of one draw are correlated, so with room.
    let mean: f64 = squares / numbers;
    assert!((0.5..1.6).contains(&mean), "{mean}");
}

#[test]
fn joint_models_are_compared_with_the_unknowns_of_every_bolt() {
    let joints = [bolt(1.0), bolt(2.5)];
    let lines = lines(&joints, &[0.0, 0.05, 0.15, 0.22, 0.3], 0.01, 1);
    for (bolts, expected) in [
        (Bolts::Different(names()), [4, 8, 12]),
        (Bolts::Alike(names()), [2, 4, 6]),
    ] {
        let options = Options {
            bolts,
            compare_models: true,
            ..Options::default()
        };
        let found =
            identify_lines(std::slice::from_ref(&lines), JointModel::Full, &options).unwrap();
        let choice = found.model_choice().unwrap();
        assert_eq!(choice.recommended, JointModel::Full, "{choice:?}");
        assert_eq!(choice.any_is_adequate, expected[0] == 4, "{choice:?}");
        let unknowns: Vec<usize> = choice.models.iter().map(|fit| fit.unknowns).collect();
        assert_eq!(unknowns, expected);
    }
}

#[test]
fn bolts_taken_as_alike_though_they_differ_do_not_leave_noise() {
    let lines = lines(
        &[bolt(1.0), bolt(2.5)],
        &[0.0, 0.05, 0.15, 0.22, 0.3],
        0.01,
        1,
    );
    let found = identified(&lines, Bolts::Alike(names()), Noise::default());
    assert!(!found.assessment.fits(), "{:?}", found.assessment);
}

#[test]
fn dofs_that_are_not_those_of_the_bolts_are_refused() {
    let lines = lines(&[bolt(1.0), bolt(1.0)], &[0.15, 0.3], 0.0, 1);
    let three = ["a", "b", "c"].map(str::to_owned).to_vec();
    for bolts in [
        Bolts::One,
        Bolts::Alike(three),
        Bolts::Different(Vec::new()),
    ] {
        let options = Options {
            bolts,
            ..Options::default()
        };
        assert!(identify_lines(std::slice::from_ref(&lines), JointModel::Full, &options).is_err());
    }
}
