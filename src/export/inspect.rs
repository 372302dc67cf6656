//! Looks into an FMU that this program exported: do its parts agree, and can it be simulated?

use std::fs::File;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use bolted_joint_dynamics::Lap;
use bolted_joint_interface::{Interface as Declared, Role, Variable};
use thiserror::Error;

use crate::joint::{DofSet, JointFile, JointFileError, Passivity};

use super::description::Description;
use super::parameters::start_value;
use super::start_file::{StartFile, parameter_lines};
use super::{ExportError, Interface, Timestamp};

/// Start values that a `check` reads back must be the exported ones to this fraction: both are shortest decimals.
const SAME_START: f64 = 1e-15;

/// How many differing variables are told of before they are only counted.
const LISTED_VARIABLES: usize = 5;

/// Why a file cannot be looked into as an FMU.
#[derive(Debug, Error)]
pub enum InspectError {
    /// The file cannot be read.
    #[error("{}: cannot be read ({source}); give the path of a joint file or an FMU", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// The file is no zip archive, or a damaged one.
    #[error("{}: found no readable zip archive ({source}), expected an FMU; copy or export it again", path.display())]
    Archive {
        /// The file.
        path: PathBuf,
        /// What the archive reader says.
        source: zip::result::ZipError,
    },
    /// A file that belongs into the FMU is missing or no text.
    #[error("{}: `{entry}` is missing or no text; expected an FMU that `bolted-joint export` wrote; export it again", path.display())]
    Entry {
        /// The FMU.
        path: PathBuf,
        /// Path within it.
        entry: &'static str,
    },
    /// The joint file within the FMU is not valid.
    #[error("{}: {source}", path.display())]
    JointFile {
        /// The FMU.
        path: PathBuf,
        /// What is wrong with it.
        source: Box<JointFileError>,
    },
}

/// What an FMU holds, and what is wrong with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspection {
    /// Which of the two FMUs it is.
    pub interface: Interface,
    /// The joint's DOFs.
    pub dofs: DofSet,
    /// Name of the model.
    pub model_name: String,
    /// Platform folders with a library.
    pub platforms: Vec<String>,
    /// Whether the joint is passive, by matrix.
    pub passivity: Passivity,
    /// Longest Runge–Kutta step, s, of a lap.
    pub step_size_max_s: Option<f64>,
    /// Everything that does not agree; empty if the FMU is sound.
    pub findings: Vec<String>,
}

/// Looks into the FMU at `path`.
///
/// # Errors
///
/// [`InspectError`] if it is no FMU of this program at all; what is wrong with one of its own is in the findings.
pub fn inspect(path: &Path) -> Result<Inspection, InspectError> {
    let archive_error = |source| InspectError::Archive {
        path: path.to_owned(),
        source,
    };
    let file = File::open(path).map_err(|source| InspectError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    let mut archive = zip::ZipArchive::new(file).map_err(archive_error)?;
    let mut text = |entry: &'static str| {
        let mut text = String::new();
        let read = archive
            .by_name(entry)
            .ok()
            .and_then(|mut file| file.read_to_string(&mut text).ok());
        read.map(|_| text).ok_or_else(|| InspectError::Entry {
            path: path.to_owned(),
            entry,
        })
    };
    let xml = text("modelDescription.xml")?;
    let start_text = text("resources/start.txt")?;
    let joint_text = text("resources/joint.json")?;
    let joint = JointFile::from_json(&joint_text, "resources/joint.json").map_err(|source| {
        InspectError::JointFile {
            path: path.to_owned(),
            source: Box::new(source),
        }
    })?;
    let Some(start) = StartFile::parse(&start_text) else {
        return Err(InspectError::Entry {
            path: path.to_owned(),
            entry: "resources/start.txt",
        });
    };
    let platforms: Vec<String> = archive
        .file_names()
        .filter_map(|name| {
            let name = name.ok()?;
            let (platform, _) = name
                .strip_prefix("binaries/")?
                .split_once("/bolted_joint.")?;
            Some(platform.to_owned())
        })
        .collect();

    let mut findings = Vec::new();
    if platforms.is_empty() {
        findings
            .push("binaries: found no library, expected one for at least one platform".to_owned());
    }
    for index in 0..archive.len() {
        let name = archive
            .name_for_index(index)
            .and_then(Result::ok)
            .map_or_else(|| format!("entry {index}"), |name| name.into_owned());
        let read = archive
            .by_index(index)
            .map_err(io::Error::other)
            .and_then(|mut file| io::copy(&mut file, &mut io::sink()));
        if let Err(refused) = read {
            findings.push(format!(
                "{name}: found it damaged ({refused}), expected it to unpack; copy or export the FMU again"
            ));
        }
    }
    if start.dof_count != joint.joint.dofs.count() {
        findings.push(format!(
            "resources/start.txt: found dofs {}, expected {} from resources/joint.json",
            start.dof_count,
            joint.joint.dofs.count()
        ));
    }
    let step_size_max_s = start.value("step_size_max");
    let expected = expected_interface(&joint, &start);
    let model_name = description_findings(&xml, &start, expected, &mut findings);
    for (name, value) in &start.parameters {
        let expected = start_value(&joint, step_size_max_s, name);
        let same = expected.is_some_and(|e| (e - value).abs() <= SAME_START * e.abs());
        if !same {
            findings.push(format!(
                "resources/start.txt: found {name} = {value:?}, expected {expected:?} from resources/joint.json"
            ));
        }
    }
    let passivity = joint.passivity();
    findings.extend(
        passivity.active().map(|matrix| {
            format!("resources/joint.json: {matrix}; a simulation with it can blow up")
        }),
    );
    if let (Interface::Lap, Some(step_s)) = (start.interface, step_size_max_s) {
        findings.extend(step_finding(&joint, step_s));
    }
    Ok(Inspection {
        interface: start.interface,
        dofs: joint.joint.dofs,
        model_name,
        platforms,
        passivity,
        step_size_max_s,
        findings,
    })
}

