//! Broken files: every fault is named with its line; and harmless differences are no faults.

use bolted_joint::frf::{FrfError, ReadOptions, UnitSystem, read_uff58, read_uff58_from};
use bolted_joint_testing::has;
use num_complex::Complex64;
use proptest::prelude::*;

use super::{is_refused, problem_of, read_text};

const HEADER: &str = "    -1\n    58\nNONE\nNONE\nNONE\nNONE\nNONE
    4         0    0         0 NONE              11   2 NONE               2   2
         5         3         1  1.00000E+00  5.00000E-01  0.00000E+00
         8    0    0    0 NONE                 NONE
";

/// One receptance with three lines; its values are lines 14 and on.
fn small(values: &str) -> String {
    let header = HEADER.replacen("         8    0", "        18    0", 1);
    format!(
        "{header}         8    0    0    0 NONE                 NONE\n        13    0    0    0 NONE                 NONE\n         0    0    0    0 NONE                 NONE\n{values}    -1\n"
    )
}

const VALUES: &str =
    "  1.00000E+00  2.00000E+00  3.00000E+00  4.00000E+00  5.00000E+00  6.00000E+00\n";

#[test]
fn the_small_file_is_good_in_every_dress() {
    let expected: Vec<Complex64> = [(1.0, 2.0), (3.0, 4.0), (5.0, 6.0)]
        .map(|(re, im)| Complex64::new(re, im))
        .into();
    let good = small(VALUES);
    let latin_1 = {
        let mut bytes = good.replacen("NONE", "Tr?ger", 1).into_bytes();
        let at = bytes.iter().position(|byte| *byte == b'?').unwrap();
        bytes[at] = 0xE4;
        bytes
    };
    for dress in [
        good.clone().into_bytes(),
        good.replace('\n', "\r\n").into_bytes(),
        good.replace("E+", "D+").into_bytes(),
        good.replacen("NONE", "Träger", 1).into_bytes(),
        latin_1,
        format!("\u{feff}{good}\n\n").into_bytes(),
        format!("    -1\n  2411\nanything at all\n        -1         1\n    -1\n{good}")
            .into_bytes(),
        good.trim_end().as_bytes().to_vec(),
    ] {
        let reading = read_text(&dress).unwrap();
        let [function] = reading.functions() else {
            panic!()
        };
        assert_eq!(function.receptance(), expected);
        assert_eq!(function.frequency_hz(), [1.0, 1.5, 2.0]);
    }
    let after_other = read_text(format!("    -1\n  2411\n\n    -1\n{good}")).unwrap();
    let skipped = after_other.skipped();
    assert_eq!(skipped, ["1 × data set 2411 (nodes)"]);
}

#[test]
fn what_is_no_universal_file_is_said_to_be_none() {
    is_refused("", 1, &["Empty"]);
    is_refused("\n \n", 1, &["Empty"]);
    let png = b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR\x00\x00\x01\x00";
    let (line, problem) = problem_of(png);
    assert_eq!(line, 1);
    let message = problem.to_string();
    has(&message, &["PNG", "UFF 58"]);
    assert!(message.chars().all(|c| !c.is_control()));
    let table = "frequency,real,imaginary";
    let found = format!("NotUniversalFile {{ found: {table:?} }}");
    is_refused(format!("\n{table}\n1,2,3\n"), 2, &[&found]);
    let random: Vec<u8> = (0..200_000_u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8 | 0x80)
        .collect();
    is_refused(random, 1, &["LineTooLong {"]);
    let error = read_uff58("no/such.uff", &ReadOptions::default()).unwrap_err();
    assert!(matches!(&error, FrfError::Read { .. }) && error.to_string().contains("no/such.uff"));
}

#[test]
fn broken_structure_is_located() {
    let good = small(VALUES);
    let junk = "BetweenDatasets { found: \"junk\" }";
    is_refused(format!("{good}junk\n"), 16, &[junk]);
    let fifty = "DatasetNumber { found: \"fifty\" }";
    is_refused(good.replacen("    58", "fifty", 1), 2, &[fifty]);
    let (header_only, _) = good.split_once("         5         3").unwrap();
    let ends = ["HeaderEnds {", "begun_at: 1,", "found: 6,", "expected: 11"];
    is_refused(format!("{header_only}    -1\n"), 9, &ends);
    let units = "    -1\n   164\n         1\n    -1\n";
    is_refused(units, 4, &["HeaderEnds {", "dataset: 164"]);
}

#[test]
fn a_file_cut_anywhere_is_an_error_and_never_half_a_function() {
    let good = small(VALUES);
    for length in 1..good.len() - 1 {
        let cut = &good[..length];
        assert!(read_text(cut).is_err(), "cut after {length} bytes: {cut}");
    }
    let cut = &good[..good.len() - 7];
    is_refused(cut, 15, &["EndsInside {", "begun_at: 1 }"]);
}

