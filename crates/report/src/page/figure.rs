//! A chart as a figure of the page: caption, key, picture, and the data for the script.

use std::fmt::Write as _;

use super::super::chart::{Chart, Level};
use bolted_joint_figures::Look;
use bolted_joint_figures::html::escaped;

/// The figure; `caption` is finished HTML.
pub(crate) fn figure(chart: &Chart<'_>, caption: &str) -> String {
    let mut keys = String::new();
    for (number, strip) in chart.strips.iter().enumerate() {
        for (curve_number, curve) in strip.curves.iter().enumerate() {
            let name = if strip.curves.len() == 1 {
                strip.name.clone()
            } else if chart.strips.len() == 1 {
                curve.name.clone()
            } else {
                format!("{} {}", strip.name, curve.name)
            };
            let _ = write!(
                keys,
                "<li>{} {} <b data-strip=\"{number}\" data-curve=\"{curve_number}\"></b></li>",
                sample(curve.look),
                escaped(&name)
            );
        }
    }
    if chart.strips.iter().any(|strip| strip.level.is_some()) {
        let _ = write!(keys, "<li>{} estimate</li>", sample(Level::LOOK));
    }
    let thinned = chart.thinned_to().map_or_else(String::new, |kept| {
        format!(
            " When zoomed, {kept} of {} lines are drawn: those at which a curve is highest or lowest.",
            chart.frequency_hz.len()
        )
    });
    format!(
        "<figure class=\"chart\" id=\"{id}\">\n<figcaption>{caption}{thinned}</figcaption>\n\
         <ul class=\"keys\"><li class=\"at\"><b data-frequency></b></li>{keys}</ul>\n\
         <div class=\"picture\">\n{svg}</div>\n<script type=\"application/json\">{data}</script>\n</figure>\n",
        id = escaped(&chart.id),
        svg = chart.to_svg(),
        data = chart.data(),
    )
}

/// A short piece of the curve for the key.
fn sample(look: Look) -> String {
    let path = if look.is_dots {
        "M4 6h0M11 6h0M18 6h0"
    } else {
        "M1 6h20"
    };
    let cap = if look.dashes.is_some() {
        "butt"
    } else {
        "round"
    };
    let dashes = look
        .dashes
        .map(|dashes| format!(" stroke-dasharray=\"{dashes}\""))
        .unwrap_or_default();
    format!(
        "<svg class=\"key\" viewBox=\"0 0 22 12\" width=\"22\" height=\"12\" aria-hidden=\"true\"><path d=\"{path}\" fill=\"none\" \
         stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"{cap}\"{dashes}/></svg>",
        look.colour, look.width
    )
}
