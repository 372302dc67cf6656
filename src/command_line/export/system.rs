//! `export` of an assembly file to an SSP: structures and joints as FMUs, with what connects them.

use std::path::Path;

use serde_json::json;

use bolted_joint::assembly::AssemblyModel;
use bolted_joint::export::{
    AssemblyOptions, Dialect, ExportedSystem, FmiVersion, SystemOptions, Timestamp, assembly_system,
};
use bolted_joint::study::StudyText;

use super::super::error::CliError;
use super::super::invocation::platforms;
use super::super::named_files::check_named;
use super::super::output::{Wrote, check_output, note, print, warn};
use super::assembly::warn_of_joints;
use super::{ExportArguments, SspReader};

/// Seed where none is given.
const SEED: u64 = 1;

/// Whether the output is an SSP by its name.
pub(super) fn is_asked_for(output: &Path) -> bool {
    let extension = output.extension().map(|own| own.to_ascii_lowercase());
    extension.is_some_and(|own| own == "ssp")
}

pub(super) fn run(arguments: &ExportArguments) -> Result<(), CliError> {
    if arguments.seed.is_some() && arguments.draws == 0 {
        let expected = "--draws with it: the seed is that of the draws";
        return Err(CliError::option("--seed", "no draws", expected));
    }
    if arguments.model_identifier.is_some() {
        let expected =
            "none: an SSP has several FMUs, which are named after their structures and joints";
        return Err(CliError::option("--model-identifier", "it", expected));
    }
    if arguments.extrapolate && arguments.draws > 0 {
        let expected = "none with --draws, where joints are taken at one preload each";
        return Err(CliError::option("--extrapolate", "it", expected));
    }
    let text = StudyText::read(&arguments.joint_file)?;
    check_output(&arguments.output, &[&arguments.joint_file])?;
    check_named(&text, &[Some(&arguments.output)])?;
    let model = AssemblyModel::of(&text)?;
    let options = SystemOptions {
        parts: AssemblyOptions {
            // SSP 1.0 was made for it, and not every tool that reads SSP takes FMI 3.0
            version: arguments.fmi.map_or(FmiVersion::V2, Into::into),
            model_identifier: None,
            platforms: arguments.platforms.clone().or_else(platforms),
            extrapolate: arguments.extrapolate,
            allow_active: arguments.allow_active,
            allow_unusable: arguments.unusable,
            date: Timestamp::from_environment()?,
        },
        dialect: match arguments.ssp_for {
            None | Some(SspReader::Standard) => Dialect::Standard,
            Some(SspReader::Ecos) => Dialect::Ecos,
        },
        draws: arguments.draws,
        seed: arguments.seed.unwrap_or(SEED),
    };
    let exported = assembly_system(&model, text.text(), &options).map_err(|source| {
        CliError::Unexportable {
            path: arguments.joint_file.clone(),
            source,
        }
    })?;
    exported.packed.write(&arguments.output)?;
    warn(&model.warnings);
    note(&model.notes);
    note(&about_preloads(&exported));
    warn_of_joints(&model);
    warn(&about_draws(&exported));
    if arguments.json {
        return print(&serde_json::to_string_pretty(&as_json(
            &exported, arguments,
        ))?);
    }
    print(&summary(&exported, arguments))
}

/// Which elements follow a preload that is theirs to set.
fn about_preloads(exported: &ExportedSystem) -> Vec<String> {
    let told = exported.following.iter().map(|(joint, nominal_n_m)| {
        format!("joint {joint}: its FMU follows the preload, the input `preload`, which starts with {nominal_n_m} N·m")
    });
    told.collect()
}

/// What is to be known of the draws.
fn about_draws(exported: &ExportedSystem) -> Vec<String> {
    let told = exported.drawn.iter().filter_map(|own| {
        if own.unknowns == 0 {
            return Some(format!(
                "joint {}: its file has no standard deviations, so that it is the same in all draws",
                own.joint
            ));
        }
        (own.drawn_anew > 0).then(|| {
            format!(
                "joint {}: {} draws could feed energy into a simulation and were drawn anew",
                own.joint, own.drawn_anew
            )
        })
    });
    told.collect()
}

fn summary(exported: &ExportedSystem, arguments: &ExportArguments) -> String {
    let packed = &exported.packed;
    let draws = match arguments.draws {
        0 => "nominal".to_owned(),
        count => format!("nominal, and {count} draws"),
    };
    format!(
        "{} (SSP 1.0 of {} FMUs, {} files, {} kB)\n\
         system: {}, {} components with {} connections: {}\n\
         parameter sets: {draws}\n",
        Wrote(&arguments.output),
        exported.version,
        packed.entries.len(),
        packed.bytes().len().div_ceil(1000),
        exported.name,
        exported.components.len(),
        exported.connections,
        exported.components.join(", "),
    )
}

fn as_json(exported: &ExportedSystem, arguments: &ExportArguments) -> serde_json::Value {
    json!({
        "output": arguments.output.display().to_string(),
        "fmi_version": exported.version.number(),
        "interface": "system",
        "name": exported.name,
        "components": exported.components,
        "connections": exported.connections,
        "draws": arguments.draws,
        "drawn_anew": exported.drawn.iter().map(|own| (own.joint.clone(), own.drawn_anew)).collect::<std::collections::BTreeMap<_, _>>(),
        "entries": exported
            .packed
            .entries
            .iter()
            .map(|entry| json!({ "path": entry.path, "size": entry.size }))
            .collect::<Vec<_>>(),
    })
}
