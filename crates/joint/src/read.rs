//! Reads a joint file, and says by key, line and column what is wrong with one.

use std::path::Path;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use serde_json::{Value, error::Category};

use super::{Format, JointFile, JointFileError, TextPlace, bracket};
use bolted_joint_files::{Encoding, nearest, text_file};

impl JointFile {
    /// Reads and checks the joint file at `path`.
    ///
    /// # Errors
    ///
    /// [`JointFileError`] where the file cannot be read, is not of this format, or contradicts itself.
    pub fn read(path: &Path) -> Result<Self, JointFileError> {
        Self::read_with_source(path).map(|(file, _)| file)
    }

    /// As [`JointFile::read`], together with the very text of the file, which the export keeps.
    ///
    /// # Errors
    ///
    /// As [`JointFile::read`].
    pub fn read_with_source(path: &Path) -> Result<(Self, String), JointFileError> {
        let bytes = text_file::bytes(path).map_err(|source| JointFileError::Unreadable {
            path: path.to_path_buf(),
            source,
        })?;
        let origin = path.display().to_string();
        let bytes = bytes.ok_or_else(|| JointFileError::TooLong {
            origin: origin.clone(),
            limit: text_file::LONGEST_FILE,
        })?;
        let source = String::from_utf8(bytes).map_err(|refused| {
            let is_zip = refused.as_bytes().starts_with(b"PK\x03\x04");
            JointFileError::Binary {
                origin: origin.clone(),
                found: match Encoding::other_than_utf8(refused.as_bytes()) {
                    _ if is_zip => "a zip archive (an FMU?)",
                    Some(_) => "text in another encoding than UTF-8: save it as UTF-8",
                    None => "bytes that are no text",
                },
            }
        })?;
        Ok((Self::from_json(&source, &origin)?, source))
    }

    /// Reads and checks the text of a joint file; `origin` names it in messages.
    ///
    /// ```
    /// use bolted_joint_joint::JointFile;
    ///
    /// let text = r#"{
    ///     "format": "bolted-joint/1",
    ///     "name": "one bolt",
    ///     "joint": { "dofs": ["y"], "stiffness": [[1.87e8]], "damping": [[120.0]] }
    /// }"#;
    /// let file = JointFile::from_json(text, "one-bolt.joint.json")?;
    /// assert!(file.passivity().is_passive());
    /// let error = JointFile::from_json(&text.replace("120.0", "-1"), "x").map(|file| file.passivity().is_passive());
    /// assert!(!error?);
    /// # Ok::<(), bolted_joint_joint::JointFileError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`JointFile::read`].
    pub fn from_json(text: &str, origin: &str) -> Result<Self, JointFileError> {
        let origin = origin.to_owned();
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if text.trim().is_empty() {
            return Err(JointFileError::Empty { origin });
        }
        if text.contains('\0') {
            let found = "text with NUL characters";
            return Err(JointFileError::Binary { origin, found });
        }
        // Broken text is left to the reading proper, which tells more about it.
        let tree: Option<Value> = serde_json::from_str(text).ok();
        bracket::refuse(text, tree.as_ref(), &origin)?;
        if let Some(tree) = &tree {
            check_version(tree, &origin)?;
        }
        let mut deserializer = serde_json::Deserializer::from_str(text);
        let file: Self =
            serde_path_to_error::deserialize(&mut deserializer).map_err(|refused| {
                let path = refused.path().to_string();
                explain(text, &origin, path, &refused.into_inner())
            })?;
        deserializer
            .end()
            .map_err(|refused| explain(text, &origin, ".".to_owned(), &refused))?;
        let written = serde_json::to_value(&file).ok();
        if let Some(path) = tree
            .zip(written)
            .and_then(|(found, written)| list_for_record(&found, &written, "."))
        {
            return Err(JointFileError::NotAnObject { origin, path });
        }
        let problems = file.validate();
        if problems.is_empty() {
            Ok(file)
        } else {
            Err(JointFileError::Invalid { origin, problems })
        }
    }
}

/// Looks at the version alone, so that a newer file is not refused for the keys that are new in it.
fn check_version(tree: &Value, origin: &str) -> Result<(), JointFileError> {
    match tree.get("format") {
        Some(found) if found != Format::NAME => Err(JointFileError::Version {
            origin: origin.to_owned(),
            found: found.to_string(),
        }),
        _ => Ok(()),
    }
}

/// Path of a list in `found` that stands for a record by the order of its entries, which serde would accept.
fn list_for_record(found: &Value, written: &Value, path: &str) -> Option<String> {
    match (found, written) {
        (Value::Array(_), Value::Object(_)) => Some(path.to_owned()),
        (Value::Object(found), Value::Object(written)) => written
            .iter()
            .find_map(|(key, value)| list_for_record(found.get(key)?, value, &child(path, key))),
        (Value::Array(found), Value::Array(written)) => {
            let mut pairs = found.iter().zip(written).enumerate();
            pairs.find_map(|(i, (found, written))| {
                list_for_record(found, written, &format!("{path}[{i}]"))
            })
        }
        _ => None,
    }
}

