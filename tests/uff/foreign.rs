//! Files of other programs: shared ones, and small ones written with pyuff (see tests/data/uff/README.md).

use bolted_joint_testing::has;
use std::path::{Path, PathBuf};

use bolted_joint::frf::{Dof, Frf, Quantity, ReadOptions, read_uff58};
use num_complex::Complex64;

use super::{dof, oscillator, read};

/// A file of the shared folder beside the package, or a message why the test has nothing to do.
fn shared_file(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../shared/data/uff")
        .join(name);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: {} is not here", path.display());
    None
}

/// A line as an independent reader (pyuff 2.5.8) gives it: index, frequency in Hz, value in the file's quantity.
type Line = (usize, f64, [f64; 2]);

/// Compares with lines of the file, whose index counts from its first line, and with the sum from index 1 on.
fn compare(function: &Frf, quantity: Quantity, left_out: usize, lines: &[Line], sum: [f64; 2]) {
    let measured: Vec<Complex64> = function
        .frequency_hz()
        .iter()
        .zip(function.receptance())
        .map(|(&hz, &receptance)| quantity.from_receptance(receptance, hz))
        .collect();
    for &(index, hz, [re, im]) in lines {
        assert_eq!(function.frequency_hz()[index - left_out], hz);
        let expected = Complex64::new(re, im);
        let found = measured[index - left_out];
        is_near(found, expected, 1e-15 * expected.norm());
    }
    let total: Complex64 = measured.iter().skip(1 - left_out).sum();
    let [re, im] = sum;
    let magnitudes: f64 = measured.iter().map(|value| value.norm()).sum();
    is_near(total, Complex64::new(re, im), 1e-14 * magnitudes);
}

#[track_caller]
fn is_near(found: Complex64, expected: Complex64, most: f64) {
    let error = (found - expected).norm();
    assert!(error <= most, "{found}, not {expected}");
}

#[test]
fn a_measured_dam_is_read_as_accelerance_without_stated_units() {
    let Some(path) = shared_file("dam0.unv") else {
        return;
    };
    let reading = read(&path);
    assert!(!reading.units_are_stated());
    assert!(reading.skipped_functions.is_empty());
    assert!(reading.skipped_datasets.is_empty());
    let functions = reading.functions().iter();
    let responses: Vec<u32> = functions.map(|one| one.response().node()).collect();
    assert_eq!(responses, (1..=13).chain(101..=113).collect::<Vec<_>>());
    #[rustfmt::skip]
    let cases = [
        (0, "1:X",
         [(1, 0.03125, [-0.000_589_24, -2.941_58e-5]), (100, 3.125, [-5.960_65e-8, 2.980_32e-8]), (400, 12.5, [1.400_75e-6, 1.430_56e-6])],
         [-0.000_522_391_352_100_000_1, -7.772_680_88e-5]),
        (4, "5:X",
         [(1, 0.03125, [9.825_75e-6, -1.443_69e-5]), (100, 3.125, [-1.955_84e-7, -1.5833e-8]), (400, 12.5, [4.004_81e-7, -1.974_46e-7])],
         [9.589_381_886e-5, 5.379_755_967e-5]),
        (25, "113:X", [(1, 0.03125, [0.000_327_344, 2.026_62e-6]), (100, 3.125, [-1.490_16e-8, 0.0]), (400, 12.5, [6.556_71e-7, 0.0])],
         [0.000_342_588_332_399_999_95, 4.452_592_769_999_999_5e-5]),
    ];
    for (index, response, lines, sum) in cases {
        let function = &reading.functions()[index];
        assert_eq!(pair(function), (dof(response), dof("3:X")));
        // The line at 0 Hz gives no receptance.
        assert_eq!(function.frequency_hz().len(), 400);
        compare(function, Quantity::Accelerance, 1, &lines, sum);
    }
    let set = reading.into_set().unwrap();
    assert_eq!(set.line_count(), 400);
    let reversed = set.receptance(dof("3:X"), dof("101:X")).unwrap();
    assert!(reversed.is_reciprocal());
}

fn pair(function: &Frf) -> (Dof, Dof) {
    (function.response(), function.reference())
}

#[test]
fn every_ascii_variant_of_the_format_is_read() {
    let real_sum = [0.007_918_374_133_629_998, 0.0];
    let complex_sum = [0.007_145_920_893_859_999, 0.000_772_453_239_769_999_5];
    let middle = [5.866_55e-6, 8.047_93e-7];
    let last = [5.128_74e-5, -4.269_21e-5];
    #[rustfmt::skip]
    let variants: [(u8, usize, &[Line], [f64; 2]); 5] = [
        (1, 1, &[(1, 0.25, [0.0, 0.0]), (100, 25.0, [7.737_14e-7, 0.0]), (1601, 400.25, [-4.269_21e-5, 0.0])], real_sum),
        (2, 0, &[(1, 10.0288, [0.0, 0.0]), (100, 13.3328, [7.737_14e-7, 0.0]), (1601, 1000.0, [-4.269_21e-5, 0.0])], real_sum),
        (3, 1, &[(100, 25.0, middle), (800, 200.0, last)], complex_sum),
        (4, 0, &[(100, 17.7828, middle), (800, 1000.0, last)], complex_sum),
        (5, 1, &[(100, 25.0, [7.737_140_208_519e-7, 0.0]), (1601, 400.25, [-4.269_209_966_878e-5, 0.0])],
         [0.007_918_374_044_922_87, 0.0]),
    ];
    for (case, left_out, lines, sum) in variants {
        let Some(path) = shared_file(&format!("dataset58_case{case}_ascii.unv")) else {
            return;
        };
        let reading = read(&path);
        let [function] = reading.functions() else {
            panic!("case {case}")
        };
        assert_eq!(pair(function), (dof("1:X"), dof("22:X")));
        compare(function, Quantity::Accelerance, left_out, lines, sum);
    }
}

