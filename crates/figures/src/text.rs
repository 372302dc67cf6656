//! Room that a text takes, without knowing the font that the reader's machine will choose.

/// Width of `text` (pixels) in a rather wide sans-serif font.
pub fn width(text: &str, font_size: f64) -> f64 {
    let per_font_size = text.chars().map(|character| match character {
        'i' | 'j' | 'l' | 'f' | 't' | 'r' | 'I' | '|' | '.' | ',' | ':' | ';' | '·' | '\''
        | ' ' => 0.34,
        'm' | 'w' | 'M' | 'W' | '%' => 0.95,
        'A'..='Z' => 0.72,
        '0'..='9' => 0.62,
        // Ideographs and symbols beyond the alphabets fill a square.
        '\u{2e80}'.. => 1.0,
        _ => 0.58,
    });
    font_size * per_font_size.sum::<f64>()
}

/// `text` itself if there is room for it, otherwise its beginning and an ellipsis.
pub fn shortened(text: &str, font_size: f64, room: f64) -> String {
    if width(text, font_size) <= room {
        return text.to_owned();
    }
    let mut kept = String::new();
    let mut taken = width("…", font_size);
    for character in text.chars() {
        taken += width(character.encode_utf8(&mut [0; 4]), font_size);
        if taken > room {
            break;
        }
        kept.push(character);
    }
    kept.truncate(kept.trim_end().len());
    kept.push('…');
    kept
}

/// `text` in lines that have room, broken between words. A word longer than a line is shortened.
pub fn wrapped(text: &str, font_size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let word = shortened(word, font_size, room);
        match lines.last_mut() {
            Some(line)
                if width(line, font_size) + width(" ", font_size) + width(&word, font_size)
                    <= room =>
            {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_between_words_and_have_room() {
        let text = "the quick brown fox jumps over the lazy dog";
        let lines = wrapped(text, 10.0, 80.0);
        assert_eq!(lines.join(" "), text);
        assert!(lines.len() > 2);
        assert!(lines.iter().all(|line| width(line, 10.0) <= 80.0));
        assert!(wrapped("  ", 10.0, 80.0).is_empty());
    }

    #[test]
    fn long_words_end_in_an_ellipsis() {
        assert_eq!(shortened("12:+Y / 12:+Y", 10.0, 200.0), "12:+Y / 12:+Y");
        let short = shortened("accelerometer at the second point", 10.0, 60.0);
        assert!(short.ends_with('…') && "accelerometer".starts_with(short.trim_end_matches('…')));
        assert!(width(&short, 10.0) <= 60.0);
        assert_eq!(shortened("abc", 10.0, 0.0), "…");
    }
}
