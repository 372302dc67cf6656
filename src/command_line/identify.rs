//! `identify`: a study becomes a joint file.

mod budget;
pub(super) mod chain;
mod lap;
mod space;
mod summary;

use std::fmt::Write as _;
use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Args;
use num_complex::Complex64;
use serde_json::json;

use bolted_joint::draws::{Merged, Origin, Share};
use bolted_joint::export::Timestamp;
use bolted_joint::identify::{Bootstrap, Identification, Study, identify_and_draw};
use bolted_joint::joint::JointFile;
use bolted_joint::report::{FrfFigure, FrfPanel, IdentificationReport};
use bolted_joint::study::{Method, StudyText};

use super::bolt_files::of_bolts;
use super::draws::{alone, among, numbers, write_part};
use super::error::CliError;
use super::kind::expect_study;
use super::named_files::check_named;
use super::output::{
    Ending, HTML, SVG, Wrote, check_output, check_outputs, print, warn, write_files,
};
use super::progress::Progress;
use summary::summary;
pub(super) use summary::{basis, fit};

/// `identify`
#[derive(Debug, Args)]
pub(super) struct IdentifyArguments {
    /// The study: what was measured, on which points, and which joint model to identify (TOML)
    pub(super) study: PathBuf,
    /// Joint file to write; NAME.BOLT.joint.json for each bolt where bolts have different joints
    #[arg(short, long, value_name = "NAME.joint.json")]
    pub(super) output: PathBuf,
    /// Also draw measured and regenerated FRFs
    #[arg(long, value_name = "NAME.svg")]
    pub(super) figure: Option<PathBuf>,
    /// Also write a report: one page with everything that was measured, assumed and found
    #[arg(long, value_name = "NAME.html")]
    pub(super) report: Option<PathBuf>,
    /// Repeat the estimate on so many data sets drawn from the fitted model
    #[arg(long, value_name = "DRAWS", value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub(super) bootstrap: Option<u32>,
    /// Seed of the bootstrap [default: 1]
    #[arg(long, requires = "bootstrap")]
    pub(super) seed: Option<u64>,
    /// Make these of the bootstrap's draws alone, such as 1000..2000, and write them to --output for `merge`
    #[arg(long, value_name = "FIRST..END", value_parser = numbers, requires = "bootstrap")]
    pub(super) draws: Option<Range<u64>>,
    /// Do not compare the joint model with others, as `rivals = false` in the study's [joint]
    #[arg(long)]
    pub(super) no_rivals: bool,
    /// Print the result as JSON
    #[arg(long)]
    pub(super) json: bool,
}

/// The methods that this command is for.
const METHODS: [Method; 4] = [
    Method::FrfDecoupling,
    Method::FrfSpace,
    Method::LapUpdate,
    Method::LapResponse,
];

/// At most so many functions are drawn.
const PANELS: usize = 3;

pub(super) fn run(arguments: &IdentifyArguments) -> Result<(), CliError> {
    run_with(arguments, None)
}

