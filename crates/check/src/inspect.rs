//! Looks into an FMU that this program exported: do its parts agree, and can it be simulated?

use std::path::Path;

use bolted_joint_dynamics::{Lap, with_dofs};
use bolted_joint_importer::FmiVersion;
use bolted_joint_interface::Interface as Declared;
use roxmltree::Document;

use super::archive::Archive;
use super::described::{Described, FILE};
use super::{CheckError, attributes, foreign, parts, variables};
use bolted_joint_export::{
    Interface, StartFile, declared, dofs_text, laws_line, start_value, table_lines,
};
use bolted_joint_joint::{JointFile, Passivity};

/// What the library reads, in every FMU of this program.
pub(super) const START_FILE: &str = "resources/start.txt";

/// Start values that a `check` reads back must be the exported ones to this fraction: both are shortest decimals.
const SAME_START: f64 = 1e-15;

/// What an FMU holds, and what is wrong with it.
#[derive(Debug)]
pub struct Inspection {
    /// Version of the standard.
    pub version: FmiVersion,
    /// Which of the two FMUs it is.
    pub interface: Interface,
    /// The joint that it was made of.
    pub joint: JointFile,
    /// Name of the model.
    pub model_name: String,
    /// Platform folders with a library.
    pub platforms: Vec<String>,
    /// Whether the joint is passive, by matrix.
    pub passivity: Passivity,
    /// Longest Runge–Kutta step, s, of a lap.
    pub step_size_max_s: Option<f64>,
    /// Communication step that the FMU suggests, s.
    pub suggested_step_s: Option<f64>,
    /// Which of the optional parts there are, in words.
    pub parts: Vec<String>,
    /// Everything that does not agree; empty if the FMU is sound.
    pub findings: Vec<String>,
    pub(super) described: Option<Described>,
}

/// Looks into the FMU at `path`; none of its code is run.
///
/// # Errors
///
/// [`CheckError`] if it is no FMU of this program at all; what is wrong with one of its own is in the findings.
pub fn inspect(path: &Path) -> Result<Inspection, CheckError> {
    let mut archive = Archive::open(path)?;
    let xml = archive.text(FILE)?;
    let start_text = archive
        .text(START_FILE)
        .map_err(|refused| foreign_or(path, refused))?;
    let joint_text = archive.text("resources/joint.json")?;
    let joint = JointFile::from_json(&joint_text, "resources/joint.json").map_err(|source| {
        CheckError::JointFile {
            path: path.to_owned(),
            source: Box::new(source),
        }
    })?;
    let Some(start) = StartFile::parse(&start_text) else {
        return Err(CheckError::Entry {
            path: path.to_owned(),
            entry: START_FILE,
        });
    };
    let platforms = platforms(&archive.names());
    let mut findings = Vec::new();
    if platforms.is_empty() {
        findings
            .push("binaries: found no library, expected one for at least one platform".to_owned());
    }
    findings.extend(archive.damage());
    let dofs = dofs_text(joint.joint.dofs);
    if start.dofs != dofs {
        findings.push(format!(
            "resources/start.txt: found dofs {}, expected {dofs} from resources/joint.json",
            start.dofs
        ));
    }
    let described = match describe(&xml, &joint, &start, &mut findings) {
        Ok(described) => Some(described),
        Err(refused) => {
            findings.push(refused);
            None
        }
    };
    findings.extend(against_joint_file(&start, &joint));
    let table = table_lines(&joint.joint, start.extrapolates());
    if start.table != laws_line(&joint) + &table {
        findings.push(
            "resources/start.txt: found another table over the preload than that of resources/joint.json; export the FMU again"
                .to_owned(),
        );
    }
    let passivity = joint.passivity();
    let active = passivity.active();
    findings.extend(active.map(|matrix| format!("resources/joint.json: {}", matrix.finding())));
    let step_size_max_s = start.value("step_size_max");
    if let (Interface::Lap, Some(step_s)) = (start.interface, step_size_max_s) {
        findings.extend(step_finding(&joint, step_s));
    }
    let mut facts = Vec::new();
    if let Some(described) = &described {
        let (found, wrong) = parts::look_at(&mut archive, described);
        facts = found;
        findings.extend(wrong);
    }
    let seen = described.as_ref();
    Ok(Inspection {
        version: seen.map_or(FmiVersion::Three, |described| described.version),
        interface: start.interface,
        model_name: seen.map_or_else(String::new, |described| described.model_name.clone()),
        platforms,
        passivity,
        step_size_max_s,
        suggested_step_s: seen.and_then(|described| described.step_size_s),
        parts: facts,
        findings,
        joint,
        described,
    })
}

