//! The JSON Schema of all studies, for editors: one alternative for each method, and one for assemblies.

mod described;

use std::collections::BTreeMap;

use bolted_joint::assembly::AssemblyModel;
use bolted_joint::identify::Study;
use bolted_joint::identify::lap::{LapResponseStudy, LapUpdateStudy};
use bolted_joint::identify::space::SpatialStudy;
use bolted_joint::predict::layered_beam::LayeredBeamStudy;
use bolted_joint::predict::study::InterfaceStudy;
use bolted_joint::respond::RespondStudy;
use bolted_joint::study::Method;
use bolted_joint::study::schema::Schema;
use described::Keys;
use serde_json::{Map, json};

/// What the schema's file is called beside a study.
pub(super) const FILE: &str = "bolted-joint.schema.json";

/// The schema as the text of a file.
pub(super) fn text() -> String {
    format!("{:#}\n", with_definitions(schema()))
}

/// The same schema with each table that stands in several places written once, and its keys in the order of the alphabet.
fn with_definitions(schema: Schema) -> Schema {
    let mut counts = BTreeMap::new();
    count_tables(&schema, &mut counts);
    counts.retain(|_, count| *count > 1);
    let names: BTreeMap<String, String> = (1..)
        .zip(counts.into_keys())
        .map(|(number, text)| (text, format!("table{number}")))
        .collect();
    let mut whole = shortened(&schema, &names, true);
    let definitions: Map<String, Schema> = names
        .iter()
        .filter_map(|(text, name)| {
            let own = serde_json::from_str(text).ok()?;
            Some((name.clone(), shortened(&own, &names, true)))
        })
        .collect();
    whole["definitions"] = sorted(definitions);
    match whole {
        Schema::Object(whole) => sorted(whole),
        other => other,
    }
}

/// How often each table with keys stands in a schema, by its text.
fn count_tables(schema: &Schema, counts: &mut BTreeMap<String, usize>) {
    match schema {
        Schema::Object(own) => {
            if is_table(own) {
                *counts
                    .entry(shortened(schema, &BTreeMap::new(), true).to_string())
                    .or_default() += 1;
            }
            own.values().for_each(|value| count_tables(value, counts));
        }
        Schema::Array(list) => list.iter().for_each(|value| count_tables(value, counts)),
        _ => {}
    }
}

fn is_table(schema: &Map<String, Schema>) -> bool {
    schema.contains_key("properties") && schema.contains_key("additionalProperties")
}

/// A schema in which tables that have a name are named only; not the outermost one where `is_whole`.
fn shortened(schema: &Schema, names: &BTreeMap<String, String>, is_whole: bool) -> Schema {
    match schema {
        Schema::Object(own) => {
            let whole = own
                .iter()
                .map(|(key, value)| (key.clone(), shortened(value, &BTreeMap::new(), true)));
            if !is_whole
                && is_table(own)
                && let Some(name) = names.get(&sorted(whole.collect()).to_string())
            {
                return json!({ "$ref": format!("#/definitions/{name}") });
            }
            sorted(
                own.iter()
                    .map(|(key, value)| (key.clone(), shortened(value, names, false)))
                    .collect(),
            )
        }
        Schema::Array(list) => list
            .iter()
            .map(|value| shortened(value, names, false))
            .collect(),
        other => other.clone(),
    }
}

/// An object with its keys in the order of the alphabet, whichever order the library keeps.
fn sorted(object: Map<String, Schema>) -> Schema {
    let sorted: BTreeMap<String, Schema> = object.into_iter().collect();
    Schema::Object(sorted.into_iter().collect())
}

fn schema() -> Schema {
    let keys = Keys::of_page();
    let methods = Method::ALL.into_iter();
    let mut alternatives: Vec<Schema> = methods.map(|method| of_method(method, &keys)).collect();
    let mut assembly = AssemblyModel::schema();
    assembly["title"] = "Assembly".into();
    assembly["required"] = json!(["name", "structures"]);
    keys.describe(&mut assembly, "Assembly file");
    alternatives.push(assembly);
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Study of bolted-joint",
        "description": "Keys and types, as the program reads them, with the words of docs/file-formats.md.",
        "oneOf": alternatives,
    })
}

fn of_method(method: Method, keys: &Keys) -> Schema {
    let mut schema = match method {
        Method::FrfDecoupling => Study::schema(),
        Method::FrfSpace => SpatialStudy::schema(),
        Method::LapUpdate => LapUpdateStudy::schema(),
        Method::LapResponse => LapResponseStudy::schema(),
        Method::FractalContact | Method::VirtualMaterial => InterfaceStudy::schema(),
        Method::LayeredBeam => LayeredBeamStudy::schema(),
        Method::Respond => RespondStudy::schema(),
    };
    let command = method.command();
    schema["title"] = format!("Study of method {method}, for bolted-joint {command}").into();
    // the method tells which alternative is meant
    schema["properties"]["method"] = json!({ "const": method.name() });
    let section = match method {
        Method::FrfDecoupling => "Study",
        Method::FrfSpace => "Study of a joint in space",
        Method::LapUpdate => "Method `lap-update`",
        Method::LapResponse => "Method `lap-response`",
        Method::FractalContact | Method::VirtualMaterial => "Study of a prediction",
        Method::LayeredBeam => "Study of a layered beam",
        Method::Respond => "Study of a response",
    };
    keys.describe(&mut schema, section);
    schema["required"] = json!(["method", "name"]);
    schema
}

