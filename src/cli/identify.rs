//! `identify`: a study becomes a joint file.

use std::fmt::Write as _;

use num_complex::Complex64;
use serde_json::json;

use crate::export::Timestamp;
use crate::identify::{
    Bootstrap, BootstrapResult, Identification, Study, Unknown, identify_and_draw,
};
use crate::report::{FrfFigure, FrfPanel, IdentificationReport};

use super::IdentifyArguments;
use super::error::CliError;
use super::output::{check_output, message, print, write_file};
use super::progress::Progress;
use super::table::{Table, number};

/// At most so many functions are drawn.
const PANELS: usize = 3;

pub(super) fn run(arguments: &IdentifyArguments) -> Result<(), CliError> {
    let named = [
        (
            "--figure",
            &arguments.figure,
            "svg",
            "a name that ends in .svg",
        ),
        (
            "--report",
            &arguments.report,
            "html",
            "a name that ends in .html",
        ),
    ];
    check_output(&arguments.output, &[&arguments.study])?;
    let mut taken = vec![&arguments.study, &arguments.output];
    for (option, path, expected_extension, expected) in named {
        let Some(path) = path else { continue };
        let extension = path.extension().and_then(|extension| extension.to_str());
        if extension != Some(expected_extension) {
            return Err(CliError::Option {
                option,
                found: path.display().to_string(),
                expected,
            });
        }
        check_output(path, &taken)?;
        taken.push(path);
    }
    let written = match arguments.report {
        Some(_) => Some(Timestamp::from_environment()?),
        None => None,
    };
    let study = Study::read(&arguments.study)?;
    let bootstrap = arguments.bootstrap.map(|draws| Bootstrap {
        draws: draws as usize,
        seed: arguments.seed.unwrap_or(1),
    });
    let progress = Progress::new(
        "identifying",
        bootstrap.map_or(0, |bootstrap| bootstrap.draws),
    );
    let found = identify_and_draw(&study, bootstrap, &progress)?;
    drop(progress);
    let joint_file = found.joint_file();
    let drawing = arguments
        .figure
        .as_ref()
        .map(|path| (path, figure(&found, "")));
    let warnings = warnings(&found);
    let page = written.map(|written| report(&study, &found, &warnings, written));
    joint_file.write(&arguments.output)?;
    if let Some((path, drawing)) = drawing {
        write_file(path, drawing.as_bytes())?;
    }
    if let (Some(path), Some(page)) = (&arguments.report, page) {
        write_file(path, page.as_bytes())?;
    }
    for warning in &warnings {
        message(&format!("warning: {warning}"));
    }
    if arguments.json {
        let value = json!({
            "output": arguments.output.display().to_string(),
            "figure": arguments.figure.as_ref().map(|path| path.display().to_string()),
            "report": arguments.report.as_ref().map(|path| path.display().to_string()),
            "joint_file": joint_file,
            "starts": { "tried": found.starts.0, "agreeing": found.starts.1 },
            "reduced_chi_squared": found.reduced_chi_squared,
            "warnings": warnings,
            "models": found.estimate.model_choice().map(|choice| json!({
                "recommended": choice.recommended,
                "compared": choice.models.iter().map(|fit| json!({
                    "model": fit.model,
                    "bic_difference": fit.bic_difference,
                    "adequate": fit.adequate,
                })).collect::<Vec<_>>(),
            })),
        });
        return print(&serde_json::to_string_pretty(&value)?);
    }
    let mut text = summary(&found);
    let _ = writeln!(text, "\nwrote {}", arguments.output.display());
    for path in [&arguments.figure, &arguments.report].into_iter().flatten() {
        let _ = writeln!(text, "wrote {}", path.display());
    }
    print(&text)
}

/// What the identification and the passivity of its result give reason to warn of.
pub(super) fn warnings(found: &Identification) -> Vec<String> {
    let passivity = found.joint_file().passivity();
    let active = passivity.active().map(|matrix| {
        format!("{matrix}: the identified joint is active; a simulation with it can blow up, so `export` refuses it")
    });
    found.warnings.iter().cloned().chain(active).collect()
}

/// The result for people.
fn summary(found: &Identification) -> String {
    let mut text = format!("{}\n{}\n\n", found.name, basis(found));
    let covariance = found.estimate.covariance();
    let active = found.estimate.free() != &found.joint;
    let mut header = vec!["", "identified", "± std. dev.", "95 % interval"];
    if active {
        header.push("free estimate");
    }
    header.extend(["band average", "unit"]);
    let mut table = Table::new(&header);
    let intervals = covariance.intervals();
    for (index, unknown) in Unknown::of(found.model).into_iter().enumerate() {
        let average = found.band_average.as_ref();
        let [low, high] = intervals[index];
        let mut cells = vec![unknown.name.to_owned()];
        if covariance.identified[index] {
            cells.extend([
                number(unknown.value(&found.joint), 5),
                number(unknown.value(&found.standard_deviation), 2),
                format!("{} … {}", number(low, 5), number(high, 5)),
            ]);
        } else {
            cells.extend(["not identified", "", ""].map(str::to_owned));
        }
        if active {
            cells.push(number(unknown.value(found.estimate.free()), 5));
        }
        cells.push(average.map_or_else(
            || "none".to_owned(),
            |average| number(unknown.value(average), 5),
        ));
        cells.push(unknown.unit.to_owned());
        table.row(cells);
    }
    text += &table.render();
    if active {
        text += "\nThe free estimate is active; \"identified\" is the passive joint that fits best, and is what the file holds.\n";
    }
    let _ = writeln!(text, "\n{}", fit(found));
    text += &models(found);
    if let Some(result) = found.estimate.bootstrap() {
        text += &bootstrap(result, &covariance.unknowns);
    }
    text
}

