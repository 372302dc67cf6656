//! Joints over the tightening torque: each torque's joint is found as sure as it says, measured substructures in common
//! couple the torques, and BIC tells a joint that depends on the torque from one that does not.

use bolted_joint::identify::{
    JointMatrices, LinesEstimate, Noise, NoiseLevel, Options, TorqueDependence, identify_lines,
};
use bolted_joint_testing::near;
use nalgebra::{DMatrix, DVector};

use crate::beams;
use crate::cases::axis;
use crate::measured::{Noisy, Rig, joint, thesis, unknowns};

const LEVEL: NoiseLevel = beams::relative(0.01);

/// The torques of Tol's Table 5.7, N·m.
const TORQUES_N_M: [f64; 4] = [10.0, 15.0, 20.0, 25.0];

/// Joints that get stiffer and less damped as they are tightened, more and more slowly.
fn over_torque() -> [JointMatrices; 4] {
    [(0.80, 1.40), (0.93, 1.15), (1.00, 1.00), (1.04, 0.92)]
        .map(|(factor, damping)| joint(factor, damping))
}

fn rig() -> Rig {
    Rig::new("medium joint", joint(1.0, 1.0), thesis(axis(500.0, 2.5)))
}

fn identified(
    rig: &Rig,
    joints: &[JointMatrices],
    noisy: Noisy,
    dependence: TorqueDependence,
    seed: u64,
) -> LinesEstimate {
    let all = rig.assemblies(joints, noisy, LEVEL, seed);
    let options = Options {
        noise: Noise::stated(LEVEL),
        torques_n_m: TORQUES_N_M[..joints.len()].to_vec(),
        dependence,
        // With errors in everything that takes its time.
        compare_models: noisy != Noisy::Everything,
        ..Options::default()
    };
    identify_lines(&all, rig.model, &options).unwrap()
}

/// Errors of the unknowns of all joints.
fn errors(rig: &Rig, found: &LinesEstimate, joints: &[JointMatrices]) -> DVector<f64> {
    let pairs = found.joints.iter().zip(joints);
    let errors = pairs.flat_map(|(found, truth)| {
        let truth = unknowns(rig.model, truth);
        let found = unknowns(rig.model, &found.free[0]);
        let pairs = found.into_iter().zip(truth);
        pairs.map(|(found, truth)| found - truth)
    });
    DVector::from_vec(errors.collect())
}

/// eᵀ C⁻¹ e, after scaling to a unit diagonal.
fn distance(errors: &DVector<f64>, covariance: &DMatrix<f64>) -> f64 {
    let scale = covariance
        .diagonal()
        .map(|variance| variance.sqrt().recip());
    let scaled = DMatrix::from_fn(errors.len(), errors.len(), |i, j| {
        scale[i] * covariance[(i, j)] * scale[j]
    });
    let errors = errors.component_mul(&scale);
    let solved = scaled.cholesky().unwrap().solve(&errors);
    errors.dot(&solved)
}

#[test]
fn each_torque_has_its_joint_within_its_intervals() {
    let (rig, joints) = (rig(), over_torque());
    let bound = rig.bound_of_all(&joints, Noisy::Assembly, LEVEL);
    let size = bound.nrows();
    let draws = 6;
    let mut squares = 0.0;
    for seed in 0..draws {
        let separate = TorqueDependence::Separate;
        let found = identified(&rig, &joints, Noisy::Assembly, separate, 40 + seed);
        let covariance = &found.covariance_of_all;
        let errors = errors(&rig, &found, &joints);
        for i in 0..size {
            let deviation = covariance[(i, i)].sqrt();
            let of_bound = deviation / bound[(i, i)].sqrt();
            assert!((0.93..1.07).contains(&of_bound), "{i}: {of_bound}");
            let error = errors[i] / deviation;
            assert!(error.abs() < 4.5, "{i}: {error}");
        }
        // Torques whose substructures are exact have nothing in common.
        for (i, j) in [(0, 6), (8, 20), (3, 21)] {
            let scale = (covariance[(i, i)] * covariance[(j, j)]).sqrt();
            near(covariance[(i, j)], 0.0, 1e-9 * scale);
        }
        squares += distance(&errors, covariance);
        let choice = found.torque_choice().unwrap();
        assert_eq!(choice.recommended, separate);
        assert!(choice.compared[0].bic_difference > 100.0, "{choice:?}");
        assert!(!choice.compared[0].adequate);
        assert_eq!(found.warnings, [""; 0]);
        for (found, torque) in found.joints.iter().zip(TORQUES_N_M) {
            assert_eq!(found.torque_n_m, Some(torque));
        }
    }
    // χ² of the errors, five of its standard deviations wide.
    let count = (draws as usize * size) as f64;
    println!("χ² of {count} errors: {squares:.1}");
    near(squares, count, 5.0 * (2.0 * count).sqrt());
}

