//! A system of FMUs (SSP): its components, and how they are connected.

use std::path::Path;

use bolted_joint_check::inspect_system;
use serde_json::json;

use crate::shown::some;
use crate::{ShowError, Shown};

/// Names that are listed at most.
const LISTED: usize = 12;

pub(crate) fn shown(path: &Path) -> Result<Shown, ShowError> {
    let found = inspect_system(path)?;
    let mut shown = Shown::of("system of FMUs (SSP)");
    shown.fact("name", found.name.clone());
    if let Some(tool) = &found.tool {
        shown.fact("tool", tool);
    }
    let components = found.components.iter().cloned();
    shown.facts_of_some("components", components, LISTED);
    shown.fact("connections", found.connections.to_string());
    for (label, names) in [
        ("inputs", &found.inputs),
        ("outputs", &found.outputs),
        ("parameters", &found.parameters),
    ] {
        if !names.is_empty() {
            shown.fact(label, some(names, LISTED));
        }
    }
    shown.detail("name", found.name);
    shown.detail("components", json!(found.components));
    shown.detail("connections", found.connections);
    shown.detail("inputs", json!(found.inputs));
    shown.detail("outputs", json!(found.outputs));
    Ok(shown)
}
