use bolted_joint_testing::{close, near};
use nalgebra::{DMatrix, Matrix3, Matrix6, Rotation3, SymmetricEigen, Unit, Vector3};

use super::*;
use crate::samples::{any_symmetric, scattered};
use crate::{CentreOfElasticity, PrincipalAxes, Uncertainty, condensed, semidefinite};

const BOLT: BoltNumbers = BoltNumbers {
    k_x: 2e8,
    k_z: 5e8,
    k_rx: 3e4,
    k_rz: 1e4,
    k_x_ry: 1e6,
};

fn of(model: &JointModel) -> Parametrisation {
    model.parametrisation().unwrap()
}

fn bolt(axis: Vector3<f64>) -> JointModel {
    JointModel::Bolt {
        axis,
        mirrors: Mirrors::Kept,
    }
}

/// 𝐑 of a rotation, or of a mirror, by which axial vectors get the other sign.
fn of_motions(turn: &Matrix3<f64>) -> Matrix6<f64> {
    let mut six = Matrix6::zeros();
    six.fixed_view_mut::<3, 3>(0, 0).copy_from(turn);
    six.fixed_view_mut::<3, 3>(3, 3)
        .copy_from(&(turn * turn.determinant()));
    six
}

fn about(axis: &Vector3<f64>, angle: f64) -> Matrix3<f64> {
    *Rotation3::from_axis_angle(&Unit::new_normalize(*axis), angle).matrix()
}

/// The n turns about z, and with mirrors each of them after the mirror across y.
fn group(turns: usize, mirrors: Mirrors) -> Vec<Matrix6<f64>> {
    let turns = (0..turns).map(|i| {
        about(
            &Vector3::z(),
            2.0 * std::f64::consts::PI * i as f64 / turns as f64,
        )
    });
    let mirror = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, 1.0));
    match mirrors {
        Mirrors::Kept => turns
            .flat_map(|turn| [turn, turn * mirror])
            .map(|turn| of_motions(&turn))
            .collect(),
        Mirrors::Lost => turns.map(|turn| of_motions(&turn)).collect(),
    }
}

fn rank(matrices: &[Matrix6<f64>]) -> usize {
    let columns = DMatrix::from_fn(36, matrices.len(), |row, n| matrices[n][row]);
    bolted_joint_singular::real(columns).unwrap().rank(1e-10)
}

/// The mean of 𝐑 K 𝐑ᵀ over the group is a projection on what the group leaves alone. What it makes of 40 random
/// symmetric matrices spans as many dimensions as the model has unknowns, and the model's matrices are among them.
#[test]
fn patterns_are_what_the_symmetry_leaves() {
    let (axis, line) = (Vector3::z(), Vector3::x());
    let bolt = |mirrors| JointModel::Bolt { axis, mirrors };
    let two = |mirrors| JointModel::TwoBolts {
        axis,
        line,
        mirrors,
    };
    let circle = |bolts, mirrors| JointModel::BoltCircle {
        bolts,
        axis,
        mirrors,
    };
    let [kept, lost] = [Mirrors::Kept, Mirrors::Lost];
    for (model, turns, mirrors, expected) in [
        (bolt(kept), 7, kept, 5),
        (bolt(lost), 7, lost, 7),
        (two(kept), 2, kept, 8),
        (two(lost), 2, lost, 13),
        (circle(3, kept), 3, kept, 5),
        (circle(3, lost), 3, lost, 7),
        (circle(4, kept), 4, kept, 5),
        (circle(4, lost), 4, lost, 7),
        (circle(6, kept), 6, kept, 5),
        (JointModel::Full, 1, lost, 21),
    ] {
        let form = of(&model);
        let group = group(turns, mirrors);
        let means: Vec<Matrix6<f64>> = (0..40)
            .map(|seed| {
                let any = any_symmetric(seed);
                group
                    .iter()
                    .map(|turn| turn * any * turn.transpose())
                    .sum::<Matrix6<f64>>()
                    / group.len() as f64
            })
            .collect();
        assert_eq!(
            (rank(&means), form.count(), rank(form.bases())),
            (expected, expected, expected),
            "{model:?}"
        );
        assert_eq!(
            rank(&[&means, form.bases()].concat()),
            expected,
            "{model:?}"
        );
    }
}

