//! Where the joint's values come from, and how far they are from the measurement.

use super::super::provenance::provenance;
use super::Page;
use bolted_joint_figures::html::{cell, escaped, number, number_cell, percent, quantity, table};
use bolted_joint_joint::{Residual, Validity};

pub(super) fn section(page: &Page<'_>) -> String {
    let provenance = match &page.file.provenance {
        Some(origin) => provenance(origin),
        None => "<p class=\"faint\">The joint file does not say.</p>\n".to_owned(),
    };
    let residual = match &page.file.residual {
        Some(residual) => deviation(residual),
        None => String::new(),
    };
    let table = if page.has_table_beside {
        "The joint file it was taken from, with the joint over the preload: \
         <a href=\"../resources/joint-over-preload.json\">resources/joint-over-preload.json</a>."
    } else {
        ""
    };
    format!(
        "<h2>Where the values come from</h2>\n{provenance}{}{residual}<p>The joint file itself is in the FMU: \
         <a href=\"../resources/joint.json\">resources/joint.json</a>. {table}</p>\n",
        page.file
            .validity
            .as_ref()
            .map(validity)
            .unwrap_or_default(),
    )
}

/// Where the values hold: outside of it nothing was measured.
fn validity(validity: &Validity) -> String {
    let range = |[low, high]: [f64; 2], unit: &str| {
        if low == high {
            quantity(low, unit)
        } else {
            format!("{} to {}", number(low), quantity(high, unit))
        }
    };
    let mut rows = vec![row("Frequency", &range(validity.frequency_hz, "Hz"))];
    if let Some(torque) = validity.torque_n_m {
        rows.push(row("Tightening torque", &range(torque, "N·m")));
    }
    if let Some(level) = &validity.level {
        rows.push(row("Level", &escaped(level)));
    }
    format!(
        "<h3>Measured at</h3>\n{}",
        table(&[], &rows).replace("<thead><tr></tr></thead>\n", "")
    )
}

fn row(name: &str, html: &str) -> String {
    format!("<th scope=\"row\">{name}</th>{}", cell(html))
}

fn deviation(residual: &Residual) -> String {
    let mut html = format!(
        "<h3>Distance from the measurement</h3>\n<p>The root mean square of measured minus computed is {} of that of \
         the measured, over {} lines.</p>\n",
        percent(residual.relative_rms),
        residual.lines
    );
    if !residual.functions.is_empty() {
        let rows: Vec<String> = residual
            .functions
            .iter()
            .map(|function| {
                [
                    cell(&escaped(&function.response)),
                    cell(&escaped(&function.reference)),
                    number_cell(&percent(function.relative_rms)),
                ]
                .concat()
            })
            .collect();
        html += &table(&["Response", "Reference", "Relative r.m.s."], &rows);
    }
    html
}
