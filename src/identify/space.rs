//! `identify` with method `frf-space`: the joint in space from functions near its interface.

use std::fmt::Write as _;

use serde_json::json;

use bolted_joint::identify::space::{
    Misfit, SpatialIdentification, SpatialStudy, Unknown, joints_sought,
};
use bolted_joint::study::StudyText;

use super::super::error::CliError;
use super::super::output::{Outputs, check_output, print, warn};
use super::super::table::{Table, number};
use super::{IdentifyArguments, chain};

pub(super) fn run(arguments: &IdentifyArguments, study: &StudyText) -> Result<(), CliError> {
    for (option, is_given) in [
        ("--report", arguments.report.is_some()),
        ("--figure", arguments.figure.is_some()),
        ("--bootstrap", arguments.bootstrap.is_some()),
        ("--no-rivals", arguments.no_rivals),
    ] {
        if is_given {
            let expected = "a study of method \"frf-decoupling\"; of a joint in space, take --json";
            return Err(CliError::option(option, "it", expected));
        }
    }
    if joints_sought(study)? != 1 {
        return chain::run(arguments, study);
    }
    let study = SpatialStudy::of(study)?;
    check_output(&arguments.output, &[&arguments.study])?;
    let misfits = study.misfits()?;
    warn(&misfits.iter().map(Misfit::to_string).collect::<Vec<_>>());
    let found = study.identify()?;
    let file = found.joint_file(&study);
    let text = file.to_json()?;
    let mut outputs = Outputs::new();
    outputs.add(Some(&arguments.output), || text);
    outputs.write()?;
    if arguments.json {
        print(&serde_json::to_string_pretty(&as_json(
            &found, &file, &misfits, arguments,
        ))?)?;
    } else {
        print(&(summary(&study, &found) + &outputs.written()))?;
    }
    CliError::unless_usable(&arguments.output, &found.reasons_against)
}

fn as_json(
    found: &SpatialIdentification,
    file: &bolted_joint::joint::JointFile,
    misfits: &[Misfit],
    arguments: &IdentifyArguments,
) -> serde_json::Value {
    json!({
        "output": arguments.output.display().to_string(),
        "joint_file": file,
        "unknowns": found.unknowns.iter().map(unknown_json).collect::<Vec<_>>(),
        "functions": found.functions,
        "lines": found.lines,
        "relative_rms": found.relative_rms,
        "reduced_chi_squared": found.reduced_chi_squared,
        "starts": { "tried": found.starts[0], "agreeing": found.starts[1] },
        "budget_used": found.budget_used,
        "budget": found.groups.iter().map(|group| json!({ "group": group.name, "largest_share": group.largest_share })).collect::<Vec<_>>(),
        "misfits": misfits.iter().map(|misfit| json!({
            "key": misfit.key,
            "dofs": misfit.dofs.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "ratio": misfit.ratio,
            "text": misfit.to_string(),
        })).collect::<Vec<_>>(),
        "usable": found.reasons_against.is_empty(),
        "reasons_against": found.reasons_against,
    })
}

/// One number of a joint.
pub(super) fn unknown_json(unknown: &Unknown) -> serde_json::Value {
    json!({
        "name": unknown.name,
        "value": unknown.value,
        "free": unknown.free,
        "standard_deviation": unknown.deviation,
        "by_noise_alone": unknown.deviation_by_noise,
        "interval_95": unknown.interval_95(),
        "is_determined": unknown.is_determined,
    })
}

/// The result for people.
fn summary(study: &SpatialStudy, found: &SpatialIdentification) -> String {
    let mut text = format!(
        "{}\njoint in space, model {}, from {} functions of the assembly at {} lines\n",
        study.name, study.model, found.functions, found.lines
    );
    let mut table = Table::new(&[
        "",
        "identified",
        "± std. dev.",
        "of noise alone",
        "95 % interval",
        "",
    ]);
    for unknown in &found.unknowns {
        let [low, high] = unknown.interval_95();
        table.row(vec![
            unknown.name.clone(),
            number(unknown.value, 5),
            number(unknown.deviation, 2),
            number(unknown.deviation_by_noise, 2),
            format!("{} … {}", number(low, 4), number(high, 4)),
            match unknown.is_determined {
                true => String::new(),
                false => "not determined".to_owned(),
            },
        ]);
    }
    text += &table.render();
    let _ = writeln!(
        text,
        "residual {} % of the functions; {} of {} starts came to the same minimum",
        number(100.0 * found.relative_rms, 3),
        found.starts[1],
        found.starts[0]
    );
    if found.free.is_some() {
        text += "the passive joint that is nearest to the free estimate, which would feed energy; the intervals are about that one\n";
    }
    if let Some(chi) = found.reduced_chi_squared {
        let _ = writeln!(text, "χ² over degrees of freedom {}", number(chi, 3));
    }
    if let Some(used) = found.budget_used {
        let _ = writeln!(
            text,
            "errors of the set-up that were found: {} of what the budget says, r.m.s.",
            number(used.sqrt(), 2)
        );
    }
    for group in &found.groups {
        let _ = writeln!(
            text,
            "errors of the {} make up to {} % of a variance",
            group.name,
            number(100.0 * group.largest_share, 2)
        );
    }
    text
}
