//! Assemblies of structures without any symmetry, against the inverse of their dynamic stiffness.

use nalgebra::Vector3;
use num_complex::Complex64;

use super::{Matrix, SIX, dense, difference, from, inverse};
use crate::samples::{definite, diagonal, scattered, structure};
use crate::{
    Connection, Coupled, Dof, JointMatrices, JointModel, Mirrors, Selection, block_diagonal, lumped,
};

fn assembled(structures: &[Matrix], selection: &Selection, dynamic: &Matrix) -> Matrix {
    let s = selection.matrix().map(Complex64::from);
    inverse(&(block_diagonal(structures) + s.transpose() * dynamic * &s))
}

fn apart(structures: &[Matrix]) -> Matrix {
    block_diagonal(&structures.iter().map(inverse).collect::<Vec<_>>())
}

fn joint(seed: u64) -> JointMatrices {
    let mass = diagonal([0.05, 0.05, 0.05, 1e-5, 1e-5, 1e-5]);
    JointMatrices {
        stiffness: definite(seed),
        damping: definite(seed + 1) * 1e-4,
        inertia: mass,
    }
}

const FREQUENCIES_HZ: [f64; 5] = [30.0, 120.0, 400.0, 900.0, 1500.0];

fn omegas() -> [f64; 5] {
    FREQUENCIES_HZ.map(|frequency_hz| 2.0 * std::f64::consts::PI * frequency_hz)
}

/// Against the inverse of the assembled dynamic stiffness: a regular joint, one that resists no torsion, one without
/// any stiffness of rotations, none at all.
#[test]
fn coupling_is_the_inverse_of_the_assembly() {
    let selection = Selection::relative(
        36,
        &[Connection {
            a: from(12),
            b: from(18),
        }],
    )
    .unwrap();
    for omega in omegas() {
        let structures = [
            structure(100, 3, true, omega),
            structure(200, 3, false, omega),
        ];
        for lost in [&[][..], &[5], &[3, 4, 5], &SIX] {
            let mut dynamic = dense(&joint(300).dynamic(omega));
            for &dof in lost {
                dynamic.row_mut(dof).fill(Complex64::ZERO);
                dynamic.column_mut(dof).fill(Complex64::ZERO);
            }
            let coupled = Coupled::new(&apart(&structures), &selection, &dynamic, 0.02).unwrap();
            let found = difference(
                coupled.receptance(),
                &assembled(&structures, &selection, &dynamic),
            );
            assert!(found < 2e-12, "{omega} {lost:?}: {found:e}");
            // a and b are what they are called
            let s = selection.matrix().map(Complex64::from);
            let receptance = coupled.receptance();
            let [a, b] = [receptance * s.transpose(), &s * receptance];
            assert!((coupled.by_joint_loads() - &a).norm() < 1e-9 * a.norm());
            assert!((coupled.joint_motions() - &b).norm() < 1e-9 * b.norm());
            // the length scales the solution and not the result
            let other = Coupled::new(&apart(&structures), &selection, &dynamic, 1.0).unwrap();
            assert!(difference(other.receptance(), receptance) < 1e-10);
        }
    }
}

#[test]
fn masses_on_the_sides_are_coupled_as_well() {
    let connections = [Connection {
        a: from(12),
        b: from(18),
    }];
    let sides = Selection::sides(36, &connections).unwrap();
    let relative = Selection::relative(36, &connections).unwrap();
    let masses = [1.0, 0.7].map(|share| diagonal([0.1, 0.1, 0.1, 2e-5, 2e-5, 2e-5]) * share);
    for omega in omegas() {
        let structures = [
            structure(100, 3, true, omega),
            structure(200, 3, false, omega),
        ];
        let d = joint(300).dynamic(omega);
        let with = lumped(&d, &masses, omega);
        let coupled = Coupled::new(&apart(&structures), &sides, &with, 0.02).unwrap();
        // the masses belong to the structures as well
        let [mut a, mut b] = structures.clone();
        for (body, at, mass) in [(&mut a, 12, masses[0]), (&mut b, 0, masses[1])] {
            let mut corner = body.view_mut((at, at), (6, 6));
            corner -= dense(&mass.map(|m| Complex64::from(omega * omega * m)));
        }
        let found = difference(
            coupled.receptance(),
            &assembled(&[a, b], &relative, &dense(&d)),
        );
        assert!(found < 2e-12, "{omega}: {found:e}");
    }
}

