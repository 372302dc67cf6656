//! Foreign text in messages: short, on one line and without control characters.

/// How much of a text an error message shows.
const SHOWN_CHARACTERS: usize = 40;

/// The beginning of a text, fit for a message.
pub fn shown(text: &str) -> String {
    let mut shown: String = text
        .trim()
        .chars()
        .take(SHOWN_CHARACTERS)
        .flat_map(char::escape_debug)
        .collect();
    if text.trim().chars().nth(SHOWN_CHARACTERS).is_some() {
        shown.push('…');
    }
    shown
}
