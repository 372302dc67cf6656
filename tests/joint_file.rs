//! The joint file as users meet it: read, written, refused with a message that says where and what to do.

use std::fs;
use std::path::{Path, PathBuf};

use bolted_joint::joint::{DofSet, JointFile, JointFileError, LawError, PreloadError};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data/joint")
        .join(name)
}

const GOOD: &str = r#"{
  "format": "bolted-joint/1",
  "name": "bad",
  "joint": {
    "dofs": ["y", "theta"],
    "stiffness": [[5.73e5, 5.82e3], [5.82e3, 1.29e3]],
    "damping": [[10.83, -0.83], [-0.83, 0.083]]
  }
}"#;

/// The message for `GOOD` with `from` replaced by `to`.
fn refusal(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    let text = GOOD.replacen(from, to, 1);
    match JointFile::from_json(&text, "m10.joint.json") {
        Ok(_) => format!("accepted: {text}"),
        Err(refused) => refused.to_string(),
    }
}

/// The message for `GOOD` with further top-level keys.
fn refusal_with(more: &str) -> String {
    refusal(
        "    \"damping\": [[10.83, -0.83], [-0.83, 0.083]]\n  }\n",
        &format!("    \"damping\": [[10.83, -0.83], [-0.83, 0.083]]\n  }},\n  {more}\n"),
    )
}

#[test]
fn the_good_text_is_good() {
    let file = JointFile::from_json(GOOD, "m10.joint.json").unwrap();
    assert_eq!(file.joint.dofs, DofSet::TranslationRotation);
    let law = file.joint.law::<2>().unwrap();
    assert_eq!(law.stiffness, [[5.73e5, 5.82e3], [5.82e3, 1.29e3]]);
    assert_eq!(law.damping, [[10.83, -0.83], [-0.83, 0.083]]);
    assert_eq!(law.cubic, [0.0, 0.0]);
    assert!(file.passivity().is_passive());
}

#[test]
fn what_is_written_reads_back_and_is_laid_out_for_people() {
    let folder = tempfile::tempdir().unwrap();
    for name in [
        "m10-aluminium.joint.json",
        "pirdayr-ex03.joint.json",
        "over-preload.joint.json",
    ] {
        let (file, source) = JointFile::read_with_source(&data(name)).unwrap();
        // The files in the repository have the very layout that the program writes.
        assert_eq!(file.to_json().unwrap(), source, "{name}");
        let copy = folder.path().join(name);
        file.write(&copy).unwrap();
        assert_eq!(fs::read_to_string(&copy).unwrap(), source);
        assert_eq!(JointFile::read(&copy).unwrap(), file);
    }
}

#[test]
fn numbers_survive_writing_to_the_last_bit() {
    let mut file = JointFile::from_json(GOOD, "").unwrap();
    // Random mantissas and exponents over the whole range (xorshift64*).
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    for _ in 0..2000 {
        seed ^= seed >> 12;
        seed ^= seed << 25;
        seed ^= seed >> 27;
        let number = f64::from_bits(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
        if number.is_finite() {
            file.joint.stiffness[0][0] = number;
            let back = JointFile::from_json(&file.to_json().unwrap(), "").unwrap();
            assert_eq!(back.joint.stiffness[0][0].to_bits(), number.to_bits());
        }
    }
}

#[test]
fn a_byte_order_mark_does_no_harm() {
    assert!(JointFile::from_json(&format!("\u{feff}{GOOD}"), "").is_ok());
}

#[test]
fn the_schema_in_docs_is_that_of_the_types() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/joint-file.schema.json");
    let schema = schemars::schema_for!(JointFile);
    let text = serde_json::to_string_pretty(&schema).unwrap() + "\n";
    if std::env::var_os("UPDATE_SCHEMA").is_some() {
        fs::write(&path, &text).unwrap();
    }
    let found = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        found == text,
        "docs/joint-file.schema.json is out of date: run UPDATE_SCHEMA=1 cargo test"
    );
}

