//! Stiffness and damping over the tightening torque, where each torque has its joint, and whether the data call for that.

use super::super::interval_figure::{Estimated, IntervalFigure, Panel};
use super::IdentificationReport;
use super::judgement::{COMPARED, Compared};
use super::parameters;
use bolted_joint_figures::html::{self, number, number_cell, quantity, table};
use bolted_joint_identify::{JointEstimate, TorqueDependence, Unknown};

const STIFFNESS: &str = "#0072b2";
const DAMPING: &str = "#d55e00";

/// Table and figure of the parameters of `joints`, by torque.
pub(super) fn section(report: &IdentificationReport<'_>, joints: &[&JointEstimate]) -> String {
    let unknowns = &joints[0].covariance.unknowns;
    let mut rows = Vec::new();
    for (index, unknown) in unknowns.iter().enumerate() {
        for (place, joint) in joints.iter().enumerate() {
            let name = match place {
                0 => report.symbol(unknown),
                _ => String::new(),
            };
            rows.push(format!(
                "<th scope=\"row\">{name}</th>{}{}",
                number_cell(&torque(joint)),
                parameters::cells(joint, index, unknown)
            ));
        }
    }
    let headings = [&["", "Torque, N·m"], &parameters::HEADINGS[..]].concat();
    let nominal = report.found.estimate.joints[0].torque_n_m.unwrap_or(0.0);
    format!(
        "<p>Each torque has a joint of its own; all were estimated together. The nominal torque, that of the first assembly, is \
         {}.</p>\n{}{}{}",
        quantity(nominal, "N·m"),
        table(&headings, &rows),
        figure(report, joints, unknowns),
        coupling(report, unknowns)
    )
}

fn torque(joint: &JointEstimate) -> String {
    joint.torque_n_m.map(number).unwrap_or_default()
}

/// Stiffnesses on the left, dampings on the right.
fn figure(
    report: &IdentificationReport<'_>,
    joints: &[&JointEstimate],
    unknowns: &[Unknown],
) -> String {
    let entries = unknowns.len() / 2;
    let panel = |index: usize, colour| {
        let unknown = &unknowns[index];
        let values = joints.iter().map(|joint| Estimated {
            at: joint.torque_n_m.unwrap_or(0.0),
            value: joint.covariance.identified[index].then(|| {
                let value = unknown.value(&joint.bolts()[unknown.joint]);
                (value, joint.intervals()[index])
            }),
        });
        Panel {
            name: report.label(unknown),
            unit: unknown.unit.to_owned(),
            colour,
            values: values.collect(),
        }
    };
    let panels = (0..entries)
        .flat_map(|entry| [panel(entry, STIFFNESS), panel(entries + entry, DAMPING)])
        .collect();
    let drawn = IntervalFigure {
        title: "Stiffness and damping over the tightening torque, with intervals of 95 %",
        across: "tightening torque, N·m",
        is_counted: false,
        panels,
    }
    .drawn();
    html::figure(
        "over-torque",
        "<b>Stiffness and damping over the torque</b> with their 95 % intervals. The dashed line is the linear interpolation that \
         an export between the torques uses.",
        &drawn,
    )
}

/// How far the errors of neighbouring torques go together.
fn coupling(report: &IdentificationReport<'_>, unknowns: &[Unknown]) -> String {
    let lines = &report.found.lines;
    if lines.a.measured().is_none() && lines.b.measured().is_none() {
        return "<p>No substructure was measured line by line, so the errors of different torques are independent, but for the level \
                of the noise where that was estimated.</p>\n"
            .to_owned();
    }
    let estimate = &report.found.estimate;
    let all = &estimate.covariance_of_all;
    let size = unknowns.len();
    let mut order: Vec<usize> = (0..estimate.joints.len()).collect();
    let torque_of = |joint: usize| estimate.joints[joint].torque_n_m.unwrap_or(0.0);
    order.sort_by(|&a, &b| torque_of(a).total_cmp(&torque_of(b)));
    let rows: Vec<String> = order
        .windows(2)
        .map(|pair| {
            let cells: String = (0..size)
                .map(|index| {
                    let (a, b) = (pair[0] * size + index, pair[1] * size + index);
                    let correlation = all[(a, b)] / (all[(a, a)] * all[(b, b)]).sqrt();
                    number_cell(&format!("{:.2}", correlation + 0.0).replace('-', "−"))
                })
                .collect();
            let [low, high] = [pair[0], pair[1]].map(|joint| number(torque_of(joint)));
            format!("<th scope=\"row\">{low} and {high} N·m</th>{cells}")
        })
        .collect();
    let names: Vec<String> = unknowns
        .iter()
        .map(|unknown| report.symbol(unknown))
        .collect();
    let mut headings = vec!["Correlation between"];
    headings.extend(names.iter().map(String::as_str));
    format!(
        "{}<p>Assemblies that share a measured substructure share its errors, which moves their joints together: the change from one \
         torque to the next is known better than the two intervals by themselves say where the correlation is positive.</p>\n",
        table(&headings, &rows)
    )
}

/// A common joint beside one for each torque, where the study has several torques.
pub(super) fn choice(report: &IdentificationReport<'_>) -> String {
    let Some(choice) = report.found.estimate.torque_choice() else {
        return String::new();
    };
    let used = report.study.torques;
    let rows: Vec<String> = choice
        .compared
        .iter()
        .map(|fit| {
            Compared {
                name: match fit.dependence {
                    TorqueDependence::Common => "one joint at all torques",
                    TorqueDependence::Separate => "a joint for each torque",
                },
                unknowns: fit.unknowns,
                bic_difference: fit.bic_difference,
                reduced_chi_squared: fit.reduced_chi_squared,
                adequate: fit.adequate,
                is_used: fit.dependence == used,
                is_recommended: fit.dependence == choice.recommended,
            }
            .row(choice.any_is_adequate)
        })
        .collect();
    let advice = match (choice.recommended == used, choice.recommended) {
        (true, TorqueDependence::Common) => {
            "The data do not show that the joint depends on the torque."
        }
        (true, TorqueDependence::Separate) => "The joint depends on the torque.",
        (false, TorqueDependence::Common) => {
            "The data do not show that the joint depends on the torque: consider one joint for all torques."
        }
        (false, TorqueDependence::Separate) => {
            "The joint depends on the torque: the common joint that was used is an average over the torques."
        }
    };
    format!(
        "<h3>Dependence on the torque</h3>\n{}<p>{advice}</p>\n",
        table(&[&[""], &COMPARED[..]].concat(), &rows)
    )
}
