//! `predict`: a joint from surfaces, materials and bolts, before anything is built.

mod interface;
mod layered_beam;

use std::path::PathBuf;

use clap::Args;

use super::error::CliError;
use super::kind::expect_study;
use bolted_joint::study::{Method, StudyText};

/// `predict`
#[derive(Debug, Args)]
pub(super) struct PredictArguments {
    /// The study: surfaces, materials, bolts and the model to take (TOML)
    study: PathBuf,
    /// Joint file to write
    #[arg(short, long, value_name = "NAME.joint.json")]
    output: PathBuf,
    /// Also write a report: one page with assumptions, surfaces, pressure, stiffness and damping
    #[arg(long, value_name = "NAME.html")]
    report: Option<PathBuf>,
    /// Also write the 6×6 stiffness and damping of the interface as a table
    #[arg(long, value_name = "NAME.csv")]
    matrix_csv: Option<PathBuf>,
    /// Also write them as an ANSYS macro of MATRIX27 elements between two nodes
    #[arg(long, value_name = "NAME.mac")]
    matrix27: Option<PathBuf>,
    /// Also write pressure, stiffness and damping of each element of the interface
    #[arg(long, value_name = "NAME.csv")]
    field_csv: Option<PathBuf>,
    /// Also write the virtual layer's material (method virtual-material): a table, or a card for Abaqus or ANSYS
    #[arg(long, value_name = "NAME.csv|NAME.inp|NAME.mac")]
    material_card: Option<PathBuf>,
    /// Also write frequencies and damping over the amplitude (method layered-beam)
    #[arg(long, value_name = "NAME.csv")]
    damping_csv: Option<PathBuf>,
    /// Also draw damping over the amplitude (method layered-beam)
    #[arg(long, value_name = "NAME.svg")]
    figure: Option<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &PredictArguments) -> Result<(), CliError> {
    expect_study(&arguments.study)?;
    let study = StudyText::read(&arguments.study)?;
    let methods = [
        Method::FractalContact,
        Method::VirtualMaterial,
        Method::LayeredBeam,
    ];
    let method = study.method()?;
    study.check_method(method, &methods)?;
    match method {
        Method::LayeredBeam => layered_beam::run(arguments, &study),
        _ => interface::run(arguments, &study, method),
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
