//! Looks into a system of FMUs (SSP), as far as its structure description tells what it is.

use std::path::Path;

use roxmltree::{Document, Node};

use super::CheckError;
use super::archive::Archive;

/// The file of a system that says what is in it.
const FILE: &str = "SystemStructure.ssd";

/// What a system of FMUs says of itself.
#[derive(Debug, PartialEq)]
pub struct SystemInspection {
    /// Name of the system.
    pub name: String,
    /// The tool that made it, if it says so.
    pub tool: Option<String>,
    /// Its components, each with its file.
    pub components: Vec<String>,
    /// Number of connections between them.
    pub connections: usize,
    /// Names of its inputs.
    pub inputs: Vec<String>,
    /// Names of its outputs.
    pub outputs: Vec<String>,
    /// Its files of parameters.
    pub parameters: Vec<String>,
}

/// Looks into the SSP at `path`.
///
/// # Errors
///
/// [`CheckError`] if it is no archive, or has no readable description.
pub fn inspect_system(path: &Path) -> Result<SystemInspection, CheckError> {
    let mut archive = Archive::open(path)?;
    let text = archive.optional_text(FILE);
    let found = text.and_then(|xml| described(&xml));
    found.ok_or_else(|| CheckError::Structure {
        path: path.to_owned(),
        entry: FILE,
    })
}

fn described(xml: &str) -> Option<SystemInspection> {
    let document = Document::parse(xml).ok()?;
    let root = document.root_element();
    let called = |node: &Node<'_, '_>, name: &str| node.tag_name().name() == name;
    let system = root.children().find(|own| called(own, "System"))?;
    let all = |name: &'static str| system.descendants().filter(move |own| called(own, name));
    let own = system.children().find(|own| called(own, "Connectors"));
    let of = |kind: &str| {
        let connectors = own.into_iter().flat_map(|own| own.children());
        let wanted = connectors.filter(|own| own.attribute("kind") == Some(kind));
        wanted
            .filter_map(|own| own.attribute("name").map(str::to_owned))
            .collect()
    };
    let component = |own: Node<'_, '_>| {
        let name = own.attribute("name").unwrap_or_default();
        match own.attribute("source") {
            Some(source) => format!("{name} ({source})"),
            None => name.to_owned(),
        }
    };
    let bindings = all("ParameterBinding");
    Some(SystemInspection {
        name: root.attribute("name")?.to_owned(),
        tool: root.attribute("generationTool").map(str::to_owned),
        components: all("Component").map(component).collect(),
        connections: all("Connection").count(),
        inputs: of("input"),
        outputs: of("output"),
        parameters: bindings
            .filter_map(|own| own.attribute("source").map(str::to_owned))
            .collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_description_tells_components_and_connections() {
        let xml = r#"<d:SystemStructureDescription xmlns:d="http://ssp-standard.org/SSP1/SystemStructureDescription" version="1.0" name="two">
            <d:System name="s"><d:Connectors><d:Connector name="push" kind="input"/></d:Connectors>
            <d:Elements><d:Component name="a" source="resources/a.fmu"><d:Connectors><d:Connector name="x" kind="output"/></d:Connectors>
            </d:Component></d:Elements><d:Connections><d:Connection startConnector="push" endElement="a" endConnector="F"/></d:Connections>
            </d:System></d:SystemStructureDescription>"#;
        let found = described(xml).unwrap();
        assert_eq!(found.components, ["a (resources/a.fmu)"]);
        assert_eq!((found.inputs.len(), found.outputs.len()), (1, 0));
        assert_eq!((found.name.as_str(), found.connections), ("two", 1));
        assert_eq!(described("<other/>"), None);
    }
}
