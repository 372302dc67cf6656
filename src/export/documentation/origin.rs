//! Where the joint's values come from, and how far they are from the measurement.

use super::Page;
use crate::html::{cell, escaped, number_cell, percent, provenance, table};
use crate::joint::Residual;

pub(super) fn section(page: &Page<'_>) -> String {
    let provenance = match &page.file.provenance {
        Some(origin) => provenance(origin),
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
