//! Are the connections of a system between places that exist, go from outputs to inputs, and keep the unit?

use std::collections::HashMap;

use super::structure::{Component, Connector, End, FILE, Structure};
use crate::described::Described;

/// The model descriptions of the FMUs that could be read, by the name of their component.
pub(super) type Models = HashMap<String, Described>;

/// Where connectors are not what their FMUs declare, and connections not between connectors that fit.
pub(super) fn findings(structure: &Structure, models: &Models) -> Vec<String> {
    let mut findings = Vec::new();
    for component in &structure.components {
        if let Some(model) = models.get(&component.name) {
            findings.extend(against_model(component, model));
        }
    }
    let mut sources: HashMap<(Option<&str>, &str), &End> = HashMap::new();
    for connection in &structure.connections {
        let (start, end) = (&connection.start, &connection.end);
        let wire = format!("{FILE}: connection from {} to {}", told(start), told(end));
        let ends = [(start, true), (end, false)].map(|(own, is_start)| {
            let found = connector(structure, own);
            let wanted = kinds_of(own, is_start);
            match found {
                None => findings.push(format!(
                    "{wire}: found no connector {}, expected one of {}",
                    told(own),
                    place(structure, own)
                )),
                Some(found) if !wanted.contains(&found.kind.as_str()) => {
                    findings.push(format!(
                        "{wire}: found {} as {}, expected it as {}",
                        told(own),
                        found.kind,
                        wanted[0]
                    ));
                }
                Some(_) => {}
            }
            found
        });
        if let [Some(from), Some(to)] = ends
            && let (Some(given), Some(taken)) = (&from.unit, &to.unit)
            && given != taken
        {
            findings.push(format!(
                "{wire}: found {given} at its start and {taken} at its end, expected the same unit: not every importer converts"
            ));
        }
        let key = (end.element.as_deref(), end.connector.as_str());
        if let Some(other) = sources.insert(key, start) {
            findings.push(format!(
                "{wire}: found another one from {} to the same place, expected one at most",
                told(other)
            ));
        }
    }
    findings
}

/// Inputs of components that nothing is connected to: they keep their start values.
pub(super) fn loose_inputs(structure: &Structure) -> Vec<String> {
    let is_fed = |component: &Component, connector: &Connector| {
        structure.connections.iter().any(|own| {
            own.end.element.as_deref() == Some(&component.name)
                && own.end.connector == connector.name
        })
    };
    let of = |component: &Component| {
        let inputs = component.connectors.iter();
        let loose = inputs.filter(|own| own.kind == "input" && !is_fed(component, own));
        loose
            .map(|own| format!("{}.{}", component.name, own.name))
            .collect::<Vec<_>>()
    };
    structure.components.iter().flat_map(of).collect()
}

fn against_model(component: &Component, model: &Described) -> Vec<String> {
    let mut findings = Vec::new();
    let source = component.source.as_deref().unwrap_or_default();
    for connector in &component.connectors {
        let place = format!("{FILE}: connector {} of {}", connector.name, component.name);
        let Some(variable) = model.variable(&connector.name) else {
            findings.push(format!("{place}: {source} has no variable of that name"));
            continue;
        };
        if variable.causality != connector.kind {
            findings.push(format!(
                "{place}: found kind {}, expected {} as {source} has it",
                connector.kind, variable.causality
            ));
        }
        if let Some(unit) = &connector.unit
            && *unit != variable.unit
            && !variable.unit.is_empty()
        {
            findings.push(format!(
                "{place}: found unit {unit}, expected {} as {source} has it",
                variable.unit
            ));
        }
    }
    findings
}

/// What an end of a connection may be: within the system its inputs give, and its outputs take.
fn kinds_of(end: &End, is_start: bool) -> [&'static str; 3] {
    match is_start == end.element.is_some() {
        true => ["output", "calculatedParameter", "inout"],
        false => ["input", "parameter", "inout"],
    }
}

fn connector<'s>(structure: &'s Structure, end: &End) -> Option<&'s Connector> {
    let all = match &end.element {
        Some(name) => &structure.component(name)?.connectors,
        None => &structure.connectors,
    };
    all.iter().find(|own| own.name == end.connector)
}

fn told(end: &End) -> String {
    match &end.element {
        Some(element) => format!("{element}.{}", end.connector),
        None => end.connector.clone(),
    }
}

/// Where the connector of an end is looked for.
fn place(structure: &Structure, end: &End) -> String {
    match &end.element {
        None => "the system's own".to_owned(),
        Some(name) if structure.component(name).is_some() => format!("those of component {name}"),
        Some(_) => {
            let names = structure.components.iter().map(|own| own.name.as_str());
            format!(
                "those of a component: {}",
                names.collect::<Vec<_>>().join(", ")
            )
        }
    }
}
