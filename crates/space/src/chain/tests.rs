use bolted_joint_testing::close;
use nalgebra::{Matrix6, Vector3};
use num_complex::Complex64;

use super::*;
use crate::samples::{any_symmetric, diagonal, sines, structure};
use crate::{
    Connection, Coupled, Entry, JointMatrices, Selection, block_diagonal, transport, transported,
};

/// 40 residuals of 5 and 4 unknowns; `parted` replaces a column of the second joint by a combination of the first one's
/// and so much of itself.
fn jacobians(parted: Option<f64>) -> [DMatrix<f64>; 2] {
    let (first, mut second) = (sines(40, 5, 0.3), sines(40, 4, 1.1));
    if let Some(share) = parted {
        let column = first.column(0) - first.column(3) * 2.0 + second.column(0) * share;
        second.set_column(0, &column);
    }
    [first, second]
}

/// Against mpmath with 60 digits: eigenvalues of I − (AᵀA)⁻¹AᵀB(BᵀB)⁻¹BᵀA, and diagonals of inverse normal matrices.
#[test]
fn correlation_and_growth_are_those_of_the_normal_matrices() {
    for (parted, apart, correlation, first, second, tolerance) in [
        (
            None,
            0.208_002_180_043_58,
            0.889_942_593_629_735,
            [
                1.479_276_837_644,
                1.652_876_757_116,
                1.584_790_999_341,
                1.430_680_589_424,
                1.057_998_103_493,
            ],
            [
                1.357_286_204_345,
                1.524_708_820_532,
                1.472_429_384_487,
                1.359_269_133_475,
            ],
            1e-11,
        ),
        (
            Some(1e-3),
            1.085_393_635_951_46e-7,
            0.999_999_945_730_317,
            [
                1_438.097_588_587,
                1.652_876_757_116,
                1.584_790_999_341,
                2_758.359_276_91,
                1.057_998_103_494,
            ],
            [
                2_640.786_639_328,
                1.606_286_886_86,
                1.480_418_138_353,
                1.247_197_664_532,
            ],
            1e-10,
        ),
        (
            Some(1e-7),
            1.085_400_436_310_34e-15,
            0.999_999_999_999_999,
            [
                14_371_122.347_9,
                1.652_876_757_247,
                1.584_790_999_547,
                27_587_793.301_46,
                1.057_998_103_512,
            ],
            [
                26_404_926.690_28,
                1.606_300_131_395,
                1.480_414_113_876,
                1.247_080_539_088,
            ],
            1e-6,
        ),
    ] {
        let [one, other] = jacobians(parted);
        let told = ToldApart::of(&one, &other).unwrap();
        assert_eq!((told.ranks, told.unknowns), ([5, 4], [5, 4]));
        close(told.correlation, correlation, 1e-13);
        close(told.apart, apart, tolerance);
        let growth = told.growth.unwrap();
        for (found, expected) in growth.iter().flatten().zip(first.iter().chain(&second)) {
            close(*found, *expected, tolerance);
        }
    }
}

#[test]
fn units_and_order_are_of_no_account() {
    let [one, other] = jacobians(None);
    let told = ToldApart::of(&one, &other).unwrap();
    assert!(told.is_told());
    let [median, _] = told.median_growth();
    close(median, 1.479_276_837_644, 1e-11);
    let [largest, of_second] = told.largest_growth();
    close(largest, 1.652_876_757_116, 1e-11);
    close(of_second, 1.524_708_820_532, 1e-11);
    let mut scaled = one.clone();
    for (number, mut column) in scaled.column_iter_mut().enumerate() {
        column *= 10.0_f64.powi(8 * number as i32 - 12);
    }
    let swapped = ToldApart::of(&other, &scaled).unwrap();
    close(swapped.apart, told.apart, 1e-12);
    close(swapped.median_growth()[1], median, 1e-11);
}

