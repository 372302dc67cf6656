//! Several bolts, sensitivities, and the two-step update, against joints that are known.

use bolted_joint::identify::{
    Amplitudes, Bands, JointMatrices, JointModel, choose_bands, from_ss, of_bolt, sensitivities,
    update_in_two_steps,
};
use bolted_joint::structure::{ComplexMatrix, Partition};
use nalgebra::DMatrix;

use crate::cases::{bolt, bolted};

#[track_caller]
fn close(found: &DMatrix<f64>, exact: &DMatrix<f64>, tolerance: f64) {
    assert!(is_close(found, exact, tolerance), "{found}");
}

fn is_close(found: &DMatrix<f64>, exact: &DMatrix<f64>, tolerance: f64) -> bool {
    let scale = |i: usize, j: usize| (exact[(i, i)] * exact[(j, j)]).abs().sqrt();
    (0..exact.nrows()).all(|i| {
        (0..exact.ncols()).all(|j| (found[(i, j)] - exact[(i, j)]).abs() <= tolerance * scale(i, j))
    })
}

#[test]
fn two_bolts_return_from_the_decoupling_as_a_block_diagonal_joint() {
    let bolts = [bolt(1.0), bolt(2.5)];
    let joint = JointMatrices::of_bolts(&bolts);
    assert_eq!(joint.stiffness[(0, 2)], 0.0);
    assert_eq!(joint.bolts(2), bolts);
    // Beyond the last bolt a beam with a free end moves in two ways only: four DOFs need points between the bolts, too.
    let points = [0.0, 0.04, 0.06, 0.2, 0.3];
    let lines = bolted(
        &[0.02, 0.08],
        &points,
        &joint,
        vec![60.0, 140.0, 230.0, 410.0],
    );
    let decoupled: Vec<Option<ComplexMatrix>> = (0..4)
        .map(|line| {
            let nothing = ComplexMatrix::zeros(0, 0);
            let a = Partition {
                joint: lines.a.at(line).into_owned(),
                joint_points: nothing.clone(),
                points_joint: nothing.clone(),
                points: nothing,
            };
            from_ss(&a, &lines.b_at(line), &lines.assembly[line])
        })
        .collect();
    for (index, bolt) in bolts.iter().enumerate() {
        for (line, found) in of_bolt(&decoupled, index, 2).iter().enumerate() {
            let found = found.as_ref().unwrap();
            let omega = std::f64::consts::TAU * lines.frequency_hz[line];
            close(&found.map(|k| k.re), &bolt.stiffness, 1e-4);
            close(&found.map(|k| k.im / omega), &bolt.damping, 1e-2);
        }
    }
}

#[test]
fn sensitivities_are_the_slopes_of_the_coupled_receptances() {
    let bolts = [bolt(1.0), bolt(2.5)];
    let joint = JointMatrices::of_bolts(&bolts);
    let frequency_hz = vec![60.0, 140.0, 410.0];
    let exact = bolted(&[0.02, 0.08], &[0.2, 0.3], &joint, frequency_hz);
    let found = sensitivities(&exact, JointModel::Full, &joint).unwrap();
    // 2 bolts × 3 entries × 3 distinct receptances (two of the four are reciprocal copies).
    assert_eq!(found.len() % 6, 0);
    for sensitivity in &found {
        let (i, j) = sensitivity.entry;
        let place = (2 * sensitivity.bolt + i, 2 * sensitivity.bolt + j);
        let step = 1e-5
            * (joint.stiffness[(place.0, place.0)] * joint.stiffness[(place.1, place.1)]).sqrt();
        let moved = |sign: f64| {
            let mut moved = joint.clone();
            moved.stiffness[place] += sign * step;
            if i != j {
                moved.stiffness[(place.1, place.0)] += sign * step;
            }
            exact.regenerated(&moved).unwrap()
        };
        let (up, down) = (moved(1.0), moved(-1.0));
        for line in 0..3 {
            let slope = (up[line][sensitivity.receptance] - down[line][sensitivity.receptance])
                / (2.0 * step);
            let error = (sensitivity.by_stiffness[line] - slope).norm();
            assert!(error < 1e-5 * slope.norm(), "{sensitivity:?} {slope}");
        }
    }
}

