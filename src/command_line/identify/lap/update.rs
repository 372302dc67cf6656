//! `identify` with method `lap-update`: the lap model from natural frequencies.

use std::fmt::Write as _;

use serde_json::json;

use super::super::super::error::CliError;
use super::super::super::output::{Outputs, check_output, print, warn};
use super::super::super::progress::Progress;
use super::super::super::table::{Table, number};
use super::super::IdentifyArguments;
use super::{at_torques, report_time};
use bolted_joint::identify::lap::{LapParameter, LapUpdate, LapUpdateStudy, TorqueUpdate};
use bolted_joint::report::{LapUpdateReport, convergence_figure};
use bolted_joint::study::StudyText;

pub(in super::super) fn run(
    arguments: &IdentifyArguments,
    study: &StudyText,
) -> Result<(), CliError> {
    let written = report_time(
        arguments,
        "a study of method \"frf-decoupling\"; a lap from frequencies has no rivals",
    )?;
    let study = LapUpdateStudy::of(study)?;
    let progress = Progress::new("updating", study.torques.len() * study.firefly.iterations);
    let found = LapUpdate::of(&study, &progress)?;
    drop(progress);
    let joint_files = found.joint_files();
    let torques: Vec<Option<f64>> = joint_files.iter().map(|(torque, _)| *torque).collect();
    let outputs = at_torques(&arguments.output, &torques);
    for output in &outputs {
        check_output(output, &[&arguments.study])?;
    }
    let warnings = found.warnings();
    let against = found.reasons_against();
    let mut files = Outputs::new();
    for (output, (_, file)) in outputs.iter().zip(&joint_files) {
        let text = file.to_json()?;
        files.add(Some(output), || text);
    }
    files.add(arguments.figure.as_ref(), || {
        convergence_figure(&found).unwrap_or_default()
    });
    if let Some(written) = written {
        let reasons = against.iter();
        let reasons = reasons.map(|reason| format!("not to be relied on: {reason}"));
        let all: Vec<String> = reasons.chain(warnings.iter().cloned()).collect();
        let page = LapUpdateReport {
            found: &found,
            warnings: &all,
            written,
        };
        files.add(arguments.report.as_ref(), || page.to_html());
    }
    files.write()?;
    warn(&warnings);
    if arguments.json {
        print(&serde_json::to_string_pretty(&as_json(&found, &outputs))?)?;
    } else {
        print(&(summary(&found) + &files.written()))?;
    }
    CliError::unless_usable(&arguments.output, &against)
}

fn as_json(found: &LapUpdate, outputs: &[std::path::PathBuf]) -> serde_json::Value {
    let torques: Vec<_> = found
        .torques
        .iter()
        .map(|torque| {
            let parameters: serde_json::Map<_, _> = LapParameter::ALL
                .into_iter()
                .map(|parameter| {
                    let value = json!({
                        "value": torque.solution.of(parameter),
                        "firefly": torque.firefly.parameters.of(parameter),
                        "unit": parameter.unit(),
                        "knowledge": torque.knowledge(parameter).words(),
                    });
                    (parameter.symbol().to_owned(), value)
                })
                .collect();
            json!({
                "torque_n_m": torque.data.torque_n_m,
                "measured_rad_per_s": torque.data.omega_rad_per_s,
                "updated_rad_per_s": torque.frequencies(&torque.solution),
                "objective": torque.objective,
                "firefly_objective": torque.firefly.objective,
                "history": torque.firefly.history,
                "parameters": parameters,
                "not_identified": torque.not_identified(),
                "determined": torque.identifiability.combinations.iter().map(|combination| json!({
                    "formula": combination.formula,
                    "value_per_s2": combination.value,
                    "standard_deviation": combination.standard_deviation,
                })).collect::<Vec<_>>(),
            })
        })
        .collect();
    json!({
        "outputs": outputs.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
        "torques": torques,
        "usable": found.reasons_against().is_empty(),
        "reasons_against": found.reasons_against(),
        "warnings": found.warnings(),
    })
}

/// The result for people.
fn summary(found: &LapUpdate) -> String {
    let mut text = format!("{}\n", found.name);
    for torque in &found.torques {
        if let Some(torque) = torque.data.torque_n_m {
            let _ = write!(text, "\nat {torque} N·m");
        }
        text.push('\n');
        text += &parameters(torque);
        text.push('\n');
        text += &frequencies(torque);
        text += &combinations(torque);
    }
    text.push('\n');
    text
}

fn parameters(torque: &TorqueUpdate) -> String {
    let mut table = Table::new(&[
        "",
        "least squares",
        "fireflies",
        "unit",
        "what the frequencies say",
    ]);
    for parameter in LapParameter::ALL {
        let knowledge = torque.knowledge(parameter);
        // In brackets: no result, but one of many values.
        let shown = |value: f64| match knowledge.is_known() {
            true => number(value, 5),
            false => format!("({})", number(value, 5)),
        };
        table.row(vec![
            parameter.symbol().to_owned(),
            shown(torque.solution.of(parameter)),
            shown(torque.firefly.parameters.of(parameter)),
            parameter.unit().to_owned(),
            knowledge.words().to_owned(),
        ]);
    }
    table.render()
}

fn frequencies(torque: &TorqueUpdate) -> String {
    let mut table = Table::new(&[
        "ω, rad/s",
        "measured",
        "least squares",
        "error",
        "fireflies",
        "error",
    ]);
    let updated = torque.frequencies(&torque.solution);
    let firefly = torque.frequencies(&torque.firefly.parameters);
    for (mode, measured) in torque.data.omega_rad_per_s.iter().enumerate() {
        let error = |value: f64| format!("{:+.2} %", 100.0 * (value / measured - 1.0));
        table.row(vec![
            format!("ω{}", mode + 1),
            number(*measured, 5),
            number(updated[mode], 5),
            error(updated[mode]),
            number(firefly[mode], 5),
            error(firefly[mode]),
        ]);
    }
    table.render()
}

fn combinations(torque: &TorqueUpdate) -> String {
    let mut text = "  determined by the frequencies:".to_owned();
    for combination in &torque.identifiability.combinations {
        let spread = combination
            .standard_deviation
            .map(|deviation| format!(" ± {}", number(deviation, 2)))
            .unwrap_or_default();
        let _ = write!(
            text,
            "  {} = {}{spread} 1/s²",
            combination.formula,
            number(combination.value, 5)
        );
    }
    let open = torque.not_identified().join(", ");
    let _ = writeln!(text, "\n  not identified: {open}");
    text
}
