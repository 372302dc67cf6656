//! The measured files: how they are written, and by whose word their values are what they were taken for.

use super::{IdentificationReport, counted};
use bolted_joint_figures::html::{cell, escaped, number, percent, table};
use bolted_joint_frf::{FileSummary, StatedBy, UnitStatement};

/// A table with a row for each file of functions; nothing where there is none.
pub(super) fn section(report: &IdentificationReport<'_>) -> String {
    let rows: Vec<String> = report.found.files.iter().map(row).collect();
    if rows.is_empty() {
        return String::new();
    }
    let headings = [
        "File",
        "Format",
        "Functions used",
        "Quantity",
        "Units",
        "Coherence",
    ];
    format!(
        "<h3>Measured files</h3>\n{}<p class=\"faint\">In brackets: who says so. What the study states takes the place of what the \
         file states.</p>\n",
        table(&headings, &rows)
    )
}

fn row(file: &FileSummary) -> String {
    let name = file.path.file_name().unwrap_or(file.path.as_os_str());
    let functions = match file.left_out {
        0 => file.functions.to_string(),
        left_out => format!("{} of {}", file.functions, file.functions + left_out),
    };
    let quantities = file
        .quantities
        .iter()
        .map(|(quantity, by)| format!("{quantity} ({})", who(*by)));
    [
        format!("<code>{}</code>", escaped(&name.to_string_lossy())),
        joined(file.formats.iter().map(|format| format.to_string())),
        functions,
        joined(quantities),
        joined(file.units.iter().map(units)),
        coherence(file),
    ]
    .iter()
    .map(|html| cell(html))
    .collect()
}

fn joined(parts: impl Iterator<Item = String>) -> String {
    parts.collect::<Vec<_>>().join("; ")
}

fn who(by: StatedBy) -> &'static str {
    match by {
        StatedBy::File => "file",
        StatedBy::Caller => "study",
    }
}

fn units(statement: &UnitStatement) -> String {
    match statement {
        UnitStatement::Label(label) => format!("{} (file)", escaped(label)),
        UnitStatement::Dataset164(units) => format!("{} (file, data set 164)", units),
        UnitStatement::Caller(units) => format!("{} (study)", units),
        UnitStatement::Assumed => "SI (assumed: nobody states them)".to_owned(),
    }
}

fn coherence(file: &FileSummary) -> String {
    match (file.coherences, file.averages) {
        (0, _) => "none".to_owned(),
        (count, Some((averages, by))) => {
            let noise = file.coherence_noise.map(|[lowest, median, highest]| {
                format!(
                    "; <i>σ</i>/|<i>H</i>| from {} to {}, median {}",
                    percent(lowest),
                    percent(highest),
                    percent(median)
                )
            });
            format!(
                "{}; {} averages ({}){}",
                counted(count, "function"),
                number(averages),
                who(by),
                noise.unwrap_or_default()
            )
        }
        (count, None) => format!(
            "{}, not used: nobody states the averages",
            counted(count, "function")
        ),
    }
}
