//! The instantiation token: whoever instantiates the library with it has read this FMU's own model description.

use sha2::{Digest, Sha256};

/// SHA-256 over the `parts`, each preceded by its length, in lower-case hexadecimal digits.
pub(super) fn token(parts: &[&str]) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part);
    }
    let digits = hash.finalize();
    digits.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::token;

    #[test]
    fn it_is_the_hash_of_lengths_and_parts() {
        // Reference: printf '\003\0\0\0\0\0\0\0abc\0\0\0\0\0\0\0\0' | sha256sum
        assert_eq!(
            token(&["abc", ""]),
            "3e2f8940c3a0e0fd6f6e07bbf07f015dd7c147431e5fa14bf3f225d782641540"
        );
    }

    #[test]
    fn moving_text_between_the_parts_changes_it() {
        assert_ne!(token(&["ab", "c"]), token(&["a", "bc"]));
    }
}