#[test]
fn the_two_step_update_returns_the_joint_from_a_start_beside_it() {
    // Dampings of the start are right, as the first step holds them; the stiffnesses are 3 % off.
    let frequency_hz: Vec<f64> = (20..900).map(|line| 0.5 * f64::from(line)).collect();
    let joint = bolt(1.0);
    let exact = bolted(&[0.03], &[0.2, 0.25, 0.3], &joint, frequency_hz);
    let start = JointMatrices {
        stiffness: &joint.stiffness * 1.03,
        damping: joint.damping.clone(),
    };
    for amplitudes in [Amplitudes::Squared, Amplitudes::Logarithmic] {
        let found = update_in_two_steps(&exact, JointModel::Full, &start, amplitudes).unwrap();
        assert_eq!(found.converged, [true; 2], "{found:?}");
        close(&found.joint.stiffness, &joint.stiffness, 1e-5);
        close(&found.joint.damping, &joint.damping, 1e-3);
        assert!(found.objective[1] < 1e-12 * found.objective[0]);
    }
    // Dampings of the start 20 % off: the stiffnesses take the error up in the first step, and keep some of it.
    let start = JointMatrices {
        stiffness: &joint.stiffness * 1.03,
        damping: &joint.damping * 1.2,
    };
    let found =
        update_in_two_steps(&exact, JointModel::Full, &start, Amplitudes::Logarithmic).unwrap();
    close(&found.joint.stiffness, &joint.stiffness, 0.02);
    assert!(!is_close(&found.joint.stiffness, &joint.stiffness, 1e-6));
}

#[test]
fn two_bolts_are_updated_together() {
    let bolts = [bolt(1.0), bolt(2.5)];
    let joint = JointMatrices::of_bolts(&bolts);
    let frequency_hz: Vec<f64> = (20..300).map(|line| 1.5 * f64::from(line)).collect();
    let exact = bolted(
        &[0.02, 0.08],
        &[0.12, 0.17, 0.21, 0.25, 0.3],
        &joint,
        frequency_hz,
    );
    let start = JointMatrices {
        stiffness: &joint.stiffness * 0.98,
        damping: joint.damping.clone(),
    };
    let found =
        update_in_two_steps(&exact, JointModel::Full, &start, Amplitudes::Logarithmic).unwrap();
    close(&found.joint.stiffness, &joint.stiffness, 1e-4);
    assert_eq!(found.joint.stiffness[(0, 2)], 0.0);
}

#[test]
fn bands_avoid_the_substructures_resonances_and_can_be_given() {
    let frequency_hz: Vec<f64> = (20..1000).map(|line| 0.5 * f64::from(line)).collect();
    let joint = bolt(1.0);
    let lines = bolted(&[0.03], &[0.2, 0.25, 0.3], &joint, frequency_hz);
    let given = Bands {
        ytheta: vec![[100.0, 120.0]],
        ..Bands::default()
    };
    let found = choose_bands(&lines, JointModel::Full, &joint, &given).unwrap();
    assert_eq!(found.ytheta, given.ytheta);
    // A alone: 0.3 m fixed-free, λ = 1.8751, 4.6941; B alone: 0.3 m free-free, λ = 4.7300 (Blevins, table 8-1).
    let natural = |root: f64| {
        let bending = 67e9 * 0.006_f64.powi(2) / (12.0 * 2700.0);
        (root / 0.3).powi(2) * bending.sqrt() / std::f64::consts::TAU
    };
    for bands in [&found.yy, &found.thetatheta] {
        assert!(!bands.is_empty());
        let width: f64 = bands.iter().map(|[from, to]| to - from).sum();
        assert!(width > 20.0 && width < 150.0, "{bands:?}");
        for own in [1.875_104, 4.694_091, 4.730_041].map(natural) {
            for [from, to] in bands {
                assert!(*to < 0.91 * own || *from > 1.09 * own, "{own} in {bands:?}");
            }
        }
    }
}
