//! How well the joint fits, which joint model the data call for, and whether the joint is passive.

use super::parameters::place;
use super::{IdentificationReport, counted, over_torque};
use bolted_joint_figures::html::{
    capitalised, cell, escaped, number_cell, percent, quantity, shown, table,
};
use bolted_joint_identify::{JointEstimate, JointMatrices};
use bolted_joint_joint::JointFile;

/// The result in a few sentences, and what to beware of.
pub(super) fn summary(report: &IdentificationReport<'_>, files: &[JointFile]) -> String {
    let found = report.found;
    let functions: usize = report
        .assemblies()
        .iter()
        .map(|assembly| assembly.fits.len())
        .sum();
    let lines: usize = report
        .assemblies()
        .iter()
        .map(|assembly| assembly.lines.frequency_hz.len())
        .sum();
    let is_passive = files.iter().all(|file| file.passivity().is_passive());
    let verdict = match (files.len(), is_passive) {
        (1, true) => "the joint is passive",
        (1, false) => "the joint is active",
        (_, true) => "all joints are passive",
        (_, false) => "not all joints are passive",
    };
    let joints = &found.estimate.joints;
    let identified = || joints.iter().flat_map(|joint| &joint.covariance.identified);
    let determined = match identified().filter(|identified| !**identified).count() {
        0 => "the data determine every parameter".to_owned(),
        open => format!(
            "{open} of {} parameters are not identified",
            identified().count()
        ),
    };
    let mut html = format!(
        "<p>From {} and {}: the regenerated functions are within {} r.m.s. of the measured ones; {determined}; \
         {verdict}.</p>\n",
        counted(functions, "function"),
        counted(lines, "line"),
        percent(found.relative_rms)
    );
    if !report.warnings.is_empty() {
        let items: String = report
            .warnings
            .iter()
            .map(|warning| format!("<li>{}</li>\n", escaped(&capitalised(warning))))
            .collect();
        html += &format!(
            "<div class=\"warning\"><b>Before using the result</b>\n<ul>\n{items}</ul></div>\n"
        );
    }
    html
}

pub(super) fn section(report: &IdentificationReport<'_>, files: &[JointFile]) -> String {
    format!(
        "<h2>How well it fits</h2>\n{}{}{}{}",
        fit(report),
        choice(report),
        over_torque::choice(report),
        passivity(report, files)
    )
}

fn fit(report: &IdentificationReport<'_>) -> String {
    let found = report.found;
    let assessment = &found.estimate.assessment;
    let (tried, agreeing) = found.starts;
    let mut rows = vec![
        row(
            "Residual, r.m.s. of the receptance",
            &percent(found.relative_rms),
        ),
        row(
            "Starts that led to this estimate",
            &format!("{agreeing} of {tried}"),
        ),
    ];
    match (found.reduced_chi_squared, assessment.noise_is_stated) {
        (Some(chi_squared), true) => {
            rows.push(row(
                "χ² per degree of freedom",
                &format!(
                    "{}, {} of its standard deviations from 1",
                    shown(chi_squared, 4),
                    shown(assessment.chi_squared_excess, 2)
                ),
            ));
        }
        (Some(chi_squared), false) => rows.push(row(
            "χ² per degree of freedom",
            &format!(
                "{}, with the noise that coherence tells; no test, because coherence is an estimate itself: with <i>n</i> averages \
                 <i>n</i>/(<i>n</i> − 2) is to be expected",
                shown(chi_squared, 4)
            ),
        )),
        (None, _) => rows.push(row(
            "χ² per degree of freedom",
            "no test: the study does not state the noise, its level follows from the residual",
        )),
    }
    if assessment.line_correlation.is_finite() {
        rows.push(row(
            "Correlation of the residuals of neighbouring lines",
            &format!(
                "{}, {} of its standard deviations from 0",
                shown(assessment.line_correlation, 2),
                shown(assessment.line_correlation_excess, 2)
            ),
        ));
    }
    let verdict = match assessment.complaint() {
        None if assessment.is_exact => {
            "What the joint leaves of the measurement is rounding: the data are exact.".to_owned()
        }
        None if !assessment.has_power => {
            "There are too few lines to test whether the residual is noise.".to_owned()
        }
        None => "What the joint leaves of the measurement cannot be told from noise.".to_owned(),
        Some(complaint) => format!(
            "What the joint leaves of the measurement is not noise: {}. Either the joint model or the substructures do not fit, \
             or every start ended in a local minimum.",
            escaped(&complaint)
        ),
    };
    let class = if assessment.fits() {
        ""
    } else {
        " class=\"warning\""
    };
    format!("{}<p{class}>{verdict}</p>\n", bare_table(&rows))
}

