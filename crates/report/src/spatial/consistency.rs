//! Whether the interfaces moved as rigid bodies: the virtual points' consistency.

use bolted_joint_figures::html::{cell, number_cell, table};
use bolted_joint_figures::{Axis, Look};
use bolted_joint_spatial::SideConsistency;
use bolted_joint_virtual_point::Role;

use super::SpatialReport;
use crate::chart::{Chart, ChartStrip, Curve};
use crate::page::figure::figure;

const HEIGHT: f64 = 110.0;
const SENSORS: Look = Look::line("#0072b2", 1.5);
const IMPACTS: Look = Look::dashed("#d55e00", 1.3, "6 3");

pub(super) fn section(report: &SpatialReport<'_>) -> String {
    let all = report.consistency;
    let mut html = "<h2>Consistency of the virtual points</h2>\n".to_owned();
    if all.is_empty() {
        return html
            + "<p>There is none to tell: an interface is a node, or six channels and impacts agree with anything.</p>\n";
    }
    html += "<p>How much of what was measured is the motion of a rigid interface: 1 is all of it. Overall over frequency, for all \
             impacts at once (sensors) and all channels added (impacts); below it that of each channel and impact, as a mean over the \
             lines. A bad one lowers others too. Set-up as stated, without the errors that were found.</p>\n";
    html += &over_frequency(report);
    for role in [Role::Channel, Role::Impact] {
        let own: Vec<&SideConsistency> = all.iter().filter(|one| one.role == role).collect();
        if own.is_empty() {
            continue;
        }
        let heading = match role {
            Role::Channel => "Sensor",
            Role::Impact => "Impact",
        };
        let tables: String = own
            .iter()
            .map(|one| table(&[heading, "DOF: coherence"], &each(one)))
            .collect();
        html += &format!("<div class=\"blocks\">\n{tables}</div>\n");
    }
    html
}

fn over_frequency(report: &SpatialReport<'_>) -> String {
    let frequency_hz = &report.found.frequency_hz;
    let strips: Vec<ChartStrip> = ["a", "b"]
        .into_iter()
        .filter_map(|side| {
            let own = report.consistency.iter().filter(|one| one.side == side);
            let curves: Vec<Curve> = own
                .map(|one| {
                    let (name, look) = match one.role {
                        Role::Channel => ("sensors", SENSORS),
                        Role::Impact => ("impacts", IMPACTS),
                    };
                    Curve {
                        name: name.to_owned(),
                        look,
                        values: one.overall.clone(),
                    }
                })
                .collect();
            let values = || curves.iter().flat_map(|curve| curve.values.iter().copied());
            let least = values().fold(f64::INFINITY, f64::min);
            // from what is not worth a look to 1, or as far down as there is anything
            let low = (10.0 * least.min(0.95)).floor() / 10.0;
            // with room above the line at 1
            let high = values().fold(1.0, f64::max) + 0.06 * (1.0 - low);
            (!curves.is_empty()).then(|| ChartStrip {
                name: format!("consistency of {side}"),
                unit: String::new(),
                height: HEIGHT,
                axis: Some(Axis::Linear { low, high }),
                curves,
                bands: Vec::new(),
                level: None,
            })
        })
        .collect();
    let chart = Chart {
        id: "consistency".to_owned(),
        title: "Consistency of the virtual points over frequency".to_owned(),
        frequency_hz,
        strips,
        resonating: None,
    };
    figure(&chart, "<b>Overall consistency</b>")
}

/// A row for each sensor or impact.
fn each(one: &SideConsistency) -> Vec<String> {
    let mut rows: Vec<(String, Vec<String>)> = Vec::new();
    for (key, dof, own) in &one.specific {
        let text = format!("{dof}: {own:.3}");
        match rows.last_mut() {
            Some((last, texts)) if last == key => texts.push(text),
            _ => rows.push((key.clone(), vec![text])),
        }
    }
    let row = |(key, texts): (String, Vec<String>)| {
        format!("{}{}", cell(&key), number_cell(&texts.join(" &emsp; ")))
    };
    rows.into_iter().map(row).collect()
}
