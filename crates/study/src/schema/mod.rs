//! The JSON Schema of a study, read off of the tables that read it: what they take is what the schema says, so that the two
//! cannot differ.
//!
//! A table tells serde its keys, and every value tells what it takes. [`of`] asks, key by key, with a reader that has nothing to
//! read.

mod look;
mod probe;

use serde::de::DeserializeOwned;
use serde_json::{Map, Value, json};

use look::{Seen, Step, Taken, look};

/// A JSON Schema.
pub type Schema = Value;

/// Tables within tables that are followed.
const DEEPEST: usize = 12;

/// The JSON Schema of what a type reads: keys, types and words, without what is checked afterwards.
#[must_use]
pub fn of<T: DeserializeOwned>() -> Schema {
    schema::<T>(&mut Vec::new())
}

fn schema<T: DeserializeOwned>(path: &mut Vec<Step>) -> Value {
    if path.len() > DEEPEST {
        return json!({});
    }
    match look::<T>(path) {
        Seen::Nothing => json!({}),
        Seen::Table(keys) => table::<T>(path, &keys),
        Seen::Map => {
            let values = below::<T>(path, Step::Entry);
            json!({ "type": "object", "additionalProperties": values })
        }
        Seen::List => json!({ "type": "array", "items": below::<T>(path, Step::Item) }),
        Seen::Number => json!({ "type": "number" }),
        Seen::Integer => json!({ "type": "integer" }),
        Seen::Boolean => json!({ "type": "boolean" }),
        Seen::Text => json!({ "type": "string" }),
        Seen::Words(words) => json!({ "enum": words }),
        Seen::OneOf(expecting, all) => {
            let mut of: Vec<Value> = Vec::new();
            for taken in &all {
                let own = one_of::<T>(path, taken);
                if !of.contains(&own) {
                    of.push(own);
                }
            }
            let mut schema = match of.len() {
                1 => of.remove(0),
                _ => json!({ "anyOf": of }),
            };
            if let Value::Object(schema) = &mut schema {
                schema.insert("description".to_owned(), expecting.into());
            }
            schema
        }
    }
}

fn one_of<T: DeserializeOwned>(path: &mut Vec<Step>, taken: &Taken) -> Value {
    match taken {
        Taken::Number => json!({ "type": "number" }),
        Taken::Boolean => json!({ "type": "boolean" }),
        Taken::Text => json!({ "type": "string" }),
        Taken::Words(words) => json!({ "enum": words }),
        Taken::Table(keys) if keys.is_empty() => json!({ "type": "object" }),
        Taken::Table(keys) => table::<T>(path, keys),
        Taken::ListOf(inner) => {
            path.push(Step::Item);
            let items = one_of::<T>(path, inner);
            path.pop();
            json!({ "type": "array", "items": items })
        }
    }
}

fn table<T: DeserializeOwned>(path: &mut Vec<Step>, keys: &[&'static str]) -> Value {
    let properties: Map<String, Value> = keys
        .iter()
        .map(|&key| (key.to_owned(), below::<T>(path, Step::Key(key))))
        .collect();
    json!({ "type": "object", "properties": properties, "additionalProperties": false })
}

fn below<T: DeserializeOwned>(path: &mut Vec<Step>, step: Step) -> Value {
    path.push(step);
    let schema = schema::<T>(path);
    path.pop();
    schema
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use serde::Deserialize;

    use super::*;
    use crate::{FrequencyTable, OneOrMore, Paths, Stated, one_or_more_tables};

    #[derive(Deserialize)]
    #[serde(rename_all = "kebab-case")]
    enum Kind {
        SlipLine,
        Full,
    }

    fn rows<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Vec<Row>, D::Error> {
        one_or_more_tables(deserializer, "a row, or rows")
    }

    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    #[expect(dead_code, reason = "asked for its keys only")]
    struct Row {
        count: u32,
    }

    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    #[expect(dead_code, reason = "asked for its keys only")]
    struct Tables {
        kind: Option<Kind>,
        #[serde(default)]
        frequency: FrequencyTable,
        #[serde(rename = "mass")]
        mass_kg: Stated,
        frf: Paths,
        damping: OneOrMore,
        places: BTreeMap<String, [f64; 2]>,
        #[serde(deserialize_with = "rows")]
        row: Vec<Row>,
        is_free: bool,
    }

    #[test]
    fn the_schema_is_what_the_tables_take() {
        let found = of::<Tables>();
        assert_eq!(found["additionalProperties"], json!(false));
        let own = &found["properties"];
        assert_eq!(own["kind"], json!({ "enum": ["slip-line", "full"] }));
        assert_eq!(own["is_free"], json!({ "type": "boolean" }));
        let bands =
            json!({ "type": "array", "items": { "type": "array", "items": { "type": "number" } } });
        assert_eq!(own["frequency"]["properties"]["bands"], bands);
        assert_eq!(
            own["frequency"]["properties"]["every"],
            json!({ "type": "integer" })
        );
        let number = json!({ "type": "number" });
        let text = json!({ "type": "string" });
        assert_eq!(own["mass"]["anyOf"], json!([number, text]));
        assert_eq!(
            own["frf"]["anyOf"],
            json!([text, { "type": "array", "items": text }])
        );
        assert_eq!(
            own["damping"]["anyOf"],
            json!([number, { "type": "array", "items": number }])
        );
        let pair = json!({ "type": "array", "items": number });
        assert_eq!(
            own["places"],
            json!({ "type": "object", "additionalProperties": pair })
        );
        let row = json!({
            "type": "object",
            "properties": { "count": { "type": "integer" } },
            "additionalProperties": false,
        });
        assert_eq!(
            own["row"]["anyOf"],
            json!([row, { "type": "array", "items": row }])
        );
        assert_eq!(own["row"]["description"], json!("a row, or rows"));
    }
}