#[test]
fn broken_values_are_located() {
    let with = |number: &str| small(&VALUES.replace("3.00000E+00", number));
    let found = ["NotANumber {", "column: 29", "found: \"3.0000oE+00\""];
    is_refused(with("3.0000oE+00"), 14, &found);
    for bad in ["        NaN", "   Infinity", "1.0000E+999"] {
        is_refused(with(bad), 14, &["NotFinite {"]);
    }
    let few = ["TooFewNumbers {", "found: 2, expected: 6, begun_at: 1 }"];
    is_refused(small("  1.00000E+00  2.00000E+00\n"), 15, &few);
    let many = ["TooManyNumbers {", "expected: 6, begun_at: 1 }"];
    is_refused(small(&VALUES.repeat(2)), 15, &many);
    // Zeros may fill the last line, but nothing else may, and no further line.
    let three = "         3         1  1.0";
    let two_lines = |values| small(values).replacen(three, "         2         1  1.0", 1);
    let filled = "  1.00000E+00  2.00000E+00  3.00000E+00  4.00000E+00  0.00000E+00  0.00000E+00\n";
    let reading = read_text(two_lines(filled)).unwrap();
    assert_eq!(reading.functions()[0].receptance().len(), 2);
    is_refused(two_lines(VALUES), 14, &["TooManyNumbers {"]);
    let zeros = format!("{VALUES}  0.00000E+00\n");
    is_refused(small(&zeros), 15, &["TooManyNumbers {"]);
    let huge = small(VALUES).replacen(three, "9999999999         1  1.0", 1);
    is_refused(huge, 15, &["TooFewNumbers {", "found: 6,"]);
}

#[test]
fn header_errors_stand_at_the_line_of_their_record() {
    let response = ["Dof {", "role: \"response\""];
    #[rustfmt::skip]
    let cases = [
        ("  11   2 NONE", "  11   9 NONE", 8, &response[..]),
        ("        18    0", "        17    0", 10, &["AbscissaNotFrequency {"]),
        ("         8    0", "         3    0", 11, &["NotMotionPerLoad {"]),
        ("5.00000E-01", "0.00000E+00", 1, &["Function(", "strictly increasing"]),
    ];
    for (from, to, line, parts) in cases {
        is_refused(small(VALUES).replacen(from, to, 1), line, parts);
    }
}

#[test]
fn units_hold_for_the_whole_file_and_may_stand_after_the_functions() {
    let units = |code: u8, length: &str| {
        format!(
            "    -1\n   164\n{code:>10}units{:>25}\n{length:>25}{:>25}{:>25}\n{:>25}\n    -1\n",
            2, "1.0D+00", "1.0D+00", "0.0D+00"
        )
    };
    let good = small(VALUES);
    let first =
        |text: String| read_text(text).map(|reading| reading.functions()[0].receptance()[0]);
    for text in [
        format!("{}{good}", units(9, "1.0D+03")),
        format!("{good}{}", units(9, "1.0D+03")),
    ] {
        assert!((first(text).unwrap() - Complex64::new(1e-3, 2e-3)).norm() < 1e-18);
    }
    let twice = units(9, "1.0D+03") + &units(1, "1.0D+00");
    let second = "SecondUnits { first_line: 1 }";
    is_refused(format!("{twice}{good}"), 7, &[second]);
    let feet = units(1, "3.28083989501312334D+00");
    is_refused(feet + &good, 3, &["UnitsCode {", "code: 1,"]);
    let inches = UnitSystem::new(1.0 / 0.0254, 1.0).ok();
    let stated = ReadOptions {
        units: inches,
        ..ReadOptions::default()
    };
    let reading = read_uff58_from(good.as_bytes(), "memory.uff", &stated).unwrap();
    assert!((reading.functions()[0].receptance()[0].re - 0.0254).abs() < 1e-16);
}

#[test]
fn units_that_do_not_end_are_not_held() {
    let line = |numbers: &str| format!("{numbers:>25}\n");
    let endless = format!(
        "    -1\n   164\n{:>10}units{:>25}\n{:>25}{:>25}{:>25}\n{}    -1\n",
        9,
        2,
        "1.0D+03",
        "1.0D+00",
        "1.0D+00",
        line("0.0D+00").repeat(1000) + "what stands here is not read\n"
    );
    let found = read_text(format!("{endless}{}", small(VALUES))).unwrap();
    let first = found.functions()[0].receptance()[0];
    assert!((first - Complex64::new(1e-3, 2e-3)).norm() < 1e-18);
}

#[test]
fn a_set_names_the_file_that_its_functions_come_from() {
    let twice = small(VALUES).repeat(2);
    let error = read_text(twice).unwrap().into_set().unwrap_err();
    let expected = "memory.uff: found two functions from 2:+Y to 11:+Y";
    assert!(error.to_string().starts_with(expected), "{error}");
}

proptest! {
    #[test]
    fn no_junk_makes_the_reader_panic(bytes in prop::collection::vec(any::<u8>(), 0..2000), at in 0..1000_usize) {
        let _ = read_text(&bytes);
        let mut spoiled = small(VALUES).into_bytes();
        let at = at % spoiled.len();
        spoiled.splice(at.., bytes);
        let _ = read_text(&spoiled);
    }
}

#[test]
fn a_unit_that_cannot_be_read_is_quoted_unless_the_caller_states_it() {
    let text = small(VALUES).replacen(
        "         8    0    0    0 NONE                 NONE\n        13",
        "         8    0    0    0 NONE                 (m/s<=)/N\n        13",
        1,
    );
    let (_, problem) = problem_of(&text);
    has(&problem.to_string(), &["the unit \"(m/s<=)/N\""]);
    let options = ReadOptions {
        units: UnitSystem::named("m", "N"),
        ..ReadOptions::default()
    };
    assert!(read_uff58_from(text.as_bytes(), "x.uff", &options).is_ok());
}

#[test]
fn a_file_with_a_coherence_alone_is_not_called_empty() {
    let coherence = small(VALUES).replacen("\n    4         0", "\n    6         0", 1);
    let reading = read_uff58_from(coherence.as_bytes(), "x.uff", &ReadOptions::default());
    let error = reading.and_then(|reading| reading.into_set()).unwrap_err();
    assert!(!error.to_string().contains("empty file"), "{error}");
}
