//! A model description of FMI 2.0 or 3.0, as it stands in the file, without judgement.

use bolted_joint_importer::FmiVersion;
use roxmltree::{Document, Node};

/// File name of the model description in an FMU.
pub(super) const FILE: &str = "modelDescription.xml";

/// What a model description says that both versions of the standard have.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Described {
    pub(super) version: FmiVersion,
    pub(super) model_name: String,
    /// `instantiationToken` or `guid`.
    pub(super) token: String,
    /// Of Co-Simulation.
    pub(super) co_simulation: Option<String>,
    /// Of Model Exchange.
    pub(super) model_exchange: Option<String>,
    pub(super) can_save_state: bool,
    pub(super) has_derivatives: bool,
    /// Suggested communication step, s.
    pub(super) step_size_s: Option<f64>,
    pub(super) variables: Vec<DescribedVariable>,
}

/// A variable as declared, attributes of its type included.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct DescribedVariable {
    pub(super) name: String,
    pub(super) reference: u32,
    pub(super) causality: String,
    pub(super) unit: String,
    pub(super) start: Option<f64>,
    pub(super) min: Option<f64>,
    pub(super) max: Option<f64>,
}

impl Described {
    /// Reads the XML; the error is a sentence that names the file.
    pub(super) fn from_xml(document: &Document<'_>) -> Result<Self, String> {
        let root = document.root_element();
        if root.tag_name().name() != "fmiModelDescription" {
            return Err(format!(
                "{FILE}: found element <{}>, expected <fmiModelDescription>",
                root.tag_name().name()
            ));
        }
        let version_text = attribute(root, "fmiVersion").unwrap_or_default();
        let version = if version_text == "2.0" {
            FmiVersion::Two
        } else if version_text == "3.0" || version_text.starts_with("3.0.") {
            FmiVersion::Three
        } else {
            return Err(format!(
                "{FILE}: found fmiVersion \"{version_text}\", expected \"2.0\" or \"3.0\""
            ));
        };
        let (token, save, derivatives) = match version {
            FmiVersion::Two => (
                "guid",
                "canGetAndSetFMUstate",
                "providesDirectionalDerivative",
            ),
            FmiVersion::Three => (
                "instantiationToken",
                "canGetAndSetFMUState",
                "providesDirectionalDerivatives",
            ),
        };
        let interface = |name| child(root, name);
        let identifier = |name| attribute(interface(name)?, "modelIdentifier");
        let claims = |flag| {
            interface("CoSimulation")
                .and_then(|element| attribute(element, flag))
                .is_some_and(|value| value == "true" || value == "1")
        };
        Ok(Self {
            version,
            model_name: attribute(root, "modelName").unwrap_or_default(),
            token: attribute(root, token).unwrap_or_default(),
            co_simulation: identifier("CoSimulation"),
            model_exchange: identifier("ModelExchange"),
            can_save_state: claims(save),
            has_derivatives: claims(derivatives),
            step_size_s: child(root, "DefaultExperiment")
                .and_then(|element| number(element, "stepSize")),
            variables: match version {
                FmiVersion::Two => variables_of_fmi2(root),
                FmiVersion::Three => variables_of_fmi3(root),
            }?,
        })
    }

    pub(super) fn variable(&self, name: &str) -> Option<&DescribedVariable> {
        self.variables.iter().find(|variable| variable.name == name)
    }
}

/// The variables of FMI 3.0: one element each, of the name of its type.
fn variables_of_fmi3(root: Node<'_, '_>) -> Result<Vec<DescribedVariable>, String> {
    elements(child(root, "ModelVariables"))
        .map(|element| described(element, element, type_of(element, root)))
        .collect()
}

/// The variables of FMI 2.0: `<ScalarVariable>` with an element of the name of its type.
fn variables_of_fmi2(root: Node<'_, '_>) -> Result<Vec<DescribedVariable>, String> {
    elements(child(root, "ModelVariables"))
        .map(|scalar| {
            let real = child(scalar, "Real").ok_or_else(|| {
                format!(
                    "{FILE}: found variable {:?} of another type, expected <Real>",
                    attribute(scalar, "name").unwrap_or_default()
                )
            })?;
            let declared = type_of(real, root).and_then(|simple| child(simple, "Real"));
            described(scalar, real, declared)
        })
        .collect()
}

/// The definition of the type that an element names.
fn type_of<'a, 'input>(
    element: Node<'a, 'input>,
    root: Node<'a, 'input>,
) -> Option<Node<'a, 'input>> {
    let name = element.attribute("declaredType")?;
    elements(child(root, "TypeDefinitions")).find(|found| found.attribute("name") == Some(name))
}

/// `general` has name and causality, `typed` what is a number; `declared` fills the gaps.
fn described(
    general: Node<'_, '_>,
    typed: Node<'_, '_>,
    declared: Option<Node<'_, '_>>,
) -> Result<DescribedVariable, String> {
    let name = attribute(general, "name").unwrap_or_default();
    let reference = attribute(general, "valueReference").unwrap_or_default();
    let reference = reference.parse().map_err(|_| {
        format!(
            "{FILE}: found valueReference {reference:?} of variable {name:?}, expected a whole number"
        )
    })?;
    let either = |key| number(typed, key).or_else(|| number(declared?, key));
    Ok(DescribedVariable {
        name,
        reference,
        causality: attribute(general, "causality").unwrap_or_else(|| "local".to_owned()),
        unit: attribute(typed, "unit")
            .or_else(|| attribute(declared?, "unit"))
            .unwrap_or_default(),
        start: number(typed, "start"),
        min: either("min"),
        max: either("max"),
    })
}

/// The first child element of this name.
pub(super) fn child<'a, 'input>(parent: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    parent.children().find(|node| node.has_tag_name(name))
}

/// The child elements.
pub(super) fn elements<'a, 'input>(
    parent: Option<Node<'a, 'input>>,
) -> impl Iterator<Item = Node<'a, 'input>> {
    parent
        .into_iter()
        .flat_map(|parent| parent.children())
        .filter(Node::is_element)
}

pub(super) fn attribute(element: Node<'_, '_>, name: &str) -> Option<String> {
    element.attribute(name).map(str::to_owned)
}

fn number(element: Node<'_, '_>, name: &str) -> Option<f64> {
    element.attribute(name)?.trim().parse().ok()
}
