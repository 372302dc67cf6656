//! Puts an FMU together.

use std::path::{Path, PathBuf};

use bolted_joint_dynamics::{Eigenvalue, Lap, Spectrum, with_dofs};

use super::archive::File;
use super::assets::pictures;
use super::declared::kind;
use super::description::{self, Description};
use super::documentation::{self, Page};
use super::identifier::model_identifier;
use super::nominal;
use super::package::{Entry, Packed, packed};
use super::parameters::start_value;
use super::platforms::Library;
use super::reference_run::{ReferenceRun, step_of_error};
use super::start_file::{laws_line, parameter_lines, start_file, table_lines};
use super::step::{Experiment, StepChoice, StepSize, StepWish};
use super::terminals::{self, terminals_and_icons};
use super::token::token;
use super::{ExportError, FmiVersion, Interface, Timestamp};
use bolted_joint_joint::{JointFile, LawError, OverPreload, Passivity};

/// What to export, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportOptions {
    /// Which of the two FMUs.
    pub interface: Interface,
    /// Version of the FMI standard.
    pub version: FmiVersion,
    /// Name of the library and of the class that tools make of the FMU; made of the model's name where it is not given.
    pub model_identifier: Option<String>,
    /// The Runge–Kutta step of a lap.
    pub step: StepWish,
    /// Folder with a folder for each further platform, such as `x86_64-windows`, that holds its FMU library.
    pub platforms: Option<PathBuf>,
    /// Preload (N·m) at which a joint over the preload is exported as a constant one. Where it is not given, the FMU has the
    /// preload as an input.
    pub preload_n_m: Option<f64>,
    /// Whether the FMU of a joint over the preload holds the ends of its table beyond them, instead of refusing such preloads.
    pub extrapolate: bool,
    /// Whether a joint that can feed energy into a simulation is exported all the same.
    pub allow_active: bool,
    /// Whether a joint that is not to be relied on, as its file says, is exported all the same.
    pub allow_unusable: bool,
    /// Date in the FMU.
    pub date: Timestamp,
}

/// Part of their largest values by which motions and loads of a lap that remembers may be wrong in its reference run, where nothing
/// else is wished for: about what the step for the fastest mode makes of a lap that does not.
const ERROR_WITH_MEMORY: f64 = 1e-5;

/// An FMU, and what is in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Exported {
    /// Which of the two FMUs it is.
    pub interface: Interface,
    /// Version of the FMI standard that it follows.
    pub version: FmiVersion,
    /// Name of its model, which is the joint's.
    pub model_name: String,
    /// Instantiation token.
    pub token: String,
    /// Longest Runge–Kutta step; `None` for the element, which takes no steps.
    pub step: Option<StepSize>,
    /// Relative displacement (m, rad) of each DOF beyond which a softening lap runs away; `None` where it does not soften,
    /// no entries for the element.
    pub escape_amplitude: Vec<Option<f64>>,
    /// Whether the joint is passive, by matrix.
    pub passivity: Passivity,
    /// Its parameters with their start values.
    pub parameters: Vec<(String, f64)>,
    /// Why the joint is not to be relied on; empty where it may be used.
    pub reasons_against: Vec<String>,
    packed: Packed,
}

impl Exported {
    /// The FMU itself.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        self.packed.bytes()
    }

    /// Libraries in it.
    #[must_use]
    pub fn libraries(&self) -> &[Library] {
        &self.packed.libraries
    }

    /// Its files.
    #[must_use]
    pub fn entries(&self) -> &[Entry] {
        &self.packed.entries
    }

    /// Writes the FMU to `path`, whole or not at all.
    ///
    /// # Errors
    ///
    /// [`ExportError::Unwritable`] where the system refuses.
    pub fn write(&self, path: &Path) -> Result<(), ExportError> {
        self.packed.write(path)
    }
}

/// What the equations of a lap model say about running it.
pub(super) struct LapFacts {
    pub(super) step: StepSize,
    pub(super) experiment: Experiment,
    pub(super) modes: Vec<Mode>,
    pub(super) escape_amplitude: Vec<Option<f64>>,
}

/// A mode of the lap model about rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Mode {
    /// Undamped natural frequency, Hz.
    pub(super) frequency_hz: f64,
    /// Negative where the mode grows.
    pub(super) damping_ratio: f64,
}

