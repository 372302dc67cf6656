//! `predict` with method `layered-beam`.

use serde_json::json;

use super::super::error::CliError;
use super::super::output::{CSV, Ending, Outputs, SVG, check_outputs, print, warn};
use super::super::progress::Progress;
use super::{PredictArguments, refuse};
use bolted_joint::draws::Numbers;
use bolted_joint::predict::layered_beam::LayeredBeamStudy;
use bolted_joint::report::LayeredBeamFigure;
use bolted_joint::study::StudyText;

pub(super) fn run(arguments: &PredictArguments, study: &StudyText) -> Result<(), CliError> {
    refuse(
        &[
            ("--report", arguments.report.as_ref()),
            ("--matrix-csv", arguments.matrix_csv.as_ref()),
            ("--matrix27", arguments.matrix27.as_ref()),
            ("--field-csv", arguments.field_csv.as_ref()),
            ("--material-card", arguments.material_card.as_ref()),
        ],
        "none: a layered beam has no interface elements; --damping-csv has its damping over the amplitude",
    )?;
    if let Some(numbers) = &arguments.draws {
        let expected = "none: all draws of a layered beam take less than a second";
        return Err(CliError::option(
            "--draws",
            Numbers(numbers.clone()),
            expected,
        ));
    }
    check_outputs(
        &arguments.study,
        &[
            ("--output", Some(&arguments.output), Ending::OfJointFile),
            ("--damping-csv", arguments.damping_csv.as_ref(), CSV),
            ("--figure", arguments.figure.as_ref(), SVG),
        ],
    )?;
    let study = LayeredBeamStudy::of(study)?;
    let progress = Progress::new("predicting", study.draws() as usize);
    let found = study.run_watched(&|| progress.advance())?;
    drop(progress);
    let joint_file = found.joint_file.to_json()?;
    let mut files = Outputs::new();
    files.add(Some(&arguments.output), || joint_file);
    files.add(arguments.damping_csv.as_ref(), || found.csv());
    files.add(arguments.figure.as_ref(), || {
        let figure = LayeredBeamFigure { outcome: &found };
        figure.to_svg().unwrap_or_default()
    });
    files.write()?;
    warn(&found.warnings);
    if arguments.json {
        let value = json!({
            "output": arguments.output.display().to_string(),
            "figure": arguments.figure.as_ref().map(|path| path.display().to_string()),
            "damping_csv": arguments.damping_csv.as_ref().map(|path| path.display().to_string()),
            "joint_file": found.joint_file,
            "result": found,
        });
        return print(&serde_json::to_string_pretty(&value)?);
    }
    let mut text = format!("{}\n", study.name);
    for line in found.summary() {
        text += &line;
        text.push('\n');
    }
    text.push('\n');
    print(&(text + &files.written()))
}