#[cfg(test)]
mod tests {
    use std::collections::{HashMap, HashSet};
    use std::path::Path;

    use super::Schema;

    /// Path and description of each key of a schema.
    fn described(schema: &Schema, path: &[String], found: &mut Vec<(Vec<String>, String)>) {
        match schema {
            Schema::Object(own) => {
                for (name, value) in own {
                    if let ("properties", Schema::Object(keys)) = (name.as_str(), value) {
                        for (key, value) in keys {
                            let path = [path, std::slice::from_ref(key)].concat();
                            let words = value["description"].as_str().unwrap_or_default();
                            found.push((path.clone(), words.to_owned()));
                            described(value, &path, found);
                        }
                    } else {
                        described(value, path, found);
                    }
                }
            }
            Schema::Array(list) => list.iter().for_each(|value| described(value, path, found)),
            _ => {}
        }
    }

    fn all_described() -> Vec<(Vec<String>, String)> {
        let mut found = Vec::new();
        for alternative in super::schema()["oneOf"].as_array().unwrap() {
            described(alternative, &[], &mut found);
        }
        found
    }

    #[test]
    fn every_key_has_a_description() {
        let mut found = all_described();
        // a mark between cells has no place in a sentence
        found.retain(|(_, words)| words.is_empty() || words.contains('|'));
        assert!(found.is_empty(), "{} keys: {found:#?}", found.len());
    }

    /// Read off of the page without what makes the schema: the last cell of each row that names a key with its table, in the section
    /// of all studies. A study's own section may say more of it.
    #[test]
    fn a_key_whose_row_names_its_table_has_the_words_of_that_row() {
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/file-formats.md");
        let page = std::fs::read_to_string(page).unwrap();
        let mut rows: HashMap<String, Vec<String>> = HashMap::new();
        let mut of_all = HashSet::new();
        let mut heading = "";
        for line in page.lines() {
            if line.starts_with('#') {
                heading = line.trim_matches(['#', ' ', '`', '[', ']']);
            }
            if !line.starts_with("| `") {
                continue;
            }
            let cells: Vec<&str> = line.trim_matches('|').split('|').collect();
            let last = cells[cells.len() - 1].trim();
            // up to the first link or mark
            let words = last.split(['[', '`', '*']).next().unwrap();
            let mut table = heading.to_owned();
            let keys = cells[0].replace(".NAME", "");
            for key in keys.split('`').skip(1).step_by(2) {
                // a section of one table names it in its heading, and `.b` is in the table of the key before it
                let (own, key) = key.rsplit_once('.').unwrap_or(("", key));
                if !own.is_empty() {
                    own.clone_into(&mut table);
                }
                let key = format!("{table}.{key}");
                if heading == "Keys within tables" {
                    of_all.insert(key.clone());
                }
                rows.entry(key).or_default().push(words.to_owned());
            }
        }
        let mut compared = 0;
        for (path, words) in all_described() {
            let is_part = |name: &&String| !matches!(name.as_str(), "a" | "b" | "c" | "d" | "far");
            let tables: Vec<&String> = path[..path.len() - 1].iter().filter(is_part).collect();
            // the row that names most of the tables
            let keys = (0..tables.len()).map(|from| {
                let mut names: Vec<&str> =
                    tables[from..].iter().map(|name| name.as_str()).collect();
                names.push(&path[path.len() - 1]);
                names.join(".")
            });
            let found = keys.filter_map(|key| rows.get_key_value(&key)).next();
            let Some((_, of_rows)) = found.filter(|(key, _)| of_all.contains(*key)) else {
                continue;
            };
            compared += 1;
            assert!(
                of_rows.iter().any(|own| words.starts_with(own)),
                "{}: {words:?} is none of {of_rows:?}",
                path.join(".")
            );
        }
        assert!(compared > 100, "{compared}");
    }

    /// `UPDATE_SCHEMA=1 cargo test --release --lib schema` writes it anew.
    #[test]
    fn the_study_schema_of_the_documents_is_what_the_tables_read() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/study.schema.json");
        let text = super::text();
        if std::env::var_os("UPDATE_SCHEMA").is_some() {
            std::fs::write(&path, &text).unwrap();
        }
        let found = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            found == text,
            "{} is not what the tables read",
            path.display()
        );
    }
}
