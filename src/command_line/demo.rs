//! `demo`: the main job on built-in data, from FRFs to FMUs.
//!
//! Substructure A is measured (Tol, Appendix A), B is computed. The assembly's FRFs are not published as data, so they are
//! synthesised from the published joint plus noise; from there on the demo is what a user does with files of their own.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use nalgebra::dmatrix;

use bolted_joint::export::{Interface, Timestamp};
use bolted_joint::frf::{polluted, resonances, write_uff58};
use bolted_joint::identify::{
    self as identification, Identification, JointMatrices, Study, Unknown, predict_assembly,
};

use super::error::CliError;
use super::export::{self, export_to};
use super::identify::{self, basis, figure, fit, warnings};
use super::output::{is_standard_output, print, warn, write_file};
use super::table::{Table, number};

/// `demo`
#[derive(Debug, Args)]
pub(super) struct DemoArguments {
    /// Folder for everything that is written; it is made if it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "bolted-joint-demo")]
    output: PathBuf,
    /// Seed of the measurement noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Relative standard deviation of the measurement noise
    #[arg(
        long,
        value_name = "FRACTION",
        default_value_t = 0.01,
        allow_hyphen_values = true
    )]
    noise: f64,
}

const STUDY: &str = include_str!("../../examples/tol-m10x16/study.toml");
const MODES: &str = include_str!("../../examples/tol-m10x16/a-modes.toml");
const PIRDAYR: &str = include_str!("../../examples/pirdayr-ex03/pirdayr-ex03.joint.json");

/// Names of what is written.
const STUDY_NAME: &str = "study.toml";
const NAMES: [&str; 10] = [
    STUDY_NAME,
    "a-modes.toml",
    "assembly.uff",
    "m10x16.joint.json",
    "m10x16-frf.svg",
    "m10x16-report.html",
    "pirdayr-ex03.joint.json",
    "m10x16-element.fmu",
    "m10x16-lap.fmu",
    "pirdayr-ex03-lap.fmu",
];

/// Lines of the thesis's measurement: 0.25 Hz apart up to 512 Hz.
const LINE_SPACING_HZ: f64 = 0.25;
const LINE_COUNT: u32 = 2048;

/// Tol Table 5.3, "updated": the joint that the assembly's FRFs are made from.
fn published_joint() -> JointMatrices {
    JointMatrices {
        stiffness: dmatrix![5.73e5, 5.82e3; 5.82e3, 1.29e3],
        damping: dmatrix![10.83, -0.83; -0.83, 0.083],
    }
}

/// Where everything that the demo writes goes.
struct Files {
    folder: PathBuf,
    written: Vec<PathBuf>,
}

impl Files {
    fn path(&mut self, name: &str) -> PathBuf {
        let path = self.folder.join(name);
        self.written.push(path.clone());
        path
    }

    fn write(&mut self, name: &str, contents: &[u8]) -> Result<PathBuf, CliError> {
        let path = self.path(name);
        write_file(&path, contents)?;
        Ok(path)
    }
}

pub(super) fn run(arguments: &DemoArguments) -> Result<(), CliError> {
    if !(arguments.noise.is_finite() && (0.0..1.0).contains(&arguments.noise)) {
        return Err(CliError::option(
            "--noise",
            arguments.noise,
            "a fraction from 0 to below 1, such as 0.01 for 1 %",
        ));
    }
    keep_what_is_there(&arguments.output)?;
    let written = Timestamp::from_environment()?;
    let element = export::options(Interface::Element)?;
    let lap = export::options(Interface::Lap)?;
    fs::create_dir_all(&arguments.output).map_err(|source| CliError::Unwritable {
        path: arguments.output.clone(),
        source,
    })?;
    let mut files = Files {
        folder: arguments.output.clone(),
        written: Vec::new(),
    };
    let study = synthesise(&mut files, arguments)?;
    let found = identification::identify(&study)?;
    let warnings = warnings(&found);
    warn(&warnings);
    let joint_file = files.path("m10x16.joint.json");
    found.joint_file().write(&joint_file)?;
    let subtitle = format!(
        "assembly synthesised from the published joint, {} % noise; regenerated with the identified joint",
        100.0 * arguments.noise
    );
    files.write("m10x16-frf.svg", figure(&found, &subtitle).as_bytes())?;
    let page = identify::report(&study, &found, &warnings, written);
    files.write("m10x16-report.html", page.as_bytes())?;
    let pirdayr = files.write("pirdayr-ex03.joint.json", PIRDAYR.as_bytes())?;
    let mut exports = String::new();
    for (joint_file, options, name) in [
        (&joint_file, &element, "m10x16-element.fmu"),
        (&joint_file, &lap, "m10x16-lap.fmu"),
        (&pirdayr, &lap, "pirdayr-ex03-lap.fmu"),
    ] {
        let fmu = files.path(name);
        let exported = export_to(joint_file, &fmu, options)?;
        let _ = writeln!(exports, "  {name}: {}", export::one_line(&exported));
    }
    print(&report(&found, arguments, &exports, &files))
}

