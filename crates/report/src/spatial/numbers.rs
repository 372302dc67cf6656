//! Every unknown of the model: estimate, deviations, interval, and whether the data determine it.

use bolted_joint_figures::html::{beside, cell, number_cell, spread, table};
use bolted_joint_spatial::{SpatialIdentification, Unknown};

use super::symbol;

pub(super) fn section(found: &SpatialIdentification) -> String {
    let is_passive_apart = found.free.is_some();
    let open: Vec<String> = found
        .unknowns
        .iter()
        .filter(|unknown| !unknown.is_determined)
        .map(|unknown| symbol(&unknown.name))
        .collect();
    let determined = match open.is_empty() {
        true => "<p>The data determine every number of this model.</p>\n".to_owned(),
        false => format!(
            "<p class=\"warning\">Not determined: {}. The joint file holds values only because the joint needs some. Measure with \
             more sensors and impacts, nearer to the joint's own motions, or take a model with fewer numbers.</p>\n",
            open.join(", ")
        ),
    };
    let rows: Vec<String> = found
        .unknowns
        .iter()
        .map(|unknown| row(unknown, is_passive_apart))
        .collect();
    let mut headings = vec!["", "Estimate"];
    if is_passive_apart {
        headings = vec!["", "Passive", "Free"];
    }
    headings.extend(["Std. dev.", "of noise alone", "95 % interval", "Unit", ""]);
    format!(
        "<h2 id=\"numbers\">All numbers of the model</h2>\n{determined}{}",
        table(&headings, &rows)
    )
}

fn row(unknown: &Unknown, is_passive_apart: bool) -> String {
    let deviation = unknown.deviation;
    let [low, high] = unknown.interval_95();
    let mut cells = format!(
        "<th scope=\"row\">{}</th>{}",
        symbol(&unknown.name),
        number_cell(&beside(unknown.value, deviation))
    );
    if is_passive_apart {
        cells += &number_cell(&beside(unknown.free, deviation));
    }
    cells += &number_cell(&spread(deviation));
    cells += &number_cell(&spread(unknown.deviation_by_noise));
    cells += &number_cell(&format!(
        "{} … {}",
        beside(low, deviation),
        beside(high, deviation)
    ));
    cells += &cell(&unit(&unknown.name));
    cells
        + &match unknown.is_determined {
            true => cell(""),
            false => "<td class=\"open\">not determined</td>".to_owned(),
        }
}

/// Of `k_x_ry` and the like: of two translations, two rotations, or one of each.
fn unit(name: &str) -> String {
    let mut parts = name.split('_');
    let letter = parts.next();
    let dofs: Vec<&str> = parts.collect();
    let rotations = match dofs.as_slice() {
        [one] => 2 * usize::from(one.starts_with('r')),
        several => several.iter().filter(|dof| dof.starts_with('r')).count(),
    };
    let time = match letter {
        Some("c") => "·s",
        _ => "",
    };
    match rotations {
        0 => format!("N{time}/m"),
        1 => format!("N{time}/rad"),
        _ => format!("N·m{time}/rad"),
    }
}
