//! `convert`: a joint for other tools.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde_json::json;

use bolted_joint::assembly::AssemblyModel;
use bolted_joint::convert::{Converted, Options, Target, convert, convert_assembly, identifier};
use bolted_joint::joint::JointFile;
use bolted_joint::show::FileKind;
use bolted_joint::study::StudyText;

use super::error::CliError;
use super::kind::expect;
use super::output::{check_output, print, warn, write_file};

/// `convert`
#[derive(Debug, Args)]
pub(super) struct ConvertArguments {
    /// Joint file (JSON); for Modelica also an assembly file (TOML)
    joint_file: PathBuf,
    /// The tool
    #[arg(long = "to", value_enum, value_name = "TOOL")]
    target: TargetArgument,
    /// File to write; a function of MATLAB and a package of Modelica get its name
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Nodes on sides a and b
    #[arg(long, value_name = "A,B", value_delimiter = ',', default_value = "1,2", value_parser = clap::value_parser!(u32).range(1..))]
    nodes: Vec<u32>,
    /// Nodes whose displacements are the rotations of sides a and b (CalculiX)
    #[arg(long, value_name = "A,B", value_delimiter = ',', default_value = "3,4", value_parser = clap::value_parser!(u32).range(1..))]
    rotation_nodes: Vec<u32>,
    /// First of free numbers for elements, properties and auxiliary nodes
    #[arg(long, value_name = "NUMBER", default_value_t = 1001, value_parser = clap::value_parser!(u32).range(1..99_999_000))]
    first_number: u32,
    /// Preload at which a joint over the preload is taken, N·m
    #[arg(long, value_name = "TORQUE", allow_hyphen_values = true)]
    preload: Option<f64>,
    /// Take the joint of small motion about rest: sliders stick, terms of higher order vanish
    #[arg(long)]
    at_rest: bool,
    /// Print what was written as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum TargetArgument {
    /// CBUSH and PBUSH, or DMIG
    Nastran,
    /// *SPRING and *DASHPOT, or a connector
    Abaqus,
    /// Springs and dashpots on relative displacements
    Calculix,
    /// COMBIN14, or MATRIX27
    Ansys,
    /// A function, also for Octave
    Matlab,
    /// A package without libraries
    Modelica,
}

impl From<TargetArgument> for Target {
    fn from(argument: TargetArgument) -> Self {
        match argument {
            TargetArgument::Nastran => Self::Nastran,
            TargetArgument::Abaqus => Self::Abaqus,
            TargetArgument::Calculix => Self::Calculix,
            TargetArgument::Ansys => Self::Ansys,
            TargetArgument::Matlab => Self::Matlab,
            TargetArgument::Modelica => Self::Modelica,
        }
    }
}

pub(super) fn run(arguments: &ConvertArguments) -> Result<(), CliError> {
    let target = Target::from(arguments.target);
    check_output(&arguments.output, &[&arguments.joint_file])?;
    let kind = expect(
        &arguments.joint_file,
        "a joint file (JSON), or for Modelica an assembly file (TOML)",
        |kind| {
            matches!(
                kind,
                FileKind::JointFile | FileKind::OtherJson | FileKind::Assembly
            )
        },
    )?;
    if kind == FileKind::Assembly {
        return assembly(arguments, target);
    }
    let file = JointFile::read(&arguments.joint_file)?;
    let file = match (arguments.preload, &file.joint.over_preload) {
        (Some(preload), _) => {
            file.at_preload(Some(preload))
                .map_err(|source| CliError::Preload {
                    path: arguments.joint_file.clone(),
                    source,
                })?
        }
        _ => file,
    };
    let options = options(arguments, &file.name)?;
    let converted = convert(&file, target, &options).map_err(|source| CliError::Unconvertible {
        path: arguments.joint_file.clone(),
        source,
    })?;
    warn(&notes_of_passivity(&file));
    write(arguments, target, &options, &converted)?;
    CliError::unless_usable(&arguments.joint_file, file.reasons_against())
}

/// A whole assembly.
fn assembly(arguments: &ConvertArguments, target: Target) -> Result<(), CliError> {
    if target != Target::Modelica {
        return Err(CliError::option(
            "--to",
            target.name(),
            "modelica: an assembly is converted for Modelica alone",
        ));
    }
    if arguments.preload.is_some() {
        return Err(CliError::option(
            "--preload",
            "it",
            "none: an assembly file says the preload of each of its joints",
        ));
    }
    let text = StudyText::read(&arguments.joint_file)?;
    let model = AssemblyModel::of(&text)?;
    warn(&model.warnings);
    let options = options(arguments, &model.name)?;
    let converted =
        convert_assembly(&model, &options).map_err(|source| CliError::Unconvertible {
            path: arguments.joint_file.clone(),
            source,
        })?;
    let joints = model.joints.iter();
    let notes = joints.flat_map(|joint| notes_of_passivity(&joint.file));
    warn(&notes.collect::<Vec<_>>());
    write(arguments, target, &options, &converted)?;
    let reasons = model
        .joints
        .iter()
        .flat_map(|joint| joint.file.reasons_against());
    CliError::unless_usable(&arguments.joint_file, &reasons.cloned().collect::<Vec<_>>())
}

fn options(arguments: &ConvertArguments, name: &str) -> Result<Options, CliError> {
    Ok(Options {
        identifier: name_of(arguments, name),
        nodes: pair("--nodes", &arguments.nodes)?,
        rotation_nodes: pair("--rotation-nodes", &arguments.rotation_nodes)?,
        first_number: arguments.first_number,
        at_rest: arguments.at_rest,
    })
}

/// Writes the file, and tells what was written.
fn write(
    arguments: &ConvertArguments,
    target: Target,
    options: &Options,
    converted: &Converted,
) -> Result<(), CliError> {
    write_file(&arguments.output, converted.text.as_bytes())?;
    if arguments.json {
        let value = json!({
            "output": arguments.output.display().to_string(),
            "to": target.name(),
            "name": options.identifier,
            "notes": converted.notes,
        });
        print(&serde_json::to_string_pretty(&value)?)
    } else {
        let mut text = format!(
            "wrote {} for {}\n",
            arguments.output.display(),
            target.name()
        );
        for note in &converted.notes {
            let _ = writeln!(text, "  {note}");
        }
        print(&text)
    }
}

/// Function and package are called as their file.
fn name_of(arguments: &ConvertArguments, name: &str) -> String {
    let stem = arguments.output.file_stem().and_then(|stem| stem.to_str());
    let stem = stem.filter(|stem| *stem != "-");
    identifier(stem.unwrap_or(name))
}

fn notes_of_passivity(file: &JointFile) -> Vec<String> {
    let passivity = file.passivity();
    let active = passivity.active();
    active
        .map(|matrix| format!("{matrix}: this joint can feed energy into a simulation"))
        .collect()
}

/// Two different nodes.
fn pair(option: &'static str, nodes: &[u32]) -> Result<[u32; 2], CliError> {
    match nodes {
        &[a, b] if a != b => Ok([a, b]),
        other => {
            let found = other
                .iter()
                .map(u32::to_string)
                .collect::<Vec<_>>()
                .join(",");
            Err(CliError::option(
                option,
                found,
                "two different numbers such as 1,2",
            ))
        }
    }
}
