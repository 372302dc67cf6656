//! A short run of the library that is in the FMU for this platform.

mod balance;
mod child;
mod excitation;
mod judge;
mod names;
mod script;
mod supervisor;

use std::io;
use std::path::{Path, PathBuf};

use bolted_joint_importer::FmiVersion;
use thiserror::Error;

pub use balance::BalanceReport;
pub use child::execute_script;
pub use supervisor::Runner;

use super::archive::Archive;
use super::described::Described;
use super::{InspectError, Inspection};
use crate::export::{self, EMBEDDED_PLATFORM, Interface};
use balance::Integral;
use excitation::{Excitation, moved};
use names::References;
use script::{Action, Script};

/// Steps in a span of the coarser and of the finer run.
const STEPS: [usize; 2] = [Integral::SPAN, 2 * Integral::SPAN];

/// Part of the energies below which the tolerance must be, or the balance says nothing.
const MEANINGFUL: f64 = 1e-3;

/// Why the run could not even be tried.
#[derive(Debug, Error)]
pub enum RunError {
    /// The FMU is no longer what was inspected.
    #[error(transparent)]
    Inspect(#[from] InspectError),
    /// The child process or its files cannot be made.
    #[error(
        "the FMU cannot be unpacked and run in a temporary folder: {0}; set TMPDIR to a folder with room, or leave the run out with --no-run"
    )]
    System(#[from] io::Error),
}

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
/// [`RunError`] if the run cannot be tried; what the FMU does wrong is in the findings.
pub fn run(path: &Path, inspection: &Inspection, runner: &Runner) -> Result<RunReport, RunError> {
    let joint = &inspection.joint.joint;
    let Some((described, references)) = inspection.described.as_ref().and_then(|described| {
        let references = References::of(described, joint.dofs.count())?;
        Some((described, references))
    }) else {
        return Ok(RunReport::without_run(RunVerdict::NoVariables));
    };
    let mut archive = Archive::open(path)?;
    let platform = platform(described.version);
    let Some(library) = library_entry(&archive.names(), platform, described) else {
        return Ok(RunReport::without_run(RunVerdict::NoLibrary(
            platform.to_owned(),
        )));
    };
    let folder = tempfile::Builder::new().prefix("bolted joint ").tempdir()?;
    let unpacked = folder.path().join("fmu");
    archive.unpack(&unpacked)?;

    let excitation = Excitation::of(
        &inspection.joint,
        inspection.interface,
        inspection.step_size_max_s,
    );
    let plan = Plan::new(excitation, references, described);
    let script = Script {
        library: unpacked.join(library),
        version: described.version.into(),
        token: described.token.clone(),
        resources: unpacked.join("resources"),
        actions: plan.actions.clone(),
    };
    let ran = runner.run(&script, folder.path())?;
    let mut report = RunReport::without_run(RunVerdict::Ran);
    report.steps = plan
        .actions
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
    match ran.failure {
        Some(failure) => {
            report.verdict = RunVerdict::Failed;
            report.findings.push(format!("run: {failure}"));
        }
        None => plan.judge(inspection, &ran.values, &mut report),
    }
    Ok(report)
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

/// Everything that is done in a run, one part after the other.
struct Plan {
    excitation: Excitation,
    references: References,
    actions: Vec<Action>,
    /// Directions of the derivatives, if the FMU has them.
    seed: Option<Vec<f64>>,
    has_states: bool,
}

impl Plan {
    fn new(excitation: Excitation, references: References, described: &Described) -> Self {
        let mut actions = Vec::new();
        for steps in STEPS {
            actions.extend(excitation.actions(&references, steps));
        }
        let mut plan = Self {
            seed: described.has_derivatives.then(|| seed(&references)),
            has_states: described.can_save_state,
            excitation,
            references,
            actions,
        };
        plan.add_derivatives();
        plan.add_states();
        plan
    }

    fn get(&self) -> Action {
        Action::Get {
            references: self.references.observed(),
        }
    }

    fn add_derivatives(&mut self) {
        let Some(seed) = &self.seed else {
            return;
        };
        self.actions.extend([
            self.excitation.start(&self.references),
            self.get(),
            Action::Derive {
                unknowns: self.references.joint.clone(),
                knowns: moved(&self.references),
                seed: seed.clone(),
            },
        ]);
    }

    /// Step, save, step, restore, step again: twice the same.
    fn add_states(&mut self) {
        if !self.has_states {
            return;
        }
        let interval_s = self.excitation.span_s;
        let step = |index: usize| Action::Step {
            time_s: index as f64 * interval_s,
            interval_s,
            tentative: true,
        };
        let input = |index: usize| match self.excitation.interface {
            Interface::Lap => self.excitation.set_loads(&self.references, 60 + index),
            Interface::Element => self
                .excitation
                .set_motion(&self.references, index as f64 * interval_s),
        };
        let actions = [
            self.excitation.start(&self.references),
            input(0),
            step(0),
            Action::Save,
            input(1),
            step(1),
            self.get(),
            Action::Restore,
            input(1),
            step(1),
            self.get(),
        ];
        self.actions.extend(actions);
    }

    fn judge(&self, inspection: &Inspection, values: &[Vec<f64>], report: &mut RunReport) {
        let joint = &inspection.joint.joint;
        let mut rest = values;
        let mut balances = Vec::new();
        for steps in STEPS {
            let Some((run, after)) = rest.split_at_checked(self.points(steps)) else {
                return;
            };
            rest = after;
            let samples = judge::samples(&self.references, run);
            if let Some(wrong) = judge::load_finding(joint, inspection.interface, &samples) {
                report.findings.push(wrong);
                return;
            }
            balances.extend(judge::balance(&self.excitation, &samples, steps));
        }
        report
            .facts
            .push("loads: those of resources/joint.json at every communication point".to_owned());
        if let [coarse, fine] = balances.as_slice() {
            let balance = judge::refined(coarse, fine);
            report.findings.extend(balance_finding(&balance));
            report.balance = Some(balance);
        }
        if let (Some(seed), [at, derived, after @ ..]) = (&self.seed, rest) {
            rest = after;
            if let Some(sample) = self.references.sample(at) {
                match judge::derivative_finding(joint, &sample, seed, derived) {
                    Some(wrong) => report.findings.push(wrong),
                    None => report
                        .facts
                        .push("directional derivatives: those of the joint's law".to_owned()),
                }
            }
        }
        if let (true, [first, second]) = (self.has_states, rest) {
            let same = first
                .iter()
                .zip(second)
                .all(|(one, other)| one.to_bits() == other.to_bits());
            if same {
                report.facts.push(
                    "saved state: the step repeated from it is the same to the last bit".to_owned(),
                );
            } else {
                report.findings.push(format!(
                    "run: found {second:?} after a step from a restored state, expected {first:?} as the first time"
                ));
            }
        }
    }

    /// Communication points of a run with `steps` steps in a span.
    fn points(&self, steps: usize) -> usize {
        self.excitation.step_count(steps) + 1
    }
}

/// Every motion of both sides at once, in different measure.
fn seed(references: &References) -> Vec<f64> {
    (0..moved(references).len())
        .map(|i| 1.0 + 0.37 * i as f64)
        .collect()
}

fn balance_finding(balance: &BalanceReport) -> Option<String> {
    if !balance.is_balanced() {
        return Some(format!(
            "run: found an energy balance that is off by {:.3e} J, expected at most {:.1e} J: {:.6e} J went in, energy.stored \
             changed by {:.6e} J, power.dissipated took {:.6e} J",
            balance.imbalance_j(),
            balance.tolerance_j,
            balance.work_j,
            balance.stored_j,
            balance.dissipated_j
        ));
    }
    (balance.tolerance_j > MEANINGFUL * balance.scale_j).then(|| {
        format!(
            "run: found an energy balance that is only known to {:.1e} J of {:.1e} J, expected the run to be accurate \
             enough to judge it",
            balance.tolerance_j, balance.scale_j
        )
    })
}