#[test]
fn one_bolt_looks_the_same_from_all_sides() {
    for (mirrors, more) in [(Mirrors::Kept, vec![]), (Mirrors::Lost, vec![3e5, -2e5])] {
        for axis in [
            Vector3::z(),
            Vector3::new(0.3, -0.4, 1.2),
            Vector3::x(),
            -Vector3::y(),
        ] {
            let unknowns = [BOLT.unknowns().to_vec(), more.clone()].concat();
            let stiffness = of(&JointModel::Bolt { axis, mirrors })
                .matrix(&unknowns)
                .unwrap();
            let largest = (0..100)
                .map(|trial| {
                    let turn = of_motions(&about(&axis, 7.0 * scattered::<1>(trial)[0]));
                    (turn * stiffness * turn.transpose() - stiffness).amax() / stiffness.amax()
                })
                .fold(0.0, f64::max);
            // along z five roundings are all; oblique axes round each number once more
            let most = if axis == Vector3::z() { 5e-16 } else { 1.5e-15 };
            assert!(largest < most, "{mirrors:?} {axis}: {largest:e}");
            assert_eq!(semidefinite(&stiffness), Ok(()));
        }
    }
    // with the other sign of k_y_rx it does not
    let mut wrong = of(&bolt(Vector3::z())).matrix(&BOLT.unknowns()).unwrap();
    wrong[(1, 3)] = 1e6;
    wrong[(3, 1)] = 1e6;
    let turn = of_motions(&about(&Vector3::z(), 1.0));
    assert!((turn * wrong * turn.transpose() - wrong).amax() > 1e5);
}

#[test]
fn one_bolt_has_its_centre_on_its_axis_and_is_decoupled_there() {
    let axis = Vector3::new(2.0, 1.0, -2.0);
    let stiffness = of(&bolt(axis)).matrix(&BOLT.unknowns()).unwrap();
    let centre = CentreOfElasticity::of(&stiffness, &Uncertainty::None).unwrap();
    near(BOLT.centre_m().unwrap(), 0.005, 1e-17);
    assert!((centre.offset_m - axis / 3.0 * 0.005).norm() < 1e-16);
    assert!(centre.relative_coupling < 1e-14);
    let axes = PrincipalAxes::of(&stiffness, &Uncertainty::None).unwrap();
    let [a, b, along] = axes.translational;
    assert_eq!((a.axis, b.axis), (None, None));
    assert!(along.axis.unwrap().cross(&axis).norm() < 1e-14);
    close(
        axes.rotational[2].stiffness,
        BOLT.bending_at_centre(),
        1e-12,
    );
    close(BOLT.bending_at_centre(), 3e4 - 5e3, 1e-14);
    // turned round, the same bolt has the other sign
    let opposite = BoltNumbers {
        k_x_ry: -BOLT.k_x_ry,
        ..BOLT
    };
    let again = of(&bolt(-axis)).matrix(&opposite.unknowns()).unwrap();
    assert!((again - stiffness).amax() < 1e-15 * stiffness.amax());
}

/// Where the conditions change sign, the smallest eigenvalue does.
#[test]
fn the_conditions_of_one_bolt_are_those_of_its_eigenvalues() {
    let form = of(&bolt(Vector3::z()));
    for seed in 0..200 {
        let [a, b, c, d, e, sign] = scattered::<6>(seed);
        let diagonal = [a, b, c, d].map(|number| if sign > -0.5 { number.abs() } else { number });
        let [k_x, k_z, k_rx, k_rz] = diagonal;
        let numbers = BoltNumbers {
            k_x,
            k_z,
            k_rx,
            k_rz,
            k_x_ry: e,
        };
        let matrix = form.matrix(&numbers.unknowns()).unwrap();
        let least = SymmetricEigen::new(matrix).eigenvalues.min();
        assert_eq!(
            numbers.semidefinite().is_ok(),
            least >= 0.0,
            "{numbers:?}: {least}"
        );
        assert_eq!(BoltNumbers::from(numbers.unknowns()), numbers);
    }
    let broken = BoltNumbers {
        k_z: f64::NAN,
        ..BOLT
    };
    assert!(matches!(
        broken.semidefinite(),
        Err(SpaceError::NotPassive {
            condition: "k_z",
            ..
        })
    ));
    let coupled = BoltNumbers {
        k_x_ry: 2.5e6,
        ..BOLT
    };
    let Err(SpaceError::NotPassive { found, .. }) = coupled.semidefinite() else {
        panic!()
    };
    close(found, 2e8 * 3e4 - 2.5e6 * 2.5e6, 1e-12);
}