/// The FMU of the joint in `file`, whose very text is `source_json`. A joint over the preload has it as an input, unless it is
/// taken at one preload; the FMU then keeps the whole table beside the constant joint.
///
/// The same file, options and program give the same bytes.
///
/// # Errors
///
/// [`ExportError`]: an invalid or active joint, a preload that the joint does not have, a lap without bodies, an unstable
/// step size, libraries that cannot be read.
pub fn fmu_bytes(
    file: &JointFile,
    source_json: &str,
    options: &ExportOptions,
) -> Result<Exported, ExportError> {
    let problems = file.validate();
    if !problems.is_empty() {
        return Err(LawError::Invalid { problems }.into());
    }
    if options.extrapolate && (file.joint.over_preload.is_none() || options.preload_n_m.is_some()) {
        return Err(ExportError::NothingToExtrapolate);
    }
    let source = File::text(JOINT_FILE, source_json);
    if options.preload_n_m.is_none() {
        // what is told of a joint over the preload by one number, or by a curve, is told at the nominal preload
        let mut constant = file.at_preload(None)?;
        constant.name.clone_from(&file.name);
        let subject = Subject {
            file: &constant,
            over_preload: file.joint.over_preload.is_some().then_some(file),
            has_table_beside: false,
        };
        return fmu(&subject, vec![source], options);
    }
    let constant = file.at_preload(options.preload_n_m)?;
    let text = constant.to_json().map_err(|_| LawError::Invalid {
        problems: constant.validate(),
    })?;
    let sources = vec![
        File::text(JOINT_FILE, text),
        File::text(TABLE_FILE, source_json),
    ];
    let subject = Subject {
        file: &constant,
        over_preload: None,
        has_table_beside: true,
    };
    fmu(&subject, sources, options)
}

/// The joint that the FMU has.
const JOINT_FILE: &str = "resources/joint.json";
/// The joint over the preload that it was taken from.
const TABLE_FILE: &str = "resources/joint-over-preload.json";

/// What an FMU is made of.
struct Subject<'a> {
    /// The joint at one preload: the one that the FMU has, or that it starts with.
    file: &'a JointFile,
    /// The joint over the preload where the FMU has the preload as an input.
    over_preload: Option<&'a JointFile>,
    /// Whether the FMU keeps a table that it does not use.
    has_table_beside: bool,
}

impl Subject<'_> {
    /// The joint file that the FMU has.
    fn source(&self) -> &JointFile {
        self.over_preload.unwrap_or(self.file)
    }

    fn table(&self) -> Option<&OverPreload> {
        self.over_preload?.joint.over_preload.as_ref()
    }
}

/// The FMU, with the files that it comes from.
fn fmu(
    subject: &Subject<'_>,
    sources: Vec<File>,
    options: &ExportOptions,
) -> Result<Exported, ExportError> {
    let file = subject.file;
    let reasons = subject.source().reasons_against();
    if !reasons.is_empty() && !options.allow_unusable {
        return Err(ExportError::NotUsable {
            reasons: reasons.to_vec(),
        });
    }
    let passivity = subject.source().passivity();
    if !passivity.is_passive() && !options.allow_active {
        return Err(ExportError::Active {
            matrices: passivity.active().cloned().collect(),
        });
    }
    let lap = lap_facts(subject, options)?;
    let step = lap.as_ref().map(|lap| lap.step);

    let dofs = file.joint.dofs;
    let mut description = Description::new(options.interface, dofs, kind(subject.source()))?;
    description.set_version(options.version);
    let summary = format!("{}: {}", file.name, options.interface.summary());
    description.set_names(&file.name, summary);
    let kind = options.interface.name();
    let identifier = model_identifier(options.model_identifier.as_deref(), &file.name, kind)?;
    description.set_identifier(&identifier);
    description.set_about(subject.source().about.as_ref());
    let experiment = experiment(file, lap.as_ref());
    if let Some(experiment) = experiment {
        description.set_experiment(experiment);
    }
    let magnitudes = nominal::magnitudes(file)?;
    let longest_step_s = step.map(|step| step.longest_s);
    let mut parameters =
        description.set_parameters(|name| start_value(file, longest_step_s, name))?;
    description.set_nominals(&magnitudes);
    if let Some(table) = subject.table() {
        let range = match (table.preload.first(), table.preload.last()) {
            (Some(&first), Some(&last)) if !options.extrapolate => Some([first, last]),
            _ => None,
        };
        description.set_preload(table.nominal, range);
        parameters.push(("preload".to_owned(), table.nominal));
    }
    let table =
        laws_line(subject.source()) + &table_lines(&subject.source().joint, options.extrapolate);
    let lines = parameter_lines(&parameters);
    let resources = format!("{table}{lines}");
    let token = token(&[&description.text()?, &resources]);
    let (xml, declared) = description.finish(&token, options.date)?;

    let step_s = experiment.map(|experiment| experiment.communication_step_s);
    let reference_run = ReferenceRun::new(
        file,
        subject.over_preload,
        &declared,
        options.interface,
        lap.as_ref(),
        step_s,
    )?;
    let page = documentation::html(&Page {
        file,
        interface: options.interface,
        version: options.version,
        declared: &declared,
        lap: lap.as_ref(),
        passivity: &passivity,
        reference_tolerance: reference_run.as_ref().map(ReferenceRun::tolerance),
        over_preload: subject.table(),
        has_table_beside: subject.has_table_beside,
        token: &token,
        date: options.date,
    });
    let mut files = vec![
        File::text(description::FILE, xml),
        File::text(
            "resources/start.txt",
            start_file(options.interface, dofs, &token, &table, &lines),
        ),
    ];
    files.extend(sources);
    files.push(File::text("documentation/index.html", page));
    files.extend(documentation::licences());
    files.push(File::text(
        terminals::FILE,
        terminals_and_icons(&declared, dofs),
    ));
    if let Some(run) = &reference_run {
        files.extend(run.files(&file.name));
    }
    files.extend(pictures(options.version, options.interface, dofs));
    let platforms = options.platforms.as_deref();
    Ok(Exported {
        interface: options.interface,
        version: options.version,
        model_name: file.name.clone(),
        token,
        step,
        escape_amplitude: lap.map(|lap| lap.escape_amplitude).unwrap_or_default(),
        passivity,
        parameters,
        reasons_against: subject.source().reasons_against().to_vec(),
        packed: packed(files, platforms, &identifier, options.version, options.date)?,
    })
}

