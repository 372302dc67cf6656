//! The joint's matrices and the bodies' lists, with units and standard deviations.

use super::super::Interface;
use super::Page;
use crate::html::{cell, escaped, number, number_cell, spread, table};
use crate::joint::{Body, DofSet};

/// Symbols and load symbols of the DOFs, in the order of the matrices' rows.
const MOTIONS: [&str; 2] = ["y", "θ"];
const LOADS: [&str; 2] = ["F", "M"];

const STIFFNESS_UNITS: [[&str; 2]; 2] = [["N/m", "N/rad"], ["N·m/m", "N·m/rad"]];
const DAMPING_UNITS: [[&str; 2]; 2] = [["N·s/m", "N·s/rad"], ["N·m·s/m", "N·m·s/rad"]];
const CUBIC_UNITS: [&str; 2] = ["N/m³", "N·m/rad³"];

pub(super) fn section(page: &Page<'_>) -> String {
    let joint = &page.file.joint;
    let deviation = page
        .file
        .uncertainty
        .as_ref()
        .map(|uncertainty| &uncertainty.standard_deviation);
    let stiffness = matrix(
        "",
        &joint.stiffness,
        deviation.map(|deviation| deviation.stiffness.as_slice()),
        &STIFFNESS_UNITS,
    );
    let damping = matrix(
        "̇",
        &joint.damping,
        deviation.map(|deviation| deviation.damping.as_slice()),
        &DAMPING_UNITS,
    );
    let basis = match &page.file.uncertainty {
        Some(uncertainty) => format!(
            "<p>± one standard deviation: {}.</p>\n",
            escaped(uncertainty.basis.trim_end_matches('.'))
        ),
        None => "<p class=\"faint\">The joint file gives no standard deviations.</p>\n".to_owned(),
    };
    let bodies = match (&page.file.bodies, page.interface) {
        (Some(bodies), Interface::Lap) => format!(
            "<h3>Bodies and their supports</h3>\n{}",
            bodies_table(&bodies.a, &bodies.b, joint.dofs)
        ),
        _ => String::new(),
    };
    format!(
        "<h2>Values of the joint{at}</h2>\n<h3>Stiffness <i>K</i></h3>\n{stiffness}<h3>Damping <i>C</i></h3>\n{damping}\
         {basis}{}{bodies}<p>{role}; the values here are those it starts with.</p>\n",
        cubic(&joint.cubic),
        at = page
            .over_preload
            .map(|table| format!(" at {} N·m", number(table.nominal)))
            .unwrap_or_default(),
        role = match page.over_preload {
            Some(_) =>
                "Those of the joint follow the input <code>preload</code>, those of the bodies are tunable parameters",
            None => "All of these are tunable parameters of the FMU",
        },
    )
}

/// `dot` is the combining mark that turns a motion into its rate.
fn matrix(
    dot: &str,
    entries: &[Vec<f64>],
    deviation: Option<&[Vec<f64>]>,
    units: &[[&str; 2]; 2],
) -> String {
    let rows: Vec<String> = entries
        .iter()
        .enumerate()
        .map(|(i, row)| {
            let cells: String = row
                .iter()
                .enumerate()
                .map(|(j, value)| {
                    let spread = deviation
                        .and_then(|deviation| deviation.get(i)?.get(j))
                        .map(|deviation| format!(" ± {}", spread(*deviation)))
                        .unwrap_or_default();
                    number_cell(&format!("{}{spread} {}", number(*value), units[i][j]))
                })
                .collect();
            format!("<th><i>{}</i></th>{cells}", LOADS[i])
        })
        .collect();
    let headings: Vec<String> = MOTIONS
        .iter()
        .take(entries.len())
        .map(|motion| format!("per <i>{motion}{dot}</i>"))
        .collect();
    let mut all: Vec<&str> = vec![""];
    all.extend(headings.iter().map(String::as_str));
    table(&all, &rows)
}

fn cubic(entries: &[f64]) -> String {
    if entries.iter().all(|entry| *entry == 0.0) {
        return "<p>The joint is linear: its cubic stiffness <i>k</i><sub>3</sub> is zero.</p>\n"
            .to_owned();
    }
    let rows: Vec<String> = entries
        .iter()
        .enumerate()
        .map(|(i, &entry)| {
            let effect = match entry {
                entry if entry > 0.0 => "hardens",
                entry if entry < 0.0 => "softens",
                _ => "linear",
            };
            format!(
                "<th><i>{}</i></th>{}{}",
                LOADS[i],
                number_cell(&format!("{} {}", number(entry), CUBIC_UNITS[i])),
                cell(effect)
            )
        })
        .collect();
    format!(
        "<h3>Cubic stiffness <i>k</i><sub>3</sub></h3>\n{}",
        table(&["", "per cube of the relative motion", ""], &rows)
    )
}

fn bodies_table(a: &Body, b: &Body, dofs: DofSet) -> String {
    type List = fn(&Body) -> &[f64];
    let rows: [(&str, &str, List, usize); 6] = [
        ("Mass", "kg", |body| &body.inertia, 0),
        ("Support stiffness", "N/m", |body| &body.stiffness, 0),
        ("Support damping", "N·s/m", |body| &body.damping, 0),
        ("Moment of inertia", "kg·m²", |body| &body.inertia, 1),
        (
            "Support stiffness in rotation",
            "N·m/rad",
            |body| &body.stiffness,
            1,
        ),
        (
            "Support damping in rotation",
            "N·m·s/rad",
            |body| &body.damping,
            1,
        ),
    ];
    let rows: Vec<String> = rows
        .iter()
        .filter(|(.., dof)| *dof < dofs.count())
        .map(|(name, unit, list, dof)| {
            let value = |body| {
                let value = list(body).get(*dof).copied().map(number);
                number_cell(&value.unwrap_or_default())
            };
            [cell(name), value(a), value(b), cell(unit)].concat()
        })
        .collect();
    table(&["", "a", "b", "Unit"], &rows)
}
