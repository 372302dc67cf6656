//! Finds the key that a misspelt one was meant to be.

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

/// Levenshtein distance: insertions, deletions and replacements of a letter.
fn edits(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.to_lowercase().chars().collect();
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (i, letter) in from.to_lowercase().chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, other) in to.iter().enumerate() {
            let replaced = diagonal + usize::from(letter != *other);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_is_levenshteins() {
        for (from, to, expected) in [
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
}
