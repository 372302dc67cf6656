//! Finds the word that a misspelt one was meant to be, in what people write and in what parsers say of it.

/// The candidate that is fewest edits away from `word`, if that is less than half of the word.
#[must_use]
pub fn nearest<'a>(word: &str, candidates: &[&'a str]) -> Option<&'a str> {
    candidates
        .iter()
        .map(|candidate| (edits(word, candidate), *candidate))
        .min_by_key(|(edits, _)| *edits)
        .filter(|(edits, _)| 2 * edits < word.chars().count().max(2))
        .map(|(_, candidate)| candidate)
}

/// What is added to a message about a word that is not known; nothing where none of the known ones is near.
#[must_use]
pub fn did_you_mean(word: &str, known: &[&str]) -> String {
    nearest(word, known).map_or_else(String::new, |meant| format!("; did you mean `{meant}`?"))
}

/// What serde says of a key or a word that is not known, up to its name.
const UNKNOWN: [&str; 2] = ["unknown field `", "unknown variant `"];
/// What it says of a text that its reader does not take, up to the text.
const NOT_TAKEN: &str = "invalid value: string \"";
/// What it says of a key that is missing, up to its name.
const MISSING: &str = "missing field `";

/// What serde calls a type that it expected, at the end of its message, and what people call it.
const TYPES: [(&str, &str); 12] = [
    ("f64", "a number"),
    ("u8", "a whole number"),
    ("u16", "a whole number"),
    ("u32", "a whole number"),
    ("u64", "a whole number"),
    ("usize", "a whole number"),
    ("i32", "a whole number"),
    ("i64", "a whole number"),
    ("a boolean", "true or false"),
    ("a string", "a text"),
    ("a sequence", "a list"),
    ("a map", "a table"),
];

/// A message that ends in the name of a type, with the word that people have for it.
fn in_words(message: &str) -> String {
    let known = message.rsplit_once(", expected ").and_then(|(found, own)| {
        let known = TYPES.iter().find(|(name, _)| *name == own);
        let words = known.map(|(_, words)| *words);
        let words = words.or_else(|| own.starts_with("struct ").then_some("a table"))?;
        Some(format!("{found}, expected {words}"))
    });
    known.unwrap_or_else(|| message.to_owned())
}

/// A message of a parser's in words, with the one that was meant: by the words that it names itself, or where a key is missing by
/// those of the `keys` that are there.
#[must_use]
pub fn with_meant<'a>(message: &str, keys: impl IntoIterator<Item = &'a str>) -> String {
    let unknown = || {
        let mut begins = UNKNOWN.iter();
        begins.find_map(|begin| {
            let (found, expected) = message.split_once(begin)?.1.split_once('`')?;
            Some(did_you_mean(found, &between(expected, '`')))
        })
    };
    let not_taken = || {
        let (found, expected) = message.split_once(NOT_TAKEN)?.1.split_once('"')?;
        Some(did_you_mean(found, &between(expected, '"')))
    };
    let missing = || {
        let missing = message.split_once(MISSING)?.1.split('`').next()?;
        let mut keys = keys.into_iter();
        let found = keys.find(|key| nearest(key, &[missing]).is_some())?;
        Some(format!("; found `{found}`, did you mean `{missing}`?"))
    };
    let suggestion = unknown().or_else(not_taken).or_else(missing);
    in_words(message) + &suggestion.unwrap_or_default()
}

/// The words of a text that stand between such marks.
pub fn between(text: &str, mark: char) -> Vec<&str> {
    text.split(mark).skip(1).step_by(2).collect()
}

/// Insertions, deletions, replacements and exchanges of neighbouring letters (Levenshtein's distance with exchanges).
fn edits(from: &str, to: &str) -> usize {
    let [from, to] = [from, to].map(|word| word.to_lowercase().chars().collect::<Vec<char>>());
    let first: Vec<usize> = (0..=to.len()).collect();
    let mut rows = vec![first];
    for i in 0..from.len() {
        let mut row = vec![i + 1];
        for j in 0..to.len() {
            let replaced = rows[i][j] + usize::from(from[i] != to[j]);
            let mut least = replaced.min(row[j] + 1).min(rows[i][j + 1] + 1);
            if i > 0 && j > 0 && from[i] == to[j - 1] && from[i - 1] == to[j] {
                least = least.min(rows[i - 1][j - 1] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[from.len()][to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_is_levenshteins_with_exchanges() {
        for (from, to, expected) in [
            ("heigth", "height", 1),
            ("kitten", "sitting", 3),
            ("stifness", "stiffness", 1),
            ("", "abc", 3),
            ("Damping", "damping", 0),
        ] {
            assert_eq!(edits(from, to), expected, "{from} {to}");
        }
    }

    #[test]
    fn only_a_near_key_is_suggested() {
        let keys = ["dofs", "stiffness", "damping", "cubic"];
        assert_eq!(nearest("stifness", &keys), Some("stiffness"));
        assert_eq!(nearest("dof", &keys), Some("dofs"));
        assert_eq!(nearest("mass", &keys), None);
    }

    #[test]
    fn a_message_gets_the_word_that_was_meant() {
        #[rustfmt::skip]
        let cases = [
            ("unknown field `fromm`, expected one of `from`, `to`", "; did you mean `from`?"),
            ("unknown field `stiffness`, expected one of `from`, `to`", ""),
            ("invalid value: string \"non\", expected \"none\" or a table", "; did you mean `none`?"),
            ("invalid value: string \"mass\", expected \"none\" or a table", ""),
            ("missing field `points`", "; found `pionts`, did you mean `points`?"),
            ("missing field `shape`", ""),
        ];
        for (message, expected) in cases {
            let found = with_meant(message, ["pionts", "mode"]);
            assert_eq!(found, format!("{message}{expected}"));
        }
    }

    #[test]
    fn a_message_names_types_as_people_do() {
        #[rustfmt::skip]
        let cases = [
            ("line 2\ninvalid type: string \"5 Hz\", expected f64", "line 2\ninvalid type: string \"5 Hz\", expected a number"),
            ("invalid type: floating point `1.5`, expected usize", "invalid type: floating point `1.5`, expected a whole number"),
            ("invalid type: integer `5`, expected struct Joint", "invalid type: integer `5`, expected a table"),
            ("invalid type: map, expected a length", "invalid type: map, expected a length"),
        ];
        for (message, expected) in cases {
            assert_eq!(with_meant(message, []), expected);
        }
    }
}