/// What the model description of this joint and interface declares.
fn expected_interface(joint: &JointFile, start: &StartFile) -> Result<Declared, ExportError> {
    let mut description = Description::new(start.interface, joint.joint.dofs)?;
    let step_size_max_s = start.value("step_size_max");
    description.set_parameters(|name| start_value(joint, step_size_max_s, name))?;
    let (_, declared) = description.finish(&start.token, Timestamp::from_epoch_text("0")?)?;
    Ok(declared)
}

/// Where the model description declares other variables than this program does; start values are compared elsewhere.
fn variable_findings(found: &Declared, expected: &Declared) -> Vec<String> {
    let mut findings = Vec::new();
    const FILE: &str = "modelDescription.xml";
    if found.model_identifier != expected.model_identifier {
        findings.push(format!(
            "{FILE}: found modelIdentifier \"{}\", expected \"{}\"",
            found.model_identifier, expected.model_identifier
        ));
    }
    for wanted in &expected.variables {
        let same = |other: &Variable| {
            (other.reference, other.role, &other.unit)
                == (wanted.reference, wanted.role, &wanted.unit)
        };
        match found.variable(&wanted.name) {
            None => findings.push(format!(
                "{FILE}: variable {} not found, expected it as resources/start.txt names this interface",
                wanted.name
            )),
            Some(other) if !same(other) => findings.push(format!(
                "{FILE}: found variable {} as {:?} {} in {}, expected {:?} {} in {}",
                wanted.name,
                other.role,
                other.reference,
                other.unit,
                wanted.role,
                wanted.reference,
                wanted.unit
            )),
            Some(_) => {}
        }
    }
    for other in &found.variables {
        if expected.variable(&other.name).is_none() {
            findings.push(format!(
                "{FILE}: found variable {}, expected none of that name",
                other.name
            ));
        }
    }
    if let Some(more) = findings.len().checked_sub(LISTED_VARIABLES + 1) {
        findings.truncate(LISTED_VARIABLES);
        findings.push(format!("{FILE}: {} more variables differ", more + 1));
    }
    findings
}

/// Checks the model description against the start values; returns the model's name.
fn description_findings(
    xml: &str,
    start: &StartFile,
    expected: Result<Declared, ExportError>,
    findings: &mut Vec<String>,
) -> String {
    match Declared::from_xml("modelDescription.xml", xml) {
        Err(error) => findings.push(error.to_string()),
        Ok(interface) => {
            match expected {
                Err(refused) => findings.push(format!("resources/joint.json: {refused}")),
                Ok(expected) => findings.extend(variable_findings(&interface, &expected)),
            }
            let declared: Vec<(String, f64)> = interface
                .variables
                .iter()
                .filter(|variable| variable.role == Role::Parameter)
                .filter_map(|variable| Some((variable.name.clone(), variable.start?)))
                .collect();
            if parameter_lines(&declared) != parameter_lines(&start.parameters) {
                findings.push(
                    "modelDescription.xml: the parameters' start values differ from resources/start.txt, which the \
                     library reads; export the FMU again instead of editing it"
                        .to_owned(),
                );
            }
        }
    }
    match fmi_schema::deserialize::<fmi_schema::fmi3::Fmi3ModelDescription>(xml) {
        Err(error) => {
            findings.push(format!("modelDescription.xml: {error}"));
            String::new()
        }
        Ok(description) => {
            if description.instantiation_token != start.token {
                findings.push(format!(
                    "modelDescription.xml: found instantiationToken \"{}\", expected \"{}\" as in resources/start.txt",
                    description.instantiation_token, start.token
                ));
            }
            description.model_name
        }
    }
}

fn step_finding(joint: &JointFile, step_s: f64) -> Option<String> {
    fn unstable<const D: usize>(lap: &Lap<D>, step_s: f64) -> Option<String> {
        match lap.spectrum() {
            None => {
                Some("resources/joint.json: the equations of motion have no eigenvalues".to_owned())
            }
            Some(spectrum) if !spectrum.is_stable_with(step_s) => Some(format!(
                "step_size_max: found {step_s:?} s, with which RK4 is unstable (|λ|max = {:.4e} 1/s); export again without \
                 --step-size-max",
                spectrum.largest_modulus()
            )),
            Some(_) => None,
        }
    }
    let finding = match joint.joint.dofs {
        DofSet::Translation => joint.lap::<1>().map(|lap| unstable(&lap, step_s)),
        DofSet::TranslationRotation => joint.lap::<2>().map(|lap| unstable(&lap, step_s)),
    };
    finding.unwrap_or_else(|error| Some(format!("resources/joint.json: {error}")))
}
