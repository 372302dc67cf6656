//! `identify` with method `frf-space` where several joints of a chain are sought.

use std::fmt::Write as _;
use std::path::PathBuf;

use serde_json::json;

use bolted_joint::identify::space::{Apart, ChainIdentification, ChainStudy, FoundJoint};
use bolted_joint::study::StudyText;

use super::super::bolt_files::named;
use super::super::error::CliError;
use super::super::output::{Outputs, check_output, print, warn};
use super::super::progress::watched;
use super::super::table::{Table, number};
use super::IdentifyArguments;

pub(super) fn run(arguments: &IdentifyArguments, study: &StudyText) -> Result<(), CliError> {
    let study = watched("reading", || ChainStudy::of_measured(study))?;
    check_output(&arguments.output, &[&arguments.study])?;
    let found = watched("identifying", || study.identify())?;
    warn(&found.warnings);
    let files: Vec<(PathBuf, _)> = found
        .joints
        .iter()
        .map(|joint| {
            let path = named(&arguments.output, &joint.number.to_string());
            (path, joint.joint_file(&study, &found))
        })
        .collect();
    let mut outputs = Outputs::new();
    for (path, file) in &files {
        check_output(path, &[&arguments.study])?;
        let text = file.to_json()?;
        outputs.add(Some(path), || text);
    }
    outputs.write()?;
    if arguments.json {
        let joints: Vec<_> = found
            .joints
            .iter()
            .zip(&files)
            .map(|(joint, (path, file))| {
                json!({
                    "joint": joint.key,
                    "output": path.display().to_string(),
                    "joint_file": file,
                    "unknowns": joint.unknowns.iter().map(super::space::unknown_json).collect::<Vec<_>>(),
                })
            })
            .collect();
        let value = json!({
            "joints": joints,
            "told_apart": found.apart.iter().map(apart_json).collect::<Vec<_>>(),
            "functions": found.functions,
            "lines": found.lines,
            "relative_rms": found.relative_rms,
            "reduced_chi_squared": found.reduced_chi_squared,
            "starts": { "tried": found.starts[0], "agreeing": found.starts[1] },
            "usable": found.reasons_against.is_empty(),
            "reasons_against": found.reasons_against,
            "warnings": found.warnings,
        });
        print(&serde_json::to_string_pretty(&value)?)?;
    } else {
        print(&(summary(&study, &found) + &outputs.written()))?;
    }
    CliError::unless_usable(&files[0].0, &found.reasons_against)
}

/// What the functions say of two joints together.
pub(in super::super) fn apart_json(pair: &Apart) -> serde_json::Value {
    // infinite where they are not told apart
    let finite = |growth: [f64; 2]| growth.map(|growth| growth.is_finite().then_some(growth));
    json!({
        "joints": pair.joints,
        "told": pair.told.is_told(),
        "canonical_correlation": pair.told.correlation,
        "apart": pair.told.apart,
        "median_growth": finite(pair.told.median_growth()),
        "largest_growth": finite(pair.told.largest_growth()),
    })
}

/// The same for people.
pub(in super::super) fn apart_text(pairs: &[Apart]) -> String {
    let mut text = String::new();
    for Apart { joints, told } in pairs {
        let [one, other] = joints;
        let _ = match told.is_told() {
            true => {
                let growth = told.median_growth().into_iter().fold(0.0, f64::max);
                let largest = told.largest_growth().into_iter().fold(0.0, f64::max);
                writeln!(
                    text,
                    "{one} and {other}: since both are sought, deviations are {} times as large in the median, at most {}",
                    number(growth, 3),
                    number(largest, 3)
                )
            }
            false => writeln!(text, "{one} and {other} are not told apart"),
        };
    }
    text
}

fn summary(study: &ChainStudy, found: &ChainIdentification) -> String {
    let mut text = format!(
        "{}\n{} joints in space, from {} functions of the assembly at {} lines\n",
        study.name,
        found.joints.len(),
        found.functions,
        found.lines
    );
    for joint in &found.joints {
        text += &table(joint);
    }
    text += &apart_text(&found.apart);
    let _ = writeln!(
        text,
        "residual {} % of the functions; {} of {} searches came to the same minimum",
        number(100.0 * found.relative_rms, 3),
        found.starts[1],
        found.starts[0]
    );
    if let Some(chi) = found.reduced_chi_squared {
        let _ = writeln!(text, "χ² over degrees of freedom {}", number(chi, 3));
    }
    text
}

fn table(joint: &FoundJoint) -> String {
    let mut table = Table::new(&[&joint.key, "identified", "± std. dev.", "95 % interval", ""]);
    for unknown in &joint.unknowns {
        let [low, high] = unknown.interval_95();
        table.row(vec![
            unknown.name.clone(),
            number(unknown.value, 5),
            number(unknown.deviation, 2),
            format!("{} … {}", number(low, 4), number(high, 4)),
            match unknown.is_determined {
                true => String::new(),
                false => "not determined".to_owned(),
            },
        ]);
    }
    table.render()
}
