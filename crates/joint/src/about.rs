//! Who stands behind a joint, and what others may do with it.

#[cfg(test)]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Who stands behind a joint, and what others may do with it; the FMU says the same of itself.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct About {
    /// Author and organisation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub author: Option<String>,
    /// Version of the joint, such as `1.2`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub version: Option<String>,
    /// Licence of the joint, such as `CC-BY-4.0`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub license: Option<String>,
    /// Copyright, such as `© 2026 Example Ltd.`
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub copyright: Option<String>,
}

impl About {
    /// Its texts by their keys.
    pub fn texts(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let all = [
            ("author", &self.author),
            ("version", &self.version),
            ("license", &self.license),
            ("copyright", &self.copyright),
        ];
        all.into_iter()
            .filter_map(|(key, text)| Some((key, text.as_deref()?)))
    }
}
