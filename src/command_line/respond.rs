//! `respond`: what a test of a study's assembly would measure if its joint were the given one.

mod assembly;
mod chain;
mod lap;
mod picture;
mod plan;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use bolted_joint_files::text_file;
use clap::{Args, Subcommand, ValueEnum};
use nalgebra::DMatrix;
use serde_json::json;

use bolted_joint::frf::{FrfSet, to_npz, write_uff58};
use bolted_joint::identify::{
    Bands, FrfFile, JointMatrices, Study, predict_assembly, predict_lines,
};
use bolted_joint::joint::JointFile;
use bolted_joint::respond::{Pollution, to_csv, with_noise};
use bolted_joint::show::FileKind;
use bolted_joint::study::{Method, StudyText};

use super::bolt_files::of_bolts;
use super::error::CliError;
use super::kind::{expect, expect_joint_file};
use super::named_files::{check_named, check_named_but_assembly};
use super::output::{Wrote, check_output, is_standard_output, print, tell_link, write_file};
use super::progress::Progress;

/// `respond`
#[derive(Debug, Args)]
pub(super) struct RespondArguments {
    /// The study (TOML): of the assembly that a test is for, whose file need not exist yet, of method `frf-space` with joints that
    /// are known, or of method `respond`, which names laps and what is done to them; or an assembly file
    study: PathBuf,
    /// Tell how well a test of a study of method `frf-space` will determine its joints, before it is made
    #[arg(long)]
    plan: bool,
    /// So many sensors or impacts to add to a planned test, one after the other [default: 1]
    #[arg(long, value_name = "NUMBER", requires = "plan")]
    add: Option<usize>,
    /// Numbers for which they are chosen, such as `k_x,c_rz` [default: all]
    #[arg(
        long = "for",
        value_name = "NAMES",
        requires = "plan",
        value_delimiter = ','
    )]
    wanted: Vec<String>,
    /// The joint that the assembly is to have (joint file); NAME.BOLT.joint.json of each bolt where they differ
    #[arg(long, value_name = "NAME.joint.json")]
    joint: Option<PathBuf>,
    /// File to write: a table or, of an assembly, a universal file or an archive of NumPy arrays
    #[arg(
        short,
        long,
        value_name = "NAME.csv|NAME.uff|NAME.npz",
        required_unless_present = "plan"
    )]
    output: Option<PathBuf>,
    /// Distance between the lines of an assembly, Hz [default: 0.25; without `[frequency]` that of what was measured]
    #[arg(long, value_name = "HZ", allow_hyphen_values = true)]
    step: Option<f64>,
    /// Also draw the response of laps, or of an assembly in space
    #[arg(long, value_name = "NAME.svg|NAME.html")]
    report: Option<PathBuf>,
    /// Also write how far the joints' deviations let the functions of an assembly in space be off
    #[arg(long, value_name = "NAME.csv")]
    deviations: Option<PathBuf>,
    /// Print what was written as JSON
    #[arg(long)]
    json: bool,
    #[command(subcommand)]
    noise: Option<RespondNoise>,
}

#[derive(Debug, Subcommand)]
enum RespondNoise {
    /// Give the functions the noise of a measurement
    Noise(NoiseArguments),
}

#[derive(Debug, Args)]
struct NoiseArguments {
    /// How the noise gets into the functions
    #[arg(value_enum)]
    procedure: NoiseProcedure,
    /// Standard deviation: of the factor, or as a fraction of the highest response
    #[arg(
        long,
        value_name = "FRACTION",
        default_value_t = 0.01,
        allow_hyphen_values = true
    )]
    level: f64,
    /// Samples of each harmonic test, for `response` [default: 4096]
    #[arg(long, value_name = "NUMBER")]
    samples: Option<u32>,
    /// Seed of the noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum NoiseProcedure {
    /// Every value times a real normal factor of mean one
    Frf,
    /// White noise on response and force of a harmonic test at each line
    Response,
}

/// What stands in a file of functions that this command has made.
const COMPUTED: &str = "computed, not measured";

/// More lines than any analyser has.
const MOST_LINES: f64 = 1e7;

