//! `export`: a joint file or an assembly file becomes an FMU.

mod assembly;
mod system;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde_json::json;

use bolted_joint::export::{
    self as fmu, ExportError, ExportOptions, Exported, Interface, StepChoice, StepSize, StepWish,
    Timestamp, fmu_bytes,
};
use bolted_joint::joint::JointFile;
use bolted_joint::show::FileKind;

use super::error::CliError;
use super::invocation::platforms;
use super::kind::expect;
use super::output::{
    Wrote, check_fmu, has_extension, is_standard_output, message, print, write_file,
};
use super::table::number;

/// `export`
#[derive(Debug, Args)]
pub(super) struct ExportArguments {
    /// Joint file (JSON), or assembly file (TOML)
    joint_file: PathBuf,
    /// FMU to write; of an assembly also an SSP (NAME.ssp): structures and joints as FMUs, connected
    #[arg(short, long, value_name = "NAME.fmu")]
    output: PathBuf,
    /// Interface of the FMU of a joint [default: element]
    #[arg(long = "as", value_enum, value_name = "INTERFACE")]
    interface: Option<InterfaceArgument>,
    /// Version of the FMI standard
    /// [default: 3, of the FMUs in an SSP 2]
    #[arg(long, value_enum, value_name = "VERSION")]
    fmi: Option<FmiVersion>,
    /// Longest Runge–Kutta step of a lap FMU, s [default: from its fastest mode]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    step_size_max: Option<f64>,
    /// Part of their largest values that motions and joint loads of a lap FMU may be wrong by: its step is as long as that allows
    #[arg(
        long,
        value_name = "PART",
        allow_hyphen_values = true,
        conflicts_with = "step_size_max"
    )]
    step_error: Option<f64>,
    /// Preload at which a joint over the preload is frozen, N·m [default: the FMU has the preload as an input]
    #[arg(long, value_name = "TORQUE", allow_hyphen_values = true)]
    preload: Option<f64>,
    /// Hold a joint over the preload beyond the ends of its table, where its FMU else refuses the preload
    #[arg(long, conflicts_with = "preload")]
    extrapolate: bool,
    /// Folder with libraries for other platforms: DIR/<platform>/bolted_joint.{so,dll,dylib}
    #[arg(long, value_name = "DIR")]
    platforms: Option<PathBuf>,
    /// Name of the FMU's library, and of the class that tools make of it: a C identifier [default: from the name of the model]
    #[arg(long, value_name = "NAME")]
    model_identifier: Option<String>,
    /// Parameter sets of an SSP that are drawn from the joints' standard deviations and correlations
    #[arg(long, value_name = "NUMBER", default_value_t = 0, value_parser = clap::value_parser!(u32).range(..=100_000))]
    draws: u32,
    /// Seed of the draws [default: 1]
    #[arg(long, value_name = "NUMBER")]
    seed: Option<u64>,
    /// For whom an SSP is written [default: standard]
    #[arg(long, value_enum, value_name = "TOOL")]
    ssp_for: Option<SspReader>,
    /// Export a joint that can feed energy into a simulation
    #[arg(long)]
    allow_active: bool,
    /// Export even a joint that is not to be relied on, as its file says
    #[arg(long)]
    unusable: bool,
    /// Print what was written as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum InterfaceArgument {
    /// The massless joint between two structures: motion in, force out
    Element,
    /// Two supported bodies and the joint between them: loads in, motion out
    Lap,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum FmiVersion {
    /// FMI 3.0
    #[value(name = "3")]
    Three,
    /// FMI 2.0
    #[value(name = "2")]
    Two,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum SspReader {
    /// Tools that follow the standard
    Standard,
    /// Ecos: without connectors of the system, and with parameter sets that are picked by name
    Ecos,
}

impl ExportArguments {
    /// What only an SSP can have.
    fn refuse_options_of_systems(&self, expected: &'static str) -> Result<(), CliError> {
        for (option, given) in [
            ("--draws", self.draws > 0),
            ("--seed", self.seed.is_some()),
            ("--ssp-for", self.ssp_for.is_some()),
        ] {
            if given {
                return Err(CliError::option(option, "it", expected));
            }
        }
        Ok(())
    }
}

impl From<FmiVersion> for fmu::FmiVersion {
    fn from(argument: FmiVersion) -> Self {
        match argument {
            FmiVersion::Three => Self::V3,
            FmiVersion::Two => Self::V2,
        }
    }
}

impl From<InterfaceArgument> for Interface {
    fn from(argument: InterfaceArgument) -> Self {
        match argument {
            InterfaceArgument::Element => Self::Element,
            InterfaceArgument::Lap => Self::Lap,
        }
    }
}

pub(super) fn run(arguments: &ExportArguments) -> Result<(), CliError> {
    let kind = expect(
        &arguments.joint_file,
        "a joint file (JSON) or an assembly file (TOML)",
        |kind| {
            matches!(
                kind,
                FileKind::JointFile | FileKind::OtherJson | FileKind::List | FileKind::Assembly
            )
        },
    )?;
    if kind == FileKind::Assembly {
        return assembly::run(arguments);
    }
    arguments.refuse_options_of_systems("none: it is for the SSP of an assembly")?;
    let interface = arguments.interface.unwrap_or(InterfaceArgument::Element);
    let options = ExportOptions {
        version: arguments.fmi.map_or_else(Default::default, Into::into),
        model_identifier: arguments.model_identifier.clone(),
        step: match (arguments.step_size_max, arguments.step_error) {
            (Some(longest_s), _) => StepWish::AtMost(longest_s),
            (None, Some(part)) => StepWish::Error(part),
            (None, None) => StepWish::Accurate,
        },
        platforms: arguments.platforms.clone().or_else(platforms),
        preload_n_m: arguments.preload,
        extrapolate: arguments.extrapolate,
        allow_active: arguments.allow_active,
        allow_unusable: arguments.unusable,
        ..options(interface.into())?
    };
    if has_extension(&arguments.output, "ssp") {
        let expected = "a name for an FMU, such as NAME.fmu: an SSP is of an assembly";
        let found = arguments.output.display();
        return Err(CliError::option("--output", found, expected));
    }
    check_fmu(&arguments.output, &[&arguments.joint_file])?;
    let exported = export_to(&arguments.joint_file, &arguments.output, &options)?;
    for reason in &exported.reasons_against {
        message(&format!("warning: not to be relied on: {reason}"));
    }
    for matrix in exported.passivity.active() {
        message(&format!(
            "warning: {matrix}: this FMU can feed energy into a simulation"
        ));
    }
    if arguments.json {
        return print(&serde_json::to_string_pretty(&as_json(
            &exported,
            &arguments.output,
        ))?);
    }
    print(&summary(&exported, &arguments.output))
}

/// The options of a plain export as this interface.
pub(super) fn options(interface: Interface) -> Result<ExportOptions, CliError> {
    Ok(ExportOptions {
        interface,
        version: fmu::FmiVersion::default(),
        model_identifier: None,
        step: StepWish::Accurate,
        platforms: platforms(),
        preload_n_m: None,
        extrapolate: false,
        allow_active: false,
        allow_unusable: false,
        date: Timestamp::from_environment()?,
    })
}

/// Reads a joint file and writes its FMU, whole or not at all.
pub(super) fn export_to(
    joint_file: &Path,
    fmu: &Path,
    options: &ExportOptions,
) -> Result<Exported, CliError> {
    let (file, text) = JointFile::read_with_source(joint_file)?;
    let exported = fmu_bytes(&file, &text, options).map_err(|source| match source {
        ExportError::Active { .. }
        | ExportError::NotUsable { .. }
        | ExportError::Law(_)
        | ExportError::NoSpectrum => CliError::Unexportable {
            path: joint_file.to_owned(),
            source,
        },
        _ => source.into(),
    })?;
    match is_standard_output(fmu) {
        true => write_file(fmu, exported.bytes())?,
        false => exported.write(fmu)?,
    }
    Ok(exported)
}

/// What was written, in five lines.
fn summary(exported: &Exported, fmu: &Path) -> String {
    let platforms: Vec<&str> = exported
        .libraries()
        .iter()
        .map(|library| library.platform.as_str())
        .collect();
    format!(
        "{} ({}, {} files, {} kB)\n\
         model: {}, {}\n\
         steps: {}\n\
         platforms: {}\n\
         token: {}\n",
        Wrote(fmu),
        exported.version,
        exported.entries().len(),
        exported.bytes().len().div_ceil(1000),
        exported.model_name,
        exported.interface.summary(),
        exported
            .step
            .as_ref()
            .map_or_else(|| "none, the element has no states".to_owned(), steps),
        platforms.join(", "),
        exported.token,
    )
}

/// What was written, in one line.
pub(super) fn one_line(exported: &Exported) -> String {
    let steps = exported
        .step
        .as_ref()
        .map(|step| format!("; {}", steps(step)));
    format!(
        "{}{}",
        exported.interface.summary(),
        steps.unwrap_or_default()
    )
}

fn steps(step: &StepSize) -> String {
    let why = match step.choice {
        StepChoice::Given => "as given".to_owned(),
        StepChoice::Accuracy => format!("for |λ|max = {} 1/s", number(step.largest_modulus, 3)),
        StepChoice::AccuracyAtRest => format!(
            "for |λ|max = {} 1/s at rest; how accurate it is where the joint slips is not known (--step-error)",
            number(step.largest_modulus, 3)
        ),
        StepChoice::Error { found, .. } => format!("error {}", number(found, 2)),
        StepChoice::NoModes => "nothing moves by itself".to_owned(),
    };
    format!("RK4 of at most {} s, {why}", number(step.longest_s, 2))
}

fn as_json(exported: &Exported, fmu: &Path) -> serde_json::Value {
    json!({
        "output": fmu.display().to_string(),
        "fmi_version": exported.version.number(),
        "interface": exported.interface.name(),
        "model_name": exported.model_name,
        "token": exported.token,
        "step_size_max_s": exported.step.map(|step| step.longest_s),
        "step_error": exported.step.and_then(|step| match step.choice {
            StepChoice::Error { found, .. } => Some(found),
            StepChoice::Given
            | StepChoice::Accuracy
            | StepChoice::AccuracyAtRest
            | StepChoice::NoModes => None,
        }),
        "escape_amplitude": exported.escape_amplitude,
        "platforms": exported.libraries().iter().map(|library| &library.platform).collect::<Vec<_>>(),
        "entries": exported
            .entries()
            .iter()
            .map(|entry| json!({ "path": entry.path, "size": entry.size }))
            .collect::<Vec<_>>(),
        "passive": exported.passivity.is_passive(),
    })
}