#[test]
fn files_that_are_no_joint_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m10.joint.json");
    let message = || JointFile::read(&path).unwrap_err().to_string();

    let missing = message();
    assert!(
        missing.contains("m10.joint.json: cannot be read: No such file"),
        "{missing}"
    );
    assert!(missing.contains("NAME.joint.json"), "{missing}");

    for empty in ["", " \n\t\n", "\u{feff}"] {
        fs::write(&path, empty).unwrap();
        assert!(
            message().ends_with(
                "found an empty file, expected a joint file (format \"bolted-joint/1\")"
            )
        );
    }
    fs::write(&path, b"PK\x03\x04\xff\xfe\x00").unwrap();
    assert!(message().contains("found a zip archive (an FMU?), expected a joint file"));
    fs::write(&path, b"\x7fELF\x80\x81").unwrap();
    assert!(message().contains("found bytes that are no text"));
    fs::write(&path, "\0\0\0\0").unwrap();
    assert!(message().contains("found text with NUL characters"));
}

#[test]
fn text_that_is_no_json() {
    for end in [1, 20, 60, 150, GOOD.len() - 1] {
        let message = JointFile::from_json(&GOOD[..end], "cut.json")
            .unwrap_err()
            .to_string();
        assert!(message.starts_with("cut.json:"), "{message}");
        assert!(
            message.contains("the file ends too early, in "),
            "{message}"
        );
    }
    assert_eq!(
        refusal("[10.83, -0.83]", "[10.83 -0.83]"),
        "m10.joint.json:7:24: is not JSON: expected `,` or `]`, in joint.damping[0]; expected a joint file (format \"bolted-joint/1\"): mend the text there, or give the NAME.joint.json that `identify` wrote"
    );
    let message = JointFile::from_json(&format!("{GOOD}\n{{}}"), "two.json")
        .unwrap_err()
        .to_string();
    assert_eq!(
        message,
        "two.json:10:1: is not JSON: trailing characters, in the file as a whole; expected a joint file (format \"bolted-joint/1\"): mend the text there, or give the NAME.joint.json that `identify` wrote"
    );
}

#[test]
fn no_damage_goes_unnoticed_or_brings_the_reader_down() {
    let whole = JointFile::from_json(GOOD, "").unwrap();
    for (at, c) in GOOD.char_indices() {
        assert!(at + 2 >= GOOD.len() || JointFile::from_json(&GOOD[..at], "").is_err());
        for other in ['"', '[', '}', ',', '-', 'e', '9', 'é', '\n', '\u{1}'] {
            let text = format!("{}{other}{}", &GOOD[..at], &GOOD[at + c.len_utf8()..]);
            if let Err(refused) = JointFile::from_json(&text, "damaged.json") {
                assert!(
                    refused.to_string().starts_with("damaged.json:"),
                    "{refused}"
                );
            } else if JointFile::from_json(&text, "").unwrap() == whole {
                // Only layout, or a digit or sign that makes no difference to the number, may be replaced unnoticed.
                assert!(
                    c.is_whitespace() || c == other,
                    "{c} by {other} at {at}: {text}"
                );
            }
        }
    }
}

#[test]
fn keys_that_do_not_exist_or_are_not_there() {
    assert_eq!(
        refusal("\"stiffness\"", "\"stifness\""),
        "m10.joint.json:6:14: joint.stifness: unknown key, did you mean \"stiffness\"?; \
         expected one of dofs, stiffness, damping, cubic, over_preload"
    );
    assert_eq!(
        refusal("\"name\"", "\"colour\""),
        "m10.joint.json:3:10: colour: unknown key; \
         expected one of format, name, joint, bodies, uncertainty, validity, residual, provenance"
    );
    let message = refusal("  \"name\": \"bad\",\n", "");
    assert!(
        message.ends_with(": name: not found, expected this key; add it"),
        "{message}"
    );
    let message = refusal("    \"dofs\": [\"y\", \"theta\"],\n", "");
    assert!(
        message.ends_with(": joint.dofs: not found, expected this key; add it"),
        "{message}"
    );
    let message = refusal(
        "    \"stiffness\": [[5.73e5, 5.82e3], [5.82e3, 1.29e3]],\n",
        "",
    );
    assert_eq!(
        message,
        "m10.joint.json: joint.stiffness: not found, \
         expected a symmetric matrix with a row for each of joint.dofs"
    );
    let message = refusal("\"name\"", "\"name\": \"once\", \"name\"");
    assert!(message.contains("duplicate field `name`"), "{message}");
}

