//! The interface joint against rigid-body kinematics, closed forms of a rectangle, and the shift of the reference point.

use bolted_joint::joint::DofSet;
use bolted_joint::predict::patch::{
    Contact, InterfaceJoint, LossFactor, Matrix6, Motions, NormalDamping, SignedAxis, matrix27,
    table,
};
use bolted_joint::predict::pressure::Element;
use bolted_joint_testing::has;
use nalgebra::{Matrix3, SMatrix, SVector, SymmetricEigen, Vector3};
use proptest::prelude::*;

type M6 = SMatrix<f64, 6, 6>;

fn to_matrix(rows: &Matrix6) -> M6 {
    M6::from_fn(|i, j| rows[i][j])
}

fn contact(normal: f64, tangential: f64) -> Contact {
    Contact {
        normal_stiffness_n_per_m3: normal,
        tangential_stiffness_n_per_m3: tangential,
        normal_damping_n_per_m3: 0.02 * normal,
        tangential_damping_n_per_m3: 0.05 * tangential,
    }
}

/// A rectangle of length l and width w about the origin, in n × n elements.
fn rectangle(l: f64, w: f64, n: usize) -> Vec<Element> {
    let at = |i: usize, size: f64| size * ((i as f64 + 0.5) / n as f64 - 0.5);
    (0..n * n)
        .map(|e| Element {
            x_m: at(e % n, l),
            y_m: at(e / n, w),
            area_m2: l * w / (n * n) as f64,
            pressure_pa: 1e6,
        })
        .collect()
}

fn joint(parts: &[(Element, Contact)], reference: [f64; 3]) -> InterfaceJoint {
    let parts = parts.iter().map(|(element, contact)| (element, *contact));
    InterfaceJoint::new(parts, reference, NormalDamping::Hysteretic).unwrap()
}

fn even(elements: &[Element], contact: Contact) -> Vec<(Element, Contact)> {
    elements.iter().map(|element| (*element, contact)).collect()
}

/// An irregular interface: pressures, places and areas without symmetry.
fn irregular() -> Vec<(Element, Contact)> {
    (0..40)
        .map(|k| {
            let t = f64::from(k);
            let element = Element {
                x_m: 0.05 * (1.3 * t).sin() + 0.01,
                y_m: 0.03 * (0.7 * t + 1.0).cos(),
                area_m2: 1e-5 * (1.5 + (2.1 * t).sin()),
                pressure_pa: 1e6,
            };
            let stiff = 1.2 + (0.9 * t).cos();
            (element, contact(3e11 * stiff, 1.4e11 * stiff * stiff))
        })
        .collect()
}

#[test]
fn an_even_rectangle_has_the_stiffnesses_of_the_textbook() {
    let (l, w, n) = (0.12, 0.07, 60);
    let (kn, kt) = (4e11, 2e11);
    let found = joint(&even(&rectangle(l, w, n), contact(kn, kt)), [0.0; 3]);
    let k = found.stiffness;
    let area = l * w;
    // Σ x² ΔA over the middles of n strips is (1 − 1/n²) l³ w/12
    let coarse = 1.0 - 1.0 / (n * n) as f64;
    let (ix, iy) = (coarse * l * w.powi(3) / 12.0, coarse * w * l.powi(3) / 12.0);
    let (tangential, normal) = (kt * area, kn * area);
    let expected = [
        tangential,
        tangential,
        normal,
        kn * ix,
        kn * iy,
        kt * (ix + iy),
    ];
    for i in 0..6 {
        assert!((k[i][i] / expected[i] - 1.0).abs() < 1e-12, "{i}");
        for j in 0..6 {
            let scale = (expected[i] * expected[j]).sqrt();
            assert!(i == j || k[i][j].abs() < 1e-12 * scale, "{i} {j}");
        }
    }
    assert!((found.normal_loss_factor() - 0.02).abs() < 1e-14);
    assert!((found.tangential_loss_factor() - 0.05).abs() < 1e-14);
}

