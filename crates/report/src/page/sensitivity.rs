//! How much each receptance depends on each parameter.

use num_complex::Complex64;

use super::super::chart::{Chart, ChartStrip, Curve};
use super::figure::figure;
use super::functions::shares;
use super::{Assembly, IdentificationReport};
use bolted_joint_figures::html::{cell, escaped, number_cell, shown, table};
use bolted_joint_figures::{Axis, Look};
use bolted_joint_identify::{JointMatrices, Sensitivity, Unknown};

/// Functions of one assembly whose sensitivities are drawn at most, and of all; but one of each.
const MOST_FIGURES: usize = 3;
const MOST_OF_ALL: usize = 6;
const HEIGHT: f64 = 240.0;
const DECADES: i32 = 5;

// From the palette of Okabe and Ito: stiffnesses as lines, dampings in the same colours, dashed.
const COLOURS: [&str; 3] = ["#0072b2", "#d55e00", "#009e73"];
const DASHES: &str = "5 3";

pub(super) fn section(report: &IdentificationReport<'_>) -> String {
    let mut html = "<h2>Sensitivity of the receptances to the parameters</h2>\n<p>|∂<i>H</i>/∂<i>p</i>|·|<i>p</i>|/|<i>H</i>| with the identified \
                    joint: by how many per cent the receptance changes when the parameter changes by one per cent. Where it is \
                    small the measurement says little about the parameter.</p>\n"
        .to_owned();
    let assemblies = report.assemblies();
    let unknowns = &report.found.estimate.covariance().unknowns;
    let mut rows = Vec::new();
    let mut figures = String::new();
    let count = assemblies.len();
    let most = (MOST_FIGURES * count).min(MOST_OF_ALL).max(count);
    for (number, (assembly, share)) in assemblies.iter().zip(shares(&assemblies, most)).enumerate()
    {
        let joints = report.found.estimate.joint_of(number).bolts();
        let found = match report.found.estimate.sensitivities(number, assembly.lines) {
            Ok(found) => found,
            Err(error) => {
                html += &format!("<p class=\"warning\">{}</p>\n", escaped(&error.to_string()));
                continue;
            }
        };
        let mut drawn = 0;
        for index in assembly.drive_points_first() {
            let fit = &assembly.fits[index];
            let own: Vec<&Sensitivity> = found
                .iter()
                .filter(|sensitivity| sensitivity.receptance == fit.place)
                .collect();
            if own.is_empty() {
                continue;
            }
            let curves = curves(report, joints, unknowns, &own);
            let name = format!("{} / {}", fit.response, fit.reference);
            let assembly_cell = match assemblies.len() {
                1 => String::new(),
                _ => cell(&(number + 1).to_string()),
            };
            let cells: String = curves
                .iter()
                .map(|curve| number_cell(&shown(rms(&curve.values), 2)))
                .collect();
            rows.push(format!("{assembly_cell}{}{cells}", cell(&escaped(&name))));
            if drawn < share.min(MOST_FIGURES) {
                if drawn == 0 && count > 1 {
                    figures += &format!("<h3>Assembly {}</h3>\n", number + 1);
                }
                drawn += 1;
                let id = format!("sensitivity-{}-{drawn}", number + 1);
                figures += &chart(assembly, &name, id, curves);
            }
        }
    }
    let names: Vec<String> = unknowns
        .iter()
        .map(|unknown| report.symbol(unknown))
        .collect();
    let mut headings = match assemblies.len() {
        1 => Vec::new(),
        _ => vec!["Assembly"],
    };
    headings.push("Function");
    headings.extend(names.iter().map(String::as_str));
    html += &table(&headings, &rows);
    html += "<p class=\"faint\">Root mean square over the lines.</p>\n";
    html + &figures
}

fn curves(
    report: &IdentificationReport<'_>,
    joints: &[JointMatrices],
    unknowns: &[Unknown],
    own: &[&Sensitivity],
) -> Vec<Curve> {
    let entries = unknowns.len() / 2;
    let relative = |derivative: &[Complex64], of: &Sensitivity, scale: f64| -> Vec<f64> {
        let lines = derivative.iter().zip(&of.assembly);
        lines
            .map(|(slope, value)| slope.norm() * scale / value.norm())
            .collect()
    };
    unknowns
        .iter()
        .enumerate()
        .filter_map(|(index, unknown)| {
            let sensitivity = own.get(index % entries)?;
            let scale = unknown.value(&joints[unknown.joint]).abs();
            let colour = COLOURS[index % entries % COLOURS.len()];
            let (look, values) = if index < entries {
                (
                    Look::line(colour, 1.5),
                    relative(&sensitivity.by_stiffness, sensitivity, scale),
                )
            } else {
                (
                    Look::dashed(colour, 1.5, DASHES),
                    relative(&sensitivity.by_damping(), sensitivity, scale),
                )
            };
            Some(Curve {
                name: report.label(unknown),
                look,
                values,
            })
        })
        .collect()
}

fn chart(assembly: &Assembly<'_>, name: &str, id: String, curves: Vec<Curve>) -> String {
    let values = curves.iter().flat_map(|curve| curve.values.iter().copied());
    let chart = Chart {
        id,
        title: format!("Sensitivity of {name} to each parameter over frequency"),
        frequency_hz: &assembly.lines.frequency_hz,
        strips: vec![ChartStrip {
            name: "sensitivity".to_owned(),
            unit: String::new(),
            height: HEIGHT,
            axis: Axis::logarithmic(values, DECADES),
            curves,
            bands: Vec::new(),
            level: None,
        }],
        resonating: None,
    };
    figure(&chart, &format!("<b>{}</b>", escaped(name)))
}

fn rms(values: &[f64]) -> f64 {
    let squares: f64 = values.iter().map(|value| value * value).sum();
    (squares / values.len().max(1) as f64).sqrt()
}
