use bolted_joint_testing::close;
use nalgebra::{Matrix6, Vector3};

use super::*;
use crate::samples::{check_stiffness, diagonal};
use crate::{Connection, Dof, Entry, JointMatrices, block_diagonal, transported};

mod assemblies;

type Matrix = DMatrix<Complex64>;

const OMEGA: f64 = 200.0 * std::f64::consts::PI;
const SIX: [usize; 6] = [0, 1, 2, 3, 4, 5];

fn dense(matrix: &Matrix6<Complex64>) -> Matrix {
    DMatrix::from_column_slice(6, 6, matrix.as_slice())
}

fn from(first: usize) -> [usize; 6] {
    SIX.map(|dof| first + dof)
}

/// Largest difference, beside √|Y_ii Y_jj|.
fn difference(found: &Matrix, expected: &Matrix) -> f64 {
    let size = expected.diagonal().map(|number| number.norm().sqrt());
    let of = |i: usize, j: usize| (found[(i, j)] - expected[(i, j)]).norm() / (size[i] * size[j]);
    (0..size.len())
        .flat_map(|i| (0..size.len()).map(move |j| (i, j)))
        .map(|(i, j)| of(i, j))
        .fold(0.0, f64::max)
}

/// The check case: A on springs, B free with its centre of mass aside of the joint.
fn check_structures() -> [Matrix; 2] {
    let inertia = diagonal([2.0, 2.0, 2.0, 0.01, 0.02, 0.03]);
    let stiffness = diagonal([1e6, 2e6, 3e6, 4e3, 5e3, 6e3]);
    let a = JointMatrices {
        stiffness,
        damping: stiffness * 1e-4,
        inertia,
    };
    let of_b = diagonal([1.0, 1.0, 1.0, 0.004, 0.005, 0.006]);
    // from the centre of mass to the joint
    let inertia = transported(&of_b, &-Vector3::new(0.01, 0.02, 0.05));
    let b = JointMatrices {
        stiffness: Matrix6::zeros(),
        damping: Matrix6::zeros(),
        inertia,
    };
    [a, b].map(|body| dense(&body.dynamic(OMEGA)))
}

fn check_joint() -> JointMatrices {
    let stiffness = check_stiffness();
    let inertia = diagonal([0.02, 0.02, 0.02, 1e-6, 1e-6, 1e-6]);
    JointMatrices {
        stiffness,
        damping: stiffness * 2e-5,
        inertia,
    }
}

fn inverse(matrix: &Matrix) -> Matrix {
    matrix.clone().try_inverse().unwrap()
}

fn check_coupled() -> Coupled {
    let receptances = block_diagonal(&check_structures().map(|body| inverse(&body)));
    let selection = Selection::relative(12, &[Connection { a: SIX, b: from(6) }]).unwrap();
    Coupled::new(
        &receptances,
        &selection,
        &dense(&check_joint().dynamic(OMEGA)),
        0.03,
    )
    .unwrap()
}

#[test]
fn the_check_values_hold() {
    let coupled = check_coupled();
    let near = |found: Complex64, re: f64, im: f64| {
        let expected = Complex64::new(re, im);
        assert!(
            (found - expected).norm() < 1e-10 * expected.norm(),
            "{found} {expected}"
        );
    };
    let receptance = coupled.receptance();
    near(receptance[(0, 0)], -5.769_927_076_4e-6, -2.906_505_588_0e-6);
    near(receptance[(1, 5)], -4.051_743_555_0e-7, 5.521_153_800_7e-8);
    near(receptance[(3, 9)], -3.112_455_717_5e-4, -1.222_862_979_7e-5);
    near(receptance[(4, 6)], 2.529_707_997_4e-5, 1.349_667_870_1e-5);
    near(
        coupled.by_entry([0, 10], [0, 4]).unwrap(),
        -1.987_790_049_2e-12,
        2.218_608_002_5e-12,
    );
    let unit = dense(&Entry::new(Dof::X, Dof::Ry).unit().map(Complex64::from));
    near(
        coupled.change(&unit).unwrap()[(0, 10)],
        -1.987_790_049_2e-12,
        2.218_608_002_5e-12,
    );
    assert_eq!(coupled.by_entry([0, 12], [0, 4]), None);
    assert_eq!(coupled.by_entry([0, 0], [0, 6]), None);
}

