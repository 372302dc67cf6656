//! `identify` with method `lap-response`: the lap model from responses at several levels.

use std::fmt::Write as _;

use serde_json::json;

use super::super::super::error::CliError;
use super::super::super::output::{Outputs, print, warn};
use super::super::super::progress::{Progress, watched};
use super::super::super::table::{Table, number};
use super::super::IdentifyArguments;
use super::report_time;
use bolted_joint::identify::lap::{Fit, LapResponse, LapResponseStudy, ModelComparison};
use bolted_joint::report::{LapResponseReport, level_figure};
use bolted_joint::study::StudyText;

pub(in super::super) fn run(
    arguments: &IdentifyArguments,
    study: &StudyText,
) -> Result<(), CliError> {
    let written = report_time(
        arguments,
        "`compare = false` beside `terms` in the study's [model], which leaves the comparison of models out; rivals are those of method \
         \"frf-decoupling\"",
    )?;
    let study = watched("reading", || LapResponseStudy::of(study))?;
    let progress = Progress::new("identifying", 0);
    let found = LapResponse::of(&study, &progress)?;
    drop(progress);
    let file = found.joint_file(&study);
    let against = file.reasons_against();
    let mut warnings = found.warnings(&study);
    for matrix in file.passivity().active() {
        warnings.push(format!(
            "{matrix}: the identified joint is active; a simulation with it can blow up, so `export` refuses it"
        ));
    }
    let text = file.to_json()?;
    let mut files = Outputs::new();
    files.add(Some(&arguments.output), || text);
    files.add(arguments.figure.as_ref(), || {
        level_figure(&study, &found).unwrap_or_default()
    });
    if let Some(written) = written {
        let against = against.iter();
        let against = against.map(|reason| format!("not to be relied on: {reason}"));
        let all: Vec<String> = against.chain(warnings.iter().cloned()).collect();
        let page = LapResponseReport {
            study: &study,
            found: &found,
            warnings: &all,
            written,
        };
        files.add(arguments.report.as_ref(), || page.to_html());
    }
    files.write()?;
    warn(&warnings);
    if arguments.json {
        let value = json!({
            "output": arguments.output.display().to_string(),
            "joint_file": file,
            "estimates": found.estimates.iter().map(|estimate| json!({
                "unknown": estimate.unknown.symbol(),
                "value": estimate.value,
                "free": estimate.free_value,
                "standard_deviation": estimate.standard_deviation,
                "interval_95": estimate.interval_95,
                "identified": estimate.is_identified,
                "unit": estimate.unknown.unit(),
            })).collect::<Vec<_>>(),
            "passive": {
                "reduced_chi_squared": found.fit.reduced_chi_squared(),
                "held": found.fit.at_limits.iter().map(|at| at.limit).collect::<Vec<_>>(),
                "free_reduced_chi_squared": found.free.as_ref().map(Fit::reduced_chi_squared),
                "price": found.price,
            },
            "of_decays": found.of_decays(),
            "starts": { "tried": found.starts.0, "agreeing": found.starts.1 },
            "models": found.comparison,
            "predictions": found.predictions,
            "unpredicted": found.unpredicted,
            "backbones": found.backbones,
            "curve": found.curve,
            "between_runs": found.between_runs,
            "usable": against.is_empty(),
            "reasons_against": against,
            "warnings": warnings,
        });
        print(&serde_json::to_string_pretty(&value)?)?;
    } else {
        print(&(summary(&found, &study) + &files.written()))?;
    }
    CliError::unless_usable(&arguments.output, against)
}

/// What is to be said of a model beside its numbers.
fn note(model: &ModelComparison) -> String {
    let held: Vec<String> = model.held.iter().map(ToString::to_string).collect();
    if held.is_empty() {
        return String::new();
    }
    let price = format!("; free −2 ln L {:.1} lower", model.price);
    let price = if model.is_passive { "" } else { &price };
    format!("{} held at zero{price}", held.join(" and "))
}