/// Refuses a folder with files of these names that are not those of an earlier demo.
fn keep_what_is_there(folder: &Path) -> Result<(), CliError> {
    if is_standard_output(folder) {
        let expected = "a folder: the demo writes several files";
        return Err(CliError::option("--output", folder.display(), expected));
    }
    if fs::read(folder.join(STUDY_NAME)).is_ok_and(|study| study == STUDY.as_bytes()) {
        return Ok(());
    }
    let there = NAMES.iter().map(|name| folder.join(name));
    match there.into_iter().find(|path| path.exists()) {
        Some(path) => Err(CliError::option(
            "--output",
            path.display(),
            "a folder without files of the demo's names, or one of an earlier demo: this file would be lost",
        )),
        None => Ok(()),
    }
}

/// Writes the study and its data: the published modes, and the assembly's FRFs made from the published joint.
fn synthesise(files: &mut Files, arguments: &DemoArguments) -> Result<Study, CliError> {
    let path = files.write(STUDY_NAME, STUDY.as_bytes())?;
    files.write("a-modes.toml", MODES.as_bytes())?;
    let study = Study::read(&path)?;
    let frequency_hz: Vec<f64> = (1..=LINE_COUNT)
        .map(|line| LINE_SPACING_HZ * f64::from(line))
        .collect();
    let exact = predict_assembly(&study, &[published_joint()], &frequency_hz)?;
    let measured = polluted(&exact, arguments.noise, arguments.seed)?;
    write_uff58(
        &measured,
        files.path("assembly.uff"),
        "synthesised, not measured: Tol Table 5.3 (updated) plus noise",
    )?;
    Ok(study)
}

/// What was found, beside what the data were made from.
fn report(
    found: &Identification,
    arguments: &DemoArguments,
    exports: &str,
    files: &Files,
) -> String {
    let mut text = format!(
        "{}: two aluminium beams joined by one bolt (Tol, section 5.2.1)\n\n\
         Substructure A: measured modes (Tol, Appendix A). Substructure B: computed beam.\n\
         Assembly: NOT measured. Its FRFs are not published as data; they are synthesised here from the joint of Tol's\n\
         Table 5.3 (updated), with {} % noise (seed {}). \"True\" below is that joint.\n\n\
         {}\n\n",
        found.name,
        100.0 * arguments.noise,
        arguments.seed,
        basis(found)
    );
    let truth = published_joint();
    let mut table = Table::new(&[
        "",
        "true",
        "identified",
        "error",
        "± std. dev.",
        "band average",
        "unit",
    ]);
    for unknown in Unknown::of(found.model) {
        let (exact, value) = (unknown.value(&truth), unknown.value(&found.joint));
        let deviation = unknown.value(&found.standard_deviation);
        table.row(vec![
            unknown.name.to_owned(),
            number(exact, 5),
            number(value, 5),
            format!("{:+.3} %", 100.0 * (value / exact - 1.0)),
            format!("{:.3} %", 100.0 * (deviation / exact).abs()),
            found.band_average.as_ref().map_or_else(
                || "none".to_owned(),
                |average| number(unknown.value(average), 4),
            ),
            unknown.unit.to_owned(),
        ]);
    }
    text += &table.render();
    let _ = writeln!(text, "\n{}", fit(found));
    let middle = found.lines.points.len() / 2;
    let drive_point: Vec<_> = found
        .regenerated
        .iter()
        .map(|matrix| matrix[(middle, middle)])
        .collect();
    let resonances: Vec<String> = resonances(&found.lines.frequency_hz, &drive_point)
        .iter()
        .map(|resonance| format!("{:.1}", resonance.frequency_hz))
        .collect();
    let _ = writeln!(
        text,
        "coupled resonances at {}: {} Hz (the thesis names 112.5 and 344 Hz)\n\nFMUs\n{exports}",
        found.lines.points[middle],
        resonances.join(", ")
    );
    let folder = files.folder.display();
    let _ = writeln!(text, "wrote {} files to {folder}:", files.written.len());
    for path in &files.written {
        let _ = writeln!(text, "  {}", name_in(&files.folder, path));
    }
    text
}

fn name_in(folder: &Path, path: &Path) -> String {
    path.strip_prefix(folder)
        .unwrap_or(path)
        .display()
        .to_string()
}

#[cfg(test)]
mod tests {
    use super::PIRDAYR;
    use bolted_joint::joint::JointFile;

    #[test]
    fn the_built_in_lap_joint_is_valid() {
        let file = JointFile::from_json(PIRDAYR, "built in").unwrap();
        assert_eq!(file.joint.stiffness, [[4.56e6]]);
    }
}
