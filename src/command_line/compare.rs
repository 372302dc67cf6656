//! `compare`: joint files beside each other.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};

use bolted_joint::compare::{Comparison, Difference, Measured, UNLIKELY};
use bolted_joint::export::Timestamp;
use bolted_joint::joint::JointFile;
use bolted_joint::report::{comparison_figure, comparison_page};

use super::error::CliError;
use super::kind::expect_joint_file;
use super::output::{check_plot, has_extension, message, print, warn, write_file};
use super::table::{Table, number};

/// `compare`
#[derive(Debug, Args)]
pub(super) struct CompareArguments {
    /// Joint files, of which the others are compared with the first
    #[arg(required = true, num_args = 2..)]
    joint_files: Vec<PathBuf>,
    /// Preload at which joints over the preload are compared, N·m [default: at each preload of their tables]
    #[arg(long, value_name = "TORQUE", allow_hyphen_values = true)]
    preload: Option<f64>,
    /// Also draw the numbers with their intervals
    #[arg(long, value_name = "NAME.html|NAME.svg")]
    plot: Option<PathBuf>,
    /// Print the comparison as JSON
    #[arg(long)]
    json: bool,
}

/// A difference of so many standard deviations is rare by chance: one in 20.
const NOTABLE: f64 = 1.96;

pub(super) fn run(arguments: &CompareArguments) -> Result<(), CliError> {
    check_plot(arguments.plot.as_ref(), &arguments.joint_files)?;
    let mut joints = Vec::new();
    let mut any_is_over_preload = false;
    for path in &arguments.joint_files {
        expect_joint_file(path)?;
        let file = JointFile::read(path)?;
        any_is_over_preload |= file.joint.over_preload.is_some();
        let file = match (arguments.preload, &file.joint.over_preload) {
            (Some(preload), Some(_)) => {
                let at = file.at_preload(Some(preload));
                at.map_err(|source| CliError::Preload {
                    path: path.clone(),
                    source,
                })?
            }
            _ => file,
        };
        joints.push((path.display().to_string(), file));
    }
    if let Some(preload) = arguments.preload
        && !any_is_over_preload
    {
        let expected = "none: none of the joints depends on the preload";
        return Err(CliError::option("--preload", preload, expected));
    }
    let comparison = Comparison::of(&joints)?;
    if let Some(path) = &arguments.plot {
        let drawing = match has_extension(path, "svg") {
            true => comparison_figure(&comparison),
            false => comparison_page(&comparison, Timestamp::from_environment()?),
        };
        write_file(path, drawing.as_bytes())?;
    }
    if arguments.json {
        print(&serde_json::to_string_pretty(&as_json(&comparison))?)?;
    } else {
        let mut text = told(&comparison);
        if let Some(path) = &arguments.plot {
            let _ = writeln!(text, "wrote {}", path.display());
        }
        print(&text)?;
    }
    warn(&comparison.notes);
    let mut all = arguments.joint_files.iter().zip(&joints);
    all.try_for_each(|(path, (_, file))| CliError::unless_usable(path, file.reasons_against()))
}

fn told(comparison: &Comparison) -> String {
    let mut text = String::new();
    for (place, name) in comparison.names.iter().enumerate() {
        let _ = writeln!(text, "joint {}: {name}", place + 1);
    }
    let count = comparison.names.len();
    let header: Vec<String> = [String::new()]
        .into_iter()
        .chain((1..=count).map(|place| format!("joint {place}")))
        .chain(["unit".to_owned()])
        .chain((2..=count).flat_map(|place| [format!("{place} against 1"), "std. dev.".to_owned()]))
        .collect();
    let mut table = Table::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    let value = |own: &Measured| match own.deviation {
        Some(deviation) => format!("{} ± {}", number(own.value, 6), number(deviation, 2)),
        None => number(own.value, 6),
    };
    for row in &comparison.rows {
        let differences = row.differences.iter().flat_map(|own| match own {
            Some(own) => difference(*own),
            None => [String::new(), String::new()],
        });
        let cells = [row.name.clone()]
            .into_iter()
            .chain(row.values.iter().map(value))
            .chain([row.unit.clone()])
            .chain(differences);
        table.row(cells.collect());
    }
    text += &table.render();
    if let Some(why) = comparison.unknown_parts() {
        let _ = writeln!(text, "{why}");
    }
    for (place, own) in comparison.together.iter().enumerate() {
        if let Some(own) = own {
            let probability = match own.likely() {
                Some(known) => number(known, 2),
                None => format!("less than {UNLIKELY:e}"),
            };
            let _ = writeln!(
                text,
                "joint {} against joint 1, all {} unknowns together: χ² = {}, exceeded by chance with a probability of {probability}",
                place + 2,
                own.unknowns,
                number(own.chi_squared, 3),
            );
        }
    }
    let known = || {
        comparison
            .rows
            .iter()
            .flat_map(|row| &row.differences)
            .flatten()
    };
    let all: Vec<f64> = known().filter_map(|own| own.deviations).collect();
    if all.is_empty() {
        message(
            "note: without deviations in both files nothing tells whether a difference is real",
        );
    } else {
        let notable = all.iter().filter(|own| own.abs() > NOTABLE).count();
        let _ = writeln!(
            text,
            "{notable} of {} differences are beyond {NOTABLE} standard deviations, which chance does once in 20",
            all.len()
        );
    }
    text
}

/// A part of the first value, and standard deviations.
fn difference(own: Difference) -> [String; 2] {
    let deviations = |own: f64| match own.abs() {
        0.0..100.0 => format!("{own:+.1}"),
        _ if own > 0.0 => format!("+{}", number(own, 3)),
        _ => number(own, 3),
    };
    [
        own.relative
            .map_or_else(|| "–".to_owned(), |own| format!("{:+.2} %", 100.0 * own)),
        own.deviations.map_or_else(String::new, deviations),
    ]
}

fn as_json(comparison: &Comparison) -> Value {
    let rows = comparison.rows.iter().map(|row| {
        json!({
            "name": row.name,
            "unit": row.unit,
            "values": row.values.iter().map(|own| own.value).collect::<Vec<_>>(),
            "standard_deviations": row.values.iter().map(|own| own.deviation).collect::<Vec<_>>(),
            "relative_differences": row.differences.iter().map(|own| own.and_then(|own| own.relative)).collect::<Vec<_>>(),
            "deviations": row.differences.iter().map(|own| own.and_then(|own| own.deviations)).collect::<Vec<_>>(),
        })
    });
    let together = comparison.together.iter().map(|own| {
        own.map(|own| {
            json!({ "chi_squared": own.chi_squared, "unknowns": own.unknowns, "probability": own.probability })
        })
    });
    json!({
        "joints": comparison.names,
        "rows": rows.collect::<Vec<_>>(),
        "together": together.collect::<Vec<_>>(),
        "notes": comparison.notes,
    })
}
