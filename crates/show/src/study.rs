//! A study: what it asks for, and the files that it names, each with what is in it.

use bolted_joint_study::{Method, StudyText};
use serde_json::json;
use toml::{Table, Value};

use crate::kind::{FileKind, command_for};
use crate::{ShowError, Shown};

/// Values that are listed at most.
const LISTED: usize = 30;
/// Endings of the names of files that studies name.
const ENDINGS: [&str; 11] = [
    "uff", "unv", "uf", "bunv", "csv", "tsv", "txt", "npz", "mat", "toml", "json",
];

pub(crate) fn shown(text: &StudyText) -> Result<Shown, ShowError> {
    let method = text.method()?;
    let tables: Table = text.tables()?;
    let mut shown = Shown::of(format!("study of method \"{method}\""));
    if let Some(name) = tables.get("name").and_then(Value::as_str) {
        shown.fact("name", name);
    }
    let (mut files, mut values) = (Vec::new(), Vec::new());
    for (key, value) in &tables {
        if !["method", "name"].contains(&key.as_str()) {
            walk(key, value, &mut files, &mut values);
        }
    }
    let told = files.iter().map(|(key, name)| {
        let path = text.resolved(name.as_ref());
        let what = match path.exists() {
            false => "is not there".to_owned(),
            true => FileKind::of(&path).to_string(),
        };
        (format!("{key} = {name}: {what}"), path.exists())
    });
    let told: Vec<(String, bool)> = told.collect();
    for (line, _) in told.iter().filter(|own| !own.1) {
        shown.warnings.push(format!(
            "{line}; paths in a study are relative to its own folder"
        ));
    }
    shown.facts_of("files", told.iter().map(|own| own.0.clone()));
    let more = values.len().saturating_sub(LISTED);
    let more = (more > 0).then(|| format!("and {more} more"));
    shown.facts_of("says", values.into_iter().take(LISTED).chain(more));
    shown.detail("method", method.name());
    let names = files
        .iter()
        .map(|(key, name)| json!({ "key": key, "file": name }));
    shown.detail("files", names.collect::<Vec<_>>());
    let next = Next::of(method, &tables);
    shown.detail("command", next.command(method));
    shown.next = next.line(method, text, has_lines(&tables));
    Ok(shown)
}

/// What a study is ready for.
#[derive(Clone, Copy, PartialEq)]
enum Next {
    /// What its method is for.
    Method,
    /// A study in space all of whose joints are known: the functions of the assembly.
    Functions,
    /// A study in space without a measured assembly: what a test would tell.
    Plan,
}

impl Next {
    fn of(method: Method, tables: &Table) -> Self {
        if method != Method::FrfSpace {
            return Self::Method;
        }
        let joints = match tables.get("joint") {
            Some(Value::Array(joints)) => joints.iter().collect(),
            Some(joint) => vec![joint],
            None => Vec::new(),
        };
        if !joints.is_empty() && joints.iter().all(|joint| joint.get("known").is_some()) {
            Self::Functions
        } else if tables
            .get("assembly")
            .is_none_or(|own| own.get("frf").is_none())
        {
            Self::Plan
        } else {
            Self::Method
        }
    }

    fn command(self, method: Method) -> &'static str {
        match self {
            Self::Method => method.command(),
            Self::Functions | Self::Plan => Method::Respond.command(),
        }
    }

    /// The command as one types it. What is computed alone has no lines of its own.
    fn line(self, method: Method, text: &StudyText, has_lines: bool) -> Option<String> {
        let path = text.path();
        let step = if has_lines { "" } else { " --step HZ" };
        match self {
            Self::Method => command_for(FileKind::Study(Some(method)), path),
            Self::Functions => command_for(FileKind::Study(Some(Method::Respond)), path)
                .map(|command| command + step),
            Self::Plan => Some(format!(
                "bolted-joint respond {} --plan{step}",
                path.display()
            )),
        }
    }
}

/// Whether a file of functions is named, whose lines a study in space has.
fn has_lines(tables: &Table) -> bool {
    tables.values().any(|table| table.get("frf").is_some())
}

/// Takes a value apart: names of files, and lines such as `a.beam.length = 0.3`.
fn walk(key: &str, value: &Value, files: &mut Vec<(String, String)>, lines: &mut Vec<String>) {
    match value {
        Value::Table(table) => {
            for (own, value) in table {
                walk(&format!("{key}.{}", part(own)), value, files, lines);
            }
        }
        Value::String(name) if is_file(name) => files.push((key.to_owned(), name.clone())),
        Value::Array(list)
            if list
                .iter()
                .any(|own| own.is_table() || own.as_str().is_some_and(is_file)) =>
        {
            for (place, value) in list.iter().enumerate() {
                walk(&format!("{key}[{place}]"), value, files, lines);
            }
        }
        other => {
            let text = written(other);
            let short: String = text.chars().take(80).collect();
            let dots = if short.len() < text.len() { "…" } else { "" };
            lines.push(format!("{key} = {short}{dots}"));
        }
    }
}

/// A part of a key, which stands in quotes where it is no word.
fn part(key: &str) -> String {
    let is_word = key
        .chars()
        .all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-'));
    match is_word {
        true => key.to_owned(),
        false => format!("{key:?}"),
    }
}

/// A value as a study has it.
fn written(value: &Value) -> String {
    match value {
        Value::String(text) => format!("{text:?}"),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) => number.to_string(),
        Value::Boolean(is) => is.to_string(),
        Value::Datetime(when) => when.to_string(),
        Value::Array(list) => {
            let list: Vec<String> = list.iter().map(written).collect();
            format!("[{}]", list.join(", "))
        }
        Value::Table(_) => "a table".to_owned(),
    }
}

fn is_file(name: &str) -> bool {
    let ending = name.rsplit_once('.').map(|own| own.1.to_ascii_lowercase());
    ending.is_some_and(|own| ENDINGS.contains(&own.as_str())) && !name.contains('\n')
}
