//! Parameter sets of a system: `*.ssv` files (SSP 1.0, System Structure Parameter Values).

use super::super::Timestamp;
use super::super::archive::File;
use super::super::description::generation_tool;
use super::super::xml::{Attributes, Document};
use super::ssd::VERSION;

pub(super) const SSV: &str = "http://ssp-standard.org/SSP1/SystemStructureParameterValues";

/// Values of parameters of components.
pub(super) struct ParameterSet {
    pub(super) name: String,
    /// Component, variable and value.
    parameters: Vec<(String, String, f64)>,
    /// Whether the names begin with the component.
    is_of_system: bool,
}

/// What the FMUs start with.
pub(super) fn nominal(parameters: Vec<(String, String, f64)>) -> ParameterSet {
    ParameterSet::new("nominal".to_owned(), parameters)
}

impl ParameterSet {
    pub(super) fn new(name: String, parameters: Vec<(String, String, f64)>) -> Self {
        Self {
            name,
            parameters,
            is_of_system: true,
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.parameters.is_empty()
    }

    /// The part of a component, if it has any.
    pub(super) fn of(&self, component: &str) -> Option<Self> {
        let own = self.parameters.iter().filter(|(of, _, _)| of == component);
        let parameters: Vec<_> = own.cloned().collect();
        (!parameters.is_empty()).then(|| Self {
            name: self.name.clone(),
            parameters,
            is_of_system: false,
        })
    }

    /// Where it is in the archive.
    pub(super) fn path(&self) -> String {
        format!("resources/{}.ssv", self.name)
    }

    pub(super) fn file(&self, date: Timestamp) -> File {
        let mut document = Document::new();
        let made = Attributes::new()
            .with("xmlns:ssv", SSV)
            .with("generationTool", generation_tool())
            .with("generationDateAndTime", date);
        self.write(&mut document, made);
        File::text(&self.path(), document.finish())
    }

    pub(super) fn write(&self, document: &mut Document, attributes: Attributes) {
        let root = attributes.with("version", VERSION).with("name", &self.name);
        document.element("ssv:ParameterSet", root, |document| {
            document.element("ssv:Parameters", Attributes::new(), |document| {
                for (component, variable, value) in &self.parameters {
                    let name = match self.is_of_system {
                        true => format!("{component}.{variable}"),
                        false => variable.clone(),
                    };
                    let name = Attributes::new().with("name", name);
                    document.element("ssv:Parameter", name, |document| {
                        document.empty("ssv:Real", Attributes::new().number("value", Some(*value)));
                    });
                }
            });
        });
    }
}
