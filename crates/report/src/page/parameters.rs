//! The identified parameters: values, intervals, correlations, and which of them the data do not determine.

use std::fmt::Write as _;

use super::{IdentificationReport, counted, over_torque, symbol};
use bolted_joint_figures::html::{
    beside, cell, escaped, number_cell, quantity, shown, spread, table, with_deviation,
};
use bolted_joint_identify::{JointEstimate, Unknown};
use bolted_joint_joint::{Drawn, with_symbols};

/// Digits of a parameter.
const DIGITS: usize = 5;
/// Correlations from here on are worth a word.
const STRONG: f64 = 0.9;

pub(super) fn section(report: &IdentificationReport<'_>) -> String {
    let joints = report.found.estimate.by_torque();
    let mut html = "<h2>Identified parameters</h2>\n".to_owned();
    html += &match joints.as_slice() {
        [joint] => only_joint(report, joint),
        joints => over_torque::section(report, joints),
    };
    html += &basis(report);
    html += &undetermined(report, &joints);
    html += &correlations(report);
    for joint in joints {
        html += &bootstrap(report, joint);
    }
    html
}

fn only_joint(report: &IdentificationReport<'_>, joint: &JointEstimate) -> String {
    let rows: Vec<String> = joint
        .covariance
        .unknowns
        .iter()
        .enumerate()
        .map(|(index, unknown)| {
            format!(
                "<th scope=\"row\">{}</th>{}",
                report.symbol(unknown),
                cells(joint, index, unknown)
            )
        })
        .collect();
    table(&[&[""], &HEADINGS[..]].concat(), &rows)
}

/// What [`cells`] are.
pub(super) const HEADINGS: [&str; 4] = ["Unit", "Estimate", "95 % interval", "Band average"];

/// One unknown of a joint: unit, estimate with its standard deviation, interval, band average. The unit comes first, where a
/// telephone shows it, too.
pub(super) fn cells(joint: &JointEstimate, index: usize, unknown: &Unknown) -> String {
    let covariance = &joint.covariance;
    let deviation = covariance.standard_deviation()[index];
    let average = joint.band_averages.as_ref().map_or_else(
        || "none".to_owned(),
        |averages| shown(unknown.value(&averages[unknown.joint]), DIGITS),
    );
    let estimate = if covariance.identified[index] {
        [
            number_cell(&with_deviation(
                unknown.value(&joint.bolts()[unknown.joint]),
                deviation,
            )),
            number_cell(&interval(joint.intervals()[index], deviation)),
        ]
        .concat()
    } else {
        "<td class=\"open\" colspan=\"2\">not identified</td>".to_owned()
    };
    format!("{}{estimate}{}", cell(unknown.unit), number_cell(&average))
}

/// The torque of a joint, after what is said of it; nothing where it is common to all.
pub(super) fn place(joint: &JointEstimate) -> String {
    joint
        .torque_n_m
        .map(|torque| format!(" at {}", quantity(torque, "N·m")))
        .unwrap_or_default()
}

/// An interval with the digits that the deviation warrants.
pub(super) fn interval([low, high]: [f64; 2], deviation: f64) -> String {
    format!("{} … {}", beside(low, deviation), beside(high, deviation))
}

impl IdentificationReport<'_> {
    /// The estimate of an unknown.
    pub(super) fn value(&self, unknown: &Unknown) -> f64 {
        unknown.value(&self.found.estimate.bolts()[unknown.joint])
    }

    /// The symbol of an unknown, after the name of its bolt where every bolt has a joint of its own.
    pub(super) fn symbol(&self, unknown: &Unknown) -> String {
        match self.found.bolts.with_own_joint().get(unknown.joint) {
            Some(bolt) => format!("{} {}", escaped(bolt), symbol(unknown.name)),
            None => symbol(unknown.name),
        }
    }

    /// The same in plain letters.
    pub(super) fn label(&self, unknown: &Unknown) -> String {
        let label = unknown.label(self.found.bolts.with_own_joint());
        with_symbols(&label)
    }
}

fn basis(report: &IdentificationReport<'_>) -> String {
    let joints = &report.found.estimate.joints;
    let on_both_sides = report.found.estimate.equations_on_both_sides();
    let equations = on_both_sides.map_or_else(
        || "equation 3.21".to_owned(),
        |equations| format!("equations {equations}"),
    );
    let mut html = format!(
        "<p>In brackets: one standard deviation, in units of the last digit. The estimate is that of maximum likelihood over all lines and functions together; its standard deviations follow \
         from the information matrix. The band average is the classical value, the mean of the decoupled values of each line \
         over the bands (Tol, {equations}); it is given for comparison."
    );
    if joints.iter().any(JointEstimate::free_is_active) {
        html += " The free estimate is not passive. The estimate above is the passive joint that fits best; the interval is about \
                 the free one.";
    }
    let inflation = joints.iter().flat_map(|joint| &joint.covariance.inflation);
    let inflation = inflation.copied().fold(1.0, f64::max);
    if inflation >= 1.05 {
        let _ = write!(
            html,
            " The residual is not the assumed noise, so the standard deviations were raised, by up to a factor of {}.",
            shown(inflation, 3)
        );
    }
    html + "</p>\n"
}

