//! `identify` with method `frf-space`: the joint in space from functions near its interface.

use std::fmt::Write as _;

use serde_json::json;

use bolted_joint::export::Timestamp;
use bolted_joint::identify::space::{
    Change, Level, Misfit, MisfitCause, Role, SetUpError, SideConsistency, SpatialIdentification,
    SpatialStudy, Unknown, joints_sought,
};
use bolted_joint::report::{SpatialReport, spatial_figure};
use bolted_joint::study::StudyText;

use super::super::error::CliError;
use super::super::output::{Outputs, check_output, print, warn};
use super::super::progress::watched;
use super::super::table::{Table, number};
use super::{IdentifyArguments, chain};

pub(super) fn run(arguments: &IdentifyArguments, study: &StudyText) -> Result<(), CliError> {
    for (option, is_given) in [
        ("--bootstrap", arguments.bootstrap.is_some()),
        ("--no-rivals", arguments.no_rivals),
    ] {
        if is_given {
            let expected = "a study of method \"frf-decoupling\"";
            return Err(CliError::option(option, "it", expected));
        }
    }
    let sought = joints_sought(study)?;
    if sought != 1 {
        for (option, is_given) in [
            ("--report", arguments.report.is_some()),
            ("--figure", arguments.figure.is_some()),
        ] {
            if is_given {
                let found = format_args!("it with {sought} joints that are sought").to_string();
                let expected = "a study that seeks one joint: of several there are joint files alone, which `bolted-joint show` and \
                                `bolted-joint compare` tell more of";
                return Err(CliError::option(option, found, expected));
            }
        }
        return chain::run(arguments, study);
    }
    let written = arguments.report.as_ref();
    let written = written.map(|_| Timestamp::from_environment()).transpose()?;
    let study = watched("reading", || SpatialStudy::of(study))?;
    check_output(&arguments.output, &[&arguments.study])?;
    let advice = study.advice();
    warn(&advice);
    let phases = watched("looking at phases", || study.phases())?;
    warn(&phases);
    let misfits = watched("looking at places", || study.misfits())?;
    warn(&misfits.iter().map(Misfit::to_string).collect::<Vec<_>>());
    let consistency = watched("looking at places", || study.consistency())?;
    let mut found = watched("identifying", || study.identify(&misfits))?;
    warn(&found.warnings);
    // told before the search; a report has them too
    found.warnings.extend(advice.into_iter().chain(phases));
    warn(not_determined(&found).as_slice());
    warn(found.overstated_noise(&study).as_slice());
    let file = found.joint_file(&study);
    let text = file.to_json()?;
    let mut outputs = Outputs::new();
    outputs.add(Some(&arguments.output), || text);
    outputs.add(arguments.figure.as_ref(), || spatial_figure(&study, &found));
    if let Some(written) = written {
        let report = SpatialReport {
            study: &study,
            found: &found,
            consistency: &consistency,
            misfits: &misfits,
            written,
        };
        outputs.add(arguments.report.as_ref(), || report.to_html());
    }
    outputs.write()?;
    if arguments.json {
        print(&serde_json::to_string_pretty(&as_json(
            &found,
            &file,
            &misfits,
            &consistency,
            arguments,
        ))?)?;
    } else {
        print(&(summary(&study, &found) + &of_consistency(&consistency) + &outputs.written()))?;
    }
    CliError::unless_usable(&arguments.output, &found.reasons_against)
}

/// Of a result that is to be relied on: numbers that it does not tell.
fn not_determined(found: &SpatialIdentification) -> Option<String> {
    let unknown = found.unknowns.iter().filter(|one| !one.is_determined);
    let names: Vec<&str> = unknown.map(|one| one.name.as_str()).collect();
    let is_told = found.reasons_against.is_empty() && !names.is_empty();
    is_told.then(|| {
        format!(
            "the functions do not determine {}: the intervals are as wide as the numbers; plan the test (`respond --plan`), or take a \
             model with fewer numbers",
            names.join(", ")
        )
    })
}

