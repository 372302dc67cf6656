//! What a system of FMUs says of itself: its components with their connectors, and what connects them.

use roxmltree::{Document, Node};

/// The file of a system that says what is in it.
pub(super) const FILE: &str = "SystemStructure.ssd";

/// A structure description, without judgement.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Structure {
    pub(super) name: String,
    pub(super) tool: Option<String>,
    pub(super) components: Vec<Component>,
    pub(super) connectors: Vec<Connector>,
    pub(super) connections: Vec<Connection>,
    /// Of the system itself.
    pub(super) bindings: Vec<Binding>,
}

/// What stands within a system under a name: an FMU, another system, a dictionary of signals.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Component {
    pub(super) name: String,
    /// Path of its file in the archive; none of a system within the system.
    pub(super) source: Option<String>,
    pub(super) connectors: Vec<Connector>,
    pub(super) bindings: Vec<Binding>,
}

/// A place where something can be connected.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Connector {
    pub(super) name: String,
    /// `input`, `output`, `parameter` …
    pub(super) kind: String,
    pub(super) unit: Option<String>,
}

/// From an output to an input. An end without an element is one of the system itself.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Connection {
    pub(super) start: End,
    pub(super) end: End,
}

/// An element, or none, and its connector.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct End {
    pub(super) element: Option<String>,
    pub(super) connector: String,
}

/// Where start values come from.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Binding {
    /// Path of a file of parameters in the archive; none where they stand in the description, or in a component's file.
    pub(super) source: Option<String>,
    /// What is put in front of their names.
    pub(super) prefix: String,
    /// Whether names are translated by a mapping.
    pub(super) is_mapped: bool,
}

impl Structure {
    /// Reads the text; `None` where it is no structure description.
    pub(super) fn of(xml: &str) -> Option<Self> {
        let document = Document::parse(xml).ok()?;
        let root = document.root_element();
        let system = child(root, "System")?;
        let elements = children(child(system, "Elements"));
        let connections = children(child(system, "Connections"));
        Some(Self {
            name: text(root, "name")?,
            tool: text(root, "generationTool"),
            components: elements.map(component).collect(),
            connectors: connectors(system),
            connections: connections
                .filter(|own| own.tag_name().name() == "Connection")
                .map(connection)
                .collect(),
            bindings: bindings(system),
        })
    }

    pub(super) fn component(&self, name: &str) -> Option<&Component> {
        self.components.iter().find(|own| own.name == name)
    }
}

fn component(own: Node<'_, '_>) -> Component {
    Component {
        name: text(own, "name").unwrap_or_default(),
        source: source(own),
        connectors: connectors(own),
        bindings: bindings(own),
    }
}

fn connectors(of: Node<'_, '_>) -> Vec<Connector> {
    let all = children(child(of, "Connectors"));
    all.map(|own| Connector {
        name: text(own, "name").unwrap_or_default(),
        kind: text(own, "kind").unwrap_or_default(),
        // the type of a connector is the element within it
        unit: own.children().find_map(|typed| text(typed, "unit")),
    })
    .collect()
}

fn connection(own: Node<'_, '_>) -> Connection {
    let end = |element: &str, connector: &str| End {
        // some tools write an empty one for the system
        element: text(own, element).filter(|name| !name.is_empty()),
        connector: text(own, connector).unwrap_or_default(),
    };
    Connection {
        start: end("startElement", "startConnector"),
        end: end("endElement", "endConnector"),
    }
}

fn bindings(of: Node<'_, '_>) -> Vec<Binding> {
    let all = children(child(of, "ParameterBindings"));
    all.map(|own| Binding {
        source: source(own).filter(|_| own.attribute("sourceBase") != Some("component")),
        prefix: text(own, "prefix").unwrap_or_default(),
        is_mapped: child(own, "ParameterMapping").is_some(),
    })
    .collect()
}

/// A path in the archive.
fn source(of: Node<'_, '_>) -> Option<String> {
    let path = of.attribute("source")?;
    Some(path.strip_prefix("./").unwrap_or(path).to_owned())
}

/// The first child of this name, in whichever namespace.
pub(super) fn child<'a, 'input>(of: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    of.children().find(|own| own.tag_name().name() == name)
}

pub(super) fn children<'a, 'input>(
    of: Option<Node<'a, 'input>>,
) -> impl Iterator<Item = Node<'a, 'input>> {
    let all = of.into_iter().flat_map(|own| own.children());
    all.filter(Node::is_element)
}

pub(super) fn text(of: Node<'_, '_>, attribute: &str) -> Option<String> {
    of.attribute(attribute).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_description_tells_components_and_connections() {
        let xml = r#"<d:SystemStructureDescription xmlns:d="http://ssp-standard.org/SSP1/SystemStructureDescription" xmlns:c="http://ssp-standard.org/SSP1/SystemStructureCommon" version="1.0" name="two">
            <d:System name="s"><d:Connectors><d:Connector name="push" kind="input"><c:Real unit="N"/></d:Connector></d:Connectors>
            <d:Elements><d:Component name="a" source="resources/a.fmu"><d:Connectors><d:Connector name="x" kind="output"/></d:Connectors>
            </d:Component></d:Elements><d:Connections><d:Connection startElement="" startConnector="push" endElement="a" endConnector="F"/></d:Connections>
            </d:System></d:SystemStructureDescription>"#;
        let found = Structure::of(xml).unwrap();
        let [a] = &found.components[..] else {
            panic!("{found:?}");
        };
        assert_eq!(a.source.as_deref(), Some("resources/a.fmu"));
        assert_eq!(
            (a.connectors[0].kind.as_str(), &a.connectors[0].unit),
            ("output", &None)
        );
        assert_eq!(found.connectors[0].unit.as_deref(), Some("N"));
        assert_eq!(found.name, "two");
        let [connection] = &found.connections[..] else {
            panic!("{found:?}");
        };
        assert_eq!(
            (&connection.start.element, connection.end.connector.as_str()),
            (&None, "F")
        );
        assert_eq!(Structure::of("<other/>"), None);
    }
}
