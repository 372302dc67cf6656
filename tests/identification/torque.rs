//! Joints over the tightening torque: each torque's joint is found as sure as it says, measured substructures in common
//! couple the torques, and BIC tells a joint that depends on the torque from one that does not.

use bolted_joint::identify::{
    JointMatrices, LinesEstimate, Noise, NoiseLevel, Options, TorqueDependence, identify_lines,
};
use nalgebra::DMatrix;

use crate::cases::axis;
use crate::measured::{Noisy, Rig, joint, thesis, unknowns};

const LEVEL: NoiseLevel = NoiseLevel {
    relative: 0.01,
    floor: 0.0,
};

/// The torques of Tol's Table 5.7, N·m.
const TORQUES_N_M: [f64; 4] = [10.0, 15.0, 20.0, 25.0];

/// Joints that get stiffer and less damped as they are tightened, more and more slowly.
fn over_torque() -> [JointMatrices; 4] {
    [
        joint(0.80, 1.40),
        joint(0.93, 1.15),
        joint(1.00, 1.00),
        joint(1.04, 0.92),
    ]
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
        compare_models: true,
        ..Options::default()
    };
    identify_lines(&all, rig.model, &options).unwrap()
}

/// Errors of the unknowns of all joints.
fn errors(rig: &Rig, found: &LinesEstimate, joints: &[JointMatrices]) -> Vec<f64> {
    let pairs = found.joints().iter().zip(joints);
    pairs
        .flat_map(|(found, truth)| {
            let truth = unknowns(rig.model, truth);
            let found = unknowns(rig.model, &found.free[0]);
            found
                .into_iter()
                .zip(truth)
                .map(|(found, truth)| found - truth)
        })
        .collect()
}

#[test]
fn each_torque_has_its_joint_within_its_intervals() {
    let (rig, joints) = (rig(), over_torque());
    for (noisy, draws) in [(Noisy::Assembly, 6), (Noisy::Everything, 1)] {
        let bound = rig.bound_of_all(&joints, noisy, LEVEL);
        let mut squares = 0.0;
        let mut count = 0.0;
        for seed in 0..draws {
            let found = identified(&rig, &joints, noisy, TorqueDependence::Separate, 40 + seed);
            let covariance = found.covariance_of_all();
            let errors = errors(&rig, &found, &joints);
            for (i, error) in errors.iter().enumerate() {
                let deviation = covariance[(i, i)].sqrt();
                let of_bound = deviation / bound[(i, i)].sqrt();
                assert!(
                    (0.93..1.07).contains(&of_bound),
                    "{noisy:?} {i}: {of_bound}"
                );
                assert!(
                    error.abs() < 4.5 * deviation,
                    "{noisy:?} {i}: {error} {deviation}"
                );
                squares += (error / deviation).powi(2);
                count += 1.0;
            }
            let choice = found.torque_choice().unwrap();
            assert_eq!(choice.recommended, TorqueDependence::Separate);
            assert!(choice.compared[0].bic_difference > 100.0, "{choice:?}");
            assert!(!choice.compared[0].adequate);
            assert_eq!(found.warnings(), [""; 0]);
            for (found, torque) in found.joints().iter().zip(TORQUES_N_M) {
                assert_eq!(found.torque_n_m, Some(torque));
            }
        }
        // χ² of the errors, five of its standard deviations wide.
        let excess = (squares - count) / f64::sqrt(2.0 * count);
        println!("{noisy:?}: χ² of {count} errors {squares:.1}");
        assert!(excess.abs() < 5.0, "{noisy:?}: {squares} of {count}");
    }
}

#[test]
fn one_joint_at_all_torques_is_recommended_as_common() {
    let rig = rig();
    let joints = [1.0; 3].map(|factor| joint(factor, 1.0));
    for noisy in [Noisy::Assembly, Noisy::AssemblyAndA] {
        for dependence in [TorqueDependence::Common, TorqueDependence::Separate] {
            let found = identified(&rig, &joints, noisy, dependence, 7);
            let choice = found.torque_choice().unwrap();
            assert_eq!(choice.recommended, TorqueDependence::Common, "{choice:?}");
            // Twelve unknowns more, each of which costs ln 2N: about 17 and 4·10³ numbers a torque.
            let difference = choice.compared[1].bic_difference;
            assert!((60.0..130.0).contains(&difference), "{difference}");
            let warned = found
                .warnings()
                .iter()
                .any(|w| w.contains("torques = \"common\""));
            assert_eq!(warned, dependence == TorqueDependence::Separate);
        }
    }
}

#[test]
fn a_common_joint_where_each_torque_has_its_own_is_warned_of() {
    let (rig, joints) = (rig(), over_torque());
    let found = identified(
        &rig,
        &joints[..2],
        Noisy::Assembly,
        TorqueDependence::Common,
        3,
    );
    assert_eq!(found.joints().len(), 1);
    assert_eq!(
        found.torque_choice().unwrap().recommended,
        TorqueDependence::Separate
    );
    let mut warnings = found.warnings().iter();
    assert!(warnings.any(|w| w.contains("torques = \"separate\"")));
}

/// What sharing the measured substructures does: standard deviations of each torque's joint, and of its change from one
/// torque to the next, beside what torques by themselves say.
#[test]
fn measured_substructures_in_common_couple_the_torques() {
    let (rig, joints) = (rig(), over_torque());
    let noisy = Noisy::Everything;
    let together = rig.bound_of_all(&joints, noisy, LEVEL);
    let size = rig.truth().len();
    let alone: Vec<DMatrix<f64>> = joints
        .iter()
        .map(|joint| rig.bound_of_all(std::slice::from_ref(joint), noisy, LEVEL))
        .collect();
    let found = identified(&rig, &joints, noisy, TorqueDependence::Separate, 11);
    let stated = found.covariance_of_all();
    println!(
        "unknown: deviation together/alone at 20 N·m; of the change from 20 to 25 N·m with/without the coupling; correlation"
    );
    for i in 0..size {
        let (low, high) = (2 * size + i, 3 * size + i);
        let own = (together[(low, low)] / alone[2][(i, i)]).sqrt();
        let change = |c: &DMatrix<f64>| c[(low, low)] + c[(high, high)] - 2.0 * c[(low, high)];
        let independent = alone[2][(i, i)] + alone[3][(i, i)];
        let correlation =
            |c: &DMatrix<f64>| c[(low, high)] / (c[(low, low)] * c[(high, high)]).sqrt();
        println!(
            "  {:13} {own:.3}  {:.3}  {:.3} (stated {:.3})",
            found.covariance().unknowns[i].name,
            (change(&together) / independent).sqrt(),
            correlation(&together),
            correlation(stated),
        );
        assert!((correlation(&together) - correlation(stated)).abs() < 0.05);
    }
}