#[test]
fn another_version_is_refused_before_its_keys_are() {
    let text = GOOD
        .replace("bolted-joint/1", "bolted-joint/2")
        .replace("dofs", "degrees");
    assert_eq!(
        JointFile::from_json(&text, "new.json")
            .unwrap_err()
            .to_string(),
        "new.json: format: found \"bolted-joint/2\", expected \"bolted-joint/1\"; \
         write the file in this version of the format"
    );
    assert!(
        refusal("\"bolted-joint/1\"", "1").contains("format: found 1, expected \"bolted-joint/1\"")
    );
}

#[test]
fn values_of_the_wrong_type() {
    assert_eq!(
        refusal("5.73e5", "\"soft\""),
        "m10.joint.json:6:25: joint.stiffness[0][0]: found string \"soft\", expected a number"
    );
    assert_eq!(
        refusal("[[10.83, -0.83], [-0.83, 0.083]]", "10.83"),
        "m10.joint.json:7:20: joint.damping: found floating point `10.83`, expected a list"
    );
    let message = refusal("[\"y\", \"theta\"]", "[\"theta\"]");
    assert!(
        message.contains("joint.dofs: found [\"theta\"], expected [\"y\"] or [\"y\", \"theta\"]"),
        "{message}"
    );
    let message = JointFile::from_json("[1]", "list.json")
        .unwrap_err()
        .to_string();
    assert!(message.starts_with("list.json:1:"), "{message}");
    let message = refusal_with(
        "\"bodies\": { \"a\": [[1, 1], [1, 1], [1, 1]], \"b\": [[1, 1], [1, 1], [1, 1]] }",
    );
    assert_eq!(
        message,
        "m10.joint.json: bodies.a: found a list, expected an object with keys"
    );
    let message = refusal_with("\"validity\": { \"frequency_hz\": [5, 512, 600] }");
    assert!(
        message.contains("validity.frequency_hz: found 3 entries, expected 2"),
        "{message}"
    );
}

#[test]
fn numbers_that_are_not_finite() {
    for literal in [
        "1e999",
        "-1e999",
        "NaN",
        "Infinity",
        "-Infinity",
        "nan",
        "inf",
    ] {
        let message = refusal("0.083", literal);
        assert!(
            message.ends_with(&format!(
                ": joint.damping[1][1]: found {literal}, expected a finite number"
            )),
            "{message}"
        );
        assert!(message.starts_with("m10.joint.json:7:"), "{message}");
    }
}

#[test]
fn contents_that_do_not_fit_together() {
    assert_eq!(
        refusal("[5.82e3, 1.29e3]", "[5.82e3, 1.29e3, 7]"),
        "m10.joint.json: joint.stiffness[1]: found 3 entries, expected 2, one for each of joint.dofs = [\"y\", \"theta\"]"
    );
    assert_eq!(
        refusal(", [-0.83, 0.083]", ""),
        "m10.joint.json: joint.damping: found 1 entry, expected 2, one for each of joint.dofs = [\"y\", \"theta\"]"
    );
    assert_eq!(
        refusal("[5.82e3, 1.29e3]", "[5.81e3, 1.29e3]"),
        "m10.joint.json: joint.stiffness: found 5820.0 at [0][1] and 5810.0 at [1][0], \
         expected a symmetric matrix; give both entries the same value"
    );
    let message = refusal("\"dofs\": [\"y\", \"theta\"]", "\"dofs\": [\"y\"]");
    for fragment in [
        "joint.stiffness: found 2 entries, expected 1",
        "joint.damping: found 2 entries, expected 1",
    ] {
        assert!(
            message.contains(fragment),
            "every problem is told: {message}"
        );
    }
    assert!(refusal("\"bad\"", "\"a\\uffff\"").contains("expected one line of text"));
    assert!(refusal("\"bad\"", "\" \"").contains("name: found \" \", expected one line of text"));
    assert!(
        refusal("\"bad\"", "\"a\\nb\"")
            .contains("name: found \"a\\nb\", expected one line of text")
    );
}