/// The matrix by its definition, Σ Bᵀ diag(k_t, k_t, k_n) B ΔA with B = (I, −[r]×).
fn by_definition(
    parts: &[(Element, Contact)],
    reference: [f64; 3],
    of: impl Fn(&Contact) -> [f64; 2],
) -> M6 {
    let mut sum = M6::zeros();
    for (element, contact) in parts {
        let r = Vector3::new(element.x_m, element.y_m, 0.0) - Vector3::from(reference);
        let mut b = SMatrix::<f64, 3, 6>::zeros();
        b.fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&Matrix3::identity());
        b.fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&(-r.cross_matrix()));
        let [normal, tangential] = of(contact);
        let k = Matrix3::from_diagonal(&Vector3::new(tangential, tangential, normal));
        sum += b.transpose() * k * b * element.area_m2;
    }
    sum
}

#[test]
fn the_sums_are_those_of_the_definition() {
    let parts = irregular();
    for reference in [[0.0; 3], [0.02, -0.01, 0.004]] {
        let found = joint(&parts, reference);
        let stiffness = by_definition(&parts, reference, |c| {
            [c.normal_stiffness_n_per_m3, c.tangential_stiffness_n_per_m3]
        });
        let damping = by_definition(&parts, reference, |c| {
            [c.normal_damping_n_per_m3, c.tangential_damping_n_per_m3]
        });
        let matrices = [(found.stiffness, stiffness), (found.hysteretic, damping)];
        for (matrix, expected) in matrices {
            let difference = (to_matrix(&matrix) - expected).norm();
            assert!(difference < 1e-13 * expected.norm(), "{difference}");
        }
    }
}

#[test]
fn a_rigid_motion_of_one_side_meets_the_load_of_every_element() {
    // About the point (0, 0, h): side a turns by a small angle about y, so that an element at (x, y) is displaced by
    // θ ŷ × (x, y, −h) = (−h θ, 0, −x θ).
    let parts = irregular();
    let (h, angle) = (0.004, 1e-6);
    let found = joint(&parts, [0.0, 0.0, h]);
    let motion = SVector::<f64, 6>::from([0.0, 0.0, 0.0, 0.0, angle, 0.0]);
    let load = to_matrix(&found.stiffness) * motion;
    let mut expected = SVector::<f64, 6>::zeros();
    for (element, contact) in &parts {
        let (x, y) = (element.x_m, element.y_m);
        let fx = contact.tangential_stiffness_n_per_m3 * element.area_m2 * (-h * angle);
        let fz = contact.normal_stiffness_n_per_m3 * element.area_m2 * (-x * angle);
        // r × F with r = (x, y, −h)
        expected += SVector::from([fx, 0.0, fz, y * fz, -h * fx - x * fz, -y * fx]);
    }
    assert!((load - expected).norm() < 1e-12 * expected.norm());
}

/// The matrix about another point: with u' = u + θ × s, K' = Tᵀ K T.
fn shifted(matrix: &M6, by: [f64; 3]) -> M6 {
    let mut t = M6::identity();
    t.fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&Vector3::from(by).cross_matrix());
    t.transpose() * matrix * t
}

#[test]
fn another_reference_point_is_a_change_of_variables() {
    let parts = irregular();
    let at_origin = to_matrix(&joint(&parts, [0.0; 3]).stiffness);
    let point = [0.03, -0.02, 0.005];
    let direct = to_matrix(&joint(&parts, point).stiffness);
    // u(origin) = u(point) + θ × (origin − point) = u(point) + point × θ
    let moved = shifted(&at_origin, point);
    assert!((direct - moved).norm() < 1e-12 * direct.norm());
    // and about the centre of the normal stiffness a translation along z is alone: parallel axes
    let about_origin = joint(&parts, [0.0; 3]);
    let [x, y] = about_origin.normal_centre_m().unwrap();
    let centred = joint(&parts, [x, y, 0.0]);
    let (k, c) = (about_origin.stiffness, centred.stiffness);
    assert!(c[2][3].abs() + c[2][4].abs() < 1e-12 * k[2][2]);
    assert!((k[4][4] - c[4][4] - x * x * c[2][2]).abs() < 1e-12 * k[4][4]);
    assert!((k[3][3] - c[3][3] - y * y * c[2][2]).abs() < 1e-12 * k[3][3]);
}

