//! `check` of a system of FMUs (SSP).

use std::path::Path;

use bolted_joint::check::{foreign, unpack_system};
use serde_json::{Map, Value};

use super::{CheckArguments, Report, fmus};
use crate::command_line::error::CliError;

/// A system of FMUs: how they fit each other, and each by itself.
pub(super) fn report(path: &Path, arguments: &CheckArguments) -> Result<Report, CliError> {
    arguments
        .neighbours
        .refuse("a system of FMUs, which has the neighbours of its joints")?;
    let unpacked = unpack_system(path)?;
    let found = &unpacked.inspection;
    let mut report = Report {
        kind: "system of FMUs (SSP)".to_owned(),
        facts: vec![
            format!("name: {}", found.name),
            format!("components: {}", found.components.join(", ")),
            format!("connections: {}", found.connections),
        ],
        reasons_against: Vec::new(),
        findings: unpacked.findings.clone(),
        messages: Vec::new(),
        details: Map::new(),
    };
    for (label, names) in [("inputs", &found.inputs), ("outputs", &found.outputs)] {
        if !names.is_empty() {
            report.facts.push(format!("{label}: {}", names.join(", ")));
        }
    }
    if !unpacked.loose_inputs.is_empty() {
        report.facts.push(format!(
            "inputs without a connection, which keep their start values: {}",
            unpacked.loose_inputs.join(", ")
        ));
    }
    let mut details = Map::new();
    for fmu in &unpacked.fmus {
        let names = fmu.components.join(", ");
        if let Ok(Some(other)) = foreign(&fmu.path) {
            let tool = other.tool.unwrap_or_else(|| "another tool".to_owned());
            report
                .facts
                .push(format!("{names}: FMU of another tool ({tool}), not run"));
            continue;
        }
        let own = match fmus::report(&fmu.path, arguments) {
            Ok(own) => own,
            Err(refused) => {
                // not where it has been unpacked
                let unpacked = fmu.path.display().to_string();
                let told = refused.to_string().replace(&unpacked, &fmu.source);
                report.findings.push(format!("{names}: {told}"));
                continue;
            }
        };
        let named = |text: String| format!("{names}: {text}");
        report.facts.push(named(own.kind));
        report.facts.extend(own.facts.into_iter().map(named));
        report.messages.extend(own.messages.into_iter().map(named));
        report.findings.extend(own.findings.into_iter().map(named));
        let against = own.reasons_against.into_iter();
        report.reasons_against.extend(against.map(named));
        details.insert(names.clone(), Value::Object(own.details));
    }
    if found.is_of_this_program() {
        report.facts.push(
        "communication step: `check` of the assembly file tells how long one of explicit coupling may be".to_owned(),
    );
    }
    report
        .details
        .insert("components".to_owned(), Value::Object(details));
    Ok(report)
}
