//! `check` of an FMU, whose library is run for a moment.

use std::path::Path;
use std::time::Duration;

use bolted_joint::check::{
    self, AssemblyInspection, RunReport, RunVerdict, Runner, inspect, inspect_assembly,
};
use bolted_joint_importer::FmiVersion;
use serde_json::{Map, Value, json};

use super::files::over_its_preloads;
use super::{CheckArguments, RUN_LIBRARY, Report};
use crate::command_line::communication_step::communication_step;
use crate::command_line::error::CliError;
use crate::command_line::invocation::{Program, program};
use crate::command_line::table::number;

/// How long a library may take for the whole run.
const TIME_LIMIT: Duration = Duration::from_secs(60);

/// The FMU of an assembly, or of a joint.
pub(super) fn report(path: &Path, arguments: &CheckArguments) -> Result<Report, CliError> {
    match inspect_assembly(path)? {
        Some(inspection) => of_assembly(path, &inspection, arguments),
        None => of_joint(path, arguments),
    }
}

fn of_joint(path: &Path, arguments: &CheckArguments) -> Result<Report, CliError> {
    let inspection = inspect(path)?;
    let mut facts = vec![
        format!(
            "model: {}, {}",
            inspection.model_name,
            inspection.interface.summary()
        ),
        format!("degrees of freedom: {}", inspection.joint.joint.dofs),
        format!("platforms: {}", inspection.platforms.join(", ")),
    ];
    facts.extend(
        inspection
            .passivity
            .matrices
            .iter()
            .map(ToString::to_string),
    );
    if let Some(step_s) = inspection.step_size_max_s {
        facts.push(format!("RK4 steps of at most {} s", number(step_s, 2)));
    }
    facts.extend(inspection.parts.iter().cloned());
    let mut details = Map::new();
    details.insert("platforms".to_owned(), json!(inspection.platforms));
    details.insert(
        "step_size_max".to_owned(),
        json!(inspection.step_size_max_s),
    );
    let (mut findings, mut messages) = (inspection.findings.clone(), Vec::new());
    if arguments.no_run {
        facts.push("run: left out".to_owned());
        details.insert("run".to_owned(), Value::Null);
    } else {
        let report = check::run(path, &inspection, &runner()?)?;
        facts.extend(run_facts(&report));
        details.insert("run".to_owned(), run_details(&report));
        findings.extend(report.findings);
        messages = report.messages;
    }
    if let Some(step) = communication_step(
        &over_its_preloads(path, &inspection.joint)?,
        inspection.interface,
        &arguments.neighbours,
        inspection.step_size_max_s,
        inspection.suggested_step_s,
    )? {
        facts.extend(step.facts);
        details.insert("communication_step".to_owned(), step.details);
    }
    Ok(Report {
        kind: kind(inspection.version),
        facts,
        reasons_against: inspection.joint.reasons_against().to_vec(),
        findings,
        messages,
        details,
    })
}

/// The FMU of an assembly.
fn of_assembly(
    path: &Path,
    inspection: &AssemblyInspection,
    arguments: &CheckArguments,
) -> Result<Report, CliError> {
    arguments
        .neighbours
        .refuse("the FMU of an assembly, which has the neighbours of its joints")?;
    let [inputs, outputs, coordinates] = inspection.counts;
    let mut facts = vec![
        format!(
            "model: {}, structures and the bolted joints between them (loads in, motion out)",
            inspection.model_name
        ),
        format!("{inputs} inputs, {outputs} outputs, {coordinates} coordinates of structures"),
        format!("platforms: {}", inspection.platforms.join(", ")),
    ];
    facts.extend(inspection.parts.iter().cloned());
    let mut details = Map::new();
    details.insert("platforms".to_owned(), json!(inspection.platforms));
    details.insert("coordinates".to_owned(), json!(coordinates));
    let (mut findings, mut messages) = (inspection.findings.clone(), Vec::new());
    if arguments.no_run {
        facts.push("run: left out".to_owned());
        details.insert("run".to_owned(), Value::Null);
    } else {
        let report = check::run_assembly(path, inspection, &runner()?)?;
        facts.extend(run_facts(&report));
        details.insert("run".to_owned(), run_details(&report));
        findings.extend(report.findings);
        messages = report.messages;
    }
    Ok(Report {
        kind: kind(inspection.version),
        facts,
        reasons_against: Vec::new(),
        findings,
        messages,
        details,
    })
}

/// What an FMU is called.
fn kind(version: FmiVersion) -> String {
    let version = match version {
        FmiVersion::Two => "2.0",
        FmiVersion::Three => "3.0",
    };
    format!("FMU (FMI {version}, Co-Simulation and Model Exchange)")
}

/// What starts a process for a library.
fn runner() -> Result<Runner, CliError> {
    let Program {
        path: program,
        mut arguments,
        ..
    } = program()?;
    arguments.push(RUN_LIBRARY.to_owned());
    Ok(Runner {
        program,
        arguments,
        time_limit: TIME_LIMIT,
    })
}

/// What the run showed, line by line.
fn run_facts(report: &RunReport) -> Vec<String> {
    let mut facts = match &report.verdict {
        RunVerdict::Ran => vec![format!(
            "run: {} communication steps of the library for this platform, every degree of freedom excited",
            report.steps
        )],
        RunVerdict::Failed => vec!["run: broken off".to_owned()],
        RunVerdict::NoLibrary(platform) => vec![format!(
            "run: left out, as the FMU has no library for this platform ({platform})"
        )],
        RunVerdict::NoVariables => vec![
            "run: left out, as modelDescription.xml does not have the variables for it".to_owned(),
        ],
    };
    facts.extend(report.facts.iter().map(|fact| format!("run: {fact}")));
    if let Some(balance) = &report.balance {
        facts.push(format!(
            "run: energy: {} J in, {} J stored, {} J dissipated; off by {} J, tolerance {} J",
            number(balance.work_j, 4),
            number(balance.stored_j, 4),
            number(balance.dissipated_j, 4),
            number(balance.imbalance_j(), 1),
            number(balance.tolerance_j, 1)
        ));
    }
    facts
}

/// The same for machines.
fn run_details(report: &RunReport) -> Value {
    json!({
        "verdict": match &report.verdict {
            RunVerdict::Ran => "ran",
            RunVerdict::Failed => "failed",
            RunVerdict::NoLibrary(_) => "no library for this platform",
            RunVerdict::NoVariables => "no variables",
        },
        "steps": report.steps,
        "energy": report.balance.map(|balance| json!({
            "work": balance.work_j,
            "stored": balance.stored_j,
            "dissipated": balance.dissipated_j,
            "imbalance": balance.imbalance_j(),
            "tolerance": balance.tolerance_j,
        })),
    })
}
