//! `convert`: a joint for other tools.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde_json::json;

use bolted_joint::assembly::AssemblyModel;
use bolted_joint::convert::{
    Converted, Options, Target, Units, convert, convert_assembly, identifier,
};
use bolted_joint::joint::{JointFile, MatrixPassivity};
use bolted_joint::show::FileKind;
use bolted_joint::study::StudyText;

use super::error::CliError;
use super::kind::expect;
use super::named_files::check_named;
use super::output::{Wrote, check_output, is_standard_output, print, warn, write_file};

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
    /// Nodes on sides a and b, for programs of finite elements [default: 1,2]
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..))]
    nodes: Option<Vec<u32>>,
    /// Nodes whose displacements are the rotations of sides a and b, for CalculiX [default: 3,4]
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..))]
    rotation_nodes: Option<Vec<u32>>,
    /// First of free numbers for elements, properties and auxiliary nodes, for programs of finite elements [default: 1001]
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..99_999_000))]
    first_number: Option<u32>,
    /// Preload at which a joint over the preload is taken, N·m
    #[arg(long, value_name = "TORQUE", allow_hyphen_values = true)]
    preload: Option<f64>,
    /// Take the joint of small motion about rest: sliders stick, terms of higher order vanish
    #[arg(long)]
    at_rest: bool,
    /// Units of the numbers; mm for programs of finite elements alone [default: si]
    #[arg(long, value_enum, value_name = "UNITS")]
    units: Option<UnitsArgument>,
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

#[derive(Clone, Copy, Debug, ValueEnum)]
enum UnitsArgument {
    /// N, m, kg, s
    Si,
    /// N, mm, t, s
    Mm,
}

impl From<UnitsArgument> for Units {
    fn from(argument: UnitsArgument) -> Self {
        match argument {
            UnitsArgument::Si => Self::Si,
            UnitsArgument::Mm => Self::Millimetres,
        }
    }
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

/// First number for elements where none is given.
const FIRST_NUMBER: u32 = 1001;

pub(super) fn run(arguments: &ConvertArguments) -> Result<(), CliError> {
    let target = Target::from(arguments.target);
    refuse_what_has_no_effect(arguments, target)?;
    check_output(&arguments.output, &[&arguments.joint_file])?;
    let kind = expect(
        &arguments.joint_file,
        "a joint file (JSON), or for Modelica an assembly file (TOML)",
        |kind| {
            matches!(
                kind,
                FileKind::JointFile | FileKind::OtherJson | FileKind::List | FileKind::Assembly
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
    if arguments.rotation_nodes.is_some() && !file.joint.dofs.turns() {
        let expected = "none: the joint has no rotation";
        return Err(CliError::option("--rotation-nodes", "it", expected));
    }
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
    check_named(&text, &[Some(&arguments.output)])?;
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
        nodes: pair("--nodes", arguments.nodes.as_deref().unwrap_or(&[1, 2]))?,
        rotation_nodes: pair(
            "--rotation-nodes",
            arguments.rotation_nodes.as_deref().unwrap_or(&[3, 4]),
        )?,
        first_number: arguments.first_number.unwrap_or(FIRST_NUMBER),
        at_rest: arguments.at_rest,
        units: arguments.units.map(Units::from).unwrap_or_default(),
    })
}

/// Refuses numbers of nodes and elements for a tool that has none.
fn refuse_what_has_no_effect(arguments: &ConvertArguments, target: Target) -> Result<(), CliError> {
    let has_nodes = target.has_nodes();
    let of_elements = "none: MATLAB and Modelica have no nodes or elements; it is for Nastran, Abaqus, CalculiX and ANSYS";
    let of_units =
        "si: MATLAB and Modelica have SI units; mm is for Nastran, Abaqus, CalculiX and ANSYS";
    let is_mm = matches!(arguments.units, Some(UnitsArgument::Mm));
    let of_rotations =
        "none: it is for CalculiX, where rotations are displacements of nodes of their own";
    let options = [
        ("--nodes", arguments.nodes.is_some(), has_nodes, of_elements),
        (
            "--first-number",
            arguments.first_number.is_some(),
            has_nodes,
            of_elements,
        ),
        ("--units", is_mm, has_nodes, of_units),
        (
            "--rotation-nodes",
            arguments.rotation_nodes.is_some(),
            target == Target::Calculix,
            of_rotations,
        ),
    ];
    match options.iter().find(|(_, given, means, _)| *given && !means) {
        Some((option @ "--units", _, _, expected)) => Err(CliError::option(option, "mm", expected)),
        Some((option, _, _, expected)) => Err(CliError::option(option, "it", expected)),
        None => Ok(()),
    }
}

/// Writes the file, and tells what was written.
fn write(
    arguments: &ConvertArguments,
    target: Target,
    options: &Options,
    converted: &Converted,
) -> Result<(), CliError> {
    let output = output_of(arguments, target, &options.identifier);
    if output != arguments.output {
        check_output(&output, &[&arguments.joint_file])?;
        warn(&[format!(
            "{}: no function of MATLAB can be called so, since it has letters, digits and _ alone and begins with a letter: file and \
             function are called {}",
            arguments.output.display(),
            options.identifier
        )]);
    }
    write_file(&output, converted.text.as_bytes())?;
    if arguments.json {
        let value = json!({
            "output": output.display().to_string(),
            "to": target.name(),
            "name": options.identifier,
            "notes": converted.notes,
        });
        print(&serde_json::to_string_pretty(&value)?)
    } else {
        let mut text = format!("{} for {}\n", Wrote(&output), target.name());
        for note in &converted.notes {
            let _ = writeln!(text, "  {note}");
        }
        print(&text)
    }
}

/// The file to write: MATLAB finds a function by the name of its file.
fn output_of(arguments: &ConvertArguments, target: Target, identifier: &str) -> PathBuf {
    let output = &arguments.output;
    let is_called = output.file_stem().is_some_and(|stem| stem == identifier);
    let is_file = output.extension().is_some() && !is_standard_output(output);
    match target == Target::Matlab && is_file && !is_called {
        true => output.with_file_name(format!("{identifier}.m")),
        false => output.clone(),
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
    passivity.active().map(MatrixPassivity::finding).collect()
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
