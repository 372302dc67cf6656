//! Where the joint's values come from, and how far they are from the measurement.

use super::Page;
use super::html::{cell, escaped, number, number_cell, table};
use crate::joint::{Provenance, Residual};

pub(super) fn section(page: &Page<'_>) -> String {
    let provenance = match &page.file.provenance {
        Some(provenance) => origin(provenance),
        None => "<p class=\"faint\">The joint file does not say.</p>\n".to_owned(),
    };
    let residual = match &page.file.residual {
        Some(residual) => deviation(residual),
        None => String::new(),
    };
    format!(
        "<h2>Where the values come from</h2>\n{provenance}{residual}<p>The joint file itself is in the FMU: \
         <a href=\"../resources/joint.json\">resources/joint.json</a>.</p>\n"
    )
}

fn origin(provenance: &Provenance) -> String {
    let mut html = format!(
        "<p>Method <code>{}</code>, joint model <code>{}</code>, by {} {}.</p>\n",
        escaped(&provenance.method),
        escaped(&provenance.model),
        escaped(&provenance.tool),
        escaped(&provenance.version),
    );
    if !provenance.inputs.is_empty() {
        let rows: Vec<String> = provenance
            .inputs
            .iter()
            .map(|input| {
                format!(
                    "{}{}<td class=\"hash\">{}</td>",
                    cell(&escaped(&input.role)),
                    cell(&escaped(&input.file)),
                    escaped(&input.sha256)
                )
            })
            .collect();
        html += &table(&["Role", "File", "SHA-256"], &rows);
    }
    if !provenance.notes.is_empty() {
        let notes: String = provenance
            .notes
            .iter()
            .map(|note| format!("<li>{}</li>\n", escaped(note)))
            .collect();
        html += &format!("<ul>\n{notes}</ul>\n");
    }
    html
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

fn percent(ratio: f64) -> String {
    // Three digits say enough about a residual.
    let rounded = format!("{:.2e}", 100.0 * ratio)
        .parse()
        .unwrap_or(100.0 * ratio);
    format!("{} %", number(rounded))
}