#[test]
fn bodies_that_do_not_fit() {
    let body = |inertia: &str, stiffness: &str| {
        format!("{{ \"inertia\": {inertia}, \"stiffness\": {stiffness}, \"damping\": [0, 0] }}")
    };
    let bodies = |a: String| {
        format!(
            "\"bodies\": {{ \"a\": {a}, \"b\": {} }}",
            body("[1, 1]", "[1, 1]")
        )
    };
    for (a, fragment) in [
        (
            body("[1.41, -0.1]", "[1, 1]"),
            "bodies.a.inertia[1]: found -0.1, expected an inertia greater than zero",
        ),
        (
            body("[0, 1]", "[1, 1]"),
            "bodies.a.inertia[0]: found 0.0, expected an inertia greater than zero",
        ),
        (
            body("[1.41]", "[1, 1]"),
            "bodies.a.inertia: found 1 entry, expected 2, one for each of joint.dofs",
        ),
        (
            body("[1, 1]", "[1, -1]"),
            "bodies.a.stiffness[1]: found -1.0, expected a support stiffness of zero or more",
        ),
    ] {
        let message = refusal_with(&bodies(a));
        assert!(message.contains(fragment), "{message}");
    }
}

#[test]
fn other_records_that_do_not_fit() {
    for (more, fragment) in [
        (
            "\"validity\": { \"frequency_hz\": [512, 5] }",
            "validity.frequency_hz: found 512.0 to 5.0 Hz, expected the lower frequency first",
        ),
        (
            "\"residual\": { \"relative_rms\": -1, \"lines\": 3 }",
            "residual.relative_rms: found -1.0, expected a root mean square of zero or more",
        ),
        (
            "\"residual\": { \"relative_rms\": 1, \"lines\": -3 }",
            "residual.lines: found integer `-3`, expected a whole number",
        ),
        (
            "\"uncertainty\": { \"basis\": \"\", \"standard_deviation\": \
             { \"stiffness\": [[1, 2], [2, -1]], \"damping\": [[1, 2], [2, 1]] } }",
            "uncertainty.standard_deviation.stiffness[1][1]: found -1.0, expected a standard deviation of zero or more",
        ),
        (
            "\"provenance\": { \"tool\": \"t\", \"version\": \"1\", \"method\": \"m\", \"model\": \"full\", \
             \"inputs\": [{ \"role\": \"a\", \"file\": \"a.uff\", \"sha256\": \"E3B0\" }] }",
            "provenance.inputs[0].sha256: found \"E3B0\", expected 64 lower-case hexadecimal digits",
        ),
    ] {
        let message = refusal_with(more);
        assert!(message.contains(fragment), "{message}");
    }
}

#[test]
fn preload_tables_that_do_not_fit() {
    let good = fs::read_to_string(data("over-preload.joint.json")).unwrap();
    for (from, to, fragment) in [
        (
            "[10.0, 25.0]",
            "[25.0, 10.0]",
            "joint.over_preload.preload[1]: found 10.0 N·m after 25.0 N·m, expected strictly increasing",
        ),
        (
            "\"nominal\": 10.0",
            "\"nominal\": 26.0",
            "joint.over_preload.nominal: found 26.0 N·m, expected a preload within the table, from 10.0 to 25.0 N·m",
        ),
        (
            "[10.0, 25.0]",
            "[10.0, 15.0, 25.0]",
            "joint.over_preload.stiffness: found 2 entries, expected 3, one for each of joint.over_preload.preload",
        ),
        (
            "[10.0, 25.0]",
            "[10.0]",
            "joint.over_preload.preload: found 1, expected at least 2 preloads",
        ),
        (
            "[600000.0]",
            "[600000.0, 1.0]",
            "joint.over_preload.stiffness[0][0]: found 2 entries, expected 1",
        ),
    ] {
        assert!(good.contains(from));
        let message = JointFile::from_json(&good.replacen(from, to, 1), "")
            .unwrap_err()
            .to_string();
        assert!(message.contains(fragment), "{message}");
    }
    let file = JointFile::from_json(&good, "").unwrap();
    assert_eq!(file.joint.law::<1>(), Err(LawError::OverPreload));
    assert!(file.passivity().is_passive());
    assert_eq!(file.passivity().matrices.len(), 4);
}

