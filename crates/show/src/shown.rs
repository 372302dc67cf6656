//! What is told of a file, whatever its kind.

use std::path::PathBuf;

use bolted_joint_files::number;
use bolted_joint_report::ShownPicture;
use serde_json::{Map, Value};

/// What is in a file.
#[derive(Debug, Default)]
pub struct Shown {
    /// The file.
    pub path: PathBuf,
    /// What it is.
    pub kind: String,
    /// What is in it.
    pub facts: Vec<Fact>,
    /// What somebody who goes on with it should know.
    pub warnings: Vec<String>,
    /// Why the joint in it is not to be relied on.
    pub reasons_against: Vec<String>,
    /// The command that goes on with it.
    pub next: Option<String>,
    /// Numbers, for machines.
    pub details: Map<String, Value>,
    /// Pictures of it.
    pub pictures: Vec<ShownPicture>,
}

/// One thing that is told.
#[derive(Debug, Clone, PartialEq)]
pub struct Fact {
    /// What it is about, a word or two.
    pub label: &'static str,
    /// One line or several.
    pub lines: Vec<String>,
}

impl Shown {
    /// Nothing yet of a file of this kind.
    pub(crate) fn of(kind: impl Into<String>) -> Self {
        Self {
            kind: kind.into(),
            ..Self::default()
        }
    }

    /// One more line.
    pub(crate) fn fact(&mut self, label: &'static str, line: impl Into<String>) {
        self.facts_of(label, [line.into()]);
    }

    /// More lines about the same; nothing where there are none.
    pub(crate) fn facts_of(
        &mut self,
        label: &'static str,
        lines: impl IntoIterator<Item = String>,
    ) {
        let lines: Vec<String> = lines.into_iter().collect();
        if !lines.is_empty() {
            self.facts.push(Fact { label, lines });
        }
    }

    /// At most so many of the lines, and how many more there are.
    pub(crate) fn facts_of_some(
        &mut self,
        label: &'static str,
        lines: impl ExactSizeIterator<Item = String>,
        most: usize,
    ) {
        let more = lines.len().saturating_sub(most);
        let more = (more > 0).then(|| format!("and {more} more"));
        self.facts_of(label, lines.take(most).chain(more));
    }

    /// A number, or more, for machines.
    pub(crate) fn detail(&mut self, key: &str, value: impl Into<Value>) {
        self.details.insert(key.to_owned(), value.into());
    }
}

/// A number to so many significant digits at most.
pub(crate) fn short(value: f64, digits: usize) -> String {
    let text = number(value, digits);
    let (mantissa, exponent) = text.split_at(text.find('e').unwrap_or(text.len()));
    let mantissa = match mantissa.contains('.') {
        true => mantissa.trim_end_matches('0').trim_end_matches('.'),
        false => mantissa,
    };
    format!("{mantissa}{exponent}")
}

/// The first so many of a list, and how many more there are.
pub(crate) fn some<T: ToString>(all: impl IntoIterator<Item = T>, most: usize) -> String {
    let all: Vec<String> = all.into_iter().map(|own| own.to_string()).collect();
    let more = all.len().saturating_sub(most);
    let mut text = all.iter().take(most).cloned().collect::<Vec<_>>().join(" ");
    if more > 0 {
        text += &format!(" and {more} more");
    }
    text
}

/// A number and the thing it counts.
pub(crate) fn counted(count: usize, thing: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {thing}{ending}")
}
