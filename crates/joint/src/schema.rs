//! JSON Schema of what a joint file has by the declarations of its laws and by the table of DOFs, beside what follows from the
//! records' own types. Only a test needs it, which holds the schema in `docs` against the types.

use std::borrow::Cow;
use std::{env, fs, path::Path};

use bolted_joint_dynamics::{
    DofKind,
    law::{Declaration, Parameter, Range, Term, UnitRule},
};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};

use super::{
    DofSet, HigherTerms, JointFile,
    dofs::NAMES,
    friction::{self, Friction},
    higher,
    units::{description, unit},
};

/// JSON Schema has a word for "greater than zero", the derive macro has none.
pub(super) fn entries_above_zero(list: &mut Schema) {
    if let Some(entries) = list
        .pointer_mut("/items")
        .and_then(|items| items.as_object_mut())
    {
        entries.insert("exclusiveMinimum".to_owned(), 0.into());
    }
}

/// Adds the list of laws with parameters of their own, as soon as there is a law that can stand in it.
pub(super) fn with_friction(joint: &mut Schema) {
    let entries: Vec<Value> = Friction::laws().map(entry).collect();
    if entries.is_empty() {
        return;
    }
    let list = json!({
        "description": "Laws with parameters of their own, each at most once on a relative DOF. Left out, there are none.",
        "type": "array",
        "items": { "oneOf": entries }
    });
    let properties = joint.get_mut("properties");
    if let Some(properties) = properties.and_then(|properties| properties.as_object_mut()) {
        // at its place among the others
        let place = properties.keys().position(|key| key == "over_preload");
        let place = place.unwrap_or(properties.len());
        properties.shift_insert(place, "friction".to_owned(), list);
    }
}

/// Adds such a list for each preload of a table.
pub(super) fn with_friction_over_preload(table: &mut Schema) {
    let list = json!({
        "description": "Such laws at each preload, the same ones at all, in place of `joint.friction`, of which slip forces alone \
                        follow the preload.\nBetween two preloads their parameters are interpolated linearly. Left out, there are none.",
        "type": "array",
        "minItems": 2,
        "items": { "$ref": "#/$defs/Joint/properties/friction" }
    });
    let properties = table.get_mut("properties");
    if let Some(properties) = properties.and_then(|properties| properties.as_object_mut()) {
        properties.insert("friction".to_owned(), list);
    }
}

/// Adds the list of the deviations of laws.
pub(super) fn with_friction_deviations(deviation: &mut Schema) {
    let list = json!({
        "description": "Of the laws that remember, as these stand in `joint.friction` or at the same preload in its table: each \
                        number's\ndeviation in place of the number, 0 where none is known. Left out, none is known of any.",
        "$ref": "#/$defs/Joint/properties/friction"
    });
    let properties = deviation.get_mut("properties");
    if let Some(properties) = properties.and_then(|properties| properties.as_object_mut()) {
        properties.insert("friction".to_owned(), list);
    }
}

impl JsonSchema for DofSet {
    fn schema_name() -> Cow<'static, str> {
        "DofSet".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let motions = |dofs: Self| {
            let each = dofs.rows().map(|dof| {
                let (motion, unit) = (dof.kind.motion(), dof.kind.displacement_unit());
                format!("{motion} {} ({unit})", dof.name)
            });
            each.collect::<Vec<_>>().join(", ")
        };
        let plane = [Self::TRANSLATION, Self::TRANSLATION_ROTATION].map(Self::names);
        json_schema!({
            "description": format!(
                "Relative motions that the joint resists. In a plane: {}. In space, some of these in this order: {}. \
                 They set the order of the matrices.",
                motions(Self::TRANSLATION_ROTATION),
                motions(Self::SPACE)
            ),
            "anyOf": [
                { "enum": plane },
                {
                    "type": "array",
                    "items": { "enum": Self::SPACE.names() },
                    "minItems": 1,
                    "maxItems": Self::SPACE.count(),
                    "uniqueItems": true
                }
            ]
        })
    }
}

