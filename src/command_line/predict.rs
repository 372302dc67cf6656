//! `predict`: a joint from surfaces, materials and bolts, before anything is built.

mod interface;
mod layered_beam;

use std::ops::Range;
use std::path::PathBuf;

use clap::Args;

use super::draws::{alone, numbers};
use super::error::CliError;
use super::kind::expect_study;
use super::named_files::check_named;
use bolted_joint::draws::Merged;
use bolted_joint::study::{Method, StudyText};

/// `predict`
#[derive(Debug, Args)]
pub(super) struct PredictArguments {
    /// The study: surfaces, materials, bolts and the model to take (TOML)
    pub(super) study: PathBuf,
    /// Joint file to write
    #[arg(short, long, value_name = "NAME.joint.json")]
    pub(super) output: PathBuf,
    /// Also write a report: one page with assumptions, surfaces, pressure, stiffness and damping
    #[arg(long, value_name = "NAME.html")]
    pub(super) report: Option<PathBuf>,
    /// Also write the 6×6 stiffness and damping of the interface as a table
    #[arg(long, value_name = "NAME.csv")]
    pub(super) matrix_csv: Option<PathBuf>,
    /// Also write them as an ANSYS macro of MATRIX27 elements between two nodes
    #[arg(long, value_name = "NAME.mac")]
    pub(super) matrix27: Option<PathBuf>,
    /// Also write pressure, stiffness and damping of each element of the interface
    #[arg(long, value_name = "NAME.csv")]
    pub(super) field_csv: Option<PathBuf>,
    /// Also write the virtual layer's material (method virtual-material): a table, or a card for Abaqus or ANSYS
    #[arg(long, value_name = "NAME.csv|NAME.inp|NAME.mac")]
    pub(super) material_card: Option<PathBuf>,
    /// Also write frequencies and damping over the amplitude (method layered-beam)
    #[arg(long, value_name = "NAME.csv")]
    pub(super) damping_csv: Option<PathBuf>,
    /// Also draw damping over the amplitude (method layered-beam)
    #[arg(long, value_name = "NAME.svg")]
    pub(super) figure: Option<PathBuf>,
    /// Make these of the study's draws alone, such as 1000..2000, and write them to --output for `merge`
    #[arg(long, value_name = "FIRST..END", value_parser = numbers)]
    pub(super) draws: Option<Range<u64>>,
    /// Print the result as JSON
    #[arg(long)]
    pub(super) json: bool,
}

pub(super) fn run(arguments: &PredictArguments) -> Result<(), CliError> {
    run_with(arguments, None)
}

/// The same with draws that have been made in parts.
pub(super) fn run_with(
    arguments: &PredictArguments,
    parts: Option<Merged>,
) -> Result<(), CliError> {
    expect_study(&arguments.study)?;
    if arguments.draws.is_some() {
        alone(&[
            ("--report", arguments.report.is_some()),
            ("--matrix-csv", arguments.matrix_csv.is_some()),
            ("--matrix27", arguments.matrix27.is_some()),
            ("--field-csv", arguments.field_csv.is_some()),
            ("--material-card", arguments.material_card.is_some()),
            ("--damping-csv", arguments.damping_csv.is_some()),
            ("--figure", arguments.figure.is_some()),
        ])?;
    }
    let study = StudyText::read(&arguments.study)?;
    let methods = [
        Method::FractalContact,
        Method::VirtualMaterial,
        Method::LayeredBeam,
    ];
    let method = study.method()?;
    study.check_method(method, &methods)?;
    let outputs = [
        Some(&arguments.output),
        arguments.report.as_ref(),
        arguments.matrix_csv.as_ref(),
        arguments.matrix27.as_ref(),
        arguments.field_csv.as_ref(),
        arguments.material_card.as_ref(),
        arguments.damping_csv.as_ref(),
        arguments.figure.as_ref(),
    ];
    check_named(&study, &outputs)?;
    match method {
        Method::LayeredBeam => layered_beam::run(arguments, &study),
        _ => interface::run(arguments, &study, method, parts),
    }
}

/// Refuses options that belong to another method.
fn refuse(
    asked: &[(&'static str, Option<&PathBuf>)],
    expected: &'static str,
) -> Result<(), CliError> {
    let mut asked = asked.iter();
    match asked.find_map(|(option, path)| Some((*option, (*path)?))) {
        Some((option, path)) => Err(CliError::option(option, path.display(), expected)),
        None => Ok(()),
    }
}
