//! The joint file as users meet it: read, written, refused with a message that says where and what to do.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

mod contents;
mod friction;
mod higher;
mod preload;
mod text;

use bolted_joint_testing::has;
use std::fs;
use std::path::{Path, PathBuf};

use bolted_joint::joint::{DofSet, JointFile, JointFileError};

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

/// The message for a text that is no joint file.
fn refused(text: &str, name: &str) -> String {
    JointFile::from_json(text, name).unwrap_err().to_string()
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
    assert_eq!(file.joint.dofs, DofSet::TRANSLATION_ROTATION);
    let law = file.joint.law::<2>().unwrap();
    assert_eq!(law.linear.stiffness, [[5.73e5, 5.82e3], [5.82e3, 1.29e3]]);
    assert_eq!(law.linear.damping, [[10.83, -0.83], [-0.83, 0.083]]);
    assert!(law.is_linear());
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
fn an_error_leaves_no_file_behind() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m10.joint.json");
    let mut file = JointFile::from_json(GOOD, "").unwrap();
    file.joint.stiffness[0][1] = f64::NAN;
    let refused = file.write(&path).unwrap_err();
    assert!(matches!(refused, JointFileError::Invalid { .. }));
    has(&refused.to_string(), &["joint.stiffness[0][1]: found NaN"]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);

    file = JointFile::from_json(GOOD, "").unwrap();
    let nowhere = folder.path().join("missing").join("m10.joint.json");
    let message = file.write(&nowhere).unwrap_err().to_string();
    assert!(message.contains("cannot be written"), "{message}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
