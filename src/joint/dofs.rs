//! Which relative motions of its two sides a joint resists.

use std::fmt;

#[cfg(test)]
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

/// Degrees of freedom of a joint, in the order of the rows of its matrices.
///
/// In the file it is the list `["y"]` or `["y", "theta"]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "Vec<String>", into = "Vec<&'static str>")]
pub enum DofSet {
    /// Translation y alone.
    Translation,
    /// Translation y and rotation θ.
    TranslationRotation,
}

impl DofSet {
    /// Number of DOFs: the order of the joint's matrices.
    #[must_use]
    pub fn count(self) -> usize {
        self.names().len()
    }

    /// Names of the DOFs in the order of the matrices' rows.
    #[must_use]
    pub fn names(self) -> &'static [&'static str] {
        match self {
            Self::Translation => &["y"],
            Self::TranslationRotation => &["y", "theta"],
        }
    }
}

/// The list as it stands in the file.
impl fmt::Display for DofSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.names())
    }
}

impl From<DofSet> for Vec<&'static str> {
    fn from(dofs: DofSet) -> Self {
        dofs.names().to_vec()
    }
}

impl TryFrom<Vec<String>> for DofSet {
    type Error = String;

    fn try_from(names: Vec<String>) -> Result<Self, String> {
        [Self::Translation, Self::TranslationRotation]
            .into_iter()
            .find(|dofs| dofs.names() == names)
            .ok_or_else(|| format!("found {names:?}, expected [\"y\"] or [\"y\", \"theta\"]"))
    }
}

#[cfg(test)]
impl JsonSchema for DofSet {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "DofSet".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Relative motions that the joint resists: translation y (m), rotation theta (rad). \
                            They set the order of the matrices.",
            "enum": [Self::Translation.names(), Self::TranslationRotation.names()]
        })
    }
}
