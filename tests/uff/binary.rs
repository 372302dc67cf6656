//! Binary data sets: all that pyuff writes, what others make of the format, and what is broken in it.

use bolted_joint::frf::{
    ByteOrder, Dof, FrfError, FrfSet, ReadOptions, Selection, read_uff58, write_uff58b,
    write_uff58b_to,
};
use bolted_joint_testing::{has, near};
use num_complex::Complex64;

use super::foreign::{is_oscillator, own_file};
use super::{dof, is_refused, oscillator, oscillators, read, read_text};

/// Receptance of a real accelerance: its imaginary part is lost before the division by −ω².
fn real_part_of_accelerance(hz: f64) -> Complex64 {
    let omega_squared = (std::f64::consts::TAU * hz).powi(2);
    let accelerance = -omega_squared * oscillator(hz);
    Complex64::new(accelerance.re / -omega_squared, 0.0)
}

#[test]
fn every_variant_that_pyuff_writes_gives_the_oscillator() {
    for (name, tolerance) in [
        ("binary_double_little.uff", 1e-14),
        ("binary_double_big.uff", 1e-14),
        ("binary_single_little.uff", 5e-6),
        ("binary_single_big.uff", 5e-6),
        ("binary_mislabelled.uff", 1e-14),
    ] {
        let reading = read(&own_file(name));
        let [even, uneven, real_even, real_uneven] = reading.functions() else {
            panic!("{name}: {} functions", reading.functions().len())
        };
        for (complex, real) in [(even, real_even), (uneven, real_uneven)] {
            is_oscillator(complex.receptance(), complex.frequency_hz(), 1.0, tolerance);
            assert_eq!(real.frequency_hz(), complex.frequency_hz());
            for (&found, &hz) in real.receptance().iter().zip(real.frequency_hz()) {
                let expected = real_part_of_accelerance(hz);
                let error = (found - expected).norm();
                assert!(error <= tolerance * oscillator(hz).norm(), "{name}");
            }
        }
        assert_eq!(even.frequency_hz().len(), 13);
        assert_eq!(even.frequency_hz()[12], 35.0);
        assert_eq!(uneven.frequency_hz().len(), 10);
        assert!((uneven.frequency_hz()[5] - 31.83).abs() <= tolerance * 31.83);
    }
}

#[test]
fn binary_and_ascii_sets_coherence_and_others_stand_in_any_order() {
    let options = ReadOptions {
        averages: Some(30.0),
        ..ReadOptions::default()
    };
    let reading = read_uff58(own_file("coherence.uff"), &options).unwrap();
    let [skipped] = reading.skipped_functions[..] else {
        panic!()
    };
    assert_eq!(skipped.kind, "auto spectrum");
    assert!(reading.units_are_stated());
    let set = reading.into_set().unwrap();
    let (y11, y12, y2) = (dof("11:Y"), dof("12:-Y"), dof("2:Y"));
    for (response, factor) in [(y11, 1.0), (y12, 0.5)] {
        let found = set.receptance(response, y2).unwrap();
        is_oscillator(&found, set.frequency_hz(), factor, 1e-11);
    }
    // γ² = 1/(1 + 0.01 i), so that σ²/|H|² = (1 − γ²)/((n − 2) γ²) is 0.01 i/28
    for response in [y11, y11.flipped()] {
        let variance = set.relative_variance(response, y2).unwrap();
        assert_eq!(set.relative_variance(y2, response).unwrap(), variance);
        for (index, found) in variance.iter().enumerate() {
            near(*found, 0.01 / 28.0 * (index + 1) as f64, 1e-9);
        }
    }
    assert_eq!(set.relative_variance(y12, y2), None);
    let part = set.restricted_to(10.0, 20.0).unwrap();
    assert_eq!(part.coherence(y11, y2).unwrap().len(), 5);
}

fn small_set(frequency_hz: &[f64]) -> FrfSet {
    let functions = [("11:Y", "2:Y", 1.0), ("12:RZ", "2:-Y", -0.3)];
    oscillators(frequency_hz, &functions)
}

fn written(frequency_hz: &[f64], order: ByteOrder) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_uff58b_to(&small_set(frequency_hz), &mut bytes, "binary", order).unwrap();
    bytes
}

const EVEN: [f64; 4] = [1.0, 1.5, 2.0, 2.5];
const UNEVEN: [f64; 4] = [1.0, 1.5, 2.25, 1_234.567_890_123_4];

#[test]
fn what_is_written_in_binary_comes_back_to_the_last_bit() {
    for order in [ByteOrder::Little, ByteOrder::Big] {
        for axis in [EVEN, UNEVEN] {
            let reading = read_text(written(&axis, order)).unwrap();
            assert!(reading.units_are_stated());
            assert_eq!(reading.into_set().unwrap(), small_set(&axis));
        }
    }
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("binary.uff");
    write_uff58b(&small_set(&UNEVEN), &path, "", ByteOrder::Big).unwrap();
    assert_eq!(read(&path).into_set().unwrap(), small_set(&UNEVEN));
}