/// The joint models beside each other.
fn models(found: &Identification) -> String {
    let Some(choice) = found.estimate.model_choice() else {
        return String::new();
    };
    let compared: Vec<String> = choice
        .models
        .iter()
        .map(|fit| {
            let residual = if fit.adequate {
                "leaves noise"
            } else {
                "leaves more than noise"
            };
            format!("{} +{:.1} ({residual})", fit.model, fit.bic_difference)
        })
        .collect();
    let advice = if !choice.any_is_adequate {
        format!("none is adequate, \"{}\" comes closest", choice.recommended)
    } else if choice.recommended == found.model {
        format!("\"{}\" is the simplest adequate one", choice.recommended)
    } else {
        format!(
            "\"{}\" is the simplest adequate one: consider it instead of \"{}\"",
            choice.recommended, found.model
        )
    };
    format!("joint models by BIC: {}; {advice}\n", compared.join(", "))
}

fn bootstrap(result: &BootstrapResult, unknowns: &[Unknown]) -> String {
    let mut text = format!(
        "\nbootstrap: {} draws, seed {}, {} converged\n",
        result.draws, result.seed, result.converged
    );
    if result.converged > 1 {
        let mut table = Table::new(&["", "± std. dev.", "95 % interval", "unit"]);
        for (index, unknown) in unknowns.iter().enumerate() {
            let [low, high] = result.intervals[index];
            table.row(vec![
                unknown.name.to_owned(),
                number(result.standard_deviation[index], 2),
                format!("{} … {}", number(low, 5), number(high, 5)),
                unknown.unit.to_owned(),
            ]);
        }
        text += &table.render();
    }
    text
}

/// What the result rests on, in one line.
pub(super) fn basis(found: &Identification) -> String {
    let frequency_hz = &found.lines.frequency_hz;
    let counted = |count: usize, thing: &str| {
        let ending = if count == 1 { "" } else { "s" };
        format!("{count} {thing}{ending}")
    };
    format!(
        "joint model \"{}\" from {} at {}, {} from {} to {} Hz",
        found.model,
        counted(
            found.fits.len()
                + found
                    .further
                    .iter()
                    .map(|assembly| assembly.fits.len())
                    .sum::<usize>(),
            "function"
        ),
        counted(found.lines.points.len(), "point"),
        counted(frequency_hz.len(), "line"),
        number(frequency_hz[0], 4),
        number(frequency_hz[frequency_hz.len() - 1], 4),
    )
}

/// How well the result fits, in one line.
pub(super) fn fit(found: &Identification) -> String {
    let chi_squared = found
        .reduced_chi_squared
        .map(|value| format!("; χ² per degree of freedom {value:.3}"))
        .unwrap_or_default();
    let passive = if found.joint_file().passivity().is_passive() {
        "passive"
    } else {
        "ACTIVE"
    };
    let (tried, agreeing) = found.starts;
    format!(
        "residual {:.2} % r.m.s. of the receptance{chi_squared}; {agreeing} of {tried} starts agree; the joint is {passive}",
        100.0 * found.relative_rms
    )
}

/// The report as a page.
pub(super) fn report(
    study: &Study,
    found: &Identification,
    warnings: &[String],
    written: Timestamp,
) -> String {
    IdentificationReport {
        study,
        found,
        warnings,
        written,
    }
    .to_html()
}

/// The drive-point functions (or, without any, the first ones), measured and regenerated.
pub(super) fn figure(found: &Identification, subtitle: &str) -> String {
    let curve = |matrices: &[crate::structure::ComplexMatrix], place| -> Vec<Complex64> {
        matrices.iter().map(|matrix| matrix[place]).collect()
    };
    let drive_points = found
        .fits
        .iter()
        .filter(|fit| fit.response == fit.reference);
    let others = found
        .fits
        .iter()
        .filter(|fit| fit.response != fit.reference);
    let curves: Vec<_> = drive_points
        .chain(others)
        .take(PANELS)
        .map(|fit| {
            let label = format!("{} / {}", fit.response, fit.reference);
            let measured = curve(&found.lines.assembly, fit.place);
            let regenerated = curve(&found.regenerated, fit.place);
            (label, measured, regenerated)
        })
        .collect();
    FrfFigure {
        title: &found.name,
        subtitle,
        frequency_hz: &found.lines.frequency_hz,
        panels: curves
            .iter()
            .map(|(label, measured, regenerated)| FrfPanel {
                label: label.clone(),
                unit: "m/N",
                measured,
                regenerated,
                uncoupled: None,
            })
            .collect(),
    }
    .to_svg()
}
