//! Texts that begin with a bracket: a list of JSON, or a table of TOML. Neither is a joint file, and what a parser of JSON says of
//! them, which takes a list for the values of a record, tells nobody what they are.

use bolted_joint_files::table_header;
use serde_json::Value;

use super::{Format, JointFileError};

/// Refuses such a text; `tree` is what it holds, if it is JSON.
pub(super) fn refuse(text: &str, tree: Option<&Value>, origin: &str) -> Result<(), JointFileError> {
    if !text.trim_start().starts_with('[') {
        return Ok(());
    }
    let origin = origin.to_owned();
    if let (None, Some(header)) = (tree, table_header(text)) {
        return Err(JointFileError::TableHeader {
            origin,
            header: header.to_owned(),
        });
    }
    let entries = tree
        .and_then(Value::as_array)
        .map_or(&[][..], Vec::as_slice);
    let is_joint_file =
        |entry: &&Value| entry.get("format").and_then(Value::as_str) == Some(Format::NAME);
    Err(JointFileError::List {
        origin,
        joint_files: entries.iter().filter(is_joint_file).count(),
    })
}
