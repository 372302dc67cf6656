//! Fields of the header records: by column as the standard says, by blanks where a writer did not count columns.

/// The text of columns `from..to` (from 0), without surrounding blanks; empty past the end of the line.
pub(super) fn columns(line: &str, from: usize, to: usize) -> String {
    let field: String = line.chars().skip(from).take(to - from).collect();
    field.trim().to_owned()
}

/// Consecutive fields of these widths, without surrounding blanks.
pub(super) fn split_columns<const N: usize>(line: &str, widths: [usize; N]) -> [String; N] {
    let mut from = 0;
    widths.map(|width| {
        let field = columns(line, from, from + width);
        from += width;
        field
    })
}

/// The fields of a line that blanks separate, if there are as many as expected.
pub(super) fn split_blanks<const N: usize>(line: &str) -> Option<[String; N]> {
    let fields: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
    fields.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_may_lie_past_the_end() {
        assert_eq!(columns("ab µm cd", 3, 6), "µm");
        assert_eq!(columns("ab", 5, 9), "");
        assert_eq!(split_columns("   12   3", [5, 4, 4]), ["12", "3", ""]);
    }

    #[test]
    fn blanks_separate_only_the_expected_number_of_fields() {
        assert_eq!(
            split_blanks::<3>(" a  b c "),
            Some(["a", "b", "c"].map(str::to_owned))
        );
        assert_eq!(split_blanks::<2>("a b c"), None);
    }
}
