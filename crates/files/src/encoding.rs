//! Texts that are not in UTF-8, as editors of Windows and old ones write them: told from binary data, so that the message says how
//! to save them.

use std::fmt;

/// How a text that is not in UTF-8 seems to be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Two bytes for each letter, the lower one first or last.
    Utf16,
    /// One byte for each letter.
    Latin1,
}

impl Encoding {
    /// The encoding, and the first line (from 1) that tells; `None` for UTF-8, and for what is no text.
    #[must_use]
    pub fn other_than_utf8(bytes: &[u8]) -> Option<(Self, usize)> {
        if is_utf16(bytes) {
            return Some((Self::Utf16, 1));
        }
        let error = std::str::from_utf8(bytes).err()?;
        let is_control = |byte: &u8| byte.is_ascii_control() && !byte.is_ascii_whitespace();
        if bytes.iter().any(is_control) {
            return None;
        }
        let before = &bytes[..error.valid_up_to()];
        let lines = before.iter().filter(|&&byte| byte == b'\n').count();
        Some((Self::Latin1, lines + 1))
    }

    /// The text, as well as can be had: what is no letter of its encoding is replaced.
    #[must_use]
    pub fn decoded(bytes: &[u8]) -> String {
        match Self::other_than_utf8(bytes) {
            Some((Self::Utf16, _)) => {
                let is_low_first = bytes.starts_with(b"\xff\xfe") || bytes.get(1) == Some(&0);
                let unit = |pair: &[u8]| match is_low_first {
                    true => u16::from_le_bytes([pair[0], pair[1]]),
                    false => u16::from_be_bytes([pair[0], pair[1]]),
                };
                let units: Vec<u16> = bytes.chunks_exact(2).map(unit).collect();
                String::from_utf16_lossy(&units)
            }
            Some((Self::Latin1, _)) => bytes.iter().map(|&byte| char::from(byte)).collect(),
            None => String::from_utf8_lossy(bytes).into_owned(),
        }
    }
}

/// With a mark at its beginning, or, since what is read here is mostly ASCII, with every other byte zero.
fn is_utf16(bytes: &[u8]) -> bool {
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return true;
    }
    let pairs = || bytes.chunks_exact(2).take(64);
    let zeros = |place: usize| pairs().filter(|pair| pair[place] == 0).count();
    let all = pairs().count();
    all > 1
        && ((zeros(0) == 0 && 4 * zeros(1) > 3 * all) || (zeros(1) == 0 && 4 * zeros(0) > 3 * all))
}

impl fmt::Display for Encoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Utf16 => "UTF-16",
            Self::Latin1 => "Latin-1 or Windows-1252",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encodings_are_told_from_binary_data() {
        let text = "name = \"Prüfling\"\n";
        let low: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let high: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        let marked = [b"\xff\xfe", low.as_slice()].concat();
        for bytes in [&low, &high, &marked] {
            assert_eq!(Encoding::other_than_utf8(bytes), Some((Encoding::Utf16, 1)));
            assert!(Encoding::decoded(bytes).contains("Prüfling"));
        }
        let latin = b"# a\nname = \"Pr\xfcfling\"\n";
        assert_eq!(
            Encoding::other_than_utf8(latin),
            Some((Encoding::Latin1, 2))
        );
        assert!(Encoding::decoded(latin).contains("Prüfling"));
        for other in [
            text.as_bytes(),
            b"",
            b"a",
            b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR",
            b"\xfc\0\0",
        ] {
            assert_eq!(Encoding::other_than_utf8(other), None, "{other:?}");
        }
    }
}