#[test]
fn the_planar_part_has_the_signs_of_its_axes() {
    let parts = irregular();
    let found = joint(&parts, [0.0; 3]);
    let axis = |text| SignedAxis::parse(text).unwrap();
    let k = found.stiffness;
    let slope = Motions::in_plane(axis("z"), Some(axis("-y"))).unwrap();
    assert_eq!(slope.dofs(), DofSet::TRANSLATION_ROTATION);
    let part = slope.part(&k);
    // A deflection w(x) = w0 + θ x of side a, θ = dw/dx: F = Σ k_n ΔA (w0 + θ x) and M = Σ k_n ΔA x (w0 + θ x).
    let sums = parts.iter().fold([0.0; 3], |sums, (element, contact)| {
        let k = contact.normal_stiffness_n_per_m3 * element.area_m2;
        let x = element.x_m;
        [sums[0] + k, sums[1] + k * x, sums[2] + k * x * x]
    });
    for (i, j, expected) in [(0, 0, sums[0]), (0, 1, sums[1]), (1, 0, sums[1])] {
        assert!((part[i][j] / expected - 1.0).abs() < 1e-12, "{i} {j}");
    }
    assert!((part[1][1] / sums[2] - 1.0).abs() < 1e-12);
    let reversed = Motions::in_plane(axis("-z"), Some(axis("y"))).unwrap();
    assert_eq!(reversed.part(&k), slope.part(&k));
    let one = Motions::in_plane(axis("x"), None).unwrap();
    assert_eq!(one.dofs(), DofSet::TRANSLATION);
    assert_eq!(one.part(&k), [[k[0][0]]]);
    let message = Motions::in_plane(axis("z"), Some(axis("-z")))
        .unwrap_err()
        .to_string();
    has(&message, &["about the axis of the translation, -z"]);
    assert!(SignedAxis::parse("w").is_err());
}

#[test]
fn damping_is_converted_at_its_frequency_and_there_alone() {
    let parts = irregular();
    let found = joint(&parts, [0.0; 3]);
    assert_eq!(found.viscous, [[0.0; 6]; 6]);
    let frequency = 240.0;
    let omega = std::f64::consts::TAU * frequency;
    let converted = to_matrix(&found.viscous_at(frequency).unwrap()) * omega;
    let own = to_matrix(&found.hysteretic);
    assert!((converted - own).norm() < 1e-14 * own.norm());
    assert!(found.viscous_at(0.0).is_err() && found.hysteretic_at(f64::NAN).is_err());

    // Zhao's dashpot: C_N = η_N √(M K_N) along the normal, the tangential part stays hysteretic
    let mass_kg = 17.0;
    let borrowed = parts.iter().map(|(element, contact)| (element, *contact));
    let zhao = InterfaceJoint::new(borrowed, [0.0; 3], NormalDamping::Viscous { mass_kg }).unwrap();
    let stiffness = zhao.stiffness[2][2];
    let expected = zhao.normal_loss_factor() * (mass_kg * stiffness).sqrt();
    assert!((zhao.viscous[2][2] / expected - 1.0).abs() < 1e-13);
    assert_eq!(zhao.hysteretic[2][2], 0.0);
    assert_eq!(zhao.hysteretic[0][0], found.hysteretic[0][0]);
    // at the frequency of that mass on that spring both conversions are one
    let resonance = (stiffness / mass_kg).sqrt() / std::f64::consts::TAU;
    let [zhao_there, found_there] =
        [&zhao, &found].map(|joint| to_matrix(&joint.hysteretic_at(resonance).unwrap()));
    assert!((zhao_there - found_there).norm() < 1e-12 * found_there.norm());
}

#[test]
fn the_energy_of_a_cycle_tells_the_loss_factors_apart() {
    // x = X cos ωt on K (1 + jη): the force K x − (ηK/ω) ẋ… dissipates ∮F dx = π η K X² and stores ½ K X²
    let (k, eta, n) = (2e8, 0.03, 10_000);
    let mut dissipated = 0.0;
    for step in 0..n {
        let phase = std::f64::consts::TAU * (f64::from(step) + 0.5) / f64::from(n);
        let (x, per_phase) = (phase.cos(), -phase.sin());
        dissipated +=
            (k * x + eta * k * per_phase) * per_phase * std::f64::consts::TAU / f64::from(n);
    }
    let energy_ratio = dissipated / (0.5 * k);
    assert!((LossFactor::EnergyRatioOverTwoPi.of(energy_ratio) / eta - 1.0).abs() < 1e-9);
    assert_eq!(LossFactor::EnergyRatio.of(energy_ratio), energy_ratio);
}