fn as_json(
    found: &SpatialIdentification,
    file: &bolted_joint::joint::JointFile,
    misfits: &[Misfit],
    consistency: &[SideConsistency],
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
            "ratio": match &misfit.cause {
                MisfitCause::Errs { ratio, .. } => Some(ratio),
                MisfitCause::Exchanged { .. } => None,
            },
            "exchanged_with": match &misfit.cause {
                MisfitCause::Errs { .. } => None,
                MisfitCause::Exchanged { key, dofs } => Some(json!({
                    "key": key,
                    "dofs": dofs.iter().map(ToString::to_string).collect::<Vec<_>>(),
                })),
            },
            "text": misfit.to_string(),
        })).collect::<Vec<_>>(),
        "consistency": consistency.iter().map(|one| json!({
            "side": one.side,
            "of": kind(one.role),
            "mean": one.mean(),
            "overall": one.overall,
            "specific": one.specific.iter().map(|(key, dof, own)| json!({
                "key": key,
                "dof": dof.to_string(),
                "coherence": own,
            })).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
        "substructures": found.substructures.as_ref().map(|own| json!({
            "lines_left_out": own.lines_left_out,
            "moves": own.moves,
        })),
        "errors": found.errors.iter().map(|error| json!({
            "key": error.key,
            "change": change(error.change),
            "value": error.value,
            "standard_deviation": error.deviation,
            "budget": error.expected,
            "pull": error.pull(),
        })).collect::<Vec<_>>(),
        "usable": found.reasons_against.is_empty(),
        "reasons_against": found.reasons_against,
        "warnings": found.warnings,
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
        "{}\njoint {}, model {}, from {} functions of the assembly at {} lines\n",
        study.name,
        study.whereabouts(),
        study.model,
        found.functions,
        found.lines
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
        "residual {} % of the functions; {} of {} searches came to the same minimum",
        number(100.0 * found.relative_rms, 3),
        found.starts[1],
        found.starts[0]
    );
    if found.free.is_some() {
        text += "the passive joint that is nearest to the free estimate, which would feed energy; the intervals are about that one\n";
    }
    if let Some(own) = &found.substructures {
        let _ = writeln!(
            text,
            "noise of the substructures moves the assembly's functions by {} % r.m.s.; {} lines left out where it moves them too far",
            number(100.0 * own.moves, 2),
            own.lines_left_out
        );
    }
    if let Some(chi) = found.reduced_chi_squared {
        let beside = match study.level {
            Level::OfCoherence => ", with the noise that coherence tells",
            Level::Relative(_) | Level::OfResiduals => "",
        };
        let _ = writeln!(
            text,
            "χ² over degrees of freedom {}{beside}",
            number(chi, 3)
        );
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
    text + &of_wholes(found)
}

/// By how much what may be off as a whole is off.
fn of_wholes(found: &SpatialIdentification) -> String {
    let wholes: Vec<&SetUpError> = found.errors.iter().filter(|own| own.is_whole).collect();
    let each = wholes.chunk_by(|one, other| one.key == other.key);
    let moved = |own: &&SetUpError| {
        let [value, deviation] = [own.value, own.deviation].map(|own| 1e3 * own);
        let unit = match own.change {
            Change::Pose(dof) if dof.is_rotation() => "mrad",
            _ => "mm",
        };
        format!("{} {value:.2} ± {deviation:.2} {unit}", change(own.change))
    };
    each.map(|errors| {
        let (told, others): (Vec<&SetUpError>, Vec<&SetUpError>) =
            errors.iter().copied().partition(|own| own.is_told());
        let told: Vec<String> = told.iter().map(moved).collect();
        let others: Vec<String> = others.iter().map(|own| change(own.change)).collect();
        let untold = match others.is_empty() {
            true => String::new(),
            false => format!("the functions do not tell {}", others.join(", ")),
        };
        let parts = [told.join(", "), untold];
        let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        format!("{}: {}\n", errors[0].key, parts.join("; "))
    })
    .collect()
}

/// How rigidly the interfaces moved.
fn of_consistency(consistency: &[SideConsistency]) -> String {
    let mut text = String::new();
    for one in consistency {
        let least = one.overall.iter().copied().fold(f64::INFINITY, f64::min);
        let _ = write!(
            text,
            "consistency of the {} of {}: {} overall, {} at the worst line",
            kind(one.role),
            one.side,
            number(one.mean(), 4),
            number(least, 3)
        );
        if let Some((key, dof, own)) = one.worst() {
            let _ = write!(text, "; least {} of {key} ({dof})", number(*own, 3));
        }
        text.push('\n');
    }
    text
}

fn kind(role: Role) -> &'static str {
    match role {
        Role::Channel => "sensors",
        Role::Impact => "impacts",
    }
}

/// A change as JSON has it: `x`, `ry`, `gain[0]`.
fn change(change: Change) -> String {
    match change {
        Change::Pose(dof) => dof.symbol().to_owned(),
        Change::Gain(channel) => format!("gain[{channel}]"),
    }
}
