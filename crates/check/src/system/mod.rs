//! A system of FMUs (SSP): what is in it, and whether its parts fit each other.
//!
//! [`inspect_system`] tells what its structure description says. [`UnpackedSystem`] has its FMUs as files, so that each can be
//! checked by itself, and holds connections and start values against what they declare.

mod parameters;
mod structure;
mod wiring;

use std::path::{Path, PathBuf};

use roxmltree::Document;
use tempfile::TempDir;

use super::CheckError;
use super::archive::Archive;
use super::described::{self, Described};
use super::foreign::is_this_program;
use parameters::Bound;
use structure::{Component, FILE, Structure};
use wiring::Models;

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

impl SystemInspection {
    /// Whether this program made it, of any version.
    #[must_use]
    pub fn is_of_this_program(&self) -> bool {
        self.tool.as_deref().is_some_and(is_this_program)
    }
}

/// A system of FMUs whose files stand in a temporary folder as long as this lives.
#[derive(Debug)]
pub struct UnpackedSystem {
    /// What it says of itself.
    pub inspection: SystemInspection,
    /// The FMUs that are there, each once; none of a damaged archive.
    pub fmus: Vec<UnpackedFmu>,
    /// Inputs of components that nothing is connected to.
    pub loose_inputs: Vec<String>,
    /// What does not fit; empty if the system is sound but for what its FMUs are by themselves.
    pub findings: Vec<String>,
    _folder: TempDir,
}

/// An FMU of a system.
#[derive(Debug)]
pub struct UnpackedFmu {
    /// Names of the components that it is.
    pub components: Vec<String>,
    /// Path in the archive.
    pub source: String,
    /// Path of the unpacked file.
    pub path: PathBuf,
}

/// Looks into the SSP at `path`.
///
/// # Errors
///
/// [`CheckError`] if it is no archive, or has no readable description.
pub fn inspect_system(path: &Path) -> Result<SystemInspection, CheckError> {
    read(path).map(|(_, structure)| inspection(&structure))
}

/// Unpacks the SSP at `path`, and looks whether its parts fit each other; no code of its FMUs is run.
///
/// # Errors
///
/// [`CheckError`] if it is no archive, has no readable description, or cannot be unpacked.
pub fn unpack_system(path: &Path) -> Result<UnpackedSystem, CheckError> {
    let (mut archive, structure) = read(path)?;
    let mut findings = archive.damage();
    let is_whole = findings.is_empty();
    let names = archive.names();
    let folder = tempfile::tempdir()?;
    if is_whole {
        archive.unpack(folder.path())?;
    }
    let mut fmus: Vec<UnpackedFmu> = Vec::new();
    let mut models = Models::new();
    for (place, component) in structure.components.iter().enumerate() {
        let name = &component.name;
        let mut before = structure.components[..place].iter();
        if before.any(|own| own.name == *name) {
            findings.push(format!(
                "{FILE}: found component {name} twice, expected each name once"
            ));
        }
        let Some(source) = component.source.as_deref().filter(|own| is_fmu(own)) else {
            continue;
        };
        if !names.iter().any(|own| own == source) {
            findings.push(format!(
                "{FILE}: component {name}: {source} not found, expected it in the archive"
            ));
            continue;
        }
        if !is_whole {
            // that it is damaged has been said, and of what is not there no more can be
            continue;
        }
        let path = folder.path().join(source);
        if let Some(model) = model(&path) {
            models.insert(name.clone(), model);
        }
        match fmus.iter_mut().find(|other| other.source == source) {
            Some(other) => other.components.push(name.clone()),
            None => fmus.push(UnpackedFmu {
                components: vec![name.clone()],
                source: source.to_owned(),
                path,
            }),
        }
    }
    findings.extend(wiring::findings(&structure, &models));
    for bound in bound(&structure, &mut archive) {
        findings.extend(bound.findings(&structure, &models));
    }
    Ok(UnpackedSystem {
        inspection: inspection(&structure),
        fmus,
        loose_inputs: wiring::loose_inputs(&structure),
        findings,
        _folder: folder,
    })
}

fn read(path: &Path) -> Result<(Archive, Structure), CheckError> {
    let mut archive = Archive::open(path)?;
    let text = archive.optional_text(FILE);
    let found = text.and_then(|xml| Structure::of(&xml));
    let structure = found.ok_or_else(|| CheckError::Structure {
        path: path.to_owned(),
        entry: FILE,
    })?;
    Ok((archive, structure))
}

fn inspection(structure: &Structure) -> SystemInspection {
    let of = |kind: &str| {
        let all = structure.connectors.iter().filter(|own| own.kind == kind);
        all.map(|own| own.name.clone()).collect()
    };
    let component = |own: &Component| match &own.source {
        Some(source) => format!("{} ({source})", own.name),
        None => own.name.clone(),
    };
    let all_bindings = bindings(structure).filter_map(|(_, own)| own.source.clone());
    SystemInspection {
        name: structure.name.clone(),
        tool: structure.tool.clone(),
        components: structure.components.iter().map(component).collect(),
        connections: structure.connections.len(),
        inputs: of("input"),
        outputs: of("output"),
        parameters: all_bindings.collect(),
    }
}

/// All bindings of start values, each with the component that it is for.
fn bindings(structure: &Structure) -> impl Iterator<Item = (Option<&str>, &structure::Binding)> {
    let own = structure.bindings.iter().map(|own| (None, own));
    let components = structure.components.iter().flat_map(|component| {
        let all = component.bindings.iter();
        all.map(|own| (Some(component.name.as_str()), own))
    });
    own.chain(components)
}

/// The files of start values, with their texts: those that are bound, and those that a user may choose.
fn bound<'s>(structure: &'s Structure, archive: &mut Archive) -> Vec<Bound<'s>> {
    let mut all: Vec<Bound<'s>> = bindings(structure)
        .filter_map(|(component, binding)| {
            Some(Bound {
                binding: Some(binding),
                component,
                source: binding.source.clone()?,
                text: None,
            })
        })
        .collect();
    for source in archive.names() {
        if source.ends_with(".ssv") && !all.iter().any(|own| own.source == source) {
            all.push(Bound {
                binding: None,
                component: None,
                source,
                text: None,
            });
        }
    }
    for own in &mut all {
        own.text = archive.optional_text(&own.source);
    }
    all
}

fn is_fmu(source: &str) -> bool {
    source.to_ascii_lowercase().ends_with(".fmu")
}

/// The model description of an FMU, if this program can read it: those of other tools may have variables of any type.
fn model(file: &Path) -> Option<Described> {
    let text = Archive::open(file).ok()?.optional_text(described::FILE)?;
    Described::from_xml(&Document::parse(&text).ok()?).ok()
}
