//! Whether a joint may be relied on, as whoever found it says.

#[cfg(test)]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::JointFile;

/// Whether the joint may be used.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Status {
    /// Whether it may; a file without a status may be used.
    pub usable: bool,
    /// Why not, a line each; there is none where it may be used.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reasons: Vec<String>,
}

impl Status {
    /// The status of a joint that these reasons speak against; none where there are none.
    #[must_use]
    pub fn against(reasons: &[String]) -> Option<Self> {
        (!reasons.is_empty()).then(|| Self {
            usable: false,
            reasons: reasons.to_vec(),
        })
    }
}

impl JointFile {
    /// Why the joint is not to be relied on; empty where it may be used.
    #[must_use]
    pub fn reasons_against(&self) -> &[String] {
        match &self.status {
            Some(status) if !status.usable => &status.reasons,
            _ => &[],
        }
    }
}
