//! Several bolts between two beams (Tol 3.27): one joint for all of them, or one each.

use bolted_joint::identify::{
    Bolts, JointMatrices, JointModel, Lines, LinesEstimate, Noise, Options, identify_lines,
};
use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

use crate::beams;
use crate::cases::{axis, bolt, bolted, error};

fn names() -> Vec<String> {
    ["tip", "root"].map(str::to_owned).to_vec()
}

/// With points between the bolts and beyond them.
const POINTS_M: [f64; 5] = [0.0, 0.05, 0.15, 0.22, 0.3];

/// Two beams that are bolted at two places and measured at points of B with this noise.
fn lines(joints: &[JointMatrices; 2], points_m: &[f64], relative: f64, seed: u64) -> Lines {
    let whole = JointMatrices::of_bolts(joints);
    let mut lines = bolted(&[0.02, 0.08], points_m, &whole, axis(500.0, 1.0));
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut generator) };
    for value in lines.assembly.iter_mut().flat_map(|h| h.iter_mut()) {
        let error = Complex64::new(normal(), normal()) * (relative / 2.0_f64.sqrt());
        *value *= 1.0 + error;
    }
    lines
}

fn identified(lines: &Lines, bolts: Bolts, noise: Noise) -> LinesEstimate {
    let options = Options {
        bolts,
        noise,
        ..Options::default()
    };
    crate::beams::identified(lines, JointModel::Full, &options)
}

#[test]
fn exact_data_give_one_joint_for_both_bolts() {
    // All points beyond the bolts: single lines tell two numbers there, all lines together tell the joint.
    let joint = bolt(1.0);
    let lines = lines(&[joint.clone(), joint.clone()], &[0.15, 0.22, 0.3], 0.0, 1);
    let found = identified(&lines, Bolts::Alike(names()), Noise::default());
    assert_eq!(found.bolts().len(), 1);
    let error = error(found.joint(), &joint);
    assert!(error < 1e-7, "{error}");
    assert_eq!(
        found.whole().bolts(2),
        [0, 1].map(|_| found.joint().clone())
    );
}

#[test]
fn exact_data_give_each_bolt_its_own_joint() {
    let joints = [bolt(1.0), bolt(2.5)];
    let lines = lines(&joints, &POINTS_M, 0.0, 1);
    let found = identified(&lines, Bolts::Different(names()), Noise::default());
    assert_eq!(found.bolts().len(), 2);
    for (found, exact) in found.bolts().iter().zip(&joints) {
        let error = error(found, exact);
        assert!(error < 1e-6, "{error}");
    }
    // With points between the bolts single lines do, too.
    let averages = found.joints[0].band_averages.as_ref().unwrap();
    for (average, exact) in averages.iter().zip(&joints) {
        let error = error(average, exact);
        assert!(error < 1e-2, "{error}");
    }
    let unknowns = found.covariance().unknowns.iter();
    let labels: Vec<String> = unknowns.map(|u| u.label(&names())).collect();
    assert_eq!(
        labels[..4],
        ["tip k_yy", "tip k_ytheta", "tip k_thetatheta", "root k_yy"]
    );
    assert_eq!(labels.len(), 12);
}

#[test]
fn with_noise_the_intervals_hold_the_joints_of_two_bolts() {
    let joints = [bolt(1.0), bolt(2.5)];
    let noise = Noise::stated(beams::relative(0.01));
    let (mut squares, mut numbers) = (0.0, 0.0);
    for seed in 0..6 {
        let lines = lines(&joints, &POINTS_M, 0.01, seed);
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
    let lines = lines(&joints, &POINTS_M, 0.01, 1);
    for (bolts, expected) in [
        (Bolts::Different(names()), [4, 8, 12]),
        (Bolts::Alike(names()), [2, 4, 6]),
    ] {
        let options = Options {
            bolts,
            compare_models: true,
            ..Options::default()
        };
        let found = crate::beams::identified(&lines, JointModel::Full, &options);
        let choice = found.model_choice().unwrap();
        assert_eq!(choice.recommended, JointModel::Full, "{choice:?}");
        assert_eq!(choice.any_is_adequate, expected[0] == 4, "{choice:?}");
        let unknowns: Vec<usize> = choice.models.iter().map(|fit| fit.unknowns).collect();
        assert_eq!(unknowns, expected);
    }
}

#[test]
fn bolts_taken_as_alike_though_they_differ_do_not_leave_noise() {
    let lines = lines(&[bolt(1.0), bolt(2.5)], &POINTS_M, 0.01, 1);
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
