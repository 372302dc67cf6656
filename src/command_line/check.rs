//! `check`: is a joint file, an FMU or a system of FMUs what it should be?

mod files;
mod fmus;
mod system;

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Map, Value, json};

use bolted_joint::check::execute_script;
use bolted_joint::show::FileKind;

use super::communication_step::NeighbourArguments;
use super::error::CliError;
use super::kind::expect;
use super::output::print;

/// `check`
#[derive(Debug, Args)]
pub(super) struct CheckArguments {
    /// Joint file, assembly file, FMU or SSP
    file: PathBuf,
    /// Only look into the FMU: run none of its code. Without this its library is run, in a process of its own
    #[arg(long)]
    no_run: bool,
    /// Print the findings as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    neighbours: NeighbourArguments,
}

/// The child process of `check`
#[derive(Debug, Args)]
pub(super) struct RunLibraryArguments {
    /// What to do
    script: PathBuf,
    /// What was done
    journal: PathBuf,
}

/// Name of the hidden command that runs an FMU's library.
pub(super) const RUN_LIBRARY: &str = "run-library";

/// What was looked at, and what is wrong with it.
struct Report {
    kind: String,
    facts: Vec<String>,
    /// Why the joint is not to be relied on.
    reasons_against: Vec<String>,
    findings: Vec<String>,
    /// What the FMU logged.
    messages: Vec<String>,
    /// Further numbers, for machines.
    details: Map<String, Value>,
}

pub(super) fn run(arguments: &CheckArguments) -> Result<(), CliError> {
    let path = &arguments.file;
    let kind = expect(
        path,
        "a joint file (JSON), an assembly file (TOML), an FMU or an SSP",
        |kind| {
            matches!(
                kind,
                FileKind::JointFile
                    | FileKind::OtherJson
                    | FileKind::List
                    | FileKind::Assembly
                    | FileKind::Fmu
                    | FileKind::OtherZip
                    | FileKind::Ssp
            )
        },
    )?;
    let report = match kind {
        FileKind::Fmu | FileKind::OtherZip => fmus::report(path, arguments)?,
        FileKind::Ssp => system::report(path, arguments)?,
        FileKind::Assembly => files::assembly(path, arguments)?,
        _ => files::joint(path, arguments)?,
    };
    if arguments.json {
        let mut value = json!({
            "file": path.display().to_string(),
            "kind": report.kind,
            "sound": report.findings.is_empty(),
            "facts": report.facts,
            "messages": report.messages,
            "findings": report.findings,
            "usable": report.reasons_against.is_empty(),
            "reasons_against": report.reasons_against,
        });
        if let Value::Object(object) = &mut value {
            object.extend(report.details);
        }
        print(&serde_json::to_string_pretty(&value)?)?;
    } else {
        let mut text = format!("{}: {}\n", path.display(), report.kind);
        for fact in &report.facts {
            let _ = writeln!(text, "  {fact}");
        }
        for message in &report.messages {
            let _ = writeln!(text, "  the FMU logged: {message}");
        }
        for reason in &report.reasons_against {
            let _ = writeln!(text, "  not to be relied on: {reason}");
        }
        if report.findings.is_empty() && report.reasons_against.is_empty() {
            text += "  no problem found\n";
        }
        print(&text)?;
    }
    if report.findings.is_empty() {
        CliError::unless_usable(path, &report.reasons_against)
    } else {
        Err(CliError::Check {
            path: path.clone(),
            findings: report.findings.join("\n  "),
        })
    }
}

/// The child process of [`run`].
pub(super) fn run_library(arguments: &RunLibraryArguments) -> Result<(), CliError> {
    Ok(execute_script(&arguments.script, &arguments.journal)?)
}
