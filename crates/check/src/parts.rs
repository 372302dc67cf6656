//! The parts of an FMU that it need not have: terminals, icons, a reference run.

use roxmltree::{Document, Node};

use super::archive::Archive;
use super::described::{Described, attribute};
use super::inspect::is_library;

/// Folder of terminals and icons (FMI 3.0, 2.5.1).
const TERMINALS: &str = "terminalsAndIcons/terminalsAndIcons.xml";

/// What the optional parts contain, in words, and what is wrong with them.
pub(super) fn look_at(archive: &mut Archive, described: &Described) -> (Vec<String>, Vec<String>) {
    let (mut facts, mut findings) = (Vec::new(), Vec::new());
    let names = archive.names();
    if let Some(text) = archive.optional_text(TERMINALS) {
        match terminals(&text, described, &names) {
            Ok((fact, wrong)) => {
                facts.push(fact);
                findings.extend(wrong);
            }
            Err(refused) => findings.push(format!("{TERMINALS}: {refused}")),
        }
    }
    let identifier = described
        .co_simulation
        .iter()
        .chain(&described.model_exchange)
        .next();
    for name in names.iter().filter(|name| name.starts_with("binaries/")) {
        let file = name.rsplit('/').next().unwrap_or_default();
        let stem = file.rsplit_once('.').map(|(stem, _)| stem);
        if let (true, Some(identifier)) = (is_library(file), identifier)
            && stem != Some(identifier)
        {
            findings.push(format!(
                "{name}: found a library of another name than modelIdentifier \"{identifier}\", expected that one, by which importers look"
            ));
        }
    }
    for name in &names {
        if !name.to_ascii_lowercase().ends_with(".png") {
            continue;
        }
        let beginning = archive.beginning(name).unwrap_or_default();
        if !beginning.starts_with(b"\x89PNG\r\n\x1a\n") {
            findings.push(format!(
                "{name}: found no picture, expected one in PNG format"
            ));
        }
    }
    (facts, findings)
}

/// Terminals whose members do not exist, icons whose files do not.
fn terminals(
    text: &str,
    described: &Described,
    names: &[String],
) -> Result<(String, Vec<String>), String> {
    let document = Document::parse(text).map_err(|refused| refused.to_string())?;
    let mut findings = Vec::new();
    let mut terminals = Vec::new();
    for element in document.root_element().descendants() {
        match element.tag_name().name() {
            // those within a terminal are parts of it
            "Terminal" if is_outer(element) => {
                terminals.push(attribute(element, "name").unwrap_or_default());
            }
            "TerminalMemberVariable" | "TerminalStreamMemberVariable" => {
                let member = attribute(element, "variableName").unwrap_or_default();
                if described.variable(&member).is_none() {
                    findings.push(format!(
                        "{TERMINALS}: found member {member:?}, expected the name of a variable"
                    ));
                }
            }
            "Icon" | "TerminalGraphicalRepresentation" => {
                if let Some(icon) = attribute(element, "iconBaseName") {
                    let path = format!("terminalsAndIcons/{icon}");
                    let png = format!("{path}.png");
                    if !names.iter().any(|name| *name == path || *name == png) {
                        findings.push(format!(
                            "{TERMINALS}: found icon {icon:?}, expected a file {png}"
                        ));
                    }
                }
            }
            _ => {}
        }
    }
    let fact = format!("terminals: {}", terminals.join(", "));
    Ok((fact, findings))
}

/// Whether a terminal is none within another.
fn is_outer(terminal: Node<'_, '_>) -> bool {
    let parent = terminal.parent_element();
    parent.is_none_or(|parent| parent.tag_name().name() != "Terminal")
}
