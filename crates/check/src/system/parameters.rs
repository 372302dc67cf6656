//! Do a system's files of start values (SSV) set parameters that its FMUs have, to values that they take?

use roxmltree::Document;

use super::structure::{Binding, Structure, child, children, text};
use super::wiring::Models;
use crate::described::DescribedVariable;

/// What may be set before a simulation.
const SETTABLE: [&str; 3] = ["parameter", "structuralParameter", "input"];

/// A file of start values as it is bound.
pub(super) struct Bound<'a> {
    /// How names are to be read; none of a file that no binding names, which a user may choose.
    pub(super) binding: Option<&'a Binding>,
    /// The component that it is for; none where it is for the whole system, and names begin with that of a component.
    pub(super) component: Option<&'a str>,
    pub(super) source: String,
    /// Its text, if it is in the archive.
    pub(super) text: Option<String>,
}

impl Bound<'_> {
    pub(super) fn findings(&self, structure: &Structure, models: &Models) -> Vec<String> {
        let source = &self.source;
        let Some(xml) = &self.text else {
            return vec![format!(
                "{source}: not found, expected the start values that it is to give"
            )];
        };
        let document = match Document::parse(xml) {
            Ok(document) => document,
            Err(refused) => return vec![format!("{source}: {refused}")],
        };
        let root = document.root_element();
        if root.tag_name().name() != "ParameterSet" {
            return vec![format!(
                "{source}: found element <{}>, expected <ParameterSet>",
                root.tag_name().name()
            )];
        }
        if self.binding.is_some_and(|own| own.is_mapped) {
            return Vec::new();
        }
        let prefix = self.binding.map_or("", |own| &own.prefix);
        let mut findings = Vec::new();
        for parameter in children(child(root, "Parameters")) {
            let own = text(parameter, "name").unwrap_or_default();
            let name = format!("{prefix}{own}");
            let is_of_the_system = structure.connectors.iter().any(|own| own.name == name);
            if self.component.is_none() && is_of_the_system {
                continue;
            }
            let Some((component, name)) = self.split(&name, structure) else {
                findings.push(format!(
                    "{source}: found parameter {own}, expected the name of a component before it"
                ));
                continue;
            };
            let Some(model) = models.get(component) else {
                continue;
            };
            let Some(variable) = model.variable(name) else {
                findings.push(format!(
                    "{source}: found parameter {own}, expected a variable of component {component}"
                ));
                continue;
            };
            if !SETTABLE.contains(&variable.causality.as_str()) {
                findings.push(format!(
                    "{source}: found {own}, which is {}, expected a parameter or an input",
                    variable.causality
                ));
            }
            let value = child(parameter, "Real").and_then(|real| text(real, "value"));
            if let Some(value) = value {
                findings.extend(
                    refused(variable, &value)
                        .map(|why| format!("{source}: found {own} = {value}, {why}")),
                );
            }
        }
        findings
    }

    /// The component of a name, and the name of its variable; components may have dots in theirs.
    fn split<'n>(&'n self, name: &'n str, structure: &'n Structure) -> Option<(&'n str, &'n str)> {
        if let Some(component) = self.component {
            return Some((component, name));
        }
        let components = structure.components.iter().map(|own| own.name.as_str());
        let fitting =
            components.filter_map(|own| Some((own, name.strip_prefix(own)?.strip_prefix('.')?)));
        fitting.max_by_key(|(own, _)| own.len())
    }
}

/// Why a variable does not take a value.
fn refused(variable: &DescribedVariable, value: &str) -> Option<String> {
    let number = match value.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => number,
        _ => return Some("expected a finite number".to_owned()),
    };
    let least = variable.min.filter(|least| number < *least);
    let most = variable.max.filter(|most| number > *most);
    least
        .map(|least| format!("expected {least} or more"))
        .or_else(|| most.map(|most| format!("expected {most} or less")))
}
