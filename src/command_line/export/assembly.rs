//! `export` of an assembly file: structures and the joints between them as one FMU.

use serde_json::json;

use bolted_joint::assembly::AssemblyModel;
use bolted_joint::export::{AssemblyOptions, ExportedAssembly, Timestamp, assembly_fmu};
use bolted_joint::study::StudyText;

use super::super::error::CliError;
use super::super::invocation::platforms;
use super::super::named_files::check_named;
use super::super::output::{Wrote, check_fmu, message, note, print, warn};
use super::super::table::number;
use super::{ExportArguments, system};

pub(super) fn run(arguments: &ExportArguments) -> Result<(), CliError> {
    for (option, given) in [
        ("--as", arguments.interface.is_some()),
        ("--step-size-max", arguments.step_size_max.is_some()),
        ("--step-error", arguments.step_error.is_some()),
        ("--preload", arguments.preload.is_some()),
    ] {
        if given {
            let expected =
                "none: it is for a joint file; an assembly file says all of its joints itself";
            return Err(CliError::option(option, "it", expected));
        }
    }
    if system::is_asked_for(&arguments.output) {
        return system::run(arguments);
    }
    arguments.refuse_options_of_systems("none: it is for an SSP; write one with -o NAME.ssp")?;
    let text = StudyText::read(&arguments.joint_file)?;
    check_named(&text, &[Some(&arguments.output)])?;
    check_fmu(&arguments.output, &[&arguments.joint_file])?;
    let model = AssemblyModel::of(&text)?;
    let options = AssemblyOptions {
        version: arguments.fmi.map_or_else(Default::default, Into::into),
        model_identifier: arguments.model_identifier.clone(),
        platforms: arguments.platforms.clone().or_else(platforms),
        allow_active: arguments.allow_active,
        allow_unusable: arguments.unusable,
        extrapolate: arguments.extrapolate,
        date: Timestamp::from_environment()?,
    };
    let exported =
        assembly_fmu(&model, text.text(), &options).map_err(|source| CliError::Unexportable {
            path: arguments.joint_file.clone(),
            source,
        })?;
    exported.packed.write(&arguments.output)?;
    warn(&model.warnings);
    note(&model.notes);
    warn_of_joints(&model);
    if arguments.json {
        return print(&serde_json::to_string_pretty(&as_json(
            &exported, &model, arguments,
        ))?);
    }
    print(&summary(&exported, &model, arguments))
}

/// What speaks against the joints.
pub(super) fn warn_of_joints(model: &AssemblyModel) {
    for joint in &model.joints {
        for reason in joint.whole().reasons_against() {
            message(&format!(
                "warning: joint {} is not to be relied on: {reason}",
                joint.name
            ));
        }
        for matrix in joint.whole().passivity().active() {
            message(&format!(
                "warning: joint {}: {matrix}: this FMU can feed energy into a simulation",
                joint.name
            ));
        }
    }
}

/// What was written, in five lines.
fn summary(
    exported: &ExportedAssembly,
    model: &AssemblyModel,
    arguments: &ExportArguments,
) -> String {
    let packed = &exported.packed;
    let libraries = packed.libraries.iter();
    let platforms: Vec<&str> = libraries.map(|library| library.platform.as_str()).collect();
    format!(
        "{} ({}, {} files, {} kB)\n\
         model: {}, {} structures with {} coordinates and {} joints between them (loads in, motion out)\n\
         steps: exact for the linear part at any length; {} s are suggested\n\
         platforms: {}\n\
         token: {}\n",
        Wrote(&arguments.output),
        exported.version,
        packed.entries.len(),
        packed.bytes().len().div_ceil(1000),
        exported.model_name,
        model.structures.len(),
        exported.coordinates,
        model.joints.len(),
        number(exported.suggested_step_s, 2),
        platforms.join(", "),
        exported.token,
    )
}

fn as_json(
    exported: &ExportedAssembly,
    model: &AssemblyModel,
    arguments: &ExportArguments,
) -> serde_json::Value {
    let packed = &exported.packed;
    let entries = packed.entries.iter();
    json!({
        "output": arguments.output.display().to_string(),
        "fmi_version": exported.version.number(),
        "interface": "assembly",
        "model_name": exported.model_name,
        "token": exported.token,
        "coordinates": exported.coordinates,
        "suggested_step_s": exported.suggested_step_s,
        "warnings": model.warnings,
        "notes": model.notes,
        "platforms": packed.libraries.iter().map(|library| &library.platform).collect::<Vec<_>>(),
        "entries": entries
            .map(|entry| json!({ "path": entry.path, "size": entry.size }))
            .collect::<Vec<_>>(),
    })
}
