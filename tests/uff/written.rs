//! Files that this package writes: their columns, and that they come back as they were.

use std::path::Path;

use bolted_joint::frf::{Dof, Frf, FrfError, FrfSet, write_uff58, write_uff58_to};
use bolted_joint_testing::has;
use num_complex::Complex64;
use proptest::prelude::*;

use super::{oscillators, read, read_text};

fn written(set: &FrfSet, description: &str) -> String {
    let mut bytes = Vec::new();
    write_uff58_to(set, &mut bytes, description).unwrap();
    String::from_utf8(bytes).unwrap()
}

fn set_over(frequency_hz: &[f64]) -> FrfSet {
    let functions = [
        ("11:Y", "2:Y", 1.0),
        ("11:-RZ", "2:Y", 3.0),
        ("4294967295:RX", "2:-RZ", -0.1),
        ("7:0", "2:Y", 2.0),
    ];
    oscillators(frequency_hz, &functions)
}

/// The standard's columns, to the letter.
#[test]
fn the_written_columns_are_those_of_the_standard() {
    let text = written(&set_over(&[1.0, 1.5, 2.0]), "demo\nof µ");
    let lines: Vec<&str> = text.lines().collect();
    let expected = [
        "    -1",
        "   164",
        "         1SI: Meter (newton)           2",
        "  1.00000000000000000D+00  1.00000000000000000D+00  1.00000000000000000D+00",
        "  2.73149999999999977D+02",
        "    -1",
        "    -1",
        "    58",
        "demo of ?",
    ];
    assert_eq!(lines[..9], expected);
    let expected = [
        "    4         0    0         0 NONE               7   0 NONE               2   2",
        "         6         3         1          1.0          0.5          0.0",
        "        18    0    0    0 Frequency            Hz                  ",
        "         8    0    0    0 NONE                 NONE                ",
        "        13    0    0    0 Force                N                   ",
        "         0    0    0    0 NONE                 NONE                ",
    ];
    assert_eq!(lines[13..19], expected);
    assert_eq!(lines[19].len(), 80);
    assert_eq!(lines[20].len(), 40);
    let rotation = "         8    0    0    0 Rotation             rad";
    let moment = "        13    0    0    0 Moment               N.m";
    has(&text, &[rotation, moment]);
    let described = |description: &str| written(&set_over(&[1.0]), description);
    has(&described("  "), &["    58\nNONE\n"]);
    let cut = format!("\n{}\n", "x".repeat(80));
    has(&described(&"x".repeat(100)), &[cut]);
}

fn assert_same(set: &FrfSet, frequency_tolerance: f64) {
    let reading = read_text(written(set, "round trip")).unwrap();
    assert!(reading.units_are_stated());
    let back = reading.into_set().unwrap();
    assert_eq!(back.line_count(), set.line_count());
    for (found, expected) in back.frequency_hz().iter().zip(set.frequency_hz()) {
        let error = (found - expected).abs();
        assert!(
            error <= frequency_tolerance * expected,
            "{found} {expected}"
        );
    }
    assert_eq!(back.functions().len(), set.functions().len());
    for (found, expected) in back.functions().zip(set.functions()) {
        assert_eq!((found.0, found.1), (expected.0, expected.1));
        for (value, original) in found.2.iter().zip(expected.2) {
            // 13 digits: half a unit of the last one.
            assert!((value.re - original.re).abs() <= 5.01e-13 * original.re.abs());
            assert!((value.im - original.im).abs() <= 5.01e-13 * original.im.abs());
        }
    }
}

#[test]
fn axes_of_every_kind_come_back() {
    let axis = |first: f64, step: f64, lines: usize| -> Vec<f64> {
        (0..lines).map(|i| first + i as f64 * step).collect()
    };
    for (frequency_hz, is_even) in [
        (axis(0.0, 0.25, 9), true),
        (axis(5.0, 1.0 / 3.0, 100), true),
        (axis(0.1, 0.1, 50), true),
        (axis(12_345.678, 1e-3, 30), true),
        (vec![1.0, 2.0, 4.0, 8.0], false),
        (vec![10.0, 10.028_777_546_57, 1_234.567_890_123_4], false),
        (vec![1e-7, 2.5e-3, 0.1, 123_456_789.25], false),
        (vec![42.0], true),
    ] {
        let set = set_over(&frequency_hz);
        let spacing = written(&set, "").lines().nth(14).unwrap()[20..30].trim() == "1";
        assert_eq!(spacing, is_even, "{frequency_hz:?}");
        assert_same(&set, 1e-9);
    }
}

#[test]
fn a_written_file_is_there_whole_or_not_at_all() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("written");
    std::fs::create_dir_all(&folder).unwrap();
    let even = folder.join("even.uff");
    write_uff58(&set_over(&[1.0, 1.5, 2.0]), &even, "even").unwrap();
    let uneven = set_over(&[1.0, 1.503, 2.25, 1_234.567_890_12]);
    write_uff58(&uneven, folder.join("uneven.uff"), "uneven").unwrap();
    assert_eq!(read(&even).functions().len(), 4);
    for entry in std::fs::read_dir(&folder).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(!name.ends_with(".part"), "{name}");
    }
    let error = write_uff58(&set_over(&[1.0]), folder.join("missing/even.uff"), "").unwrap_err();
    assert!(matches!(error, FrfError::Write { .. }));
}

fn any_dof() -> impl Strategy<Value = Dof> {
    (any::<u32>(), -6..=6_i32).prop_map(|(node, code)| Dof::from_uff(node, code).unwrap())
}

fn any_part() -> impl Strategy<Value = f64> {
    prop_oneof![
        -1e3..1e3,
        -1e-12..1e-12,
        any::<f64>().prop_filter("finite and normal", |x| x.is_normal()),
        Just(0.0)
    ]
}

fn any_set() -> impl Strategy<Value = FrfSet> {
    let axis = prop::collection::btree_set(0..4_000_000_u32, 1..20);
    let pairs = prop::collection::btree_set((any_dof(), any_dof()), 1..4);
    (axis, pairs).prop_flat_map(|(axis, pairs)| {
        let frequency_hz: Vec<f64> = axis
            .into_iter()
            .map(|thousandths| f64::from(thousandths) / 1000.0)
            .collect();
        let lines = frequency_hz.len();
        let values = prop::collection::vec(
            prop::collection::vec((any_part(), any_part()), lines),
            pairs.len(),
        );
        values.prop_map(move |values| {
            let pairs = pairs.iter().zip(values);
            let functions = pairs.map(|(&(response, reference), values)| {
                let values = values.into_iter().map(|(re, im)| Complex64::new(re, im));
                let axis = frequency_hz.clone();
                Frf::new(response, reference, axis, values.collect()).unwrap()
            });
            FrfSet::new(functions.collect()).unwrap()
        })
    })
}

proptest! {
    #[test]
    fn whatever_is_written_is_read_back(set in any_set()) {
        assert_same(&set, 1e-9);
    }
}

#[cfg(unix)]
#[test]
fn a_link_stays_one_and_its_target_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let (link, target) = (
        folder.path().join("link.uff"),
        folder.path().join("target.uff"),
    );
    std::os::unix::fs::symlink("target.uff", &link).unwrap();
    // at first the target does not exist
    for _ in 0..2 {
        write_uff58(&set_over(&[1.0, 1.5]), &link, "linked").unwrap();
        assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
        assert!(std::fs::symlink_metadata(&target).unwrap().is_file());
    }
}