/// K, C and k₃ of two DOFs at three preloads, with their standard deviations.
const OVER_PRELOAD: &str = r#"{
  "format": "bolted-joint/1",
  "name": "table",
  "joint": { "dofs": ["y", "theta"], "over_preload": {
    "preload": [10, 15, 25], "nominal": 15,
    "stiffness": [[[4e5, 3e3], [3e3, 9e2]], [[6e5, 5e3], [5e3, 1.2e3]], [[7e5, 6e3], [6e3, 1.4e3]]],
    "damping": [[[12, -0.5], [-0.5, 0.1]], [[8, -0.3], [-0.3, 0.06]], [[7, -0.2], [-0.2, 0.05]]],
    "cubic": [[0, 0], [-1e9, 0], [-3e9, 20]]
  } },
  "uncertainty": {
    "standard_deviation": { "stiffness": [[200, 2], [2, 0.2]], "damping": [[0.2, 0.02], [0.02, 0.002]] },
    "basis": "test",
    "interval_95": { "stiffness": [[[599600, 600400], [4996, 5004]], [[4996, 5004], [1199.6, 1200.4]]],
                     "damping": [[[7.6, 8.4], [-0.34, -0.26]], [[-0.34, -0.26], [0.056, 0.064]]] },
    "over_preload": { "at": [
      { "preload": 10,
        "standard_deviation": { "stiffness": [[100, 1], [1, 0.1]], "damping": [[0.1, 0.01], [0.01, 0.001]] },
        "not_identified": ["k_ytheta"] },
      { "preload": 15,
        "standard_deviation": { "stiffness": [[200, 2], [2, 0.2]], "damping": [[0.2, 0.02], [0.02, 0.002]] },
        "free_estimate": { "stiffness": [[6e5, 5e3], [5e3, 1.2e3]], "damping": [[8, -0.4], [-0.4, 0.05]] } },
      { "preload": 25,
        "standard_deviation": { "stiffness": [[400, 4], [4, 0.4]], "damping": [[0.4, 0.04], [0.04, 0.004]] } }
    ] }
  },
  "validity": { "frequency_hz": [5, 500], "torque_n_m": [10, 25] },
  "provenance": { "tool": "t", "version": "1", "method": "m", "model": "full" }
}"#;

#[test]
fn a_joint_over_preload_is_taken_at_one_by_linear_interpolation() {
    let table = JointFile::from_json(OVER_PRELOAD, "").unwrap();
    // 17 N·m is a fifth of the way from 15 to 25 N·m.
    let file = table.at_preload(Some(17.0)).unwrap();
    assert_eq!(file.validate(), []);
    assert_eq!(file.name, "table, at 17 N·m");
    let law = file.joint.law::<2>().unwrap();
    let near = |found: &[f64], expected: &[f64]| {
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() <= 1e-14 * expected.abs(),
                "{found} {expected}"
            );
        }
    };
    near(law.stiffness.as_flattened(), &[6.2e5, 5.2e3, 5.2e3, 1.24e3]);
    near(law.damping.as_flattened(), &[7.8, -0.28, -0.28, 0.058]);
    near(&law.cubic, &[-1.4e9, 4.0]);
    let uncertainty = file.uncertainty.unwrap();
    near(&uncertainty.standard_deviation.stiffness[0], &[240.0, 2.4]);
    near(&uncertainty.standard_deviation.damping[1], &[0.024, 0.0024]);
    assert!(
        uncertainty
            .basis
            .starts_with("test; between 15 and 25 N·m interpolated")
    );
    // The free estimate of 25 N·m is the joint itself.
    let free = uncertainty.free_estimate.unwrap();
    near(&free.damping[0], &[7.8, 0.8 * -0.4 + 0.2 * -0.2]);
    assert_eq!(uncertainty.over_preload, None);
    assert_eq!(file.validity.unwrap().torque_n_m, Some([15.0, 25.0]));
    let notes = file.provenance.unwrap().notes;
    assert!(notes[0].contains("17 N·m, interpolated linearly between 15 and 25 N·m"));
}