#[test]
fn what_cannot_be_told_apart_says_why() {
    // a change in common
    let [one, other] = jacobians(Some(0.0));
    let told = ToldApart::of(&one, &other).unwrap();
    assert_eq!((told.ranks, told.growth.is_none()), ([5, 4], true));
    assert!(told.apart < 1e-28 && told.correlation > 1.0 - 1e-14);
    assert_eq!(
        [told.median_growth(), told.largest_growth()],
        [[f64::INFINITY; 2]; 2]
    );
    // a joint whose own numbers are not told: one number of no effect, two of the same
    let [one, mut other] = jacobians(None);
    other.column_mut(2).fill(0.0);
    let told = ToldApart::of(&one, &other).unwrap();
    assert_eq!((told.ranks, told.is_told()), ([5, 3], false));
    assert!(told.correlation < 0.95);
    let same = one.column(1) * 3.0;
    let mut twice = one.clone();
    twice.set_column(4, &same);
    assert_eq!(ToldApart::of(&twice, &other).unwrap().ranks, [4, 3]);
    // fewer residuals than unknowns
    let [one, other] = jacobians(None).map(|jacobian| jacobian.rows(0, 8).into_owned());
    assert!(!ToldApart::of(&one, &other).unwrap().is_told());
    // no effect at all
    let told = ToldApart::of(&DMatrix::zeros(40, 2), &sines(40, 4, 1.1)).unwrap();
    assert_eq!(
        (told.ranks, told.correlation, told.is_told()),
        ([0, 4], 0.0, false)
    );
}

#[test]
fn what_is_no_jacobian_is_refused() {
    let refused = |one: &DMatrix<f64>, other: &DMatrix<f64>| ToldApart::of(one, other).unwrap_err();
    let good = sines(40, 3, 0.0);
    assert!(matches!(
        refused(&good, &sines(39, 3, 0.0)),
        SpaceError::Size {
            found: 39,
            expected: 40,
            ..
        }
    ));
    assert!(matches!(
        refused(&DMatrix::zeros(40, 0), &good),
        SpaceError::TooFew { found: 0, .. }
    ));
    assert!(matches!(
        refused(&good, &(&good * f64::NAN)),
        SpaceError::NotFinite { .. }
    ));
}

/// From joint 1 to joint 2.
const BETWEEN: Vector3<f64> = Vector3::new(0.12, -0.05, 0.08);

fn chain_joints() -> [JointMatrices; 2] {
    let one = diagonal([3e7, 2e7, 6e7, 8e3, 1.2e4, 5e3]);
    let other = diagonal([2e7, 4e7, 3e7, 9e3, 6e3, 7e3]);
    let one = transported(&one, &Vector3::new(0.004, -0.006, 0.008));
    let other = transported(&other, &Vector3::new(-0.003, 0.005, 0.002));
    [one, other].map(|stiffness| JointMatrices::massless(stiffness, stiffness * 5e-6))
}