/// The same with draws that have been made in parts.
pub(super) fn run_with(
    arguments: &IdentifyArguments,
    parts: Option<Merged>,
) -> Result<(), CliError> {
    let taken = check_outputs(
        &arguments.study,
        &[
            ("--output", Some(&arguments.output), Ending::OfJointFile),
            ("--figure", arguments.figure.as_ref(), SVG),
            ("--report", arguments.report.as_ref(), HTML),
        ],
    )?;
    expect_study(&arguments.study)?;
    let study = StudyText::read(&arguments.study)?;
    let method = study.method()?;
    study.check_method(method, &METHODS)?;
    let outputs = [
        Some(&arguments.output),
        arguments.figure.as_ref(),
        arguments.report.as_ref(),
    ];
    check_named(&study, &outputs)?;
    match method {
        Method::FrfDecoupling => {}
        Method::FrfSpace => return space::run(arguments, &study),
        Method::LapUpdate => return lap::update(arguments, &study),
        Method::LapResponse => return lap::response(arguments, &study),
        other => study.check_method(other, &METHODS)?,
    }
    let written = arguments.report.as_ref();
    let written = written.map(|_| Timestamp::from_environment()).transpose()?;
    let mut study = Study::of(&study)?;
    study.compares_rivals &= !arguments.no_rivals;
    if let Some(numbers) = &arguments.draws {
        return part(arguments, study, numbers);
    }
    let outputs = of_bolts(&arguments.output, &study.bolts);
    if outputs.len() > 1 {
        for output in &outputs {
            check_output(output, &taken)?;
        }
    }
    let bootstrap = match &parts {
        Some(parts) => Some(Bootstrap {
            draws: parts.origin.draws as usize,
            seed: parts.origin.seed,
            share: Share::Made(parts.draws.as_slice().into()),
        }),
        None => all_draws(arguments),
    };
    let count = arguments.bootstrap.unwrap_or(0);
    let progress = Progress::new("identifying", count as usize);
    let found = identify_and_draw(&study, bootstrap, &progress)?;
    drop(progress);
    if let Some(parts) = &parts {
        let origin = origin(&found, parts.origin.draws, parts.origin.seed)?;
        let names = found.estimate.names_of_draws(found.bolts.with_own_joint());
        parts.check(&origin, &names)?;
    }
    let joint_files = found.joint_files();
    let drawing = arguments
        .figure
        .as_ref()
        .map(|path| (path, figure(&found, "")));
    let warnings = warnings(&found);
    let page = written.map(|written| {
        let against = found.reasons_against.iter();
        let against = against.map(|reason| format!("not to be relied on: {reason}"));
        let all: Vec<String> = against.chain(warnings.iter().cloned()).collect();
        report(&study, &found, &all, written)
    });
    let beside = drawing
        .into_iter()
        .chain(arguments.report.as_ref().zip(page));
    write_all(&outputs, &joint_files, &beside.collect::<Vec<_>>())?;
    warn(&warnings);
    if arguments.json {
        let bolts: Vec<_> = outputs
            .iter()
            .zip(&joint_files)
            .map(|(output, (bolt, file))| {
                json!({ "bolt": bolt, "output": output.display().to_string(), "joint_file": file })
            })
            .collect();
        let models = found.estimate.model_choice();
        let not_compared = study.models_not_compared();
        let only = |key: &str| (bolts.len() == 1).then(|| &bolts[0][key]);
        let value = json!({
            "output": only("output"),
            "figure": arguments.figure.as_ref().map(|path| path.display().to_string()),
            "report": arguments.report.as_ref().map(|path| path.display().to_string()),
            "joint_file": only("joint_file"),
            "bolts": (bolts.len() > 1).then_some(&bolts),
            "starts": { "tried": found.starts.0, "agreeing": found.starts.1 },
            "lines": {
                "used": found.estimate.lines_used.0,
                "measured": found.estimate.lines_used.1,
            },
            "reduced_chi_squared": found.reduced_chi_squared,
            "budget": budget::json(&found),
            "usable": found.reasons_against.is_empty(),
            "reasons_against": found.reasons_against,
            "warnings": warnings,
            "models": models.filter(|_| not_compared.is_none()).map(|choice| json!({
                "recommended": choice.recommended,
                "compared": choice.models.iter().map(|fit| json!({
                    "model": fit.model,
                    "bic_difference": fit.bic_difference,
                    "adequate": fit.adequate,
                })).collect::<Vec<_>>(),
            })),
            "torques": found.estimate.torque_choice().map(|choice| json!({
                "used": study.torques,
                "recommended": choice.recommended,
                "compared": choice.compared.map(|fit| json!({
                    "torques": fit.dependence,
                    "unknowns": fit.unknowns,
                    "bic_difference": fit.bic_difference,
                    "adequate": fit.adequate,
                })),
            })),
            "models_not_compared": not_compared,
        });
        print(&serde_json::to_string_pretty(&value)?)?;
        return CliError::unless_usable(&outputs[0], &found.reasons_against);
    }
    let mut text = summary(&found, &study);
    text.push('\n');
    for path in &outputs {
        let _ = writeln!(text, "{}", Wrote(path));
    }
    for path in [&arguments.figure, &arguments.report].into_iter().flatten() {
        let _ = writeln!(text, "{}", Wrote(path));
    }
    print(&text)?;
    CliError::unless_usable(&outputs[0], &found.reasons_against)
}

/// The whole bootstrap that is asked for.
fn all_draws(arguments: &IdentifyArguments) -> Option<Bootstrap> {
    let draws = arguments.bootstrap?;
    Some(Bootstrap {
        draws: draws as usize,
        seed: arguments.seed.unwrap_or(1),
        share: Share::Whole,
    })
}