/// Central differences of the whole formula, for a change of two joints at once.
#[test]
fn the_derivative_is_that_of_differences() {
    let connections = [
        Connection {
            a: from(6),
            b: from(12),
        },
        Connection {
            a: from(18),
            b: from(24),
        },
    ];
    let selection = Selection::relative(36, &connections).unwrap();
    for omega in omegas() {
        let structures = [(1, true), (2, false), (3, false)]
            .map(|(seed, ground)| structure(100 * seed, 2, ground, omega));
        let receptances = apart(&structures);
        let dynamic = block_diagonal(&[300, 400].map(|seed| dense(&joint(seed).dynamic(omega))));
        let scale: [f64; 6] = [1e8, 1e8, 1e8, 4e4, 4e4, 4e4];
        let direction = Matrix::from_fn(12, 12, |i, j| {
            let [re, im] = scattered::<2>((20 * i + j) as u64);
            Complex64::new(re, im) * (scale[i % 6] * scale[j % 6]).sqrt() * 1e-2
        });
        let coupled = |step: f64| {
            let changed = &dynamic + &direction * Complex64::from(step);
            Coupled::new(&receptances, &selection, &changed, 0.02).unwrap()
        };
        let step = 1e-3;
        let expected = (coupled(step).receptance() - coupled(-step).receptance())
            / Complex64::from(2.0 * step);
        let found = coupled(0.0).change(&direction).unwrap();
        let off = (&found - &expected).norm() / expected.norm();
        assert!(off < 1e-7, "{omega}: {off:e}");
        // entry by entry
        let mut entry = Matrix::zeros(12, 12);
        entry[(7, 10)] = Complex64::ONE;
        entry[(10, 7)] = Complex64::ONE;
        let at = coupled(0.0);
        let [by_change, by_entry] = [
            at.change(&entry).unwrap()[(3, 33)],
            at.by_entry([3, 33], [7, 10]).unwrap(),
        ];
        assert!((by_change - by_entry).norm() < 1e-13 * by_entry.norm());
        // by what a number of a model is in the second joint
        let form = JointModel::Bolt {
            axis: Vector3::new(1.0, 2.0, 3.0),
            mirrors: Mirrors::Kept,
        };
        for basis in form.parametrisation().unwrap().bases() {
            let mut second = Matrix::zeros(12, 12);
            second
                .view_mut((6, 6), (6, 6))
                .copy_from(&basis.map(Complex64::from));
            let by_change = at.change(&second).unwrap()[(3, 33)];
            let by_matrix = at.by_matrix([3, 33], 6, basis).unwrap();
            assert!((by_change - by_matrix).norm() < 1e-13 * by_matrix.norm());
            assert_eq!(
                [
                    at.by_matrix([36, 0], 0, basis),
                    at.by_matrix([0, 0], 7, basis)
                ],
                [None; 2]
            );
        }
    }
}

/// Three structures and two joints: against the assembly, joint after joint, and H in blocks.
#[test]
fn a_chain_is_coupled_in_one_step() {
    let connections = [
        Connection {
            a: from(6),
            b: from(12),
        },
        Connection {
            a: from(18),
            b: from(24),
        },
    ];
    let both = Selection::relative(36, &connections).unwrap();
    let [first, second] = connections.map(|joint| Selection::relative(36, &[joint]).unwrap());
    for omega in omegas() {
        let structures = [(1, true), (2, false), (3, false)]
            .map(|(seed, ground)| structure(100 * seed, 2, ground, omega));
        let joints = [300, 400].map(|seed| dense(&joint(seed).dynamic(omega)));
        let dynamic = block_diagonal(&joints);
        let receptances = apart(&structures);
        let chain = Coupled::new(&receptances, &both, &dynamic, 0.02).unwrap();
        let found = difference(chain.receptance(), &assembled(&structures, &both, &dynamic));
        assert!(found < 2e-12, "{omega}: {found:e}");
        let one = Coupled::new(&receptances, &first, &joints[0], 0.02).unwrap();
        let two = Coupled::new(one.receptance(), &second, &joints[1], 0.02).unwrap();
        assert!(difference(two.receptance(), chain.receptance()) < 1e-10);
    }
}

/// Sensors at some places and excitations at others, beside the joint's motions on both sides.
#[test]
fn rows_and_columns_may_be_at_other_places() {
    let omega = 900.0;
    let structures = [
        structure(100, 3, true, omega),
        structure(200, 3, false, omega),
    ];
    let selection = Selection::relative(
        36,
        &[Connection {
            a: from(12),
            b: from(18),
        }],
    )
    .unwrap();
    let dynamic = dense(&joint(300).dynamic(omega));
    let whole = Coupled::new(&apart(&structures), &selection, &dynamic, 0.02).unwrap();
    let rows: Vec<usize> = (12..24).chain([0, 7, 30]).collect();
    let columns: Vec<usize> = (12..24).chain([3, 35]).collect();
    let [motions, loads] = [&rows, &columns].map(|places| {
        let matrix = selection.matrix().select_columns(places);
        Selection::new(matrix, Dof::ALL.to_vec()).unwrap()
    });
    let measured = apart(&structures)
        .select_rows(&rows)
        .select_columns(&columns);
    let coupled = Coupled::between(&measured, [&motions, &loads], &dynamic, 0.02).unwrap();
    let expected = whole
        .receptance()
        .select_rows(&rows)
        .select_columns(&columns);
    assert!((coupled.receptance() - &expected).norm() < 1e-11 * expected.norm());
    let a = whole.by_joint_loads().select_rows(&rows);
    assert!((coupled.by_joint_loads() - &a).norm() < 1e-11 * a.norm());
}
