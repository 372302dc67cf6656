//! `merge`: draws that were made in parts become the result that one machine would have.

use std::path::PathBuf;

use clap::Args;

use bolted_joint::study::{Method, StudyText};

use super::draws::read_parts;
use super::error::CliError;
use super::identify::{self, IdentifyArguments};
use super::kind::{expect_draws, expect_study};
use super::predict::{self, PredictArguments};

/// `merge`
#[derive(Debug, Args)]
pub(super) struct MergeArguments {
    /// The study that the draws were made from (TOML)
    study: PathBuf,
    /// Files of draws that `identify` or `predict` has written with --draws, in any order; together they have all draws
    #[arg(required = true)]
    parts: Vec<PathBuf>,
    /// Joint file to write; NAME.BOLT.joint.json for each bolt where bolts have different joints
    #[arg(short, long, value_name = "NAME.joint.json")]
    output: PathBuf,
    /// Also draw measured and regenerated FRFs (method frf-decoupling)
    #[arg(long, value_name = "NAME.svg")]
    figure: Option<PathBuf>,
    /// Also write a report: one page with everything that was measured or assumed, and found
    #[arg(long, value_name = "NAME.html")]
    report: Option<PathBuf>,
    /// Do not compare the joint model with others, as `rivals = false` in the study's [joint]
    #[arg(long)]
    no_rivals: bool,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &MergeArguments) -> Result<(), CliError> {
    expect_study(&arguments.study)?;
    let study = StudyText::read(&arguments.study)?;
    let method = study.method()?;
    let methods = [
        Method::FrfDecoupling,
        Method::FractalContact,
        Method::VirtualMaterial,
    ];
    study.check_method(method, &methods)?;
    arguments
        .parts
        .iter()
        .try_for_each(|part| expect_draws(part))?;
    let parts = read_parts(&arguments.parts)?;
    parts.check_study(&study.record())?;
    if method == Method::FrfDecoupling {
        let all = IdentifyArguments {
            study: arguments.study.clone(),
            output: arguments.output.clone(),
            figure: arguments.figure.clone(),
            report: arguments.report.clone(),
            bootstrap: None,
            seed: None,
            draws: None,
            no_rivals: arguments.no_rivals,
            json: arguments.json,
        };
        return identify::run_with(&all, Some(parts));
    }
    let all = PredictArguments {
        study: arguments.study.clone(),
        output: arguments.output.clone(),
        report: arguments.report.clone(),
        matrix_csv: None,
        matrix27: None,
        field_csv: None,
        material_card: None,
        damping_csv: None,
        figure: arguments.figure.clone(),
        draws: None,
        json: arguments.json,
    };
    predict::run_with(&all, Some(parts))
}
