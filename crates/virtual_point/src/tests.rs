//! The whole against check values of a NumPy program, against another program, and against exact cases.

use bolted_joint_space::{Dof, Motions};
use bolted_joint_testing::{close, near};
use nalgebra::{DMatrix, Vector3};
use num_complex::Complex64;

use crate::samples::*;
use crate::{Impact, Noise, Role, Sensor, SetUp, VirtualPoint, Weights};

/// Numbers of a NumPy program with the same definitions: three triaxial sensors, seven impacts, a row 10 % too large.
#[test]
fn check_values() {
    let point = equal(check_set_up());
    let (t_u, t_f) = (point.motions_of_channels(), point.forces_of_loads());
    let (channels, impacts) = (
        point.conditioning(Role::Channel),
        point.conditioning(Role::Impact),
    );
    for (found, expected) in [
        (t_u[(3, 0)], -0.196_958_171_71),
        (t_u[(5, 7)], 0.245_870_198_78),
        (t_f[(6, 3)], -17.020_749_582),
        (t_f[(0, 4)], -15.128_885_735),
        (channels.condition, 3.735_338_847_4),
        (impacts.condition, 3.297_934_428_2),
        (channels.length_m, 3.628_590_176_2e-2),
        (impacts.length_m, 3.545_621_041_7e-2),
    ] {
        close(found, expected, 1e-10);
    }
    let found = point.receptance(&check_functions()).unwrap();
    let expected = Complex64::new(4.481_219_947_6e-6, -1.338_027_602_4e-6);
    same(found[(0, 0)], expected, 1e-10);
    let expected = Complex64::new(-3.356_566_467_8e-8, -2.165_466_367_8e-9);
    same(found[(3, 5)], expected, 1e-10);
}

/// Lines at 100, 150 and 230 Hz of the check values without gains: row 0 is 10 % too large, row 5 turned round, column
/// 2 10 % too small.
fn bad_lines() -> (SetUp, Vec<DMatrix<Complex64>>) {
    let set_up = SetUp::new(&triaxials([[1.0; 3]; 3]), &impacts()).unwrap();
    let lines = [100.0, 150.0, 230.0].map(|frequency_hz| {
        let mut functions = set_up.functions(&check_receptance(frequency_hz));
        functions.row_mut(0).scale_mut(1.1);
        functions.row_mut(5).scale_mut(-1.0);
        functions.column_mut(2).scale_mut(0.9);
        functions
    });
    (set_up, lines.to_vec())
}

/// pyFBS 1.0.7 (`VPT`, `apply_vpt`, `consistency`) on the same functions. Its `wf` is the inverse of these
/// weights; with it, its consistency of the impacts is that of another projection, and is left out.
#[test]
fn as_pyfbs() {
    let (set_up, lines) = bad_lines();
    let point = equal(set_up.clone());
    #[rustfmt::skip]
    let expected = [
        (0, 0, 0, 4.455348269959e-06, -1.280947921447e-06),
        (1, 3, 5, -1.320767847744e-06, 2.362235717866e-07),
        (2, 4, 1, -4.297731652530e-07, -1.533943881700e-07),
    ];
    agree_at(&point, &lines, &expected);
    let overall = [0.997657420707, 0.997745597940, 0.982813271831];
    let specific = [
        0.968730730256,
        0.996917611254,
        0.999899349580,
        0.991910710184,
        0.972997066610,
        0.999027732626,
        0.970937203097,
        0.954698366542,
        0.999608790117,
    ];
    consistent(&point, Role::Channel, &lines, &overall, &specific);
    let overall = [0.999696119233, 0.999990559674, 0.999951979241];
    let specific = [
        0.992247652096,
        0.999715736859,
        0.999870301363,
        0.999752850066,
        0.999947711681,
        0.999980102032,
        0.999935463660,
    ];
    consistent(&point, Role::Impact, &lines, &overall, &specific);

    let (channels, impacts) = (sine_weights(9, 0.0), sine_weights(7, 1.0));
    let point = VirtualPoint::new(set_up, &channels, &impacts).unwrap();
    #[rustfmt::skip]
    let expected = [
        (0, 0, 0, 4.425543125426e-06, -1.249689561996e-06),
        (1, 3, 5, -7.114543346690e-06, 1.315368777043e-06),
        (2, 4, 1, -1.126813421705e-06, -4.021815910781e-07),
    ];
    agree_at(&point, &lines, &expected);
    let overall = [1.000171004358, 1.005382854285, 1.041157520244];
    let specific = [
        0.979379106469,
        0.990646021437,
        0.999900338245,
        0.998232052310,
        0.962025919040,
        0.999703813348,
        0.982161220763,
        0.936690327427,
        0.999030848220,
    ];
    consistent(&point, Role::Channel, &lines, &overall, &specific);
}