/// Whether a file is a shared library on some platform, by its name.
pub(super) fn is_library(file: &str) -> bool {
    let extension = file.rsplit_once('.').map(|(_, extension)| extension);
    matches!(extension, Some("so" | "dll" | "dylib"))
}

/// Says of what tool an FMU without a start file is, if its model description says so.
fn foreign_or(path: &Path, refused: CheckError) -> CheckError {
    match foreign(path) {
        Ok(Some(found)) => CheckError::Foreign {
            path: path.to_owned(),
            tool: found.tool.unwrap_or_else(|| "another tool".to_owned()),
        },
        _ => refused,
    }
}

/// Platform folders that hold a library.
pub(super) fn platforms(names: &[String]) -> Vec<String> {
    let mut platforms: Vec<String> = names
        .iter()
        .filter_map(|name| {
            let (platform, file) = name.strip_prefix("binaries/")?.split_once('/')?;
            is_library(file).then(|| platform.to_owned())
        })
        .collect();
    platforms.sort();
    platforms.dedup();
    platforms
}

/// Reads the model description and compares it with what it should be.
fn describe(
    xml: &str,
    joint: &JointFile,
    start: &StartFile,
    findings: &mut Vec<String>,
) -> Result<Described, String> {
    let document = Document::parse(xml).map_err(|refused| format!("{FILE}: {refused}"))?;
    let described = Described::from_xml(&document)?;
    match described.version {
        // strict: all that the standard's text asks of variables, units and model structure
        FmiVersion::Three => {
            if let Err(refused) = Declared::from_xml(FILE, xml) {
                findings.push(refused.to_string());
            }
        }
        FmiVersion::Two => {
            let parsed = fmi_schema::deserialize::<fmi_schema::fmi2::Fmi2ModelDescription>(xml);
            if let Err(refused) = parsed {
                findings.push(format!("{FILE}: {refused}"));
            }
        }
    }
    findings.extend(attributes::findings(
        document.root_element(),
        described.version,
    ));
    findings.extend(variables::starts_out_of_range(&described));
    match declared(joint, start.interface, start.value("step_size_max")) {
        Err(refused) => findings.push(format!("resources/joint.json: {refused}")),
        Ok(expected) => findings.extend(variables::differences(&described, &expected)),
    }
    findings.extend(variables::against_start_file(&described, start));
    Ok(described)
}

/// Where the start values are not those of the joint file.
fn against_joint_file(start: &StartFile, joint: &JointFile) -> Vec<String> {
    let step_size_max_s = start.value("step_size_max");
    let mut findings = Vec::new();
    for (name, value) in &start.parameters {
        let expected = start_value(joint, step_size_max_s, name);
        let same = expected.is_some_and(|e| (e - value).abs() <= SAME_START * e.abs());
        if !same {
            let expected = expected.map_or("none".to_owned(), |expected| format!("{expected:?}"));
            findings.push(format!(
                "resources/start.txt: found {name} = {value:?}, expected {expected} from resources/joint.json"
            ));
        }
    }
    findings
}

fn step_finding(joint: &JointFile, step_s: f64) -> Option<String> {
    fn unstable<const D: usize>(laps: &[Lap<D>], step_s: f64) -> Option<String> {
        laps.iter().find_map(|lap| match lap.spectrum() {
            None => {
                Some("resources/joint.json: the equations of motion have no eigenvalues".to_owned())
            }
            Some(spectrum) if !spectrum.is_stable_with(step_s) => Some(format!(
                "step_size_max: found {step_s:?} s, with which RK4 is unstable (|λ|max = {:.4e} 1/s); export again without \
                 --step-size-max",
                spectrum.largest_modulus()
            )),
            Some(_) => None,
        })
    }
    let at_one = |joint: &JointFile| {
        let finding = with_dofs!(joint.joint.dofs.size(), D => {
            joint.tangent_laps::<D>().map(|laps| unstable(&laps, step_s))
        });
        finding.unwrap_or_else(|error| Some(format!("resources/joint.json: {error}")))
    };
    match joint.over_its_preloads() {
        Ok(joints) => joints.iter().find_map(at_one),
        Err(error) => Some(format!("resources/joint.json: {error}")),
    }
}
