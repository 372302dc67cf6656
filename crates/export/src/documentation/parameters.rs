//! The joint's matrices and the bodies' lists, with units and standard deviations.

use super::super::Interface;
use super::Page;
use bolted_joint_figures::html::{cell, escaped, number, number_cell, spread, table};
use bolted_joint_joint::{Body, DofSet, Joint};

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
         {basis}{}{}{bodies}<p>{role}; the values here are those it starts with.</p>\n",
        cubic(joint),
        higher(joint),
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

fn cubic(joint: &Joint) -> String {
    let entries = &joint.cubic;
    if entries.iter().all(|entry| *entry == 0.0) {
        if joint.has_terms_of_higher_order() {
            return String::new();
        }
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

/// The terms of higher order, a row for each that is not zero.
fn higher(joint: &Joint) -> String {
    let Some(terms) = joint
        .higher
        .as_ref()
        .filter(|_| joint.has_terms_of_higher_order())
    else {
        return String::new();
    };
    // symbol, what it multiplies, and units of the DOFs
    let kinds = [
        (&terms.quintic, ("k", 5), "<i>r</i>⁵", ["N/m⁵", "N·m/rad⁵"]),
        (&terms.septic, ("k", 7), "<i>r</i>⁷", ["N/m⁷", "N·m/rad⁷"]),
        (
            &terms.damping_quadratic,
            ("c", 2),
            "<i>r</i>² d<i>r</i>/d<i>t</i>",
            ["N·s/m³", "N·m·s/rad³"],
        ),
        (
            &terms.damping_quartic,
            ("c", 4),
            "<i>r</i>⁴ d<i>r</i>/d<i>t</i>",
            ["N·s/m⁵", "N·m·s/rad⁵"],
        ),
    ];
    let mut rows = Vec::new();
    for (list, (letter, order), factor, units) in kinds {
        for (i, &term) in list.iter().enumerate().filter(|(_, term)| **term != 0.0) {
            rows.push(format!(
                "<th><i>{letter}</i><sub>{order}</sub> of <i>{}</i></th>{}{}",
                LOADS[i.min(1)],
                number_cell(&format!("{} {}", number(term), units[i.min(1)])),
                cell(&format!("times {factor}"))
            ));
        }
    }
    let range = terms
        .amplitude
        .iter()
        .zip(MOTIONS.iter().zip(["m", "rad"]))
        .map(|(amplitude, (motion, unit))| {
            format!("<i>{motion}</i> up to {} {unit}", number(*amplitude))
        })
        .collect::<Vec<_>>();
    let range = if range.is_empty() {
        String::new()
    } else {
        format!(
            "<p>They hold for a relative motion {}.</p>\n",
            range.join(", ")
        )
    };
    format!(
        "<h3>Terms of higher order</h3>\n{}{range}",
        table(&["", "", "of the relative motion <i>r</i>"], &rows)
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
