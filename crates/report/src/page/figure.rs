//! A chart as a figure of the page.

use super::super::chart::Chart;
use bolted_joint_figures::html;

/// The figure; `caption` is finished HTML.
pub(crate) fn figure(chart: &Chart<'_>, caption: &str) -> String {
    let thinned = chart.thinned_to().map_or_else(String::new, |kept| {
        format!(
            " {kept} of {} lines can be zoomed and saved: those at which a curve is highest or lowest.",
            chart.frequency_hz.len()
        )
    });
    html::figure(&chart.id, &format!("{caption}{thinned}"), &chart.drawn())
}