#[test]
fn one_joint_at_all_torques_is_recommended_as_common() {
    let rig = rig();
    let joints = [1.0; 3].map(|factor| joint(factor, 1.0));
    for (noisy, dependence) in [
        (Noisy::Assembly, TorqueDependence::Common),
        (Noisy::Assembly, TorqueDependence::Separate),
        (Noisy::AssemblyAndA, TorqueDependence::Common),
    ] {
        let found = identified(&rig, &joints, noisy, dependence, 7);
        let choice = found.torque_choice().unwrap();
        assert_eq!(choice.recommended, TorqueDependence::Common, "{choice:?}");
        // Twelve unknowns more, each of which costs ln 2N, with 27 functions and 200 lines, less what they gain by chance.
        let cost = 12.0 * f64::ln(2.0 * 27.0 * 200.0);
        let difference = choice.compared[1].bic_difference;
        println!("{noisy:?} {dependence:?}: {difference:.1}");
        near(difference, cost - 12.0, 25.0);
        let mut warnings = found.warnings.iter();
        let warned = warnings.any(|w| w.contains("torques = \"common\""));
        assert_eq!(warned, dependence == TorqueDependence::Separate);
    }
}

#[test]
fn a_common_joint_where_each_torque_has_its_own_is_warned_of() {
    let (rig, joints) = (rig(), over_torque());
    let common = TorqueDependence::Common;
    let found = identified(&rig, &joints[..2], Noisy::Assembly, common, 3);
    assert_eq!(found.joints.len(), 1);
    let choice = found.torque_choice().unwrap();
    assert_eq!(choice.recommended, TorqueDependence::Separate);
    let mut warnings = found.warnings.iter();
    assert!(warnings.any(|w| w.contains("torques = \"separate\"")));
}

/// What sharing the measured substructures does: standard deviations of each torque's joint, and of its change from one
/// torque to the next, beside what torques by themselves say.
#[test]
fn measured_substructures_in_common_couple_the_torques() {
    let (rig, joints) = (rig(), over_torque());
    let joints = &joints[..3];
    let noisy = Noisy::Everything;
    let bound = rig.bound_of_all(joints, noisy, LEVEL);
    let size = rig.truth().len();
    let alone: Vec<DMatrix<f64>> = joints
        .iter()
        .map(|joint| rig.bound_of_all(std::slice::from_ref(joint), noisy, LEVEL))
        .collect();
    let correlation =
        |c: &DMatrix<f64>, i: usize, j: usize| c[(i, j)] / (c[(i, i)] * c[(j, j)]).sqrt();
    for seed in [40, 41] {
        let found = identified(&rig, joints, noisy, TorqueDependence::Separate, seed);
        assert_eq!(found.warnings, [""; 0]);
        let stated = &found.covariance_of_all;
        println!(
            "unknown: deviation at 15 N·m together/alone; of the change to 20 N·m with/without what is in common; correlation"
        );
        for i in 0..size {
            let (low, high) = (size + i, 2 * size + i);
            let own = (bound[(low, low)] / alone[1][(i, i)]).sqrt();
            let change = bound[(low, low)] + bound[(high, high)] - 2.0 * bound[(low, high)];
            let independent = alone[1][(i, i)] + alone[2][(i, i)];
            let change = (change / independent).sqrt();
            println!(
                "  {:13} {own:.3}  {change:.3}  {:.3} (stated {:.3})",
                found.covariance().unknowns[i].name,
                correlation(&bound, low, high),
                correlation(stated, low, high),
            );
            // The other torques tell of the substructures, and most of the error is the same at all torques.
            assert!(own < 0.95 && change < 0.2, "{i}: {own} {change}");
            let of_bound = (stated[(low, low)] / bound[(low, low)]).sqrt();
            assert!((0.85..1.2).contains(&of_bound), "{i}: {of_bound}");
        }
        // χ² of the errors with all their correlations.
        let errors = errors(&rig, &found, joints);
        let squares = distance(&errors, stated);
        let count = errors.len() as f64;
        println!("χ² of {count} errors: {squares:.1}");
        near(squares, count, 4.0 * (2.0 * count).sqrt());
        // What separate studies would say of a change from torque to torque is far more than its error.
        for i in 0..size {
            let (low, high) = (size + i, 2 * size + i);
            let change = errors[high] - errors[low];
            let independent = (alone[1][(i, i)] + alone[2][(i, i)]).sqrt();
            assert!(change.abs() < 0.5 * independent, "{i}: {change}");
        }
    }
}