fn summary(found: &LapResponse, study: &LapResponseStudy) -> String {
    let mut text = format!(
        "{}\nterms that depend on amplitude: {}\n\n",
        found.name, found.model.terms
    );
    let mut header = vec!["", "identified", "± std. dev.", "95 % interval", "unit"];
    if found.free.is_some() {
        header.push("free estimate");
    }
    let mut table = Table::new(&header);
    for estimate in &found.estimates {
        let [low, high] = estimate.interval_95;
        let mut cells = vec![estimate.unknown.symbol().to_owned()];
        if estimate.is_identified {
            cells.extend([
                number(estimate.value, 5),
                number(estimate.standard_deviation, 2),
                format!("{} … {}", number(low, 5), number(high, 5)),
            ]);
        } else {
            cells.extend(["not identified", "", ""].map(str::to_owned));
        }
        cells.push(estimate.unknown.unit().into_owned());
        if found.free.is_some() {
            cells.push(number(estimate.free_value, 5));
        }
        table.row(cells);
    }
    text += &table.render();
    if let Some(free) = &found.free {
        let _ = writeln!(
            text,
            "\nThe free estimate is active: χ² per degree of freedom {}, −2 ln L {:.1} lower. \"identified\" is the passive joint that \
             fits best, and is what the file holds; the intervals are about the free one, and reach to it.",
            number(free.reduced_chi_squared(), 4),
            found.price
        );
    }
    let reduced = found.fit.reduced_chi_squared();
    let noise: Vec<String> = study
        .noise_by_kind()
        .into_iter()
        .map(|(kind, part)| format!("{} % ({kind})", number(100.0 * part, 2)))
        .collect();
    let of = match noise.is_empty() {
        true => String::new(),
        false => format!(" of {}", noise.join(", ")),
    };
    let _ = writeln!(
        text,
        "\nχ² per degree of freedom {} with noise{of} ({}); {} of {} starts agree",
        number(reduced, 4),
        study.noise_is().words(),
        found.starts.1,
        found.starts.0
    );
    if let Some(of_decays) = found.of_decays() {
        let _ = writeln!(text, "{of_decays}");
    }
    text += "\nmodels by likelihood\n";
    let mut table = Table::new(&["terms", "unknowns", "χ²/ν", "BIC", ""]);
    for model in &found.comparison {
        table.row(vec![
            model.terms.to_string(),
            model.unknowns.to_string(),
            number(model.reduced_chi_squared, 4),
            format!("{:.1}", model.bic_difference),
            note(model),
        ]);
    }
    text += &table.render();
    if !found.predictions.is_empty() {
        text += "\nphase resonance at the measured force\n";
        let mut table = Table::new(&[
            "run",
            "",
            "force, N",
            "measured, Hz",
            "model",
            "expected, 95 %",
            "error, Hz",
            "measured, mm",
            "model",
            "expected, 95 %",
            "error",
        ]);
        for row in &found.predictions {
            let (predicted, expected) = (row.predicted, row.interval_95);
            let optional = |value: Option<String>| value.unwrap_or_else(|| "none".to_owned());
            table.row(vec![
                found.named(row),
                if row.left_out { "left out" } else { "fitted" }.to_owned(),
                number(row.measured.force_n, 3),
                format!("{:.3}", row.measured.frequency_hz),
                optional(predicted.map(|at| format!("{:.3}", at.frequency_hz))),
                optional(expected.map(|at| {
                    let [low, high] = at.frequency_hz;
                    format!("{low:.3} … {high:.3}")
                })),
                optional(row.frequency_error_hz().map(|error| format!("{error:+.3}"))),
                number(1e3 * row.measured.displacement_m, 4),
                optional(predicted.map(|at| number(1e3 * at.displacement_m, 4))),
                optional(expected.map(|at| {
                    let [low, high] = at.displacement_m.map(|m| number(1e3 * m, 3));
                    format!("{low} … {high}")
                })),
                optional(
                    row.amplitude_error()
                        .map(|error| format!("{:+.1} %", 100.0 * error)),
                ),
            ]);
        }
        text += &table.render();
    }
    for reason in found.without_interval() {
        let _ = writeln!(text, "{reason}");
    }
    if !found.backbones.is_empty() {
        text += &beside_backbones(found);
    }
    text.push('\n');
    text
}

/// Backbones and decays beside the model.
fn beside_backbones(found: &LapResponse) -> String {
    let mut table = Table::new(&[
        "run",
        "",
        "frequency, Hz",
        "damping ratio",
        "within 95 %",
        "falls in, s",
        "model",
        "expected, 95 %",
    ]);
    for row in &found.backbones {
        let (all, outside) = row.outside();
        let within = match all {
            0 => String::new(),
            _ => format!("{} of {all}", all - outside),
        };
        let mut cells = vec![
            row.run.clone(),
            if row.left_out { "left out" } else { "fitted" }.to_owned(),
            number(row.frequency_error_hz, 2),
            row.damping_error
                .map_or_else(String::new, |error| format!("{:.1} %", 100.0 * error)),
            within,
        ];
        if let Some(fall) = &row.fall {
            let own = fall.duration_s;
            let expected = own.interval_95.map(|ends| ends.map(|end| number(end, 4)));
            cells.extend([
                number(own.measured, 4),
                number(own.predicted, 4),
                expected.map_or_else(String::new, |[low, high]| format!("{low} … {high}")),
            ]);
        } else {
            cells.extend(["", "", ""].map(str::to_owned));
        }
        table.row(cells);
    }
    let between = found.between_runs.as_ref();
    let between = between.map_or_else(String::new, |own| format!("{}\n", own.words()));
    format!(
        "\nbackbones and decays beside the model, root mean square\n{}{between}",
        table.render()
    )
}
