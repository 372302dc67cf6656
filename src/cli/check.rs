//! `check`: is a joint file or an FMU what it should be?

use std::fmt::Write as _;
use std::io::Read as _;
use std::path::Path;

use serde_json::json;

use crate::export::inspect;
use crate::joint::{DofSet, JointFile};

use super::CheckArguments;
use super::error::CliError;
use super::output::print;
use super::table::number;

/// What was looked at, and what is wrong with it.
struct Report {
    kind: &'static str,
    facts: Vec<String>,
    findings: Vec<String>,
}

pub(super) fn run(arguments: &CheckArguments) -> Result<(), CliError> {
    let path = &arguments.file;
    let report = if is_zip(path) {
        fmu(path)?
    } else {
        joint_file(path)?
    };
    if arguments.json {
        let value = json!({
            "file": path.display().to_string(),
            "kind": report.kind,
            "sound": report.findings.is_empty(),
            "facts": report.facts,
            "findings": report.findings,
        });
        print(&serde_json::to_string_pretty(&value)?)?;
    } else {
        let mut text = format!("{}: {}\n", path.display(), report.kind);
        for fact in &report.facts {
            let _ = writeln!(text, "  {fact}");
        }
        if report.findings.is_empty() {
            text += "  no problem found\n";
        }
        print(&text)?;
    }
    if report.findings.is_empty() {
        Ok(())
    } else {
        Err(CliError::Check {
            path: path.clone(),
            findings: report.findings.join("\n  "),
        })
    }
}

/// Whether the file begins as a zip archive does; one that cannot be read is left to its reader's message.
fn is_zip(path: &Path) -> bool {
    let mut magic = [0; 2];
    std::fs::File::open(path)
        .and_then(|mut file| file.read_exact(&mut magic))
        .is_ok_and(|()| magic == *b"PK")
}

fn joint_file(path: &Path) -> Result<Report, CliError> {
    let file = JointFile::read(path)?;
    let passivity = file.passivity();
    let mut facts = vec![
        format!("name: {}", file.name),
        format!("degrees of freedom: {}", file.joint.dofs),
    ];
    facts.extend(passivity.matrices.iter().map(ToString::to_string));
    if file.bodies.is_some() && file.joint.over_preload.is_none() {
        facts.push(match file.joint.dofs {
            DofSet::Translation => lap_fact(&file.lap::<1>()),
            DofSet::TranslationRotation => lap_fact(&file.lap::<2>()),
        });
    }
    let findings = passivity
        .active()
        .map(|matrix| format!("{matrix}; expected it positive semidefinite: this joint can feed energy into a simulation"))
        .collect();
    Ok(Report {
        kind: "joint file",
        facts,
        findings,
    })
}

/// How fast the lap model with these bodies is.
fn lap_fact<const D: usize>(
    lap: &Result<bolted_joint_dynamics::Lap<D>, crate::joint::LawError>,
) -> String {
    let spectrum = lap
        .as_ref()
        .ok()
        .and_then(bolted_joint_dynamics::Lap::spectrum);
    match spectrum
        .and_then(|spectrum| Some((spectrum.largest_modulus(), spectrum.accurate_step_s()?)))
    {
        Some((modulus, step_s)) => format!(
            "as lap: |λ|max = {} 1/s, so RK4 steps of {} s",
            number(modulus, 4),
            number(step_s, 3)
        ),
        None => "as lap: nothing moves by itself".to_owned(),
    }
}

fn fmu(path: &Path) -> Result<Report, CliError> {
    let inspection = inspect(path)?;
    let mut facts = vec![
        format!(
            "model: {}, {}",
            inspection.model_name,
            inspection.interface.summary()
        ),
        format!("degrees of freedom: {}", inspection.dofs),
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
    Ok(Report {
        kind: "FMU (FMI 3.0, Co-Simulation and Model Exchange)",
        facts,
        findings: inspection.findings,
    })
}
