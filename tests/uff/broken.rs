//! Broken files: every fault is named with its line; and harmless differences are no faults.

use bolted_joint::frf::{
    FrfError, ReadOptions, UffProblem, UnitSystem, read_uff58, read_uff58_from,
};
use num_complex::Complex64;
use proptest::prelude::*;

use super::{problem_of, read_text};

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
    assert_eq!(after_other.skipped_datasets, 1);
}

#[test]
fn what_is_no_universal_file_is_said_to_be_none() {
    assert!(matches!(problem_of(""), (1, UffProblem::Empty)));
    assert!(matches!(problem_of("\n \n"), (1, UffProblem::Empty)));
    let png = b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR\x00\x00\x01\x00";
    let (line, problem) = problem_of(png);
    assert_eq!(line, 1);
    assert!(problem.to_string().contains("PNG") && problem.to_string().contains("UFF 58"));
    assert!(problem.to_string().chars().all(|c| !c.is_control()));
    let (line, problem) = problem_of("\nfrequency,real,imaginary\n1,2,3\n");
    assert!(
        matches!((line, problem), (2, UffProblem::NotUniversalFile { found }) if found == "frequency,real,imaginary")
    );
    let random: Vec<u8> = (0..200_000_u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8 | 0x80)
        .collect();
    assert!(matches!(
        problem_of(random),
        (1, UffProblem::LineTooLong { .. })
    ));
    let error = read_uff58("no/such.uff", &ReadOptions::default()).unwrap_err();
    assert!(matches!(&error, FrfError::Read { .. }) && error.to_string().contains("no/such.uff"));
}

#[test]
fn broken_structure_is_located() {
    let good = small(VALUES);
    let (line, problem) = problem_of(format!("{good}junk\n"));
    assert!(
        matches!((line, problem), (16, UffProblem::BetweenDatasets { found }) if found == "junk")
    );
    let (line, problem) = problem_of(good.replacen("    58", "fifty", 1));
    assert!(
        matches!((line, problem), (2, UffProblem::DatasetNumber { found }) if found == "fifty")
    );
    let header_only: String = good
        .lines()
        .take(8)
        .map(|line| format!("{line}\n"))
        .collect();
    let (line, problem) = problem_of(format!("{header_only}    -1\n"));
    assert!(matches!(
        (line, problem),
        (
            9,
            UffProblem::HeaderEnds {
                found: 6,
                expected: 11,
                begun_at: 1,
                ..
            }
        )
    ));
    assert!(matches!(
        problem_of("    -1\n   164\n         1\n    -1\n"),
        (4, UffProblem::HeaderEnds { dataset: 164, .. })
    ));
}

#[test]
fn a_file_cut_anywhere_is_an_error_and_never_half_a_function() {
    let good = small(VALUES);
    for length in 1..good.len() - 1 {
        let cut = &good[..length];
        assert!(read_text(cut).is_err(), "cut after {length} bytes: {cut}");
    }
    let (line, problem) = problem_of(&good[..good.len() - 7]);
    assert!(matches!(
        (line, problem),
        (15, UffProblem::EndsInside { begun_at: 1, .. })
    ));
}

#[test]
fn broken_values_are_located() {
    let (line, problem) = problem_of(small(&VALUES.replace("3.00000E+00", "3.0000oE+00")));
    assert!(
        matches!((line, problem), (14, UffProblem::NotANumber { column: 29, found }) if found == "3.0000oE+00")
    );
    for bad in ["        NaN", "   Infinity", "1.0000E+999"] {
        let (line, problem) = problem_of(small(&VALUES.replace("3.00000E+00", bad)));
        assert!(
            matches!((line, problem), (14, UffProblem::NotFinite { .. })),
            "{bad}"
        );
    }
    let (line, problem) = problem_of(small("  1.00000E+00  2.00000E+00\n"));
    assert!(matches!(
        (line, problem),
        (
            15,
            UffProblem::TooFewNumbers {
                found: 2,
                expected: 6,
                begun_at: 1
            }
        )
    ));
    let (line, problem) = problem_of(small(&VALUES.repeat(2)));
    assert!(matches!(
        (line, problem),
        (
            15,
            UffProblem::TooManyNumbers {
                expected: 6,
                begun_at: 1
            }
        )
    ));
    // Zeros may fill the last line, but nothing else may, and no further line.
    let two_lines = |values| {
        small(values).replacen("         3         1  1.0", "         2         1  1.0", 1)
    };
    let filled = "  1.00000E+00  2.00000E+00  3.00000E+00  4.00000E+00  0.00000E+00  0.00000E+00\n";
    assert_eq!(
        read_text(two_lines(filled)).unwrap().functions()[0]
            .receptance()
            .len(),
        2
    );
    assert!(matches!(
        problem_of(two_lines(VALUES)),
        (14, UffProblem::TooManyNumbers { .. })
    ));
    let zeros = format!("{VALUES}  0.00000E+00\n");
    assert!(matches!(
        problem_of(small(&zeros)),
        (15, UffProblem::TooManyNumbers { .. })
    ));
    let huge = small(VALUES).replacen("         3         1  1.0", "9999999999         1  1.0", 1);
    assert!(matches!(
        problem_of(huge),
        (15, UffProblem::TooFewNumbers { found: 6, .. })
    ));
}

#[test]
fn header_errors_stand_at_the_line_of_their_record() {
    let (line, problem) = problem_of(small(VALUES).replacen("  11   2 NONE", "  11   9 NONE", 1));
    assert!(matches!(
        (line, problem),
        (
            8,
            UffProblem::Dof {
                role: "response",
                ..
            }
        )
    ));
    let (line, problem) =
        problem_of(small(VALUES).replacen("        18    0", "        17    0", 1));
    assert!(matches!(
        (line, problem),
        (10, UffProblem::AbscissaNotFrequency { .. })
    ));
    let (line, problem) =
        problem_of(small(VALUES).replacen("         8    0", "         3    0", 1));
    assert!(matches!(
        (line, problem),
        (11, UffProblem::NotMotionPerLoad { .. })
    ));
    let (line, problem) = problem_of(small(VALUES).replacen("5.00000E-01", "0.00000E+00", 1));
    assert!(matches!((line, &problem), (1, UffProblem::Function(_))));
    assert!(problem.to_string().contains("strictly increasing"));
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
    let (line, problem) = problem_of(format!(
        "{}{}{good}",
        units(9, "1.0D+03"),
        units(1, "1.0D+00")
    ));
    assert!(matches!(
        (line, problem),
        (7, UffProblem::SecondUnits { first_line: 1 })
    ));
    let (line, problem) = problem_of(format!("{}{good}", units(1, "3.28083989501312334D+00")));
    assert!(matches!(
        (line, problem),
        (3, UffProblem::UnitsCode { code: 1, .. })
    ));
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
    assert!(
        error
            .to_string()
            .starts_with("memory.uff: found two functions from 2:+Y to 11:+Y"),
        "{error}"
    );
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
