//! The headers by which tables of TOML begin, such as `[frequency]`: a reader of JSON takes one for a list that is broken.

/// The header by which a text begins, if it begins as TOML with a table does; none for lists of numbers.
///
/// `["a"]` may be either: who reads JSON looks first whether the text is that.
#[must_use]
pub fn table_header(text: &str) -> Option<&str> {
    let line = text.trim_start().lines().next()?;
    let line = line.split_once('#').map_or(line, |(line, _)| line).trim();
    let inner = line.strip_prefix('[')?.strip_suffix(']')?;
    let of_list = inner
        .strip_prefix('[')
        .and_then(|inner| inner.strip_suffix(']'));
    let name = of_list.unwrap_or(inner).trim();
    let is_name = name.starts_with(|c: char| c.is_alphabetic() || matches!(c, '_' | '"' | '\''));
    let is_key = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | '"' | '\'' | ' ');
    (is_name && name.chars().all(is_key)).then_some(line)
}

#[cfg(test)]
mod tests {
    use super::table_header;

    #[test]
    fn headers_are_told_from_lists() {
        #[rustfmt::skip]
        let cases = [
            ("[frequency]\nfrom = 1", Some("[frequency]")),
            ("\n  [[mode]]  # the first\n", Some("[[mode]]")),
            ("[a.beam]", Some("[a.beam]")),
            ("[1, 2]\n[3, 4]", None),
            ("[[1.0,", None),
            ("[]", None),
            ("[{\"a\": 1}]", None),
            ("name = 1", None),
            ("", None),
        ];
        for (text, header) in cases {
            assert_eq!(table_header(text), header, "{text}");
        }
    }
}
