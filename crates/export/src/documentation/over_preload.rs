//! The table of a joint over the preload, and how the FMU goes between its lines.

use super::super::Interface;
use super::Page;
use bolted_joint_dynamics::law::{DAMPING, STIFFNESS};
use bolted_joint_figures::html::{number, number_cell, table};

/// Nothing for a constant joint.
pub(super) fn section(page: &Page<'_>) -> String {
    let Some(over_preload) = page.over_preload else {
        return String::new();
    };
    let dofs = page.file.joint.dofs;
    let mut headings = vec!["Preload, N·m".to_owned()];
    for parameter in [STIFFNESS, DAMPING] {
        headings.extend(dofs.entries().map(|[i, j]| {
            let (row, column) = (dofs.row(i).symbol, dofs.row(j).symbol);
            format!("<i>{}</i><sub>{row}{column}</sub>", parameter.symbol)
        }));
    }
    headings.extend(
        dofs.rows()
            .map(|dof| format!("<i>k</i><sub>3,{}</sub>", dof.symbol)),
    );
    let rows: Vec<String> = over_preload
        .preload
        .iter()
        .enumerate()
        .map(|(place, preload)| {
            let mut cells = number_cell(&number(*preload));
            for matrices in [&over_preload.stiffness, &over_preload.damping] {
                for [row, column] in dofs.entries() {
                    let entry = matrices
                        .get(place)
                        .and_then(|matrix| matrix.get(row)?.get(column));
                    cells += &number_cell(&entry.copied().map(number).unwrap_or_default());
                }
            }
            for dof in 0..dofs.count() {
                let cubic = over_preload.cubic.get(place).and_then(|list| list.get(dof));
                cells += &number_cell(&number(cubic.copied().unwrap_or_default()));
            }
            cells
        })
        .collect();
    let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
    let energy = match page.interface {
        Interface::Element => {
            "<p>While the importer tells how fast the preload changes, <code>power.preload</code> is the power that the springs \
             take up by that.</p>\n"
        }
        Interface::Lap => {
            "<p>The energy is accounted for: <code>energy.stored</code> changes by <code>energy.supplied</code> − \
             <code>energy.dissipated</code> + <code>energy.preload</code>.</p>\n"
        }
    };
    format!(
        "<h2>Over the preload</h2>\n<p>The input <code>preload</code> is the tightening torque of the bolt. In SI units:</p>\n{}\
         <p>Between two lines each number follows a monotone cubic, with one slope on both sides of a line; stiffness and \
         damping stay positive semidefinite.</p>\n{energy}",
        table(&headings, &rows),
    )
}