/// Derivatives by the 21 stiffnesses and 21 dampings of each joint, scaled by √(k_ii k_jj), of accelerances between A
/// and C, and of those of B if sensors are there; B is rigid, with `share` of its mass.
fn chain_jacobians(share: f64, on_b: bool) -> [DMatrix<f64>; 2] {
    let joints = chain_joints();
    // A has nodes 0 to 2, B its points at both joints, C nodes 0 to 2
    let from = |first: usize| [0, 1, 2, 3, 4, 5].map(|dof| first + dof);
    let connections = [
        Connection {
            a: from(12),
            b: from(18),
        },
        Connection {
            a: from(24),
            b: from(30),
        },
    ];
    let selection = Selection::relative(48, &connections).unwrap();
    let mass = diagonal([0.8, 0.8, 0.8, 1e-3, 2e-3, 1.5e-3]) * share;
    let mass = transported(&mass, &-Vector3::new(0.05, -0.02, 0.05));
    let to_second = transport(&-BETWEEN);
    let mut outputs: Vec<usize> = [0, 6, 36, 42]
        .into_iter()
        .flat_map(|node| [0, 1, 2, 3, 4, 5].map(|dof| node + dof))
        .collect();
    let inputs = outputs.clone();
    if on_b {
        outputs.extend(18..24);
    }
    let mut rows: [Vec<f64>; 2] = Default::default();
    for line in 0..25 {
        let omega = 2.0 * std::f64::consts::PI * 60.0 * 1.15_f64.powi(line);
        let rigid = (-mass * (omega * omega)).try_inverse().unwrap();
        let mut b = DMatrix::zeros(12, 12);
        for (row, left) in [Matrix6::identity(), to_second].iter().enumerate() {
            for (column, right) in [Matrix6::identity(), to_second].iter().enumerate() {
                b.view_mut((6 * row, 6 * column), (6, 6))
                    .copy_from(&(left * rigid * right.transpose()));
            }
        }
        let [a, c] = [
            structure(100, 3, true, omega),
            structure(200, 3, false, omega),
        ]
        .map(|z| z.try_inverse().unwrap());
        let receptances = block_diagonal(&[a, b.map(Complex64::from), c]);
        let dynamic = block_diagonal(
            &joints.map(|joint| DMatrix::from_column_slice(6, 6, joint.dynamic(omega).as_slice())),
        );
        let coupled = Coupled::new(&receptances, &selection, &dynamic, 0.02).unwrap();
        for &output in &outputs {
            for &input in &inputs {
                for (number, joint) in joints.iter().enumerate() {
                    let derivatives =
                        [Complex64::ONE, Complex64::new(0.0, 5e-6 * omega)].map(|part| {
                            Entry::ALL.map(|entry| {
                                let [p, q] = [entry.row.index(), entry.column.index()];
                                let size =
                                    (joint.stiffness[(p, p)] * joint.stiffness[(q, q)]).sqrt();
                                let at = [p, q].map(|dof| dof + 6 * number);
                                coupled.by_entry([output, input], at).unwrap()
                                    * part
                                    * size
                                    * (omega * omega)
                            })
                        });
                    rows[number].extend(derivatives.iter().flatten().map(|number| number.re));
                    rows[number].extend(derivatives.iter().flatten().map(|number| number.im));
                }
            }
        }
    }
    rows.map(|rows| DMatrix::from_row_slice(rows.len() / 42, 42, &rows))
}

/// Joints in series: with a part between them that hardly has mass only the sum of their compliances is seen, δK₁ = −K₁
/// E K₁ and δK₂ = K₂ T E Tᵀ K₂ cancel, T from joint 1 to joint 2. Mass or sensors between them tell them apart.
#[test]
fn joints_in_series_are_told_apart_by_what_is_between_them() {
    let [k, l] = chain_joints().map(|joint| joint.stiffness);
    let roots = k.diagonal().map(|stiffness| stiffness.sqrt().recip());
    let e = Matrix6::from_diagonal(&roots) * any_symmetric(5) * Matrix6::from_diagonal(&roots);
    let t = transport(&-BETWEEN);
    // K₁ and C₁ = β K₁ change by the same matrix: D₁⁻¹ = K₁⁻¹/(1 + jβω)
    let changes = [-(k * e * k), l * t * e * t.transpose() * l];
    let direction = |change: &Matrix6<f64>, stiffness: &Matrix6<f64>| {
        let numbers = Entry::ALL.map(|entry| {
            let (p, q) = (entry.row.index(), entry.column.index());
            change[(p, q)] / (stiffness[(p, p)] * stiffness[(q, q)]).sqrt()
        });
        DVector::from_iterator(42, numbers.into_iter().chain(numbers))
    };
    let seen = |share: f64| {
        let [one, other] = chain_jacobians(share, false);
        let first = &one * direction(&changes[0], &k);
        let both = &first + &other * direction(&changes[1], &l);
        let told = ToldApart::of(&one, &other).unwrap();
        (both.norm() / first.norm(), told)
    };
    let (heavy, told) = seen(1.0);
    assert!(heavy > 1e-2, "{heavy}");
    assert!(
        told.is_told() && told.median_growth()[0] < 10.0,
        "{:?}",
        told.median_growth()
    );
    let (light, told) = seen(1e-6);
    assert!(light < 1e-4 * heavy, "{light}");
    assert!(told.median_growth()[0] > 1e3, "{:?}", told.median_growth());
    let [one, other] = chain_jacobians(1e-6, true);
    let told = ToldApart::of(&one, &other).unwrap();
    assert!(
        told.is_told() && told.median_growth()[0] < 20.0,
        "{:?}",
        told.median_growth()
    );
}
