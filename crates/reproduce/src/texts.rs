//! What is said beside the tables of Tol's thesis: the texts of `texts.toml`.

use serde::Deserialize;

use super::draws::Draws;
use super::error::ReproduceError;
use super::outcome::{Reproduction, Row};
use super::published::PublishedTable;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    text: Vec<Texts>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Texts {
    /// Keys of the tables that they belong to.
    tables: Vec<String>,
    #[serde(default)]
    conditions: Vec<String>,
    #[serde(default)]
    differences: Vec<String>,
    #[serde(default)]
    not_given: Vec<String>,
}

/// The rows of a table with what is said about them.
pub(super) fn with_texts(
    table: PublishedTable,
    rows: Vec<Row>,
    draws: &Draws,
) -> Result<Reproduction, ReproduceError> {
    let File { text } = toml::from_str(include_str!("texts.toml"))?;
    let mut found = Reproduction {
        table,
        conditions: Vec::new(),
        rows,
        differences: Vec::new(),
        not_given: Vec::new(),
    };
    let is_of = |texts: &Texts| texts.tables.iter().any(|key| key == table.key());
    for texts in text.into_iter().filter(is_of) {
        found.conditions.extend(texts.conditions);
        found.differences.extend(texts.differences);
        found.not_given.extend(texts.not_given);
    }
    let samples: Vec<String> = draws.samples.iter().map(u32::to_string).collect();
    for text in &mut found.not_given {
        *text = text.replace("{samples}", &samples.join(", "));
    }
    Ok(found)
}