#[derive(Clone, Copy)]
enum Format {
    Table,
    Universal,
    Archive,
}

impl Format {
    /// Writes functions that were computed.
    fn write(self, set: &FrfSet, output: &Path, what: &str) -> Result<(), CliError> {
        let description = format!("{COMPUTED}: {what}");
        match self {
            Self::Table => write_file(output, to_csv(set).as_bytes()),
            Self::Archive => write_file(output, &to_npz(set, &description)?),
            Self::Universal => {
                write_uff58(set, output, &description)?;
                tell_link(output);
                Ok(())
            }
        }
    }
}

/// Samples of a harmonic test where no number is given.
const SAMPLES: u32 = 4096;

/// Distance between lines where none is given, Hz.
const STEP_HZ: f64 = 0.25;

pub(super) fn run(arguments: &RespondArguments) -> Result<(), CliError> {
    let kind = expect(
        &arguments.study,
        "a study or an assembly file (TOML)",
        |kind| matches!(kind, FileKind::Study(_) | FileKind::Assembly),
    )?;
    if let Some(joint) = &arguments.joint {
        expect_joint_file(joint)?;
    }
    let text = StudyText::read(&arguments.study)?;
    let outputs = [
        arguments.output.as_ref(),
        arguments.report.as_ref(),
        arguments.deviations.as_ref(),
    ];
    if kind == FileKind::Assembly {
        check_named(&text, &outputs)?;
        return assembly::run(arguments, &text);
    }
    let method = text.method()?;
    text.check_method(
        method,
        &[Method::Respond, Method::FrfDecoupling, Method::FrfSpace],
    )?;
    check_named_but_assembly(&text, &outputs)?;
    if arguments.plan {
        return plan::run(arguments, &text);
    }
    if method == Method::FrfSpace {
        return chain::run(arguments, &text);
    }
    if let Some(path) = &arguments.deviations {
        let expected = "a study of method \"frf-space\"";
        return Err(CliError::option("--deviations", path.display(), expected));
    }
    let output = output(arguments)?;
    if method == Method::Respond {
        return lap::run(arguments, &text, output);
    }
    let Some(joint) = &arguments.joint else {
        return Err(CliError::option(
            "--joint",
            "nothing",
            "the joint file that the assembly is to have, or a study of method \"respond\", which names its own",
        ));
    };
    if let Some(report) = &arguments.report {
        let expected =
            "none: the functions of an assembly are not drawn here, `identify --report` draws them";
        return Err(CliError::option("--report", report.display(), expected));
    }
    let format = format(output)?;
    check_output(output, &[&arguments.study, joint])?;
    let noise = match &arguments.noise {
        Some(RespondNoise::Noise(noise)) => Some((noise, pollution(noise)?.checked()?)),
        None => None,
    };
    let study = Study::of(&text)?;
    keep_what_was_measured(output, &study)?;
    let frequency_hz = lines(&study, arguments.step)?;
    let joints = joints(joint, &study)?;
    let progress = Progress::new("responding", 0);
    let exact = predict_assembly(&study, &joints, &frequency_hz)?;
    let measured = match noise {
        Some((noise, pollution)) => with_noise(&exact, &pollution, noise.seed)?,
        None => exact,
    };
    let what = match noise {
        Some((_, Pollution::Frf { level })) => {
            format!("FRF pollution of {} %", 100.0 * level)
        }
        Some((_, Pollution::Response { level, samples })) => format!(
            "response pollution of {} %, {samples} samples a line",
            100.0 * level
        ),
        None => "no noise".to_owned(),
    };
    format.write(&measured, output, &format!("{}, {what}", study.name))?;
    let functions = measured.functions().count();
    let lines = predict_lines(&study, &joints, &frequency_hz)?;
    let bands = study.choose_bands(&lines, &joints)?;
    drop(progress);
    if arguments.json {
        let of_bands = |bands: &Bands| json!({ "yy": bands.yy, "ytheta": bands.ytheta, "thetatheta": bands.thetatheta });
        let mut value = json!({
            "output": output.display().to_string(),
            "functions": functions,
            "lines": frequency_hz.len(),
            "noise": what,
            "bands": of_bands(&bands[0]),
        });
        if let (Some(object), [_, _, ..]) = (value.as_object_mut(), bands.as_slice()) {
            let all = study.bolts.with_own_joint().iter().zip(&bands);
            let all = all.map(|(bolt, bands)| (bolt.clone(), of_bands(bands)));
            object.insert(
                "bands".to_owned(),
                all.collect::<serde_json::Map<_, _>>().into(),
            );
        }
        print(&serde_json::to_string_pretty(&value)?)?;
        return judged(joint, &study);
    }
    print(&format!(
        "{}: {functions} functions of {} lines from {} to {} Hz, {what}\n\n{}\n{}",
        study.name,
        frequency_hz.len(),
        frequency_hz[0],
        frequency_hz[frequency_hz.len() - 1],
        band_tables(&bands, &study),
        Wrote(output)
    ))?;
    judged(joint, &study)
}