/// Where the values of the first function begin, and how many bytes they are.
fn values_of_first(file: &[u8], lines: usize, bytes_per_line: usize) -> std::ops::Range<usize> {
    // 6 lines of units, 2 that begin the data set, 11 records
    let mut ends = (0..file.len()).filter(|&at| file[at] == b'\n');
    let begin = ends.nth(6 + 2 + 11 - 1).unwrap() + 1;
    begin..begin + lines * bytes_per_line
}

#[test]
fn frequencies_in_single_precision_beside_values_in_double_are_told_by_the_length() {
    let file = written(&UNEVEN, ByteOrder::Little);
    let range = values_of_first(&file, 4, 24);
    let mut other = file[..range.start].to_vec();
    for line in file[range.clone()].chunks(24) {
        let hz = f64::from_le_bytes(line[..8].try_into().unwrap());
        other.extend_from_slice(&(hz as f32).to_le_bytes());
        other.extend_from_slice(&line[8..]);
    }
    other.extend_from_slice(&file[range.end..]);
    let reading = read_text(&other).unwrap();
    let found = &reading.functions()[0];
    let set = small_set(&UNEVEN);
    let expected = set.receptance(dof("11:Y"), dof("2:Y")).unwrap();
    assert_eq!(found.receptance(), expected.values());
    assert_eq!(found.frequency_hz()[2], 2.25);
    assert_eq!(found.frequency_hz()[3], f64::from(1_234.567_9_f32));
}

#[test]
fn the_closing_line_may_stand_by_itself_and_binary_sets_of_other_types_are_skipped() {
    let file = written(&EVEN, ByteOrder::Little);
    let range = values_of_first(&file, 4, 16);
    for end_of_line in ["\n", "\r\n"] {
        let mut other = b"    -1\n  2414b     1     2           2          30     0     0           0           0\nNONE\nNONE\n".to_vec();
        other.extend_from_slice(b"\x00\xff\n    -17\n\n  -1    -1x9\x80\x81\x82\x83    -1\n");
        other.extend_from_slice(&file[..range.end]);
        other.extend_from_slice(end_of_line.as_bytes());
        other.extend_from_slice(&file[range.end..]);
        let reading = read_text(&other).unwrap();
        assert_eq!(reading.functions().len(), 2);
        assert_eq!(reading.skipped_datasets.len(), 1);
        assert_eq!(reading.into_set().unwrap(), small_set(&EVEN));
    }
}

#[test]
fn a_binary_file_cut_anywhere_is_an_error() {
    let file = written(&UNEVEN, ByteOrder::Little);
    for length in 1..file.len() - 1 {
        let cut = &file[..length];
        let between_sets = cut.trim_ascii_end().ends_with(b"    -1");
        assert!(read_text(cut).is_err() || between_sets, "{length}");
    }
}

#[test]
fn a_length_that_does_not_fit_is_refused_with_all_that_would() {
    let file = written(&EVEN, ByteOrder::Little);
    let changed = |from: &str, to: &str| {
        let mut parts = file.windows(from.len());
        let at = parts.position(|w| w == from.as_bytes()).unwrap();
        [&file[..at], to.as_bytes(), &file[at + from.len()..]].concat()
    };
    let four = "         6         4         1";
    let three = changed(four, "         6         3         1");
    is_refused(&three, 7, &["BinaryLength {", "lines: 3,", "Some(64)"]);
    is_refused(&three, 7, &["after 48 bytes", "says 64 bytes"]);
    for count in ["1000000000000", "18446744073709551615"] {
        let claims = changed(four, &format!("         6 {count} 1"));
        is_refused(&claims, 7, &["BinaryLength {"]);
        let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("claims.uff");
        std::fs::write(&path, claims).unwrap();
        assert!(read_uff58(&path, &ReadOptions::default()).is_err());
    }
    is_refused(changed("58b     1     2", "58b     1     1"), 8, &["VAX"]);
}

#[test]
fn only_what_is_asked_for_is_kept_and_the_rest_is_known_by_name() {
    let files = [
        written(&UNEVEN, ByteOrder::Big),
        written(&EVEN, ByteOrder::Little),
        {
            let mut bytes = Vec::new();
            bolted_joint::frf::write_uff58_to(&small_set(&EVEN), &mut bytes, "").unwrap();
            bytes
        },
    ];
    let wanted: [Dof; 2] = [dof("11:-Y"), dof("2:Y")];
    for file in files {
        let select = |selection| {
            let options = ReadOptions {
                selection,
                ..ReadOptions::default()
            };
            bolted_joint::frf::read_uff58_from(file.as_slice(), "memory.uff", &options)
        };
        let reading = select(Selection::between(wanted).within(1.5, 2.0)).unwrap();
        let [function] = reading.functions() else {
            panic!()
        };
        assert_eq!(function.response(), dof("11:Y"));
        assert_eq!(function.frequency_hz()[0], 1.5);
        let mut lines = function.frequency_hz().iter();
        assert!(lines.all(|hz| (1.5..=2.0).contains(hz)));
        let set = reading.into_set().unwrap();
        let error = set.receptance(dof("99:Y"), dof("2:Y")).unwrap_err();
        has(&error.to_string(), &["12:+RZ / 2:-Y"]);
        let error = select(Selection::everything().within(1.1, 1.2)).unwrap_err();
        assert!(matches!(error, FrfError::InFile { .. }));
        has(&error.to_string(), &["no line from 1.1 to 1.2 Hz"]);
    }
}