#[track_caller]
fn agree_at(
    point: &VirtualPoint,
    lines: &[DMatrix<Complex64>],
    expected: &[(usize, usize, usize, f64, f64)],
) {
    let found = point.receptances(lines).unwrap();
    for &(line, row, column, re, im) in expected {
        same(found[line][(row, column)], Complex64::new(re, im), 1e-8);
    }
}

#[track_caller]
fn consistent(
    point: &VirtualPoint,
    role: Role,
    lines: &[DMatrix<Complex64>],
    overall: &[f64],
    specific: &[f64],
) {
    let found = point.consistency(role, lines).unwrap().unwrap();
    assert_eq!(found.overall.len(), overall.len());
    assert_eq!(found.specific.len(), specific.len());
    for (found, expected) in found.overall.iter().zip(overall) {
        near(*found, *expected, 1e-10);
    }
    for (found, expected) in found.specific.iter().zip(specific) {
        near(*found, *expected, 1e-10);
    }
}

/// NumPy's product with the whole Kronecker matrix, for noise 1 + sin(7 i + j)/2 of channel i and impact j.
#[test]
fn covariance_as_numpy() {
    let (set_up, _) = bad_lines();
    let (channels, impacts) = (sine_weights(9, 0.0), sine_weights(7, 1.0));
    let point = VirtualPoint::new(set_up, &channels, &impacts).unwrap();
    let each = DMatrix::from_fn(9, 7, |i, j| 1.0 + 0.5 * ((7 * i + j) as f64).sin());
    let covariance = point.noise_covariance(&Noise::Each(each)).unwrap();
    for (row, column, expected) in [
        (0, 0, 2.436558255010),
        (7, 7, 0.9398578152341),
        (3, 20, -158.1408344635),
        (35, 34, 50946.93596562),
    ] {
        close(covariance.hermitian[(row, column)].re, expected, 1e-9);
    }
}

/// T_u R_u = I, R_fᵀ T_f = I, and the receptance comes back from functions of a rigid interface, with any weights.
#[test]
fn a_rigid_interface_gives_back_its_receptance() {
    let mut mixed = Mixed(2_000);
    let diagonal: Vec<_> = (0..12).map(|_| 2.0 + mixed.next()).collect();
    let full = Weights::Full(mixed.definite(12));
    let set_up = disordered(4);
    let functions = set_up.functions(&full_receptance(2));
    for (channels, impacts) in [
        (&Weights::Equal, &full),
        (&full, &Weights::Diagonal(diagonal.clone())),
    ] {
        let point = VirtualPoint::new(set_up.clone(), channels, impacts).unwrap();
        let unit = DMatrix::<f64>::identity(6, 6);
        let left = point.motions_of_channels() * set_up.channels().matrix();
        assert!((left - &unit).amax() < 1e-12);
        let right = set_up.impacts().matrix().transpose() * point.forces_of_loads();
        assert!((right - &unit).amax() < 1e-12);
        let found = point.receptance(&functions).unwrap() - full_receptance(2);
        assert!(found.norm() < 1e-11 * full_receptance(2).norm());
        let motions = point.motions(&functions).unwrap();
        let both = point.responses(&motions).unwrap();
        let expected = point.receptance(&functions).unwrap();
        let expected = DMatrix::from_fn(6, 6, |i, j| expected[(i, j)]);
        assert!(apart(&both, &expected) < 1e-12);
    }
    // a diagonal of ones, and a full matrix of it, are equal weights
    let ones = Weights::Diagonal(vec![1.0; 12]);
    let unit = Weights::Full(DMatrix::identity(12, 12));
    let same = VirtualPoint::new(set_up.clone(), &ones, &unit).unwrap();
    assert_eq!(same, equal(set_up));
}