/// Refuses to replace what was measured, according to the study: that need not be there yet, but where it is, it may be all there
/// is of it. What was computed before may be computed anew.
fn keep_what_was_measured(output: &Path, study: &Study) -> Result<(), CliError> {
    let further = study.further.iter();
    let sets = std::iter::once((&study.assembly, &study.repeats))
        .chain(further.map(|further| (&further.file, &further.repeats)));
    let mut files = sets.flat_map(|(file, repeats)| {
        let files = std::iter::once(file).chain(repeats);
        files.flat_map(FrfFile::function_files)
    });
    let is_output = |file: &&PathBuf| match (fs::canonicalize(output), fs::canonicalize(file)) {
        (Ok(output), Ok(file)) => output == file,
        _ => false,
    };
    let is_computed = |file: &Path| {
        let text = text_file::beginning(file).unwrap_or_default();
        text.contains(COMPUTED)
    };
    match files.find(is_output) {
        Some(file) if !is_computed(file) => Err(CliError::option(
            "--output",
            file.display(),
            "a file of another name: the study says that this one was measured, and it would be lost; \
             remove it first if that is not so",
        )),
        _ => Ok(()),
    }
}

/// The file to write, which is there unless a test is planned.
fn output(arguments: &RespondArguments) -> Result<&PathBuf, CliError> {
    let expected = "a file to write";
    arguments
        .output
        .as_ref()
        .ok_or_else(|| CliError::option("--output", "nothing", expected))
}

/// Says of joints that are not to be relied on that they are not.
fn judged(joint: &Path, study: &Study) -> Result<(), CliError> {
    of_bolts(joint, &study.bolts).iter().try_for_each(|path| {
        CliError::unless_usable(path, JointFile::read(path)?.reasons_against())
    })
}

/// The bands of each joint as the study's own table, to be copied there.
fn band_tables(bands: &[Bands], study: &Study) -> String {
    let given = study.bands.given();
    let bolts = study.bolts.with_own_joint();
    let table = |(joint, bands)| {
        let bolt = bolts.get(joint).map(|bolt| format!(" of {bolt}:"));
        band_table(bands, &given, &bolt.unwrap_or_default())
    };
    bands.iter().enumerate().map(table).collect()
}

fn band_table(bands: &Bands, given: &Bands, bolt: &str) -> String {
    let mut text = format!(
        "[bands]  #{bolt} most sensitive lines, 10 % or more away from the substructures' own resonances\n"
    );
    for (name, bands, given) in [
        ("yy", &bands.yy, &given.yy),
        ("ytheta", &bands.ytheta, &given.ytheta),
        ("thetatheta", &bands.thetatheta, &given.thetatheta),
    ] {
        if bands.is_empty() {
            continue;
        }
        let list: Vec<String> = bands
            .iter()
            .map(|[from, to]| format!("[{from}, {to}]"))
            .collect();
        let origin = if given.is_empty() {
            ""
        } else {
            "  # as in the study"
        };
        let _ = writeln!(text, "{name} = [{}]{origin}", list.join(", "));
    }
    text
}