proptest! {
    #[test]
    fn stiffness_and_damping_feed_no_energy(
        stiffnesses in proptest::collection::vec((0.0..1e12_f64, 0.0..1e12_f64), 1..30),
        reference in [-0.2..0.2_f64, -0.2..0.2, -0.1..0.1],
    ) {
        let parts: Vec<(Element, Contact)> = stiffnesses.iter().enumerate().map(|(place, &(normal, tangential))| {
            let t = place as f64;
            let element = Element { x_m: 0.1 * (1.7 * t).sin(), y_m: 0.1 * (2.9 * t).cos(), area_m2: 1e-5, pressure_pa: 0.0 };
            (element, contact(normal, tangential))
        }).collect();
        let found = joint(&parts, reference);
        for matrix in [&found.stiffness, &found.hysteretic, &found.viscous_at(100.0).unwrap()] {
            let matrix = to_matrix(matrix);
            prop_assert_eq!(matrix, matrix.transpose());
            let values = SymmetricEigen::new(matrix).eigenvalues;
            prop_assert!(values.min() >= -1e-12 * values.max());
        }
    }
}

#[test]
fn the_table_gives_every_matrix_back() {
    let found = joint(&irregular(), [0.01, 0.0, 0.002]);
    let text = table("Four M8\nand more", &found, 300.0).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("# Four M8 and more"));
    let rows: Vec<Vec<&str>> = text
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(rows[0], ["matrix", "row", "x", "y", "z", "rx", "ry", "rz"]);
    assert_eq!(rows.len(), 1 + 4 * 6);
    let total = found.viscous_at(300.0).unwrap();
    let blocks = [found.stiffness, found.hysteretic, found.viscous, total];
    for (block, matrix) in blocks.into_iter().enumerate() {
        for i in 0..6 {
            for j in 0..6 {
                let text = rows[1 + 6 * block + i][2 + j];
                assert_eq!(text.parse::<f64>().unwrap(), matrix[i][j]);
            }
        }
    }
}

#[test]
fn the_macro_holds_the_upper_triangle_of_both_nodes() {
    let found = joint(&irregular(), [0.0; 3]);
    let text = matrix27("joint $ one", &found, 300.0).unwrap();
    assert!(text.starts_with("! joint   one\n"), "{text}");
    let sets: Vec<Vec<f64>> = text
        .split("KEYOPT,")
        .filter(|part| part.contains("RMORE"))
        .map(|part| {
            let is_value = |line: &&str| line.starts_with("R,") || line.starts_with("RMORE");
            let lines: Vec<&str> = part.lines().filter(is_value).collect();
            assert_eq!(lines.len(), 13);
            let values = lines.iter().flat_map(|line| {
                let skipped = if line.starts_with("R,") { 2 } else { 1 };
                line.split(',').skip(skipped)
            });
            values.map(|value| value.parse().unwrap()).collect()
        })
        .collect();
    let damping = found.viscous_at(300.0).unwrap();
    for (constants, matrix) in sets.iter().zip([&found.stiffness, &damping]) {
        assert_eq!(constants.len(), 78);
        let mut full = [[0.0; 12]; 12];
        let mut next = constants.iter();
        for i in 0..12 {
            for j in i..12 {
                let value = *next.next().unwrap();
                full[i][j] = value;
                full[j][i] = value;
            }
        }
        let size = matrix[2][2];
        for i in 0..12 {
            for j in 0..12 {
                let sign = if (i < 6) == (j < 6) { 1.0 } else { -1.0 };
                let expected = sign * matrix[i % 6][j % 6];
                assert!((full[i][j] - expected).abs() <= 1e-11 * size, "{i} {j}");
            }
        }
        // Both nodes moved alike meet no load.
        for row in full {
            for dof in 0..6 {
                assert_eq!(row[dof] + row[dof + 6], 0.0);
            }
        }
    }
    assert_eq!(sets.len(), 2);
    for command in "ET,ARG3,MATRIX27 KEYOPT,ARG3,3,4 KEYOPT,ARG3+1,3,5 E,ARG1,ARG2".split(' ') {
        assert!(text.lines().any(|line| line == command), "{command}");
    }
}