#[test]
fn a_label_that_contradicts_its_units_needs_the_callers_word() {
    let Some(path) = shared_file("dataset58_FRF.unv") else {
        return;
    };
    let error = read_uff58(&path, &ReadOptions::default()).unwrap_err();
    let problem = [
        "line: 11",
        "ContradictingQuantities {",
        "first: Mobility",
        "second: Receptance",
    ];
    has(&format!("{error:?}"), &problem);
    let message = error.to_string();
    has(&message, &["dataset58_FRF.unv, line 11", "(m/s)/N"]);
    has(&message, &["\"Receptance\"", "state the quantity"]);
    let options = ReadOptions {
        quantity: Some(Quantity::Mobility),
        ..ReadOptions::default()
    };
    let reading = read_uff58(&path, &options).unwrap();
    let [function] = reading.functions() else {
        panic!()
    };
    // Node and direction stand in the entity names; the two filling values after line 1600 are none.
    assert_eq!(pair(function), (dof("1:-Z"), dof("56:Z")));
    assert_eq!(function.frequency_hz().len(), 1599);
    assert!(reading.units_are_stated());
    let lines = [
        (1, 0.5, [-1.293_02, -0.927_769]),
        (100, 50.0, [0.619_649, 0.279_415]),
        (1599, 799.5, [-5.356_54, 2.127_43]),
    ];
    let sum = [-585.789_618_320_000_3, -403.785_522_445_6];
    compare(function, Quantity::Mobility, 1, &lines, sum);
}

#[test]
fn every_binary_variant_holds_what_its_ascii_twin_prints() {
    for case in 1..=5 {
        let name = |form: &str| shared_file(&format!("dataset58_case{case}_{form}.unv"));
        let (Some(ascii), Some(binary)) = (name("ascii"), name("binary")) else {
            return;
        };
        let (ascii, binary) = (read(&ascii), read(&binary));
        let ([printed], [stored]) = (ascii.functions(), binary.functions()) else {
            panic!()
        };
        assert_eq!(pair(stored), pair(printed));
        assert_eq!(stored.frequency_hz().len(), printed.frequency_hz().len());
        // Six printed digits, twelve in double precision (case 5).
        let tolerance = if case == 5 { 1e-11 } else { 5.1e-6 };
        for (a, b) in stored.frequency_hz().iter().zip(printed.frequency_hz()) {
            assert!((a - b).abs() <= 5.1e-6 * b, "case {case}: {a} {b}");
        }
        let lines = stored.receptance().iter().zip(printed.receptance());
        for ((a, b), hz) in lines.zip(printed.frequency_hz()) {
            // ω² differs with the digits of an uneven frequency.
            let tolerance = if case % 2 == 0 { 1.6e-5 } else { tolerance };
            assert!(
                (a - b).norm() <= tolerance * b.norm(),
                "case {case}, {hz} Hz: {a} {b}"
            );
        }
    }
}

pub(crate) fn own_file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data/uff")
        .join(name)
}

pub(crate) fn is_oscillator(
    found: &[Complex64],
    frequency_hz: &[f64],
    factor: f64,
    tolerance: f64,
) {
    for (&value, &hz) in found.iter().zip(frequency_hz) {
        let expected = factor * oscillator(hz);
        is_near(value, expected, tolerance * expected.norm());
    }
}

#[test]
fn double_precision_files_of_pyuff_give_the_oscillator_to_their_last_digit() {
    let set = read(&own_file("even_double.uff")).into_set().unwrap();
    assert_eq!(set.line_count(), 13);
    assert_eq!(set.frequency_hz()[12], 35.0);
    let found = set.receptance(dof("11:Y"), dof("2:Y")).unwrap();
    is_oscillator(&found, set.frequency_hz(), 1.0, 1e-11);
    let reversed = set.receptance(dof("2:Y"), dof("12:Y")).unwrap();
    assert!(reversed.is_reciprocal() && reversed.is_negated());
    is_oscillator(&reversed, set.frequency_hz(), -0.5, 1e-11);

    let set = read(&own_file("uneven_double.uff")).into_set().unwrap();
    assert_eq!(set.frequency_hz()[4..6], [31.5, 31.83]);
    let found = set.receptance(dof("11:Y"), dof("2:Y")).unwrap();
    is_oscillator(&found, set.frequency_hz(), 1.0, 1e-11);
}

#[test]
fn single_precision_files_of_pyuff_give_six_digits() {
    let reading = read(&own_file("uneven_single.uff"));
    assert!(!reading.units_are_stated());
    let set = reading.into_set().unwrap();
    let found = set.receptance(dof("11:Y"), dof("2:Y")).unwrap();
    is_oscillator(&found, set.frequency_hz(), 1.0, 5e-6);
}

#[test]
fn millimetres_become_metres_by_the_kinds_of_both_ends() {
    let reading = read(&own_file("millimetres.uff"));
    assert!(reading.units_are_stated());
    assert!(reading.skipped_functions.is_empty());
    let [coherence] = &reading.coherences[..] else {
        panic!()
    };
    assert_eq!(coherence.gamma_squared, [1.0; 13]);
    let set = reading.into_set().unwrap();
    for (response, reference, factor) in [
        ("11:Y", "2:Y", 1.0),
        ("11:RZ", "2:Y", 2.0),
        ("11:RZ", "2:RZ", 3.0),
    ] {
        let found = set.receptance(dof(response), dof(reference)).unwrap();
        is_oscillator(&found, set.frequency_hz(), factor, 5e-6);
    }
}
