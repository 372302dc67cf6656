//! Looks at an FMU of another tool, as far as its model description tells what it is.

use std::path::Path;

use roxmltree::{Document, Node};

use super::archive::Archive;
use super::described::FILE;
use super::{CheckError, inspect};

/// What an FMU says that another tool made.
#[derive(Debug, PartialEq)]
pub struct ForeignFmu {
    /// Name of the model.
    pub model_name: String,
    /// Version of the standard, as it is written.
    pub version: String,
    /// The tool that made it, if it says so.
    pub tool: Option<String>,
    /// Kinds of use, such as Co-Simulation.
    pub kinds: Vec<&'static str>,
    /// Names of its inputs.
    pub inputs: Vec<String>,
    /// Names of its outputs.
    pub outputs: Vec<String>,
    /// Number of parameters.
    pub parameters: usize,
    /// Platform folders with a library.
    pub platforms: Vec<String>,
}

const THIS_PROGRAM: &str = "bolted-joint ";
const KINDS: [(&str, &str); 3] = [
    ("CoSimulation", "Co-Simulation"),
    ("ModelExchange", "Model Exchange"),
    ("ScheduledExecution", "Scheduled Execution"),
];

/// Looks into the FMU at `path`, if it is none of this program; none of its code is run.
///
/// # Errors
///
/// [`CheckError`] if it is no archive. `None` if it has no readable model description, or what only this program writes.
pub fn foreign(path: &Path) -> Result<Option<ForeignFmu>, CheckError> {
    let mut archive = Archive::open(path)?;
    if archive.optional_text(inspect::START_FILE).is_some() {
        return Ok(None);
    }
    let platforms = inspect::platforms(&archive.names());
    let text = archive.optional_text(FILE);
    let found = text.and_then(|xml| described(&xml, platforms));
    Ok(found.filter(|found| !found.tool.as_deref().is_some_and(is_this_program)))
}

/// Whether the tool that made a file is this program, of any version.
pub(super) fn is_this_program(tool: &str) -> bool {
    tool.starts_with(THIS_PROGRAM)
}

fn described(xml: &str, platforms: Vec<String>) -> Option<ForeignFmu> {
    let document = Document::parse(xml).ok()?;
    let root = document.root_element();
    let attribute = |name: &str| root.attribute(name).map(str::to_owned);
    let has = |tag: &str| root.children().any(|own| own.has_tag_name(tag));
    let variables = root
        .children()
        .find(|own| own.has_tag_name("ModelVariables"))?;
    let of = |causality: &str| {
        let all = variables.children().filter(Node::is_element);
        let own = all.filter(|own| own.attribute("causality") == Some(causality));
        own.filter_map(|own| own.attribute("name").map(str::to_owned))
            .collect::<Vec<_>>()
    };
    Some(ForeignFmu {
        model_name: attribute("modelName")?,
        version: attribute("fmiVersion")?,
        tool: attribute("generationTool"),
        kinds: KINDS
            .iter()
            .filter(|(tag, _)| has(tag))
            .map(|(_, name)| *name)
            .collect(),
        inputs: of("input"),
        outputs: of("output"),
        parameters: of("parameter").len(),
        platforms,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_description_tells_what_it_is_of() {
        let xml = r#"<fmiModelDescription fmiVersion="2.0" modelName="Bouncing Ball" generationTool="another">
            <CoSimulation modelIdentifier="b"/>
            <ModelVariables>
                <ScalarVariable name="f" causality="input"><Real/></ScalarVariable>
                <ScalarVariable name="h" causality="output"><Real/></ScalarVariable>
                <ScalarVariable name="g" causality="parameter"><Real/></ScalarVariable>
            </ModelVariables></fmiModelDescription>"#;
        let found = described(xml, Vec::new()).unwrap();
        assert_eq!(found.model_name, "Bouncing Ball");
        assert_eq!(found.tool.as_deref(), Some("another"));
        assert_eq!(
            (found.inputs, found.outputs),
            (vec!["f".into()], vec!["h".into()])
        );
        assert_eq!((found.kinds, found.parameters), (vec!["Co-Simulation"], 1));
        assert_eq!(described("<other/>", Vec::new()), None);
    }
}
