//! The name of an FMU's library and of the class that import tools make of it: FMI's `modelIdentifier`.

use super::ExportError;

/// Longest identifier that is made of a name: tools make paths and class names of it.
const LONGEST: usize = 48;
/// Longest that is taken from the user.
const LONGEST_GIVEN: usize = 128;

/// Words of C (ISO/IEC 9899:2024, 6.4.1), and of C++, in which tools wrap FMUs: none of them is a name.
const WORDS: &str = "alignas alignof and asm auto bool break case catch char class const constexpr continue default delete do double \
                     else enum explicit extern false float for friend goto if inline int long mutable namespace new not nullptr \
                     operator or private protected public register restrict return short signed sizeof static static_assert struct \
                     switch template this thread_local throw true try typedef typeid typename typeof typeof_unqual union unsigned \
                     using virtual void volatile while xor _Alignas _Alignof _Atomic _BitInt _Bool _Complex _Decimal128 _Decimal32 \
                     _Decimal64 _Generic _Imaginary _Noreturn _Static_assert _Thread_local";

/// The identifier that the user gives, or one that is made of the model's name and of what it is.
pub(super) fn model_identifier(
    given: Option<&str>,
    name: &str,
    kind: &str,
) -> Result<String, ExportError> {
    match given {
        None => Ok(made_of(name, kind)),
        Some(given) if is_identifier(given) && given.len() <= LONGEST_GIVEN => Ok(given.to_owned()),
        Some(found) => Err(ExportError::NotAnIdentifier {
            found: found.to_owned(),
        }),
    }
}

/// Whether C takes it as a name (FMI 3.0, 2.4.1.1; FMI 2.0, 3.3.1).
fn is_identifier(text: &str) -> bool {
    let letters = text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let is_word = WORDS.split_whitespace().any(|word| word == text);
    letters && !is_word && text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

/// The words of the name, with underscores between them, and the kind behind them.
fn made_of(name: &str, kind: &str) -> String {
    let words = name.split(|c: char| !c.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    let mut own = words.join("_");
    own.truncate(LONGEST);
    let own = own.trim_end_matches('_');
    match own.chars().next() {
        None => format!("joint_{kind}"),
        Some(first) if first.is_ascii_digit() => format!("joint_{own}_{kind}"),
        Some(_) => format!("{own}_{kind}"),
    }
}

#[cfg(test)]
mod tests {
    use super::model_identifier;

    #[test]
    fn names_become_identifiers_of_c() {
        for (name, expected) in [
            (
                "M10x16 A2-70 on 6 mm aluminium",
                "M10x16_A2_70_on_6_mm_aluminium_lap",
            ),
            ("8.8 bolt", "joint_8_8_bolt_lap"),
            ("Größe", "Gr_e_lap"),
            ("螺栓", "joint_lap"),
        ] {
            assert_eq!(model_identifier(None, name, "lap").unwrap(), expected);
        }
        let long = model_identifier(None, &"word ".repeat(40), "lap").unwrap();
        assert!(long.len() <= 52 && !long.contains("__"), "{long}");
    }

    #[test]
    fn what_is_none_is_refused() {
        assert_eq!(
            model_identifier(Some("Bolt_1"), "x", "lap").unwrap(),
            "Bolt_1"
        );
        for given in [
            "",
            "1bolt",
            "a b",
            "a-b",
            "ä",
            "while",
            "class",
            &"a".repeat(200),
        ] {
            assert!(
                model_identifier(Some(given), "x", "lap").is_err(),
                "{given}"
            );
        }
    }
}
