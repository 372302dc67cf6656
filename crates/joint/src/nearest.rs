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
}
