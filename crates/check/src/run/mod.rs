//! A short run of the library that is in the FMU for this platform.

mod assembly;
mod balance;
mod child;
mod comparison;
mod excitation;
mod judge;
mod names;
mod plan;
mod script;
mod supervisor;

use std::path::{Path, PathBuf};

use bolted_joint_importer::FmiVersion;

pub use balance::BalanceReport;
pub use child::execute_script;
pub use supervisor::Runner;

use super::archive::Archive;
use super::described::Described;
use super::reference::ReferenceRun;
use super::{AssemblyInspection, CheckError, Inspection};
use assembly::AssemblyPlan;
use bolted_joint_export::{self as export, EMBEDDED_PLATFORM};
use comparison::Comparison;
use excitation::Excitation;
use names::References;
use plan::Plan;
use script::{Action, Script};

/// Whether the library was run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RunVerdict {
    /// It was, to the end of the script.
    Ran,
    /// It was, but not to the end: the finding says why.
    Failed,
    /// There is no library for this platform, which is named.
    NoLibrary(String),
    /// The model description does not name the variables that are needed.
    NoVariables,
}

/// What a run showed.
#[derive(Debug, Clone, PartialEq)]
pub struct RunReport {
    /// Whether the library was run.
    pub verdict: RunVerdict,
    /// Communication steps that were asked for.
    pub steps: usize,
    /// What the FMU logged.
    pub messages: Vec<String>,
    /// Energy balance, if the run went to its end.
    pub balance: Option<BalanceReport>,
    /// What else was tried and is right, in words.
    pub facts: Vec<String>,
    /// What is wrong.
    pub findings: Vec<String>,
}

impl RunReport {
    fn without_run(verdict: RunVerdict) -> Self {
        Self {
            verdict,
            steps: 0,
            messages: Vec::new(),
            balance: None,
            facts: Vec::new(),
            findings: Vec::new(),
        }
    }
}

/// Runs the library in the FMU at `path`, which was inspected before, in a child process.
///
/// # Errors
///
/// [`CheckError`] if the run cannot be tried; what the FMU does wrong is in the findings.
pub fn run(path: &Path, inspection: &Inspection, runner: &Runner) -> Result<RunReport, CheckError> {
    // a joint over the preload is run at its nominal one
    let Ok(constant) = inspection.joint.at_preload(None) else {
        return Ok(RunReport::without_run(RunVerdict::NoVariables));
    };
    let joint = &constant.joint;
    let Some((described, references)) = inspection.described.as_ref().and_then(|described| {
        let references = References::of(described, joint.dofs)?;
        Some((described, references))
    }) else {
        return Ok(RunReport::without_run(RunVerdict::NoVariables));
    };
    let mut archive = Archive::open(path)?;
    let (comparison, finding) = comparison(&mut archive, described);
    let excitation = Excitation::of(&constant, inspection.interface, inspection.step_size_max_s);
    let plan = Plan::new(excitation, references, described, comparison);
    let (mut report, values) = carry_out(archive, described, &plan.actions, runner)?;
    report.findings.splice(0..0, finding);
    if let Some(values) = values {
        plan.judge(inspection, joint, &values, &mut report);
    }
    Ok(report)
}

/// Runs the library in the FMU of an assembly, which was inspected before, in a child process: its reference run, its energies, and
/// a step that is repeated from a saved state.
///
/// # Errors
///
/// [`CheckError`] if the run cannot be tried; what the FMU does wrong is in the findings.
pub fn run_assembly(
    path: &Path,
    inspection: &AssemblyInspection,
    runner: &Runner,
) -> Result<RunReport, CheckError> {
    let Some(described) = &inspection.described else {
        return Ok(RunReport::without_run(RunVerdict::NoVariables));
    };
    let mut archive = Archive::open(path)?;
    let (comparison, finding) = comparison(&mut archive, described);
    let Some(plan) = AssemblyPlan::new(described, inspection.suggested_step_s, comparison) else {
        return Ok(RunReport::without_run(RunVerdict::NoVariables));
    };
    let (mut report, values) = carry_out(archive, described, &plan.actions, runner)?;
    report.findings.splice(0..0, finding);
    if let Some(values) = values {
        plan.judge(&values, &mut report);
    }
    Ok(report)
}

/// The FMU's own reference run, if it has one, or what is wrong with that.
fn comparison(
    archive: &mut Archive,
    described: &Described,
) -> (Option<Comparison>, Option<String>) {
    let read = ReferenceRun::read(archive);
    match read.and_then(|run| run.map(|run| Comparison::new(run, described)).transpose()) {
        Ok(comparison) => (comparison, None),
        Err(refused) => (None, Some(refused)),
    }
}

/// What each reading of variables gave.
type Readings = Vec<Vec<f64>>;

/// Lets a child process do this with the library; returns what it read, if it came to its end.
fn carry_out(
    mut archive: Archive,
    described: &Described,
    actions: &[Action],
    runner: &Runner,
) -> Result<(RunReport, Option<Readings>), CheckError> {
    let platform = platform(described.version);
    let Some(library) = library_entry(&archive.names(), platform, described) else {
        let verdict = RunVerdict::NoLibrary(platform.to_owned());
        return Ok((RunReport::without_run(verdict), None));
    };
    let folder = tempfile::Builder::new().prefix("bolted joint ").tempdir()?;
    let unpacked = folder.path().join("fmu");
    if let Err(refused) = archive.unpack(&unpacked) {
        let mut report = RunReport::without_run(RunVerdict::Failed);
        let finding = format!("run: the FMU cannot be unpacked and run: {refused}");
        report.findings.push(finding);
        return Ok((report, None));
    }
    let script = Script {
        library: unpacked.join(library),
        version: described.version,
        token: described.token.clone(),
        resources: unpacked.join("resources"),
        actions: actions.to_vec(),
    };
    let ran = runner.run(&script, folder.path(), &unpacked)?;
    let mut report = RunReport::without_run(RunVerdict::Ran);
    report.steps = actions
        .iter()
        .filter(|action| matches!(action, Action::Step { .. }))
        .count();
    report.messages = ran.messages;
    if ran.printed > 0 {
        report.findings.push(format!(
            "run: found {} bytes on standard output, expected the library to log by its callback alone",
            ran.printed
        ));
    }
    if let Some(failure) = ran.failure {
        report.verdict = RunVerdict::Failed;
        report.findings.push(format!("run: {failure}"));
        return Ok((report, None));
    }
    Ok((report, Some(ran.values)))
}

/// Folder of this platform below `binaries`.
fn platform(version: FmiVersion) -> &'static str {
    match version {
        FmiVersion::Two => export::FmiVersion::V2,
        FmiVersion::Three => export::FmiVersion::V3,
    }
    .platform_folder(EMBEDDED_PLATFORM)
}

fn library_entry(names: &[String], platform: &str, described: &Described) -> Option<PathBuf> {
    let identifier = described.co_simulation.as_deref()?;
    let beginning = format!("binaries/{platform}/{identifier}.");
    names
        .iter()
        .find(|name| {
            name.strip_prefix(&beginning)
                .is_some_and(|extension| matches!(extension, "so" | "dll" | "dylib"))
        })
        .map(PathBuf::from)
}
