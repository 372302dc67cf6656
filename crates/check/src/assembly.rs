//! Looks into the FMU of an assembly: do its parts agree?

use std::path::Path;

use bolted_joint_export::AssemblyStartFile;
use bolted_joint_importer::FmiVersion;
use bolted_joint_interface::Interface as Declared;
use roxmltree::Document;

use super::archive::Archive;
use super::described::{Described, DescribedVariable, FILE};
use super::inspect::START_FILE;
use super::{CheckError, attributes, inspect, parts, variables};

/// What the FMU of an assembly holds, and what is wrong with it.
#[derive(Debug)]
pub struct AssemblyInspection {
    /// Version of the standard.
    pub version: FmiVersion,
    /// Name of the model.
    pub model_name: String,
    /// Platform folders with a library.
    pub platforms: Vec<String>,
    /// Number of loads, of motions and loads that come out, and of the structures' coordinates.
    pub counts: [usize; 3],
    /// Communication step that the FMU suggests, s.
    pub suggested_step_s: Option<f64>,
    /// Which of the optional parts there are, in words.
    pub parts: Vec<String>,
    /// Everything that does not agree; empty if the FMU is sound.
    pub findings: Vec<String>,
    pub(super) described: Option<Described>,
}

/// Looks into the FMU at `path`, if it is that of an assembly; none of its code is run.
///
/// # Errors
///
/// [`CheckError`] if it is no FMU of this program at all; what is wrong with one of its own is in the findings.
pub fn inspect_assembly(path: &Path) -> Result<Option<AssemblyInspection>, CheckError> {
    let mut archive = Archive::open(path)?;
    let Some(start) = archive
        .optional_text(START_FILE)
        .and_then(|text| AssemblyStartFile::parse(&text))
    else {
        return Ok(None);
    };
    let xml = archive.text(FILE)?;
    let platforms = inspect::platforms(&archive.names());
    let mut findings = Vec::new();
    if platforms.is_empty() {
        findings
            .push("binaries: found no library, expected one for at least one platform".to_owned());
    }
    findings.extend(archive.damage());
    let described = match described(&xml, &start, &mut findings) {
        Ok(described) => Some(described),
        Err(refused) => {
            findings.push(refused);
            None
        }
    };
    let mut facts = Vec::new();
    if let Some(described) = &described {
        let (found, wrong) = parts::look_at(&mut archive, described);
        facts = found;
        findings.extend(wrong);
    }
    let of = |causality: &str| {
        let all = start.variables.iter();
        all.filter(|own| own.causalities == [causality]).count()
    };
    let coordinates = start
        .variables
        .iter()
        .filter(|own| own.name.starts_with("modal.q"));
    let seen = described.as_ref();
    Ok(Some(AssemblyInspection {
        version: seen.map_or(FmiVersion::Three, |described| described.version),
        model_name: seen.map_or_else(String::new, |described| described.model_name.clone()),
        platforms,
        counts: [of("input"), of("output"), coordinates.count()],
        suggested_step_s: seen.and_then(|described| described.step_size_s),
        parts: facts,
        findings,
        described,
    }))
}

fn described(
    xml: &str,
    start: &AssemblyStartFile,
    findings: &mut Vec<String>,
) -> Result<Described, String> {
    let document = Document::parse(xml).map_err(|refused| format!("{FILE}: {refused}"))?;
    let described = Described::from_xml(&document)?;
    if described.version == FmiVersion::Three
        && let Err(refused) = Declared::from_xml(FILE, xml)
    {
        findings.push(refused.to_string());
    }
    findings.extend(attributes::findings(
        document.root_element(),
        described.version,
    ));
    findings.extend(variables::starts_out_of_range(&described));
    findings.extend(against_list(&described, start));
    if described.token != start.token {
        findings.push(format!(
            "{FILE}: found the token \"{}\", expected \"{}\" as in {START_FILE}",
            described.token, start.token
        ));
    }
    Ok(described)
}

/// Where the model description does not declare what the library reads.
fn against_list(found: &Described, start: &AssemblyStartFile) -> Vec<String> {
    let mut findings = Vec::new();
    for wanted in &start.variables {
        let same = |other: &DescribedVariable| {
            other.reference == wanted.reference
                && other.unit == wanted.unit
                && wanted.causalities.contains(&other.causality.as_str())
        };
        match found.variable(&wanted.name) {
            Some(other) if same(other) => {}
            Some(other) => findings.push(format!(
                "{FILE}: found variable {} as {} {} in {}, expected {} {} in {} as in {START_FILE}",
                wanted.name,
                other.causality,
                other.reference,
                other.unit,
                wanted.causalities.join(" or "),
                wanted.reference,
                wanted.unit
            )),
            None => findings.push(format!(
                "{FILE}: variable {} not found, expected it as {START_FILE} lists it",
                wanted.name
            )),
        }
    }
    let is_listed = |name: &str| start.variables.iter().any(|own| own.name == name);
    let strays = found
        .variables
        .iter()
        .filter(|own| own.name != "time" && !is_listed(&own.name));
    findings.extend(strays.map(|own| {
        format!(
            "{FILE}: found variable {}, expected none of that name",
            own.name
        )
    }));
    variables::shortened(findings)
}
