//! Pages with figures: one look for all, without any reference to the network.

use std::fmt::Write as _;

use super::{STYLE, escaped};
use crate::look::Look;
use crate::plot::{Drawn, PlotPoints};

/// How a reader uses the figures of a page, before the first of them; it is seen where the page's script runs.
const HOW_TO_READ: &str = "<p class=\"script-only faint\">Point at a figure or tap it to read values. Drag across it, along it or over a part \
     of it to zoom, or use two fingers; a double click shows the whole range. Names in the key hide their curves. With the keyboard: arrows move \
     the cursor, + and − zoom, 0 shows the whole range.</p>\n";

/// How a figure with a script begins.
const CHART: &str = "<figure class=\"chart\"";

/// A page around finished sections, with the script that its figures need; `what` is a sentence about the page, in HTML.
#[must_use]
pub fn page(title: &str, heading: &str, what: &str, sections: &str) -> String {
    let sections = sections.replacen(CHART, &format!("{HOW_TO_READ}{CHART}"), 1);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}{own}</style>\n</head>\n<body>\n<header>\n\
         <h1>{heading}</h1>\n<p>{what}</p>\n</header>\n\
         <main>\n{sections}</main>\n<script>\n{script}</script>\n</body>\n</html>\n",
        title = escaped(title),
        heading = escaped(heading),
        own = include_str!("page.css"),
        script = include_str!("charts.js"),
    )
}

/// A figure with cursor and zoom under its caption, which is finished HTML.
#[must_use]
pub fn figure(id: &str, caption: &str, drawn: &Drawn) -> String {
    let plot = &drawn.plot;
    let curves = || plot.panels.iter().flat_map(|panel| &panel.curves);
    // Where curves have abscissae of their own, the key is in the picture.
    let keys = match curves().any(|curve| matches!(curve.points, PlotPoints::Lines(_))) {
        true => static_key(drawn),
        false => String::new(),
    };
    format!(
        "{CHART} id=\"{}\">\n<figcaption>{caption}</figcaption>\n{keys}<div class=\"picture\">\n{}</div>\n\
         <script type=\"application/json\">{}</script>\n</figure>\n",
        escaped(id),
        embedded(&drawn.svg),
        plot.to_json(),
    )
}

/// A picture that stands as it is, under its caption; both are finished.
#[must_use]
pub fn still(id: &str, caption: &str, svg: &str) -> String {
    format!(
        "<figure class=\"still\" id=\"{}\">\n<figcaption>{caption}</figcaption>\n<div class=\"picture\">\n{}</div>\n</figure>\n",
        escaped(id),
        embedded(svg)
    )
}

fn embedded(svg: &str) -> String {
    svg.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1)
}

/// Each name and look once.
fn static_key(drawn: &Drawn) -> String {
    let plot = &drawn.plot;
    let mut entries: Vec<(&str, Look)> = Vec::new();
    for panel in &plot.panels {
        let curves = panel.curves.iter();
        let levels = panel
            .level
            .iter()
            .map(|level| (level.name.as_str(), level.look));
        for entry in curves
            .map(|curve| (curve.name.as_str(), curve.look))
            .chain(levels)
        {
            if !entries.contains(&entry) {
                entries.push(entry);
            }
        }
    }
    let mut keys = String::new();
    for (name, look) in entries {
        let _ = write!(keys, "<li>{} {}</li>", sample(look), escaped(name));
    }
    format!("<ul class=\"keys\">{keys}</ul>\n")
}

/// A short piece of the curve for the key.
fn sample(look: Look) -> String {
    let path = match look.is_dots {
        true => "M4 6h0M11 6h0M18 6h0",
        false => "M1 6h20",
    };
    let cap = match look.dashes {
        Some(_) => "butt",
        None => "round",
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
