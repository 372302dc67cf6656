//! Texts that begin or end in certain words.

/// A text begins with these words.
#[track_caller]
pub fn begins(text: &str, words: &str) {
    assert!(text.starts_with(words), "{words:?} does not begin: {text}");
}

/// A text ends with these words.
#[track_caller]
pub fn ends(text: &str, words: &str) {
    assert!(text.ends_with(words), "{words:?} does not end: {text}");
}
