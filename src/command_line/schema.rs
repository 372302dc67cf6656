//! The JSON Schema of all studies, for editors: one alternative for each method, and one for assemblies.

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
    let mut alternatives: Vec<Schema> = Method::ALL.into_iter().map(of_method).collect();
    let mut assembly = AssemblyModel::schema();
    assembly["title"] = "Assembly".into();
    assembly["required"] = json!(["name", "structures"]);
    alternatives.push(assembly);
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Study of bolted-joint",
        "description": "Keys and types, as the program reads them. What values have to be is in docs/file-formats.md.",
        "oneOf": alternatives,
    })
}

fn of_method(method: Method) -> Schema {
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
    schema["required"] = json!(["method", "name"]);
    schema
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    /// `UPDATE_SCHEMA=1 cargo test --workspace --lib study_schema` writes it anew.
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
