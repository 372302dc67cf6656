//! Writes a joint file so that people can read it: one line for each row of a matrix.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

use super::{JointFile, JointFileError};
use bolted_joint_files::whole_file;

impl JointFile {
    /// The file as JSON text; numbers have the fewest digits that read back to the same value.
    ///
    /// # Errors
    ///
    /// [`JointFileError::Invalid`] where reading would refuse the text.
    pub fn to_json(&self) -> Result<String, JointFileError> {
        let invalid = |problems| JointFileError::Invalid {
            origin: self.name.clone(),
            problems,
        };
        let problems = self.validate();
        if !problems.is_empty() {
            return Err(invalid(problems));
        }
        // Finite numbers and text keys, which validation has seen to, always have a JSON form.
        let value = serde_json::to_value(self).map_err(|_| invalid(Vec::new()))?;
        let mut text = String::new();
        append(&mut text, &value, 0);
        text.push('\n');
        Ok(text)
    }

    /// Writes the file to `path`, whole or not at all.
    ///
    /// # Errors
    ///
    /// [`JointFileError::Invalid`] as [`JointFile::to_json`], [`JointFileError::Unwritable`] where the system refuses.
    pub fn write(&self, path: &Path) -> Result<(), JointFileError> {
        let text = self.to_json()?;
        whole_file::write(path, text.as_bytes()).map_err(|source| JointFileError::Unwritable {
            path: path.to_path_buf(),
            source,
        })
    }
}

/// Appends `value`, indented by `depth` levels: lists of numbers or words on one line, everything else on lines of its own.
fn append(text: &mut String, value: &Value, depth: usize) {
    match value {
        Value::Array(entries) if entries.iter().any(is_container_or_long) => {
            block(text, ['[', ']'], entries.len(), depth, |text, i| {
                append(text, &entries[i], depth + 1);
            });
        }
        Value::Array(entries) => {
            let words: Vec<String> = entries.iter().map(Value::to_string).collect();
            // writing to a String cannot fail
            let _ = write!(text, "[{}]", words.join(", "));
        }
        Value::Object(entries) => {
            let entries: Vec<(&String, &Value)> = entries.iter().collect();
            block(text, ['{', '}'], entries.len(), depth, |text, i| {
                let (key, value) = entries[i];
                let _ = write!(text, "{}: ", Value::from(key.as_str()));
                append(text, value, depth + 1);
            });
        }
        scalar => {
            let _ = write!(text, "{scalar}");
        }
    }
}

fn is_container_or_long(value: &Value) -> bool {
    match value {
        Value::Array(_) | Value::Object(_) => true,
        Value::String(word) => word.len() > 40,
        _ => false,
    }
}

fn block(
    text: &mut String,
    [open, close]: [char; 2],
    count: usize,
    depth: usize,
    entry: impl Fn(&mut String, usize),
) {
    text.push(open);
    for i in 0..count {
        let comma = if i > 0 { "," } else { "" };
        let _ = write!(text, "{comma}\n{:1$}", "", 2 * (depth + 1));
        entry(text, i);
    }
    let _ = write!(text, "\n{:1$}{close}", "", 2 * depth);
}