/// Three, four and five bolts around a centre, each its own 6×6 that is moved there, are of the form of one bolt:
/// across and along n times as stiff, and bending and torsion larger by n/2 k_z R² and n k_x R².
#[test]
fn bolts_on_a_circle_make_one_large_bolt() {
    let (axis, radius) = (Vector3::new(1.0, -1.0, 0.5), 0.04);
    let axes = Axes::with_z_along(&axis).unwrap();
    for count in [3_usize, 4, 5] {
        let positions_m = (0..count).map(|i| {
            let angle = 0.3 + 2.0 * std::f64::consts::PI * i as f64 / count as f64;
            axes.matrix().transpose()
                * Vector3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
        });
        let form = of(&JointModel::Bolts {
            axis,
            positions_m: positions_m.collect(),
        });
        let sum = form.matrix(&BOLT.unknowns()).unwrap();
        let circle = of(&JointModel::BoltCircle {
            bolts: count,
            axis,
            mirrors: Mirrors::Kept,
        });
        let nearest = circle.nearest(&sum, 0.1).unwrap();
        assert!(
            nearest.left_out_share < 1e-14,
            "{count}: {}",
            nearest.left_out_share
        );
        let n = count as f64;
        let square = radius * radius;
        let expected = [2e8, 5e8, 3e4 + 0.5 * 5e8 * square, 1e4 + 2e8 * square, 1e6].map(|k| n * k);
        for (found, expected) in nearest.unknowns.iter().zip(expected) {
            close(*found, expected, 1e-12);
        }
        // the five numbers of the single bolt come back
        let single = form.nearest(&sum, 0.02).unwrap();
        for (found, expected) in single.unknowns.iter().zip(BOLT.unknowns()) {
            close(*found, expected, 1e-9);
        }
    }
}

#[test]
fn two_bolts_have_eight_numbers_about_their_middle() {
    let (axis, line) = (Vector3::y(), Vector3::new(0.03, 0.0, 0.04));
    let positions_m = vec![line * 0.5, line * -0.5];
    let sum = of(&JointModel::Bolts { axis, positions_m })
        .matrix(&BOLT.unknowns())
        .unwrap();
    let form = of(&JointModel::TwoBolts {
        axis,
        line,
        mirrors: Mirrors::Kept,
    });
    let nearest = form.nearest(&sum, 0.05).unwrap();
    assert!(nearest.left_out_share < 1e-14);
    // x points along the line: rotation about y lifts the bolts, rotation about x does not
    let lever = 2.0 * 0.025_f64.powi(2);
    let expected = [
        4e8,
        4e8,
        1e9,
        6e4,
        6e4 + 5e8 * lever,
        2e4 + 2e8 * lever,
        2e6,
        -2e6,
    ];
    for (found, expected) in nearest.unknowns.iter().zip(expected) {
        close(*found, expected, 1e-12);
    }
    // as one large bolt they cannot be told
    let one = of(&bolt(axis)).nearest(&sum, 0.05).unwrap();
    assert!(one.left_out_share > 1e-2);
}

/// A bolt aside of the point: a force along it turns the joint. By hand, k_z at (a, b, 0) has k_rx = k_z b², k_z_rx =
/// k_z b, k_z_ry = −k_z a.
#[test]
fn a_bolt_aside_is_moved_to_the_point() {
    let positions_m = vec![Vector3::new(0.02, 0.05, 0.0)];
    let form = of(&JointModel::Bolts {
        axis: Vector3::z(),
        positions_m,
    });
    let along = form.bases()[1];
    let expected = [
        (2, 2, 1.0),
        (2, 3, 0.05),
        (2, 4, -0.02),
        (3, 3, 0.0025),
        (4, 4, 0.0004),
        (3, 4, -0.001),
        (5, 5, 0.0),
    ];
    for (row, column, value) in expected {
        near(along[(row, column)], value, 1e-17);
        near(along[(column, row)], value, 1e-17);
    }
}

/// A circle is round also for what measures it in a plane: the planar parts agree whichever way the plane lies.
#[test]
fn planes_through_the_axis_of_a_bolt_agree() {
    use crate::{Dof, Others};
    let stiffness = of(&bolt(Vector3::z())).matrix(&BOLT.unknowns()).unwrap();
    let one = condensed(&stiffness, &[Dof::X, Dof::Ry], Others::Free).unwrap();
    let other = condensed(&stiffness, &[Dof::Y, Dof::Rx], Others::Free).unwrap();
    close(one[(0, 0)], other[(0, 0)], 1e-14);
    close(one[(0, 1)], -other[(0, 1)], 1e-14);
    close(one[(1, 1)], other[(1, 1)], 1e-14);
}