/// Turns the parser's refusal into this format's terms.
fn explain(text: &str, origin: &str, path: String, refused: &serde_json::Error) -> JointFileError {
    let at = TextPlace {
        origin: origin.to_owned(),
        line: refused.line(),
        column: refused.column(),
        path,
    };
    let message = refused.to_string();
    let message = message
        .strip_suffix(&format!(" at line {} column {}", at.line, at.column))
        .unwrap_or(&message)
        .to_owned();
    match refused.classify() {
        Category::Eof => JointFileError::Truncated { at },
        Category::Data => explain_data(at, &message),
        Category::Io | Category::Syntax => match literal_that_is_not_finite(text, &at, &message) {
            Some(found) => JointFileError::NotFinite { at, found },
            None => JointFileError::NotJson { at, message },
        },
    }
}

/// JSON has no NaN and no infinity, but programs write them, and numbers too large to be held.
fn literal_that_is_not_finite(text: &str, at: &TextPlace, message: &str) -> Option<String> {
    let line = text.lines().nth(at.line.checked_sub(1)?)?;
    let ends_token = |c: char| c.is_whitespace() || matches!(c, ',' | '[' | ']' | '{' | '}' | ':');
    let end = line
        .char_indices()
        .map(|(index, _)| index)
        .rfind(|index| *index < at.column)?;
    let start = line[..end].rfind(ends_token).map_or(0, |index| index + 1);
    let token = line[start..].split(ends_token).next()?;
    let not_finite = ["nan", "inf", "infinity"];
    let bare = token.trim_start_matches(['+', '-']).to_lowercase();
    (message == "number out of range" || not_finite.contains(&bare.as_str()))
        .then(|| token.to_owned())
}

fn explain_data(at: TextPlace, message: &str) -> JointFileError {
    // Serde words these messages the same for every format: unknown field `x`, expected one of `y`, `z`.
    let mut quoted = message.split('`').skip(1).step_by(2);
    let at_key = |at: TextPlace, key: &str| TextPlace {
        path: child(&at.path, key),
        ..at
    };
    if message.starts_with("unknown field") {
        let key = quoted.next().unwrap_or_default();
        let known: Vec<&str> = quoted.collect();
        return JointFileError::UnknownKey {
            at: at_key(at, key),
            nearest: nearest(key, &known).map(str::to_owned),
            known: known.into_iter().map(str::to_owned).collect(),
        };
    }
    if message.starts_with("missing field") {
        let at = at_key(at, quoted.next().unwrap_or_default());
        return JointFileError::MissingKey { at };
    }
    if message.starts_with("invalid type: sequence, expected struct") {
        let TextPlace { origin, path, .. } = at;
        return JointFileError::NotAnObject { origin, path };
    }
    if message.starts_with("duplicate field") {
        let at = at_key(at, quoted.next().unwrap_or_default());
        return JointFileError::Twice { at };
    }
    let message = found_and_expected(message);
    JointFileError::WrongType { at, message }
}

/// `path.key`, unless the path already ends there.
fn child(path: &str, key: &str) -> String {
    if path == "." || path == key {
        key.to_owned()
    } else if path.ends_with(&format!(".{key}")) {
        path.to_owned()
    } else {
        format!("{path}.{key}")
    }
}

/// `invalid type: string "x", expected f64` in this project's words.
fn found_and_expected(message: &str) -> String {
    let Some(rest) = ["invalid type: ", "invalid value: ", "invalid length "]
        .iter()
        .find_map(|start| message.strip_prefix(start))
    else {
        return message.to_owned();
    };
    let Some((found, expected)) = rest.rsplit_once(", expected ") else {
        return message.to_owned();
    };
    let expected = match expected {
        "f64" => "a number",
        "usize" => "a whole number",
        "a sequence" => "a list",
        "a map" => "an object",
        record if record.starts_with("struct ") => "an object",
        other => other,
    };
    let found = match found {
        "map" => "an object",
        "sequence" => "a list",
        other => other,
    };
    // floating point `1.5`, integer `2`, boolean `true`
    let literal = found
        .split_once('`')
        .and_then(|(_, literal)| literal.strip_suffix('`'));
    let found = literal.unwrap_or(found);
    format!("found {found}, expected {expected}")
}

/// Exactly two numbers.
pub(super) fn pair<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 2], D::Error> {
    let entries = Vec::<f64>::deserialize(deserializer)?;
    <[f64; 2]>::try_from(entries)
        .map_err(|entries| D::Error::custom(format!("found {} entries, expected 2", entries.len())))
}