/// What draws about the joint that was found are made from.
fn origin(found: &Identification, draws: u64, seed: u64) -> Result<Origin, CliError> {
    let files = found.joint_files();
    let files = files.iter().map(|(_, file)| file);
    Ok(Origin::of(&found.name, files, draws, seed)?)
}

/// Makes a part of the draws and writes it.
fn part(
    arguments: &IdentifyArguments,
    mut study: Study,
    numbers: &Range<u64>,
) -> Result<(), CliError> {
    alone(&[
        ("--figure", arguments.figure.is_some()),
        ("--report", arguments.report.is_some()),
    ])?;
    let Some(all) = all_draws(arguments) else {
        return Ok(());
    };
    let expected = "numbers below that of all draws, which --bootstrap states";
    among(numbers, all.draws as u64, expected)?;
    // draws are about the joint that is found, whatever others are beside it
    study.compares_rivals = false;
    let (draws, seed) = (all.draws as u64, all.seed);
    let bootstrap = Bootstrap {
        share: Share::Part(numbers.clone()),
        ..all
    };
    let progress = Progress::new("identifying", (numbers.end - numbers.start) as usize);
    let found = identify_and_draw(&study, Some(bootstrap), &progress)?;
    drop(progress);
    let made = found.estimate.draws.clone().ok_or_else(|| {
        let expected =
            "a joint with which the model can be computed: there is nothing to draw from";
        CliError::option("--draws", "none", expected)
    })?;
    let names = found.estimate.names_of_draws(found.bolts.with_own_joint());
    let origin = origin(&found, draws, seed)?;
    let output = &arguments.output;
    write_part(output, origin, names, numbers.start, made, arguments.json)?;
    warn(&warnings(&found));
    CliError::unless_usable(output, &found.reasons_against)
}

/// Writes every joint file and what goes with them or, if one cannot be written, none.
fn write_all<T>(
    outputs: &[PathBuf],
    files: &[(T, JointFile)],
    beside: &[(&PathBuf, String)],
) -> Result<(), CliError> {
    let texts = files.iter().map(|(_, file)| file.to_json());
    let texts: Vec<String> = texts.collect::<Result<_, _>>()?;
    let contents = outputs.iter().zip(&texts);
    let beside = beside.iter().map(|(path, text)| (*path, text));
    let contents: Vec<(&Path, &[u8])> = contents
        .chain(beside)
        .map(|(output, text)| (output.as_path(), text.as_bytes()))
        .collect();
    write_files(&contents)
}

/// What the identification and the passivity of its result give reason to warn of.
pub(super) fn warnings(found: &Identification) -> Vec<String> {
    let mut warnings = found.warnings.clone();
    for (bolt, file) in found.joint_files() {
        let bolt = bolt.map(|bolt| format!("{bolt}, ")).unwrap_or_default();
        let passivity = file.passivity();
        warnings.extend(passivity.active().map(|matrix| {
            format!("{bolt}{matrix}: the identified joint is active; a simulation with it can blow up, so `export` refuses it")
        }));
    }
    warnings
}

/// The report as a page.
pub(super) fn report(
    study: &Study,
    found: &Identification,
    warnings: &[String],
    written: Timestamp,
) -> String {
    IdentificationReport {
        study,
        found,
        warnings,
        written,
    }
    .to_html()
}

/// The drive-point functions (or, without any, the first ones), measured and regenerated.
pub(super) fn figure(found: &Identification, subtitle: &str) -> String {
    let curve = |matrices: &[bolted_joint::structure::ComplexMatrix], place| -> Vec<Complex64> {
        matrices.iter().map(|matrix| matrix[place]).collect()
    };
    let mut fits: Vec<_> = found.fits.iter().collect();
    // stable: each kind stays in its order
    fits.sort_by_key(|fit| fit.response != fit.reference);
    let curves: Vec<_> = fits
        .into_iter()
        .take(PANELS)
        .map(|fit| {
            let label = format!("{} / {}", fit.response, fit.reference);
            let measured = curve(&found.lines.assembly, fit.place);
            let regenerated = curve(&found.regenerated, fit.place);
            (label, measured, regenerated)
        })
        .collect();
    FrfFigure {
        title: &found.name,
        subtitle,
        frequency_hz: &found.lines.frequency_hz,
        panels: curves
            .iter()
            .map(|(label, measured, regenerated)| FrfPanel {
                label: label.clone(),
                unit: "m/N",
                measured,
                regenerated,
                uncoupled: None,
            })
            .collect(),
    }
    .to_svg()
}
