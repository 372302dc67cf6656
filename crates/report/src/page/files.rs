//! The measured files: how they are written, and by whose word their values are what they were taken for.

use super::{IdentificationReport, counted};
use bolted_joint_figures::html::{cell, escaped, number, percent, table};
use bolted_joint_frf::{FileSummary, StatedBy, UnitStatement, UnitSystem};

/// Units of length and force that have a name, with how many make one SI unit.
const LENGTHS: [(&str, f64); 6] = [
    ("m", 1.0),
    ("cm", 1e2),
    ("mm", 1e3),
    ("µm", 1e6),
    ("in", 1.0 / 0.0254),
    ("ft", 1.0 / 0.3048),
];
const FORCES: [(&str, f64); 5] = [
    ("N", 1.0),
    ("mN", 1e3),
    ("kN", 1e-3),
    ("lbf", 1.0 / 4.448_221_615_260_5),
    ("kgf", 1.0 / 9.806_65),
];
/// Two factors are the same unit within this share; files often round theirs.
const SAME_UNIT: f64 = 1e-3;

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
        UnitStatement::Dataset164(units) => format!("{} (file, data set 164)", system(*units)),
        UnitStatement::Caller(units) => format!("{} (study)", system(*units)),
        UnitStatement::Assumed => "SI (assumed: nobody states them)".to_owned(),
    }
}

/// A length and a force by name, or by their factors.
fn system(units: UnitSystem) -> String {
    let named = |known: &[(&'static str, f64)], per_si: f64| {
        let found = known
            .iter()
            .find(|(_, factor)| (per_si / factor - 1.0).abs() < SAME_UNIT);
        found.map(|(name, _)| *name)
    };
    let (length, force) = (units.length_per_metre(), units.force_per_newton());
    let length = match named(&LENGTHS, length) {
        Some(name) => name.to_owned(),
        None => format!("{} to the metre", number(length)),
    };
    let force = match named(&FORCES, force) {
        Some(name) => name.to_owned(),
        None => format!("{} to the newton", number(force)),
    };
    format!("{length}, {force}")
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