#[test]
fn a_joint_over_preload_is_at_its_own_preloads_what_the_table_says() {
    let table = JointFile::from_json(OVER_PRELOAD, "").unwrap();
    let over_preload = table.joint.over_preload.clone().unwrap();
    for (place, preload) in [10.0, 15.0, 25.0].into_iter().enumerate() {
        let file = table.at_preload(Some(preload)).unwrap();
        assert_eq!(file.joint.stiffness, over_preload.stiffness[place]);
        assert_eq!(file.joint.damping, over_preload.damping[place]);
        assert_eq!(file.joint.cubic, over_preload.cubic[place]);
        assert_eq!(file.validity.unwrap().torque_n_m, Some([preload; 2]));
        let own = &table
            .uncertainty
            .as_ref()
            .unwrap()
            .over_preload
            .as_ref()
            .unwrap()
            .at[place];
        let uncertainty = file.uncertainty.unwrap();
        assert_eq!(uncertainty.standard_deviation, own.standard_deviation);
        // The nominal preload's interval stands beside the table.
        assert_eq!(uncertainty.interval_95.is_some(), preload == 15.0);
    }
    assert_eq!(table.at_preload(None), table.at_preload(Some(15.0)));
    let constant = JointFile::from_json(GOOD, "").unwrap();
    assert_eq!(constant.at_preload(None), Ok(constant.clone()));
    assert_eq!(
        constant.at_preload(Some(10.0)),
        Err(PreloadError::Constant { found_n_m: 10.0 })
    );
    for found_n_m in [9.9, 25.1, -1.0, f64::INFINITY] {
        assert_eq!(
            table.at_preload(Some(found_n_m)),
            Err(PreloadError::Outside {
                found_n_m,
                first_n_m: 10.0,
                last_n_m: 25.0
            })
        );
    }
    assert!(table.at_preload(Some(f64::NAN)).is_err());
}

#[test]
fn interpolation_between_passive_joints_is_passive() {
    let table = JointFile::from_json(OVER_PRELOAD, "").unwrap();
    for step in 0..=150 {
        let file = table
            .at_preload(Some(10.0 + 0.1 * f64::from(step)))
            .unwrap();
        assert!(file.passivity().is_passive(), "{}", file.name);
    }
}

#[test]
fn deviations_over_preload_that_do_not_fit_the_joint() {
    for (from, to, fragment) in [
        (
            "{ \"preload\": 10,",
            "{ \"preload\": 11,",
            "uncertainty.over_preload.at[0].preload: found 11.0 N·m, expected 10.0 N·m as in joint.over_preload.preload",
        ),
        (
            "[[100, 1], [1, 0.1]]",
            "[[-100, 1], [1, 0.1]]",
            "uncertainty.over_preload.at[0].standard_deviation.stiffness[0][0]: found -100.0",
        ),
        (
            "[[8, -0.4], [-0.4, 0.05]]",
            "[[8, -0.4], [-0.5, 0.05]]",
            "uncertainty.over_preload.at[1].free_estimate.damping: found -0.4 at [0][1]",
        ),
        (
            "\"preload\": [10, 15, 25]",
            "\"preload\": [10, 15, 20, 25]",
            "uncertainty.over_preload.at: found 3 entries, expected 4, one for each of joint.over_preload.preload",
        ),
    ] {
        assert!(OVER_PRELOAD.contains(from), "{from}");
        let text = OVER_PRELOAD.replacen(from, to, 1);
        let message = JointFile::from_json(&text, "").unwrap_err().to_string();
        assert!(message.contains(fragment), "{message}");
    }
}

#[test]
fn equations_come_only_in_the_size_of_the_joint() {
    let lap = JointFile::read(&data("pirdayr-ex03.joint.json")).unwrap();
    let equations = lap.lap::<1>().unwrap();
    assert_eq!(equations.a.inertia, [2.35]);
    assert_eq!(equations.joint.cubic, [1670.0]);
    assert_eq!(
        lap.lap::<2>().unwrap_err().to_string(),
        "joint.dofs: found [\"y\"], expected 2 degrees of freedom"
    );
    let element = JointFile::read(&data("m10-aluminium.joint.json")).unwrap();
    assert_eq!(element.lap::<2>(), Err(LawError::NoBodies));
}

#[test]
fn an_error_leaves_no_file_behind() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m10.joint.json");
    let mut file = JointFile::from_json(GOOD, "").unwrap();
    file.joint.stiffness[0][1] = f64::NAN;
    let refused = file.write(&path).unwrap_err();
    assert!(matches!(refused, JointFileError::Invalid { .. }));
    assert!(
        refused
            .to_string()
            .contains("joint.stiffness[0][1]: found NaN")
    );
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);

    file = JointFile::from_json(GOOD, "").unwrap();
    let nowhere = folder.path().join("missing").join("m10.joint.json");
    let message = file.write(&nowhere).unwrap_err().to_string();
    assert!(message.contains("cannot be written"), "{message}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