impl JsonSchema for HigherTerms {
    fn schema_name() -> Cow<'static, str> {
        "HigherTerms".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut lists = Map::new();
        for term in Self::terms() {
            let row = term.row();
            let description = format!("{}, {}.", row.symbol, units(row));
            lists.insert(row.key.to_owned(), list(&description, json!({})));
        }
        let above_zero = json!({ "exclusiveMinimum": 0 });
        lists.insert(higher::AMPLITUDE.to_owned(), list(AMPLITUDE, above_zero));
        json_schema!({
            "description": format!(
                "Terms of higher order on each relative DOF r = x_a - x_b: load on side b {}. What is\nleft out is zero.",
                load()
            ),
            "type": "object",
            "properties": lists,
            "additionalProperties": false
        })
    }
}

const AMPLITUDE: &str = "Largest relative displacement, m and rad, that the joint was observed at and its terms hold up to. \
                         Within it the joint\nmust take energy; left out, it must at every displacement.";

/// An entry of the list of laws.
fn entry(law: &Declaration) -> Value {
    let mut properties = Map::new();
    properties.insert(friction::DOF.to_owned(), json!({ "enum": NAMES }));
    properties.insert(friction::LAW.to_owned(), json!({ "const": law.name }));
    for parameter in law.parameters {
        let mut number = json!({
            "description": format!(
                "{}, {}.",
                description(parameter, &kinds()),
                units(parameter)
            ),
            "type": "number",
            "format": "double"
        });
        match parameter.range {
            Range::Any => {}
            Range::NotNegative => number["minimum"] = 0.into(),
        }
        properties.insert(parameter.key.to_owned(), number);
    }
    let required: Vec<String> = properties.keys().cloned().collect();
    json!({
        "description": format!("{}.", law.summary),
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
        "required": required
    })
}

/// Both kinds of DOFs.
fn kinds() -> [DofKind; 2] {
    [DofKind::Translation, DofKind::Rotation]
}

/// Units of a parameter in translation and in rotation.
fn units(parameter: &Parameter) -> String {
    match parameter.unit {
        UnitRule::One => "no unit".to_owned(),
        rule => kinds().map(|kind| unit(rule, kind, kind)).join(" and "),
    }
}

/// A list with a number for each DOF.
fn list(description: &str, more: Value) -> Value {
    let mut items = json!({ "type": "number", "format": "double" });
    if let (Some(items), Value::Object(more)) = (items.as_object_mut(), more) {
        items.extend(more);
    }
    json!({
        "description": description,
        "type": "array",
        "items": items,
        "minItems": 1,
        "maxItems": DofSet::SPACE.count()
    })
}

/// The load of the terms, such as `k5 r^5 + (c2 r^2) dr/dt`.
fn load() -> String {
    let of = |is_damper: bool| {
        let terms = HigherTerms::terms().filter(move |term| term.is_damper() == is_damper);
        let each = terms.map(|term: Term| {
            let [power, _] = term.powers();
            format!("{} r^{power}", term.row().symbol)
        });
        each.collect::<Vec<String>>().join(" + ")
    };
    format!("{} + ({}) dr/dt", of(false), of(true))
}

#[test]
fn the_schema_in_docs_is_that_of_the_types() {
    let mut folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let in_docs = folders.find_map(|folder| {
        let path = folder.join("docs/joint-file.schema.json");
        path.exists().then_some(path)
    });
    let path = in_docs.unwrap();
    let schema = schemars::schema_for!(JointFile);
    let text = serde_json::to_string_pretty(&schema).unwrap() + "\n";
    if env::var_os("UPDATE_SCHEMA").is_some() {
        fs::write(&path, &text).unwrap();
    }
    let found = fs::read_to_string(&path).unwrap();
    assert!(
        found == text,
        "docs/joint-file.schema.json is out of date: run UPDATE_SCHEMA=1 cargo test -p bolted-joint-joint"
    );
}