/// `None` for the element.
fn lap_facts(
    subject: &Subject<'_>,
    options: &ExportOptions,
) -> Result<Option<LapFacts>, ExportError> {
    match (options.interface, subject.file.joint.dofs) {
        (Interface::Element, _) => match options.step {
            StepWish::AtMost(found_s) => Err(ExportError::StepOfElement { found_s }),
            StepWish::Error(found) => Err(ExportError::ErrorOfElement { found }),
            StepWish::Accurate => Ok(None),
        },
        (Interface::Lap, dofs) => {
            with_dofs!(dofs.size(), D => sized_lap_facts::<D>(subject, options)).map(Some)
        }
    }
}

fn sized_lap_facts<const D: usize>(
    subject: &Subject<'_>,
    options: &ExportOptions,
) -> Result<LapFacts, ExportError> {
    let lap = subject.file.lap::<D>()?;
    // of a joint over the preload, the bolt may come to any preload of the table
    let joints = subject.source().over_its_preloads()?;
    let laps = joints
        .iter()
        .map(JointFile::lap)
        .collect::<Result<Vec<Lap<D>>, _>>()?;
    let tangents = joints
        .iter()
        .map(JointFile::tangent_laps)
        .collect::<Result<Vec<Vec<Lap<D>>>, _>>()?;
    let mut step = StepSize::choose(&tangents.concat(), options.step)?;
    if subject.over_preload.is_some() {
        step = step.for_energy();
    }
    let spectrum = lap.spectrum();
    let least = |one: Option<f64>, other: Option<f64>| match (one, other) {
        (Some(one), Some(other)) => Some(f64::min(one, other)),
        (amplitude, None) | (None, amplitude) => amplitude,
    };
    let mut escape_amplitude = vec![None; D];
    for lap in &laps {
        for (all, own) in escape_amplitude.iter_mut().zip(lap.escape_amplitude()) {
            *all = least(*all, own);
        }
    }
    let facts = |step: StepSize| LapFacts {
        step,
        experiment: Experiment::of_lap(spectrum.as_ref(), &step),
        modes: spectrum.as_ref().map(modes).unwrap_or_default(),
        escape_amplitude: escape_amplitude.clone(),
    };
    let facts_of_accurate = facts(step);
    let of_error = |wanted: f64| {
        step_of_error(
            &lap,
            subject.file,
            subject.over_preload,
            &facts_of_accurate,
            wanted,
        )
    };
    match options.step {
        StepWish::Error(wanted) => Ok(facts(of_error(wanted)?)),
        // eigenvalues know nothing of what slips
        StepWish::Accurate if lap.joint.has_memory() => match of_error(ERROR_WITH_MEMORY) {
            Ok(shorter) if shorter.longest_s < step.longest_s => Ok(facts(shorter)),
            Ok(_) => Ok(facts_of_accurate),
            Err(_) if step.choice == StepChoice::Accuracy => Ok(facts(StepSize {
                choice: StepChoice::AccuracyAtRest,
                ..step
            })),
            Err(_) => Ok(facts_of_accurate),
        },
        StepWish::Accurate | StepWish::AtMost(_) => Ok(facts_of_accurate),
    }
}

/// The oscillating modes, by frequency.
fn modes(spectrum: &Spectrum) -> Vec<Mode> {
    let negligible = 1e-6 * spectrum.largest_modulus();
    let oscillates = |eigenvalue: &&Eigenvalue| eigenvalue.imaginary > negligible;
    let mut modes: Vec<Mode> = spectrum
        .eigenvalues()
        .iter()
        .filter(oscillates)
        // λ = −ζω + jω√(1 − ζ²)
        .map(|eigenvalue| Mode {
            frequency_hz: eigenvalue.modulus() / std::f64::consts::TAU,
            damping_ratio: -eigenvalue.real / eigenvalue.modulus(),
        })
        .collect();
    modes.sort_by(|one, other| one.frequency_hz.total_cmp(&other.frequency_hz));
    modes
}

/// `None` where the joint file says nothing about the times that matter.
fn experiment(file: &JointFile, lap: Option<&LapFacts>) -> Option<Experiment> {
    match (lap, &file.validity) {
        (Some(lap), _) => Some(lap.experiment),
        (None, Some(validity)) => Some(Experiment::of_element(validity.frequency_hz[1])),
        (None, None) => None,
    }
}
