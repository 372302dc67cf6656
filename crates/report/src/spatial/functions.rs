//! The strongest functions of the assembly: measured, computed with the joint, and what is left.

use bolted_joint_figures::html::{escaped, percent};
use bolted_joint_frf::receptance_unit;
use bolted_joint_spatial::{SpatialIdentification, SpatialStudy};

use crate::page::counted;
use crate::page::functions::{Function, drawn};
use crate::{FrfFigure, FrfPanel};

pub(super) fn section(found: &SpatialIdentification) -> String {
    let mut html = format!(
        "<h2>Frequency response functions</h2>\n<p>Measured, and regenerated with the identified joint: the strongest of {}, two \
         within each substructure and two across the joint each way, as far as they were measured. All were used; their residual \
         is {} r.m.s.</p>\n",
        counted(found.functions, "function"),
        percent(found.relative_rms)
    );
    for (number, fit) in found.fits.iter().enumerate() {
        html += &drawn(&Function {
            id: &format!("frf-{}", number + 1),
            name: &format!("{} / {}", fit.response, fit.reference),
            unit: receptance_unit(fit.response, fit.reference),
            remark: &format!(" residual {} r.m.s.", percent(fit.relative_rms)),
            frequency_hz: &found.frequency_hz,
            measured: &fit.measured,
            regenerated: &fit.computed,
        });
    }
    html
}

/// The strongest functions as an SVG document.
#[must_use]
pub fn spatial_figure(study: &SpatialStudy, found: &SpatialIdentification) -> String {
    let subtitle = format!(
        "joint {}, model {}, {} at {}; residual {} r.m.s.",
        study.whereabouts(),
        escaped(&study.model),
        counted(found.functions, "function"),
        counted(found.lines, "line"),
        percent(found.relative_rms)
    );
    let panels = found.fits.iter().map(|fit| FrfPanel {
        label: format!("{} / {}", fit.response, fit.reference),
        unit: receptance_unit(fit.response, fit.reference),
        measured: &fit.measured,
        regenerated: &fit.computed,
        uncoupled: None,
    });
    FrfFigure {
        title: &study.name,
        subtitle: &subtitle,
        frequency_hz: &found.frequency_hz,
        panels: panels.collect(),
    }
    .to_svg()
}
