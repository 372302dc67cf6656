use bolted_joint_testing::{close, near};
use nalgebra::{Matrix6, Vector3};

use super::*;
use crate::samples::{check_stiffness, scattered};
use crate::{Dof, JointModel, Mirrors, Motions, Part, numbers};

fn of(model: &JointModel) -> Parametrisation {
    model.parametrisation().unwrap()
}

fn bolt(axis: Vector3<f64>) -> JointModel {
    JointModel::Bolt {
        axis,
        mirrors: Mirrors::Kept,
    }
}

#[test]
fn names_and_numbers_are_those_of_the_models() {
    let axis = Vector3::z();
    let line = Vector3::x();
    let five = vec!["k_x", "k_z", "k_rx", "k_rz", "k_x_ry"];
    let names = |model: &JointModel| of(model).names(Part::Stiffness);
    assert_eq!(names(&bolt(axis)), five);
    assert_eq!(
        names(&JointModel::Bolts {
            axis,
            positions_m: vec![Vector3::zeros()]
        }),
        five
    );
    assert_eq!(
        names(&JointModel::BoltCircle {
            bolts: 6,
            axis,
            mirrors: Mirrors::Kept
        }),
        five
    );
    let seven = [five, vec!["k_x_rx", "k_z_rz"]].concat();
    assert_eq!(
        names(&JointModel::Bolt {
            axis,
            mirrors: Mirrors::Lost
        }),
        seven
    );
    let eight = vec![
        "k_x", "k_y", "k_z", "k_rx", "k_ry", "k_rz", "k_x_ry", "k_y_rx",
    ];
    assert_eq!(
        names(&JointModel::TwoBolts {
            axis,
            line,
            mirrors: Mirrors::Kept
        }),
        eight
    );
    assert_eq!(names(&JointModel::Diagonal), eight[..6]);
    assert_eq!(
        of(&JointModel::Translations).names(Part::Damping),
        ["c_x", "c_y", "c_z"]
    );
    let blocks = names(&JointModel::Blocks);
    assert_eq!(blocks.len(), 12);
    assert_eq!(blocks[..4], ["k_x", "k_x_y", "k_x_z", "k_y"]);
    let full = of(&JointModel::Full);
    assert_eq!(
        (full.count(), &full.names(Part::Stiffness)[8]),
        (21, &"k_y_rx".to_owned())
    );
    assert_eq!(full.entries(), Entry::ALL);
    assert_eq!(full.axes(), &Axes::identity());
}

#[test]
fn the_matrix_comes_back_from_the_nearest_unknowns() {
    let axis = Vector3::new(1.0, 2.0, 3.0);
    let line = Vector3::new(3.0, 0.0, -1.0);
    let positions_m = (0..4)
        .map(|seed| Vector3::from(scattered::<3>(seed)) * 0.1)
        .collect();
    for model in [
        JointModel::Translations,
        JointModel::Diagonal,
        bolt(axis),
        JointModel::TwoBolts {
            axis,
            line,
            mirrors: Mirrors::Lost,
        },
        JointModel::BoltCircle {
            bolts: 3,
            axis,
            mirrors: Mirrors::Lost,
        },
        JointModel::Bolts { axis, positions_m },
        JointModel::Blocks,
        JointModel::Full,
    ] {
        let form = of(&model);
        let unknowns = &scattered::<21>(11)[..form.count()];
        let matrix = form.matrix(unknowns).unwrap();
        assert_eq!(matrix.shape(), (6, 6));
        assert!((matrix - matrix.transpose()).amax() < 1e-15);
        for length_m in [0.05, 2.0] {
            let nearest = form.nearest(&matrix, length_m).unwrap();
            for (found, expected) in nearest.unknowns.iter().zip(unknowns) {
                near(*found, *expected, 1e-10);
            }
            assert!(
                nearest.left_out_share < 1e-12,
                "{model:?}: {}",
                nearest.left_out_share
            );
        }
    }
}

