//! What placeholders in braces stand for: in names of variables the names of a DOF, in texts the words for it.

use bolted_joint_dynamics::{Dof, DofKind};

/// A quantity of a DOF.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    Displacement,
    Rate,
    Acceleration,
    Load,
    Inertia,
}

impl Quantity {
    pub(super) fn parse(word: &str) -> Option<Self> {
        Some(match word {
            "displacement" => Self::Displacement,
            "rate" => Self::Rate,
            "acceleration" => Self::Acceleration,
            "load" => Self::Load,
            "inertia" => Self::Inertia,
            _ => return None,
        })
    }

    /// Its name in variables.
    pub(super) const fn name(self, dof: &Dof) -> &'static str {
        match self {
            Self::Displacement => dof.name,
            Self::Rate => dof.rate,
            Self::Acceleration => dof.acceleration,
            Self::Load => dof.load,
            Self::Inertia => dof.inertia,
        }
    }

    /// The word for it.
    pub(super) const fn word(self, kind: DofKind) -> &'static str {
        match self {
            Self::Displacement => kind.displacement(),
            Self::Rate => kind.rate(),
            Self::Acceleration => kind.acceleration(),
            Self::Load => kind.load(),
            Self::Inertia => kind.inertia(),
        }
    }
}

/// The word that a placeholder stands for, with a capital where the placeholder has one; `translation|rotation` stands for the one
/// or the other.
pub(super) fn word(placeholder: &str, kind: DofKind) -> Option<String> {
    if let Some((translation, rotation)) = placeholder.split_once('|') {
        let word = match kind {
            DofKind::Translation => translation,
            DofKind::Rotation => rotation,
        };
        return Some(word.to_owned());
    }
    let small = placeholder.to_ascii_lowercase();
    let word = match small.as_str() {
        "motion" => kind.motion(),
        other => Quantity::parse(other)?.word(kind),
    };
    Some(if placeholder == small {
        word.to_owned()
    } else {
        capitalised(word)
    })
}

/// The name of a type after words: those of `moment of inertia` put together, each with a capital.
pub(super) fn type_name(words: &str) -> String {
    words.split(' ').map(capitalised).collect()
}

fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters
        .next()
        .map(|first| first.to_uppercase().chain(letters).collect())
        .unwrap_or_default()
}

/// `text` with each `{placeholder}` replaced, or the first placeholder that stands for nothing.
pub(super) fn filled(text: &str, value: impl Fn(&str) -> Option<String>) -> Result<String, String> {
    let mut filled = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('{') {
        let (placeholder, after) = after.split_once('}').ok_or_else(|| after.to_owned())?;
        filled.push_str(before);
        filled.push_str(&value(placeholder).ok_or_else(|| placeholder.to_owned())?);
        rest = after;
    }
    filled.push_str(rest);
    Ok(filled)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_follow_the_kind() {
        for (placeholder, translation, rotation) in [
            ("Inertia", "Mass", "Moment of inertia"),
            ("motion", "translation", "rotation"),
            ("1|2e-3", "1", "2e-3"),
            ("rate", "velocity", "angular velocity"),
        ] {
            assert_eq!(
                word(placeholder, DofKind::Translation).unwrap(),
                translation
            );
            assert_eq!(word(placeholder, DofKind::Rotation).unwrap(), rotation);
        }
        assert_eq!(word("force", DofKind::Translation), None);
        assert_eq!(type_name("moment of inertia"), "MomentOfInertia");
    }

    #[test]
    fn placeholders_are_replaced() {
        let value = |placeholder: &str| (placeholder == "x").then(|| "y".to_owned());
        assert_eq!(filled("a.{x}{x}_", value), Ok("a.yy_".to_owned()));
        assert_eq!(filled("a.{z}", value), Err("z".to_owned()));
        assert_eq!(filled("a.{x", value), Err("x".to_owned()));
    }
}
