//! What the identification used beside the measured functions: bands of the averages, modes, a presumed joint.

use super::IdentificationReport;
use bolted_joint_figures::html::{escaped, number, percent};
use bolted_joint_identify::{BandOrigin, FromModes, JointMatrices};
use bolted_joint_joint::with_symbols;

/// What the modes supplied, and how well they give what was measured.
pub(super) fn from_modes(found: &FromModes) -> String {
    let functions = found.functions.iter().map(|(response, reference)| {
        format!(
            "{} / {}",
            escaped(&response.to_string()),
            escaped(&reference.to_string())
        )
    });
    let functions: Vec<String> = functions.collect();
    let functions = match functions.as_slice() {
        [] => "nothing: all functions were measured".to_owned(),
        functions => format!("{}, taken as exact", functions.join(", ")),
    };
    let deviation = found.deviation.map(|deviation| {
        format!(
            "; of the measured functions the modes are {} away (r.m.s.)",
            percent(deviation)
        )
    });
    functions + &deviation.unwrap_or_default()
}

pub(super) fn start(joint: &JointMatrices) -> String {
    let matrix = |matrix: &nalgebra::DMatrix<f64>| {
        let rows = matrix.row_iter().map(|row| {
            let row: Vec<String> = row.iter().map(|value| number(*value)).collect();
            format!("[{}]", row.join(", "))
        });
        format!("[{}]", rows.collect::<Vec<_>>().join(", "))
    };
    format!(
        "<i>K</i> = {}, <i>C</i> = {} (SI units)",
        matrix(&joint.stiffness),
        matrix(&joint.damping)
    )
}

pub(super) fn bands(report: &IdentificationReport<'_>) -> String {
    let bolts = report.found.bolts.with_own_joint();
    let mut entries = Vec::new();
    for (joint, used) in report.found.estimate.bands().iter().enumerate() {
        for used in used {
            let bolt = bolts.get(joint).map(|bolt| format!("{} ", escaped(bolt)));
            let name = bolt.unwrap_or_default() + &with_symbols(used.name);
            let ranges = used.bands.iter();
            let ranges =
                ranges.map(|[from, to]| format!("{} to {} Hz", number(*from), number(*to)));
            let ranges = ranges.collect::<Vec<_>>().join(", ");
            entries.push(match used.origin {
                BandOrigin::Given => format!("{name}: {ranges}, given"),
                BandOrigin::Automatic => format!("{name}: {ranges}, chosen"),
                BandOrigin::NoneQualifies => {
                    format!("{name}: median over all lines, because no band qualifies")
                }
                BandOrigin::Median => format!("{name}: median over all lines, as asked for"),
            });
        }
    }
    let mut html = entries.join("; ");
    let mut all = report.found.estimate.bands().iter().flatten();
    if all.any(|used| used.origin == BandOrigin::Automatic) {
        html += ". Chosen are the most sensitive lines, 10 % or more away from the substructures' own resonances, at the estimate";
    }
    html
}