/// Fisher information of three numbers by six receptances at one line, E|ε|² = σ².
#[test]
fn the_information_of_the_check_case_holds() {
    let coupled = check_coupled();
    let j_omega = Complex64::new(0.0, OMEGA);
    let unknowns = [
        ([0, 0], Complex64::ONE),
        ([0, 4], Complex64::ONE),
        ([0, 0], j_omega),
    ];
    let jacobian: Vec<[Complex64; 3]> = [0, 1, 5]
        .into_iter()
        .flat_map(|output| [6, 10].map(|input| [output, input]))
        .map(|pair| unknowns.map(|(entry, factor)| coupled.by_entry(pair, entry).unwrap() * factor))
        .collect();
    let information = |i: usize, j: usize| {
        let sum: f64 = jacobian.iter().map(|row| (row[i].conj() * row[j]).re).sum();
        2.0 * sum / 1e-18
    };
    close(information(0, 0), 2.989_237_756_7e-9, 1e-10);
    close(information(0, 1), 9.618_353_772_9e-8, 1e-10);
    close(information(1, 1), 2.594_010_492_7e-5, 1e-10);
    close(information(1, 2), -1.591_783_927_2e-4, 1e-10);
    close(information(2, 2), 1.180_103_764_8e-3, 1e-10);
    assert!(information(0, 2).abs() < 1e-15);
}

#[test]
fn the_check_case_is_the_inverse_of_its_assembly() {
    let [a, b] = check_structures();
    let d = dense(&check_joint().dynamic(OMEGA));
    let mut assembled = block_diagonal(&[&a + &d, &b + &d]);
    assembled.view_mut((0, 6), (6, 6)).copy_from(&-&d);
    assembled.view_mut((6, 0), (6, 6)).copy_from(&-&d);
    let found = difference(check_coupled().receptance(), &inverse(&assembled));
    assert!(found < 1e-13, "{found:e}");
}

/// Two masses on a spring with a planar joint: by the closed form of m_a m_b s² + (m_a + m_b)(k + c s).
#[test]
fn two_masses_are_those_of_the_textbook() {
    let (m_a, m_b, k, c, omega) = (2.0, 0.5, 1e6, 30.0, 800.0);
    let square = -omega * omega;
    let receptances = Matrix::from_diagonal(&nalgebra::DVector::from_vec(vec![
        Complex64::from(1.0 / (square * m_a)),
        Complex64::from(1.0 / (square * m_b)),
    ]));
    let selection =
        Selection::new(DMatrix::from_row_slice(1, 2, &[1.0, -1.0]), vec![Dof::Y]).unwrap();
    let d = Complex64::new(k, omega * c);
    let coupled = Coupled::new(
        &receptances,
        &selection,
        &Matrix::from_element(1, 1, d),
        1.0,
    )
    .unwrap();
    let determinant = square * (square * m_a * m_b + (m_a + m_b) * d);
    for (at, expected) in [
        ((0, 0), square * m_b + d),
        ((0, 1), d),
        ((1, 1), square * m_a + d),
    ] {
        let expected = expected / determinant;
        assert!((coupled.receptance()[at] - expected).norm() < 1e-14 * expected.norm());
    }
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let selection = Selection::relative(12, &[Connection { a: SIX, b: from(6) }]).unwrap();
    let receptances = Matrix::identity(12, 12);
    let dynamic = Matrix::identity(6, 6);
    let refused = |y: &Matrix, d: &Matrix, length_m: f64| {
        Coupled::new(y, &selection, d, length_m).unwrap_err()
    };
    assert!(matches!(
        refused(&Matrix::identity(11, 11), &dynamic, 1.0),
        SpaceError::Size {
            found: 12,
            expected: 11,
            ..
        }
    ));
    assert!(matches!(
        refused(&receptances, &Matrix::identity(5, 5), 1.0),
        SpaceError::Size {
            found: 6,
            expected: 5,
            ..
        }
    ));
    assert!(matches!(
        refused(&receptances, &Matrix::zeros(6, 5), 1.0),
        SpaceError::Size {
            found: 5,
            expected: 6,
            ..
        }
    ));
    assert!(matches!(
        refused(&receptances, &dynamic, 0.0),
        SpaceError::Value { .. }
    ));
    let broken = Matrix::from_element(12, 12, Complex64::new(f64::NAN, 0.0));
    assert!(matches!(
        refused(&broken, &dynamic, 1.0),
        SpaceError::NotFinite {
            what: "the receptances"
        }
    ));
    // H = 2 I and D = −I/2: a resonance without damping
    let resonant = &dynamic * Complex64::from(-0.5);
    assert_eq!(refused(&receptances, &resonant, 1.0), SpaceError::Resonance);
    let coupled = Coupled::new(&receptances, &selection, &dynamic, 1.0).unwrap();
    assert!(matches!(
        coupled.change(&Matrix::zeros(6, 5)),
        Err(SpaceError::Size {
            found: 5,
            expected: 6,
            ..
        })
    ));
}
