//! Text that is no joint file, or one of another shape: refused with place, key and what was expected.

use bolted_joint_testing::has;
use std::fs;

use bolted_joint::joint::JointFile;

use crate::{GOOD, refusal, refusal_with};

#[test]
fn files_that_are_no_joint_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m10.joint.json");
    let message = || JointFile::read(&path).unwrap_err().to_string();

    let missing = message();
    has(&missing, &["m10.joint.json: cannot be read: No such file"]);
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
        has(&message, &["the file ends too early, in "]);
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
         expected one of dofs, stiffness, damping, cubic, higher, friction, over_preload"
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
    has(
        &message,
        &["joint.dofs: found [\"theta\"], expected [\"y\"] or [\"y\", \"theta\"]"],
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
    has(
        &message,
        &["validity.frequency_hz: found 3 entries, expected 2"],
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
