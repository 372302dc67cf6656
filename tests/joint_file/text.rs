//! Text that is no joint file, or one of another shape: refused with place, key and what was expected.

use bolted_joint_testing::{begins, ends, has};
use std::fs;

use bolted_joint::joint::JointFile;

use crate::{GOOD, refusal, refusal_with, refused};

#[test]
fn files_that_are_no_joint_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m10.joint.json");
    let message = || JointFile::read(&path).unwrap_err().to_string();

    let missing = "m10.joint.json: cannot be read: No such file";
    has(&message(), &[missing, "NAME.joint.json"]);

    for empty in ["", " \n\t\n", "\u{feff}"] {
        fs::write(&path, empty).unwrap();
        let expected = "found an empty file, expected a joint file (format \"bolted-joint/1\")";
        ends(&message(), expected);
    }
    let zip = "found a zip archive (an FMU?), expected a joint file";
    for (bytes, fragment) in [
        (b"PK\x03\x04\xff\xfe\x00".as_slice(), zip),
        (b"\x7fELF\x80\x81", "found bytes that are no text"),
        (b"\0\0\0\0", "found text with NUL characters"),
    ] {
        fs::write(&path, bytes).unwrap();
        has(&message(), &[fragment]);
    }
}

#[test]
fn text_that_is_no_json() {
    for end in [1, 20, 60, 150, GOOD.len() - 1] {
        let message = refused(&GOOD[..end], "cut.json");
        begins(&message, "cut.json:");
        has(&message, &["the file ends too early, in "]);
    }
    let advice = "expected a joint file (format \"bolted-joint/1\"): mend the text there, \
                  or give the NAME.joint.json that `identify` wrote";
    assert_eq!(
        refusal("[10.83, -0.83]", "[10.83 -0.83]"),
        format!(
            "m10.joint.json:7:24: is not JSON: expected `,` or `]`, in joint.damping[0]; {advice}"
        )
    );
    assert_eq!(
        refused(&format!("{GOOD}\n{{}}"), "two.json"),
        format!(
            "two.json:10:1: is not JSON: trailing characters, in the file as a whole; {advice}"
        )
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
                begins(&refused.to_string(), "damaged.json:");
            } else if JointFile::from_json(&text, "").unwrap() == whole {
                // Only layout, or a digit or sign that makes no difference to the number, may be replaced unnoticed.
                let is_the_same = c.is_whitespace() || c == other;
                assert!(is_the_same, "{c} by {other} at {at}: {text}");
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
         expected one of format, name, about, status, joint, bodies, uncertainty, validity, residual, provenance"
    );
    for (line, key) in [
        ("  \"name\": \"bad\",\n", "name"),
        ("    \"dofs\": [\"y\", \"theta\"],\n", "joint.dofs"),
    ] {
        let expected = format!(": {key}: not found, expected this key; add it");
        ends(&refusal(line, ""), &expected);
    }
    let stiffness = "    \"stiffness\": [[5.73e5, 5.82e3], [5.82e3, 1.29e3]],\n";
    assert_eq!(
        refusal(stiffness, ""),
        "m10.joint.json: joint.stiffness: not found, \
         expected a symmetric matrix with a row for each of joint.dofs"
    );
    let twice = refusal("\"name\"", "\"name\": \"once\", \"name\"");
    has(&twice, &["name: found twice, expected this key once"]);
}

#[test]
fn another_version_is_refused_before_its_keys_are() {
    let text = GOOD.replace("bolted-joint/1", "bolted-joint/2");
    assert_eq!(
        refused(&text.replace("dofs", "degrees"), "new.json"),
        "new.json: format: found \"bolted-joint/2\", expected \"bolted-joint/1\"; \
         write the file in this version of the format"
    );
    let one = refusal("\"bolted-joint/1\"", "1");
    has(&one, &["format: found 1, expected \"bolted-joint/1\""]);
}

#[test]
fn values_of_the_wrong_type() {
    assert_eq!(
        refusal("5.73e5", "\"soft\""),
        "m10.joint.json:6:25: joint.stiffness[0][0]: found string \"soft\", expected a number"
    );
    assert_eq!(
        refusal("[[10.83, -0.83], [-0.83, 0.083]]", "10.83"),
        "m10.joint.json:7:20: joint.damping: found 10.83, expected a list"
    );
    let message = refusal("[\"y\", \"theta\"]", "[\"theta\"]");
    let expected = "joint.dofs: found [\"theta\"], expected [\"y\"] or [\"y\", \"theta\"]";
    has(&message, &[expected]);
    begins(
        &refused("[1]", "list.json"),
        "list.json: found a list, expected an object",
    );
    let lists = "[[1, 1], [1, 1], [1, 1]]";
    assert_eq!(
        refusal_with(&format!("\"bodies\": {{ \"a\": {lists}, \"b\": {lists} }}")),
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
    for literal in "1e999 -1e999 NaN Infinity -Infinity nan inf".split(' ') {
        let message = refusal("0.083", literal);
        let found = format!(": joint.damping[1][1]: found {literal}, expected a finite number");
        ends(&message, &found);
        begins(&message, "m10.joint.json:7:");
    }
}
