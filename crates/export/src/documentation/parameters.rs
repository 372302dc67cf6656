//! The joint's matrices and the bodies' lists, with units and standard deviations.

use super::super::Interface;
use super::Page;
use bolted_joint_dynamics::{
    DofKind,
    law::{DAMPING, Parameter, STIFFNESS, Term},
};
use bolted_joint_figures::html::{cell, escaped, number, number_cell, spread, table};
use bolted_joint_joint::{
    Body, DofSet, HigherTerms, Joint, description, superscript, unit, unit_for_people,
};

pub(super) fn section(page: &Page<'_>) -> String {
    let joint = &page.file.joint;
    let deviation = page
        .file
        .uncertainty
        .as_ref()
        .map(|uncertainty| &uncertainty.standard_deviation);
    let of_stiffness = deviation.map(|deviation| deviation.stiffness.as_slice());
    let stiffness = matrix("", &joint.stiffness, of_stiffness, STIFFNESS, joint.dofs);
    let of_damping = deviation.map(|deviation| deviation.damping.as_slice());
    let damping = matrix("̇", &joint.damping, of_damping, DAMPING, joint.dofs);
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
         {basis}{}{}{}{bodies}<p>{role}; the values here are those it starts with.</p>\n",
        cubic(joint),
        higher(joint),
        friction(joint),
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
    parameter: &Parameter,
    dofs: DofSet,
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
                    let unit = dofs.unit(parameter.unit, [i, j]);
                    number_cell(&format!("{}{spread} {unit}", number(*value)))
                })
                .collect();
            format!("<th><i>{}</i></th>{cells}", dofs.row(i).load)
        })
        .collect();
    let headings: Vec<String> = dofs
        .rows()
        .take(entries.len())
        .map(|dof| format!("per <i>{}{dot}</i>", dof.symbol))
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
                joint.dofs.row(i).load,
                number_cell(&value_on(joint, Term::CUBIC, i, entry)),
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
    let mut rows = Vec::new();
    for term in HigherTerms::terms() {
        let list = joint.term(term).iter().enumerate();
        for (i, &value) in list.filter(|(_, value)| **value != 0.0) {
            rows.push(format!(
                "<th>{} of <i>{}</i></th>{}{}",
                symbol(term.row()),
                joint.dofs.row(i).load,
                number_cell(&value_on(joint, term, i, value)),
                cell(&format!("times {}", factor(term)))
            ));
        }
    }
    let range = terms
        .amplitude
        .iter()
        .zip(joint.dofs.rows())
        .map(|(amplitude, dof)| {
            let (motion, unit) = (dof.symbol, dof.kind.displacement_unit());
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

/// A coefficient of a term on the DOF of row `i`, with its unit.
fn value_on(joint: &Joint, term: Term, i: usize, value: f64) -> String {
    let unit = joint.dofs.unit(term.row().unit, [i, i]);
    format!("{} {unit}", number(value))
}

/// A parameter's symbol, its number below the letter.
fn symbol(parameter: &Parameter) -> String {
    let (letter, order) = parameter.symbol.split_at(1);
    format!("<i>{letter}</i><sub>{order}</sub>")
}

/// What a term's coefficient is multiplied by.
fn factor(term: Term) -> String {
    let [power, of_rate] = term.powers();
    let power = superscript(power.unsigned_abs() as u8);
    match of_rate {
        0 => format!("<i>r</i>{power}"),
        _ => format!("<i>r</i>{power} d<i>r</i>/d<i>t</i>"),
    }
}

/// The laws with parameters of their own, a row for each parameter.
fn friction(joint: &Joint) -> String {
    if joint.friction.is_empty() {
        return String::new();
    }
    let rows: Vec<String> = joint
        .friction
        .iter()
        .enumerate()
        .flat_map(|(place, own)| {
            let kind = own.dof.kind;
            let before = joint.friction[..place].iter();
            let same =
                before.filter(|other| other.dof.name == own.dof.name && other.law == own.law);
            let name = match same.count() {
                0 => own.law.name.to_owned(),
                before => format!("{}, number {}", own.law.name, before + 1),
            };
            let parameters = own.law.parameters.iter().zip(&own.parameters);
            parameters.map(move |(parameter, &value)| {
                let unit = unit(parameter.unit, kind, kind);
                format!(
                    "<th><i>{}</i></th>{}{}{}",
                    own.dof.load,
                    cell(&name),
                    number_cell(&format!("{} {unit}", number(value))),
                    cell(&description(parameter, &[kind]))
                )
            })
        })
        .collect();
    format!("<h3>Friction</h3>\n{}", table(&["", "", "", ""], &rows))
}

fn bodies_table(a: &Body, b: &Body, dofs: DofSet) -> String {
    let rows: Vec<String> = dofs
        .rows()
        .enumerate()
        .flat_map(|(i, dof)| {
            let kind = dof.kind;
            let (inertia, of_rotation) = match kind {
                DofKind::Translation => ("Mass", ""),
                DofKind::Rotation => ("Moment of inertia", " in rotation"),
            };
            let row = |name: String, unit: String, list: fn(&Body) -> &[f64]| {
                let value = |body| {
                    let value = list(body).get(i).copied().map(number);
                    number_cell(&value.unwrap_or_default())
                };
                [cell(&name), value(a), value(b), cell(&unit)].concat()
            };
            [
                row(
                    inertia.to_owned(),
                    unit_for_people(kind.inertia_unit()),
                    |body| &body.inertia,
                ),
                row(
                    format!("Support stiffness{of_rotation}"),
                    unit(STIFFNESS.unit, kind, kind),
                    |body| &body.stiffness,
                ),
                row(
                    format!("Support damping{of_rotation}"),
                    unit(DAMPING.unit, kind, kind),
                    |body| &body.damping,
                ),
            ]
        })
        .collect();
    table(&["", "a", "b", "Unit"], &rows)
}
