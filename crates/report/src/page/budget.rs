//! What errors of the set-up do to the estimate: deviations without and with them, what to calibrate, and what stands out.

use super::IdentificationReport;
use bolted_joint_figures::html::{cell, escaped, number_cell, percent, shown, spread, table};
use bolted_joint_identify::Systematic;

/// Causes that are shown at most where the data speak against the set-up.
const SHOWN: usize = 6;
/// Parts of a variance below this are not shown.
const WORTH_SHOWING: f64 = 0.005;

pub(super) fn section(report: &IdentificationReport<'_>) -> String {
    let Some(found) = &report.found.systematic else {
        return String::new();
    };
    let (used, all) = found.lines;
    format!(
        "<h2>Error budget</h2>\n<p>What the set-up of the test leaves unknown takes part in the estimate: {} causes, each with a \
         limit from the study. {used} of {all} lines are used: on the others noise of the structures, or a frequency within its \
         limit, moves the assembly too much to be told by first order.</p>\n{}{}{}",
        found.causes.len(),
        deviations(report, found),
        bands(found),
        suspects(found)
    )
}

fn deviations(report: &IdentificationReport<'_>, found: &Systematic) -> String {
    let joints = report.found.estimate.joints.iter();
    let unknowns = joints.flat_map(|joint| {
        let at = joint
            .torque_n_m
            .map(|torque| format!(" at {} N·m", shown(torque, 6)));
        let own = joint.covariance.unknowns.iter();
        own.map(move |unknown| (at.clone().unwrap_or_default(), unknown))
    });
    let groups: Vec<_> = found
        .shares
        .groups
        .iter()
        .filter(|(_, parts)| parts.iter().any(|part| *part > WORTH_SHOWING))
        .collect();
    let mut heading = vec!["", "Std. dev. by noise alone", "With the budget"];
    heading.extend(groups.iter().map(|(group, _)| group.name()));
    heading.push("Unit");
    let rows: Vec<String> = unknowns
        .enumerate()
        .map(|(index, (at, unknown))| {
            let parts: String = groups
                .iter()
                .map(|(_, parts)| number_cell(&percent(parts[index])))
                .collect();
            format!(
                "<th scope=\"row\">{}{at}</th>{}{}{parts}{}",
                report.symbol(unknown),
                number_cell(&spread(found.noise_covariance[(index, index)].sqrt())),
                number_cell(&spread(found.covariance[(index, index)].sqrt())),
                cell(unknown.unit)
            )
        })
        .collect();
    let advice = found.largest_groups().first().map(|(group, part)| {
        format!(
            "<p>What matters most: {}, with {} of a variance. To know the joint better, {}.</p>\n",
            group.name(),
            percent(*part),
            group.remedy()
        )
    });
    format!(
        "{}<p>The percentages are what a variance would fall by if a group were known exactly.</p>\n{}",
        table(&heading, &rows),
        advice.unwrap_or_default()
    )
}

fn capital(name: &str) -> String {
    bolted_joint_figures::html::capitalised(name)
}

/// Whether bands agree, with the estimate of each.
fn bands(found: &Systematic) -> String {
    let tests: Vec<String> = found
        .consistency
        .iter()
        .map(|(test, p)| {
            format!(
                "{} bands agree with <i>p</i> = {}",
                test.bands.len(),
                shown(*p, 2)
            )
        })
        .collect();
    if tests.is_empty() {
        return String::new();
    }
    format!(
        "<p>If the set-up were exact, every band of the range would have the same joint: {}. Below 0.01 it is not chance.</p>\n",
        tests.join(", ")
    )
}

fn suspects(found: &Systematic) -> String {
    if found.suspects.is_empty() {
        return "<p>No single cause stands out from the noise.</p>\n".to_owned();
    }
    let rows: Vec<String> = found
        .suspects
        .iter()
        .take(SHOWN)
        .map(|(name, suspect)| {
            let (value, unit) = suspect.cause.shown(suspect.value);
            let (deviation, _) = suspect.cause.shown(suspect.standard_deviation);
            format!(
                "<th scope=\"row\">{}</th>{}{}{}{}",
                escaped(&capital(name)),
                number_cell(&shown(value, 3)),
                number_cell(&shown(deviation, 2)),
                cell(unit),
                number_cell(&shown(suspect.drop, 3))
            )
        })
        .collect();
    format!(
        "<p>Causes that stand out if each acts alone. Those with nearly the same drop cannot be told apart by these data.</p>\n{}",
        table(
            &["Cause", "Size", "Std. dev.", "Unit", "χ² drops by"],
            &rows
        )
    )
}