fn undetermined(report: &IdentificationReport<'_>, joints: &[&JointEstimate]) -> String {
    let html: String = joints.iter().map(|joint| open(report, joint)).collect();
    if html.is_empty() {
        return "<p>The data determine every parameter of this joint model.</p>\n".to_owned();
    }
    html
}

/// What the data do not determine of one joint; nothing if there is nothing.
fn open(report: &IdentificationReport<'_>, joint: &JointEstimate) -> String {
    let covariance = &joint.covariance;
    let open: Vec<String> = covariance
        .unknowns
        .iter()
        .zip(&covariance.identified)
        .filter(|(_, identified)| !**identified)
        .map(|(unknown, _)| report.symbol(unknown))
        .collect();
    if open.is_empty() {
        return String::new();
    }
    let mut html = format!(
        "<p class=\"warning\">Not identified{}: {}. The data do not determine {}; the joint file holds a value only because the joint \
         needs one.",
        place(joint),
        open.join(", "),
        if open.len() == 1 { "it" } else { "them" }
    );
    for combination in &covariance.determined_together {
        let _ = write!(html, " Determined together: {}.", escaped(combination));
    }
    html + "</p>\n"
}

fn correlations(report: &IdentificationReport<'_>) -> String {
    let covariance = report.found.estimate.covariance();
    let correlation = covariance.correlation();
    if correlation.iter().any(|value| !value.is_finite()) {
        return "<p>Nothing is known of the noise, so there are no correlations.</p>\n".to_owned();
    }
    let names: Vec<String> = covariance
        .unknowns
        .iter()
        .map(|unknown| report.symbol(unknown))
        .collect();
    let rows: Vec<String> = names
        .iter()
        .enumerate()
        .map(|(row, name)| {
            let cells: String = (0..names.len())
                .map(|column| {
                    let value = correlation[(row, column)];
                    let text = format!("{:.2}", value + 0.0).replace('-', "−");
                    let tint = match value {
                        value if row == column || value == 0.0 => String::new(),
                        value => {
                            let colour = if value > 0.0 { "0,114,178" } else { "213,94,0" };
                            format!(
                                " style=\"background:rgba({colour},{:.2})\"",
                                0.5 * value.abs()
                            )
                        }
                    };
                    format!("<td class=\"number\"{tint}>{text}</td>")
                })
                .collect();
            format!("<th scope=\"row\">{name}</th>{cells}")
        })
        .collect();
    let mut headings = vec![""];
    headings.extend(names.iter().map(String::as_str));
    let mut strong = Vec::new();
    for row in 0..names.len() {
        for column in row + 1..names.len() {
            let value = correlation[(row, column)];
            if value.abs() > STRONG {
                strong.push(format!("{} with {}", names[row], names[column]));
            }
        }
    }
    let remark = if strong.is_empty() {
        String::new()
    } else {
        format!(
            "<p>Strongly correlated: {}. The data determine a combination of the two better than each of them.</p>\n",
            strong.join(", ")
        )
    };
    format!(
        "<h3>Correlations{}</h3>\n{}{remark}",
        place(&report.found.estimate.joints[0]),
        table(&headings, &rows)
    )
}

fn bootstrap(report: &IdentificationReport<'_>, joint: &JointEstimate) -> String {
    let Some(result) = &joint.bootstrap else {
        return String::new();
    };
    let mut html = format!(
        "<h3>Bootstrap{}</h3>\n<p>{} of {} from the fitted model, seed {}; the estimate converged on {} of them.</p>\n",
        place(joint),
        counted(result.draws, "draw"),
        match result.drawn {
            Drawn::Noise => "noise",
            Drawn::NoiseAndSetUp => "noise and of errors of the set-up within the error budget",
        },
        result.seed,
        result.converged
    );
    if result.converged > 1 {
        let unknowns = &joint.covariance.unknowns;
        let rows: Vec<String> = unknowns
            .iter()
            .enumerate()
            .map(|(index, unknown)| {
                format!(
                    "<th scope=\"row\">{}</th>{}{}{}",
                    report.symbol(unknown),
                    number_cell(&spread(result.standard_deviation[index])),
                    number_cell(&interval(
                        result.intervals[index],
                        result.standard_deviation[index]
                    )),
                    cell(unknown.unit)
                )
            })
            .collect();
        html += &table(&["", "Std. dev.", "95 % interval", "Unit"], &rows);
    }
    html
}