fn format(path: &Path) -> Result<Format, CliError> {
    if is_standard_output(path) {
        return Ok(Format::Table);
    }
    let extension = path.extension().and_then(|extension| extension.to_str());
    match extension.map(str::to_ascii_lowercase).as_deref() {
        Some("csv") => Ok(Format::Table),
        Some("uff" | "unv") => Ok(Format::Universal),
        Some("npz") => Ok(Format::Archive),
        _ => Err(CliError::option(
            "--output",
            path.display(),
            "a name that ends in .csv, .uff, .unv or .npz",
        )),
    }
}

fn pollution(noise: &NoiseArguments) -> Result<Pollution, CliError> {
    let level = noise.level;
    match (noise.procedure, noise.samples) {
        (NoiseProcedure::Frf, None) => Ok(Pollution::Frf { level }),
        (NoiseProcedure::Frf, Some(samples)) => {
            let expected = "none: it is for the harmonic tests of `noise response`";
            Err(CliError::option("--samples", samples, expected))
        }
        (NoiseProcedure::Response, samples) => Ok(Pollution::Response {
            level,
            samples: samples.unwrap_or(SAMPLES),
        }),
    }
}

/// Lines from the study's first to its last frequency; where it does not say these, those of what was measured before.
fn lines(study: &Study, step_hz: Option<f64>) -> Result<Vec<f64>, CliError> {
    let [mut from_hz, mut to_hz] = study.frequency_range_hz;
    if from_hz == f64::MIN_POSITIVE || to_hz == f64::MAX {
        let measured = study.measured_frequencies_hz().unwrap_or_default();
        let [first, .., last] = measured[..] else {
            let found = match (from_hz == f64::MIN_POSITIVE, to_hz == f64::MAX) {
                (true, true) => "nothing",
                (true, false) => "no `from`",
                (false, _) => "no `to`",
            };
            let expected = "the lines of the test, such as from = 10 and to = 500 (Hz) in the study: it names no measured file that has them";
            return Err(CliError::option("[frequency]", found, expected));
        };
        if step_hz.is_none() {
            return Ok(measured);
        }
        [from_hz, to_hz] = [first, last];
    }
    let step_hz = step_hz.unwrap_or(STEP_HZ);
    let count = ((to_hz - from_hz) / step_hz + 1e-9).floor() + 1.0;
    if !(step_hz.is_finite() && step_hz > 0.0) {
        let expected = "a positive distance between lines in Hz";
        return Err(CliError::option("--step", step_hz, expected));
    }
    if !(2.0..MOST_LINES).contains(&count) {
        let found = format!("{from_hz} to {to_hz} Hz in steps of {step_hz} Hz");
        let expected =
            "`from` and `to` in the study, two lines apart or more and at most ten million";
        return Err(CliError::option("[frequency]", found, expected));
    }
    Ok((0..count as u64)
        .map(|line| from_hz + step_hz * line as f64)
        .collect())
}

/// The joint of each bolt that has one of its own, or the one for all.
fn joints(path: &Path, study: &Study) -> Result<Vec<JointMatrices>, CliError> {
    let paths = of_bolts(path, &study.bolts);
    paths.iter().map(|path| joint(path, study)).collect()
}

/// The joint that the assembly is to have; of one over the preload, that at the first assembly's torque.
fn joint(path: &Path, study: &Study) -> Result<JointMatrices, CliError> {
    let file = JointFile::read(path)?;
    let torque_n_m = file.joint.over_preload.as_ref().and(study.torque_n_m);
    let file = file
        .at_preload(torque_n_m)
        .map_err(|source| CliError::Preload {
            path: path.to_owned(),
            source,
        })?;
    let size = study.model.dofs();
    let matrix = |rows: &[Vec<f64>]| -> Result<DMatrix<f64>, CliError> {
        if rows.len() != size {
            return Err(CliError::option(
                "--joint",
                format_args!("{} with {} degrees of freedom", path.display(), rows.len()),
                "as many as the study's joint model has",
            ));
        }
        Ok(DMatrix::from_fn(size, size, |i, j| rows[i][j]))
    };
    Ok(JointMatrices {
        stiffness: matrix(&file.joint.stiffness)?,
        damping: matrix(&file.joint.damping)?,
    })
}
