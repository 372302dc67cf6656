//! `check`: is a joint file, an FMU or a system of FMUs what it should be?

mod system;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use bolted_joint_dynamics::with_dofs;
use bolted_joint_importer::FmiVersion;
use clap::Args;
use serde_json::{Map, Value, json};

use bolted_joint::assembly::AssemblyModel;
use bolted_joint::check::{
    self, AssemblyInspection, RunReport, RunVerdict, Runner, execute_script, inspect,
    inspect_assembly,
};
use bolted_joint::export::Interface;
use bolted_joint::joint::{JointFile, MatrixPassivity};
use bolted_joint::show::FileKind;
use bolted_joint::study::StudyText;

use super::communication_step::{NeighbourArguments, communication_step};
use super::error::CliError;
use super::flexible_neighbours::of_assembly;
use super::invocation::{Program, program};
use super::kind::expect;
use super::named_files::check_named;
use super::output::{print, warn};
use super::table::number;

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

/// How long a library may take for the whole run.
const TIME_LIMIT: Duration = Duration::from_secs(60);

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
        FileKind::Fmu | FileKind::OtherZip => any_fmu(path, arguments)?,
        FileKind::Ssp => system::report(path, arguments)?,
        FileKind::Assembly => assembly_file(path, arguments)?,
        _ => joint_file(path, arguments)?,
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

fn joint_file(path: &Path, arguments: &CheckArguments) -> Result<Report, CliError> {
    let file = JointFile::read(path)?;
    let passivity = file.passivity();
    let mut facts = vec![
        format!("name: {}", file.name),
        format!("degrees of freedom: {}", file.joint.dofs),
    ];
    facts.extend(passivity.matrices.iter().map(ToString::to_string));
    if !file.joint.friction.is_empty() {
        let laws = file.joint.friction.iter();
        let laws = laws.map(|own| format!("{} on {}", own.law.name, own.dof.name));
        let laws: Vec<String> = laws.collect();
        facts.push(format!(
            "friction: {}, passive with their parameters",
            laws.join(", ")
        ));
    }
    // what a simulation does with the joint is told of the whole table, all of which an FMU may come to
    let joints = over_its_preloads(path, &file)?;
    if let Some(table) = &file.joint.over_preload {
        let preloads: Vec<String> = table.preload.iter().map(f64::to_string).collect();
        facts.push(format!(
            "preloads: {} N·m, nominal {} N·m",
            preloads.join(", "),
            table.nominal
        ));
    }
    if file.bodies.is_some() {
        facts.push(with_dofs!(file.joint.dofs.size(), D => lap_fact::<D>(&joints)));
    }
    let findings = passivity.active().map(MatrixPassivity::finding).collect();
    let mut details = Map::new();
    let neighbours = &arguments.neighbours;
    if let Some(step) = communication_step(&joints, Interface::Element, neighbours, None, None)? {
        facts.extend(step.facts);
        details.insert("communication_step".to_owned(), step.details);
    }
    Ok(Report {
        kind: "joint file".to_owned(),
        facts,
        reasons_against: file.reasons_against().to_vec(),
        findings,
        messages: Vec::new(),
        details,
    })
}

/// An assembly file: what it has, and how its parts would bear explicit coupling.
fn assembly_file(path: &Path, arguments: &CheckArguments) -> Result<Report, CliError> {
    arguments
        .neighbours
        .refuse("an assembly file, which has the neighbours of its joints")?;
    let text = StudyText::read(path)?;
    check_named(&text, &[])?;
    let model = AssemblyModel::of(&text)?;
    warn(&model.warnings);
    let names = |all: &mut dyn Iterator<Item = &String>| {
        all.map(String::as_str).collect::<Vec<_>>().join(", ")
    };
    let mut facts = vec![
        format!("name: {}", model.name),
        format!(
            "structures: {}, with {} coordinates",
            names(&mut model.structures.iter().map(|own| &own.name)),
            model.size()
        ),
        match model.joints.is_empty() {
            true => "joints: none".to_owned(),
            false => format!(
                "joints: {}",
                names(&mut model.joints.iter().map(|own| &own.name))
            ),
        },
    ];
    facts.extend(model.notes.iter().cloned());
    let (mut findings, mut reasons_against) = (Vec::new(), Vec::new());
    for joint in &model.joints {
        let name = &joint.name;
        let passivity = joint.file.passivity();
        let active = passivity.active();
        findings.extend(active.map(|matrix| format!("joint {name}: {}", matrix.finding())));
        reasons_against.extend(
            joint
                .file
                .reasons_against()
                .iter()
                .map(|reason| format!("joint {name}: {reason}")),
        );
    }
    facts.push("as one FMU: exact for the linear part at any communication step".to_owned());
    let mut details = Map::new();
    if model.joints.is_empty() {
        facts.push(
            "communication step: there is no joint to couple, so that none is bounded".to_owned(),
        );
    } else {
        let step = of_assembly(&model)?;
        facts.extend(
            step.facts
                .into_iter()
                .map(|fact| format!("as structures and elements (SSP): {fact}")),
        );
        details.insert("communication_step".to_owned(), step.details);
    }
    Ok(Report {
        kind: "assembly file".to_owned(),
        facts,
        reasons_against,
        findings,
        messages: Vec::new(),
        details,
    })
}

/// The joint, or one over the preload at each preload that is judged.
fn over_its_preloads(path: &Path, file: &JointFile) -> Result<Vec<JointFile>, CliError> {
    file.over_its_preloads()
        .map_err(|source| CliError::Preload {
            path: path.to_owned(),
            source,
        })
}

/// How fast the lap model with these bodies is, at the preload where it is fastest.
fn lap_fact<const D: usize>(joints: &[JointFile]) -> String {
    let fastest = joints
        .iter()
        .filter_map(|joint| joint.lap::<D>().ok()?.spectrum())
        .filter_map(|spectrum| Some((spectrum.largest_modulus(), spectrum.accurate_step_s()?)))
        .max_by(|one, other| one.0.total_cmp(&other.0));
    match fastest {
        Some((modulus, step_s)) => format!(
            "as lap: |λ|max = {} 1/s, so RK4 steps of {} s",
            number(modulus, 4),
            number(step_s, 3)
        ),
        None => "as lap: nothing moves by itself".to_owned(),
    }
}

/// The FMU of an assembly, or of a joint.
fn any_fmu(path: &Path, arguments: &CheckArguments) -> Result<Report, CliError> {
    match inspect_assembly(path)? {
        Some(inspection) => assembly(path, &inspection, arguments),
        None => fmu(path, arguments),
    }
}

fn fmu(path: &Path, arguments: &CheckArguments) -> Result<Report, CliError> {
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
fn assembly(
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