/// Of a beam along x that bends along y: deflections at places along it tell y and its slope.
fn in_a_plane(sensors_m: &[f64], impacts_m: &[f64]) -> SetUp {
    let place = |&x: &f64| Vector3::new(x, 0.0, 0.0);
    let sensor = |x| Sensor::uniaxial(place(x), Vector3::y(), 1.0).unwrap();
    let impact = |x| Impact::new(place(x), Vector3::y(), 1.0).unwrap();
    let sensors: Vec<_> = sensors_m.iter().map(sensor).collect();
    let impacts: Vec<_> = impacts_m.iter().map(impact).collect();
    let plane = Motions::of(&[Dof::Y, Dof::Rz]).unwrap();
    SetUp::new(&sensors, &impacts).unwrap().in_motions(plane)
}

#[test]
fn two_deflections_are_a_virtual_point_in_a_plane() {
    let point = equal(in_a_plane(&[-0.01, 0.05], &[0.0, 0.04]));
    let (t_u, t_f) = (point.motions_of_channels(), point.forces_of_loads());
    // y = u₁ + (u₂ − u₁)/6, θ = (u₂ − u₁)/60 mm; f₁ + f₂ = f, 40 mm f₂ = m
    let expected_u = [(1, [5.0 / 6.0, 1.0 / 6.0]), (5, [-1.0 / 0.06, 1.0 / 0.06])];
    let expected_f = [(1, [1.0, 0.0]), (5, [-25.0, 25.0])];
    for (n, expected) in expected_u {
        for (channel, expected) in expected.into_iter().enumerate() {
            near(t_u[(n, channel)], expected, 1e-12);
        }
    }
    for (n, expected) in expected_f {
        for (impact, expected) in expected.into_iter().enumerate() {
            near(t_f[(impact, n)], expected, 1e-12);
        }
    }
    for n in [0, 2, 3, 4] {
        assert!(
            t_u.row(n)
                .iter()
                .chain(t_f.column(n).iter())
                .all(|own| *own == 0.0)
        );
    }
}

#[test]
fn a_plane_asks_for_two_places_that_differ() {
    let refused = |sensors_m: &[f64]| {
        let set_up = in_a_plane(sensors_m, &[0.0, 0.04]);
        VirtualPoint::new(set_up, &Weights::Equal, &Weights::Equal)
            .unwrap_err()
            .to_string()
    };
    let few = "channels: found 1, expected 2 or more";
    assert!(refused(&[0.01]).starts_with(few), "{}", refused(&[0.01]));
    let alike = refused(&[0.01, 0.01]);
    let expected = "channels: found rank 1, expected 2: no channel sees the rotation about the line through (0.01, 0, 0) m along (0, 0, 1)";
    assert!(alike.starts_with(expected), "{alike}");
}

/// A channel 10 % too large among five, and derivatives by differences.
#[test]
fn what_is_wrong_in_a_plane_is_found() {
    let set_up = in_a_plane(&[-0.04, -0.02, 0.0, 0.03, 0.05], &[-0.03, 0.0, 0.03]);
    let point = equal(set_up.clone());
    let receptance = full_receptance(0);
    let mut lines: Vec<_> = (0..3)
        .map(|n| set_up.functions(&full_receptance(n)))
        .collect();
    for line in &mut lines {
        line.row_mut(3).scale_mut(1.1);
    }
    let suspects = point.suspects(Role::Channel, &lines).unwrap().unwrap();
    assert_eq!(suspects.bad, Some(crate::Place::Channel(3)));
    near(suspects.ranked[0].diagnosis.gains[0], 1.1, 1e-9);
    let functions = set_up.functions(&receptance);
    let step = 1e-7;
    for (p, derivative) in point.derivatives(&functions).unwrap().iter().enumerate() {
        let moved = |size: f64| {
            let mut errors = vec![0.0; set_up.parameters().len()];
            errors[p] = size;
            equal(set_up.displaced(&errors).unwrap())
                .receptance(&functions)
                .unwrap()
        };
        let difference = (moved(step) - moved(-step)) / Complex64::from(2.0 * step);
        assert!(
            (difference - derivative).norm() < 1e-6 * receptance.norm() * 50.0,
            "{p}"
        );
    }
}