/// Of a matrix that is not of the form: means of what should be equal, and the rest in the part that is left out. No
/// other unknowns leave out less.
#[test]
fn what_a_model_cannot_hold_is_left_out() {
    let stiffness = check_stiffness();
    let form = of(&bolt(Vector3::z()));
    let nearest = form.nearest(&stiffness, 0.02).unwrap();
    for (found, expected) in nearest.unknowns.iter().zip([2.5e7, 5e7, 5e3, 8e3, 7.5e4]) {
        close(*found, expected, 1e-12);
    }
    let out = nearest.left_out;
    near(out[(0, 0)], -5e6, 1e-7);
    near(out[(2, 5)], 2e4, 1e-9);
    near(out[(1, 3)], 2.5e4, 1e-9);
    // by hand, with entries of rotations over 0.02 and 0.02²: the rest over the whole
    let part = |entries: &[f64]| entries.iter().map(|entry| entry * entry).sum::<f64>();
    let [couplings, rotations] = [50.0, 2500.0];
    let rest = part(&[5e6, 5e6, 1e3 * rotations, 1e3 * rotations])
        + 2.0 * part(&[2.5e4 * couplings, 2.5e4 * couplings, 2e4 * couplings]);
    let whole = part(&[
        2e7,
        3e7,
        5e7,
        4e3 * rotations,
        6e3 * rotations,
        8e3 * rotations,
    ]) + 2.0 * part(&[1e5 * couplings, 5e4 * couplings, 2e4 * couplings]);
    close(nearest.left_out_share, (rest / whole).sqrt(), 1e-12);
    assert_eq!(
        of(&JointModel::Full)
            .nearest(&stiffness, 0.1)
            .unwrap()
            .unknowns
            .len(),
        numbers(&stiffness).len()
    );
    let nothing = form.nearest(&Matrix6::zeros(), 0.1).unwrap();
    assert_eq!(
        (nothing.left_out_share, nothing.unknowns),
        (0.0, vec![0.0; 5])
    );
}

#[test]
fn what_is_no_model_is_refused() {
    let axis = Vector3::z();
    let flat = bolt(Vector3::zeros()).parametrisation();
    assert!(matches!(
        flat,
        Err(SpaceError::Direction { what: "axis", .. })
    ));
    let line = JointModel::TwoBolts {
        axis,
        line: axis,
        mirrors: Mirrors::Kept,
    }
    .parametrisation();
    assert!(matches!(
        line,
        Err(SpaceError::Direction { what: "line", .. })
    ));
    let few = JointModel::BoltCircle {
        bolts: 2,
        axis,
        mirrors: Mirrors::Kept,
    }
    .parametrisation();
    assert!(matches!(
        few,
        Err(SpaceError::TooFew {
            found: 2,
            least: 3,
            ..
        })
    ));
    let nowhere = JointModel::Bolts {
        axis,
        positions_m: vec![],
    }
    .parametrisation();
    assert!(matches!(nowhere, Err(SpaceError::TooFew { found: 0, .. })));
    let lost = JointModel::Bolts {
        axis,
        positions_m: vec![Vector3::repeat(f64::NAN)],
    }
    .parametrisation();
    assert!(matches!(lost, Err(SpaceError::NotFinite { .. })));
    let form = of(&bolt(axis));
    assert!(matches!(
        form.matrix(&[1.0; 4]),
        Err(SpaceError::Size {
            found: 4,
            expected: 5,
            ..
        })
    ));
    assert!(matches!(
        form.nearest(&Matrix6::identity(), 0.0),
        Err(SpaceError::Value { .. })
    ));
    let broken = Matrix6::from_element(f64::NAN);
    assert!(matches!(
        form.nearest(&broken, 1.0),
        Err(SpaceError::NotFinite { .. })
    ));
}

#[test]
fn a_plane_leaves_the_numbers_between_its_motions() {
    let plane = Motions::of(&[Dof::Y, Dof::Rz]).unwrap();
    let full = JointModel::Full.parametrisation().unwrap();
    let own = full.within(plane).unwrap();
    assert_eq!(own.names(Part::Stiffness), ["k_y", "k_y_rz", "k_rz"]);
    let matrix = own.matrix(&[3.0, 2.0, 5.0]).unwrap();
    assert_eq!(plane.part(&matrix), matrix);
    assert_eq!((matrix[(1, 5)], matrix[(5, 1)]), (2.0, 2.0));
    let bolt = JointModel::Bolt {
        axis: Vector3::z(),
        mirrors: Mirrors::Kept,
    };
    let error = bolt.parametrisation().unwrap().within(plane).unwrap_err();
    assert!(error.to_string().contains("for a test of y, rz"), "{error}");
    let turns = Motions::of(&[Dof::Rz]).unwrap();
    let translations = JointModel::Translations.parametrisation().unwrap();
    assert!(translations.within(turns).is_err());
}
