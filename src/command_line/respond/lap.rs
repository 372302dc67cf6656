//! `respond` with a study of method `respond`: how laps answer, as a table and a picture.

use std::path::Path;

use serde_json::json;

use bolted_joint::respond::{RespondStudy, ResponseTable};
use bolted_joint::study::StudyText;

use super::super::error::CliError;
use super::super::output::{Wrote, check_output, has_extension, print, warn, write_file};
use super::super::progress::Progress;
use super::RespondArguments;
use super::picture::{Picture, also};

pub(super) fn run(
    arguments: &RespondArguments,
    study: &StudyText,
    output: &Path,
) -> Result<(), CliError> {
    if let Some(joint) = &arguments.joint {
        let expected = "none: a study of method \"respond\" names its joint files in [[lap]]";
        return Err(CliError::option("--joint", joint.display(), expected));
    }
    if let Some(step) = arguments.step {
        let expected = "none: a study of method \"respond\" has its frequencies in [frequency]";
        return Err(CliError::option("--step", step, expected));
    }
    if arguments.noise.is_some() {
        let expected = "nothing: noise is for the functions of an assembly";
        return Err(CliError::option("noise", "it", expected));
    }
    if !has_extension(output, "csv") {
        let expected = "a name that ends in .csv";
        return Err(CliError::option("--output", output.display(), expected));
    }
    check_output(output, &[&arguments.study])?;
    let picture = Picture::asked(arguments)?;
    let text = study;
    let study = RespondStudy::of(text)?;
    let progress = Progress::of_share("responding");
    let table = study.run(&|share| progress.reached(share))?;
    drop(progress);
    let warnings = study.warnings(&table);
    let drawing = Picture::drawn(picture, &study.name, text.text(), &warnings, || {
        study.figure(&table)
    })?;
    write_file(output, table.to_csv().as_bytes())?;
    if let Some((path, drawing)) = &drawing {
        write_file(path, drawing.as_bytes())?;
    }
    let rows: usize = table.series.iter().map(|series| series.rows.len()).sum();
    warn(&warnings);
    if arguments.json {
        let value = json!({
            "output": output.display().to_string(),
            "report": arguments.report.as_ref().map(|path| path.display().to_string()),
            "series": summary(&table),
            "warnings": warnings,
        });
        print(&serde_json::to_string_pretty(&value)?)?;
        return judged(&study);
    }
    print(&format!(
        "{}: {} series, {rows} rows\n{}{}",
        study.name,
        table.series.len(),
        Wrote(output),
        also(&[arguments.report.as_ref()])
    ))?;
    judged(&study)
}

/// Says of joints that are not to be relied on that they are not.
fn judged(study: &RespondStudy) -> Result<(), CliError> {
    let mut laps = study.laps.iter();
    laps.try_for_each(|lap| CliError::unless_usable(&lap.path, lap.file.reasons_against()))
}

fn summary(table: &ResponseTable) -> Vec<serde_json::Value> {
    let of = |series: &bolted_joint::respond::Series| {
        json!({
            "lap": series.lap,
            "level": series.level,
            "rows": series.rows.len(),
            "largest_relative_displacement": series.largest,
        })
    };
    table.series.iter().map(of).collect()
}
