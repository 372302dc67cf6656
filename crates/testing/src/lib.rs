//! What tests of several crates assert in the same words: texts that hold parts, numbers that are close.
#![forbid(unsafe_code)]

mod ends;

pub use ends::{begins, ends};

use std::fmt::Debug;

/// Every part stands in the text.
#[track_caller]
pub fn has(text: &str, parts: &[impl AsRef<str> + Debug]) {
    for part in parts {
        assert!(text.contains(part.as_ref()), "{part:?} is not in: {text}");
    }
}

/// A number is less than `tolerance` from the one expected.
#[track_caller]
pub fn near(found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs();
    assert!(error < tolerance, "{found} is {error:e} from {expected}");
}

/// A number is less than `tolerance` times itself from the one expected.
#[track_caller]
pub fn close(found: f64, expected: f64, tolerance: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error < tolerance, "{found} is {error:e} of {expected} off");
}
