//! `respond --plan`: what a test will tell of its joints, before it is made.

use std::fmt::Write as _;

use serde_json::json;

use bolted_joint::identify::space::{Addition, Aim, ChainStudy, Plan, Planned};
use bolted_joint::study::{Method, StudyText};

use super::super::error::CliError;
use super::super::identify::chain::{apart_json, apart_text};
use super::super::output::{CSV, Wrote, check_outputs, print, warn, write_file};
use super::super::progress::watched;
use super::super::table::{Table, number};
use super::RespondArguments;

/// Candidates that are shown beside the best one.
const SHOWN: usize = 5;

pub(super) fn run(arguments: &RespondArguments, study: &StudyText) -> Result<(), CliError> {
    let method = study.method()?;
    if method == Method::FrfDecoupling {
        let expected = "a study of method \"frf-space\": a test in a plane is not planned yet";
        return Err(CliError::option(
            "--plan",
            format_args!("method \"{method}\""),
            expected,
        ));
    }
    study.check_method(method, &[Method::FrfSpace])?;
    let without = [
        ("--joint", arguments.joint.is_some()),
        ("--report", arguments.report.is_some()),
        ("--deviations", arguments.deviations.is_some()),
        ("noise", arguments.noise.is_some()),
    ];
    for (option, is_given) in without {
        if is_given {
            let expected =
                "none beside --plan: the study has the joint (joint.expected) and the noise";
            return Err(CliError::option(option, "it", expected));
        }
    }
    let output = arguments.output.as_ref();
    check_outputs(&arguments.study, &[("--output", output, CSV)])?;
    let aim = match arguments.wanted.as_slice() {
        [] => Aim::All,
        names => Aim::Numbers(names.to_vec()),
    };
    let study = watched("reading", || ChainStudy::of(study, arguments.step))?;
    let additions = arguments.add.unwrap_or(1);
    let plan = watched("planning", || study.plan(&aim, additions))?;
    if let Some(path) = output {
        write_file(path, csv(&plan).as_bytes())?;
    }
    warn(&plan.warnings);
    if arguments.json {
        return print(&serde_json::to_string_pretty(&as_json(&plan, arguments))?);
    }
    let mut text = summary(&study, &plan, &aim);
    if let Some(path) = output {
        let _ = writeln!(text, "{}", Wrote(path));
    }
    print(&text)
}

fn as_json(plan: &Plan, arguments: &RespondArguments) -> serde_json::Value {
    let unknown = |one: &Planned| {
        json!({
            "joint": one.joint,
            "name": one.name,
            "value": one.value,
            "size": one.size,
            "standard_deviation": one.deviation,
            "by_noise_alone": one.deviation_by_noise,
            "is_determined": one.is_determined,
            "reason": one.reason.as_ref().map(ToString::to_string),
            "budget": one.largest_group.as_ref().map(|(group, share)| json!({ "group": group, "share": share })),
        })
    };
    let addition = |one: &Addition| json!({ "what": one.what, "gain": one.gain });
    json!({
        "output": arguments.output.as_ref().map(|path| path.display().to_string()),
        "functions": plan.functions,
        "lines": plan.lines,
        "unknowns": plan.unknowns.iter().map(unknown).collect::<Vec<_>>(),
        "told_apart": plan.apart.iter().map(apart_json).collect::<Vec<_>>(),
        "additions": plan.additions.iter().map(addition).collect::<Vec<_>>(),
        "ranking": plan.ranking.iter().map(addition).collect::<Vec<_>>(),
        "warnings": plan.warnings,
    })
}

/// A row for each unknown.
fn csv(plan: &Plan) -> String {
    let mut text =
        "joint,unknown,value,size,standard deviation,by noise alone,determined,reason\n".to_owned();
    for one in &plan.unknowns {
        let reason = one
            .reason
            .as_ref()
            .map(ToString::to_string)
            .unwrap_or_default();
        let _ = writeln!(
            text,
            "{},{},{:e},{:e},{:e},{:e},{},\"{}\"",
            one.joint,
            one.name,
            one.value,
            one.size,
            one.deviation,
            one.deviation_by_noise,
            one.is_determined,
            reason.replace('"', "\"\"")
        );
    }
    text
}

fn summary(study: &ChainStudy, plan: &Plan, aim: &Aim) -> String {
    let mut text = format!(
        "{}\nexpected of {} functions of the assembly at {} lines\n",
        study.name, plan.functions, plan.lines
    );
    let mut joint = "";
    let mut table = Table::new(&[]);
    for one in &plan.unknowns {
        if one.joint != joint {
            text += &table.render();
            joint = &one.joint;
            table = Table::new(&[
                joint,
                "taken to be",
                "± std. dev.",
                "of noise alone",
                "relative",
                "",
            ]);
        }
        let percent = format!("{} %", number(100.0 * one.deviation / one.size, 2));
        let row = match &one.reason {
            None => vec![
                one.name.clone(),
                number(one.value, 4),
                number(one.deviation, 2),
                number(one.deviation_by_noise, 2),
                percent,
                String::new(),
            ],
            Some(_) => vec![
                one.name.clone(),
                number(one.value, 4),
                "–".to_owned(),
                "–".to_owned(),
                "–".to_owned(),
                "not determined".to_owned(),
            ],
        };
        table.row(row);
    }
    text += &table.render();
    text += "relative to what couples the motions at most, √(k_ii k_jj)\n";
    let open: Vec<&Planned> = plan
        .unknowns
        .iter()
        .filter(|one| !one.is_determined)
        .collect();
    if open.is_empty() {
        text += "every number will be determined\n";
    } else {
        let _ = writeln!(
            text,
            "{} of {} numbers will not be determined:",
            open.len(),
            plan.unknowns.len()
        );
        let mut reasons: Vec<(String, Vec<&str>)> = Vec::new();
        for one in open {
            let reason = one
                .reason
                .as_ref()
                .map(ToString::to_string)
                .unwrap_or_default();
            match reasons.iter_mut().find(|(own, _)| *own == reason) {
                Some((_, names)) => names.push(&one.name),
                None => reasons.push((reason, vec![&one.name])),
            }
        }
        for (reason, names) in reasons {
            let _ = writeln!(text, "  {}: {reason}", names.join(", "));
        }
    }
    text += &apart_text(&plan.apart);
    for (step, addition) in plan.additions.iter().enumerate() {
        let _ = writeln!(
            text,
            "{} {} ({})",
            if step == 0 { "add next:" } else { "then:" },
            addition.what,
            gain(addition, aim)
        );
    }
    if plan.additions.is_empty() && plan.ranking.is_empty() {
        text += "nothing to add was stated, and nothing can be proposed: state [candidates], or the interface's node\n";
    }
    for addition in plan.ranking.iter().skip(1).take(SHOWN) {
        let _ = writeln!(text, "  or {} ({})", addition.what, gain(addition, aim));
    }
    text
}

fn gain(addition: &Addition, aim: &Aim) -> String {
    match aim {
        Aim::All => format!("ln det grows by {}", number(addition.gain, 3)),
        Aim::Numbers(_) => {
            format!(
                "their variances fall by {} %",
                number(100.0 * addition.gain, 2)
            )
        }
    }
}