fn row(name: &str, html: &str) -> String {
    format!("<th scope=\"row\">{name}</th><td>{html}</td>")
}

fn bare_table(rows: &[String]) -> String {
    table(&[], rows).replace("<thead><tr></tr></thead>\n", "")
}

fn choice(report: &IdentificationReport<'_>) -> String {
    let Some(choice) = report.found.estimate.model_choice() else {
        return String::new();
    };
    if let Some(reason) = report.study.models_not_compared() {
        return format!(
            "<h3>Choice of the joint model</h3>\n<p>The joint models are not compared: {}.</p>\n",
            escaped(&reason)
        );
    }
    let used = report.found.model;
    let rows: Vec<String> = choice
        .models
        .iter()
        .map(|fit| {
            let mut remarks = Vec::new();
            if fit.model == used {
                remarks.push("used");
            }
            if fit.model == choice.recommended {
                remarks.push(if choice.any_is_adequate {
                    "recommended"
                } else {
                    "comes closest"
                });
            }
            [
                cell(&fit.model.to_string()),
                number_cell(&fit.unknowns.to_string()),
                number_cell(&format!("{:.1}", fit.bic_difference)),
                number_cell(
                    &fit.reduced_chi_squared
                        .map_or_else(|| "–".to_owned(), |chi| shown(chi, 4)),
                ),
                cell(if fit.adequate {
                    "noise"
                } else {
                    "more than noise"
                }),
                cell(&remarks.join(", ")),
            ]
            .concat()
        })
        .collect();
    let advice = if !choice.any_is_adequate {
        "No joint model leaves noise alone.".to_owned()
    } else if choice.recommended == used {
        "The model used is the simplest adequate one.".to_owned()
    } else {
        format!(
            "The model “{}” is the simplest adequate one: consider it instead of “{used}”.",
            choice.recommended
        )
    };
    format!(
        "<h3>Choice of the joint model</h3>\n{}<p>{advice} BIC is Schwarz's criterion, −2 ln <i>L</i> + <i>p</i> ln <i>n</i>, \
         less that of the best model; the lowest is best.</p>\n",
        table(&["Model", "Unknowns", "BIC", "χ²/ν", "Leaves", ""], &rows)
    )
}

fn passivity(report: &IdentificationReport<'_>, files: &[JointFile]) -> String {
    let found = report.found;
    let bolts = found.bolts.with_own_joint();
    let mut verdicts = String::new();
    for (joint, file) in files.iter().enumerate() {
        let bolt = bolts.get(joint).map(|bolt| format!("{}: ", escaped(bolt)));
        let bolt = bolt.unwrap_or_default();
        for matrix in &file.passivity().matrices {
            verdicts += &format!("<li>{bolt}{}</li>\n", escaped(&matrix.to_string()));
        }
    }
    let mut html = format!(
        "<h3>Passivity</h3>\n<p>A passive joint stores energy or takes it: its matrices are positive semidefinite.</p>\n\
         <ul>\n{verdicts}</ul>\n"
    );
    let joints = found.estimate.by_torque();
    let active: Vec<String> = joints
        .iter()
        .filter(|joint| joint.free_is_active())
        .map(|joint| place(joint))
        .collect();
    if active.is_empty() {
        html += "<p>The free estimate is passive already: free and passive estimate are the same.</p>\n";
        return html;
    }
    let tables = joints.iter().filter(|joint| joint.free != joint.bolts());
    html += &tables
        .map(|joint| free_and_passive(report, joint))
        .collect::<String>();
    html + &format!(
        "<p>The free estimate is active{}. The passive one, K = LLᵀ and C = LLᵀ with the same likelihood, is what the joint file \
         holds.</p>\n",
        active.join(" and")
    )
}

/// Both estimates of a joint.
fn free_and_passive(report: &IdentificationReport<'_>, joint: &JointEstimate) -> String {
    let covariance = &joint.covariance;
    let rows: Vec<String> = covariance
        .unknowns
        .iter()
        .zip(&covariance.identified)
        .map(|(unknown, identified)| {
            let value = |joints: &[JointMatrices]| match identified {
                true => number_cell(&shown(unknown.value(&joints[unknown.joint]), 5)),
                false => "<td class=\"open\">not identified</td>".to_owned(),
            };
            format!(
                "<th scope=\"row\">{}</th>{}{}{}",
                report.symbol(unknown),
                value(&joint.free),
                value(joint.bolts()),
                cell(unknown.unit)
            )
        })
        .collect();
    let heading = joint
        .torque_n_m
        .map(|torque| format!("<p>At {}:</p>\n", quantity(torque, "N·m")))
        .unwrap_or_default();
    format!(
        "{heading}{}",
        table(&["", "Free estimate", "Passive estimate", "Unit"], &rows)
    )
}
