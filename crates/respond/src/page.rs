//! The page of a response, of laps or of an assembly: the largest values, the figure, and what was asked for.

use bolted_joint_figures::html::{self, cell, escaped, figure, number_cell, shown, table};
use bolted_joint_figures::{Axis, Drawn, PlotPanel, PlotPoints};
use bolted_joint_files::{TOOL, Timestamp, VERSION};

/// What a page tells of a response.
#[derive(Debug, Clone, Copy)]
pub struct ResponsePage<'a> {
    /// The study's name.
    pub name: &'a str,
    /// What the reader should know before using the response.
    pub warnings: &'a [String],
    /// The response.
    pub drawn: &'a Drawn,
    /// The study itself.
    pub study: &'a str,
    /// When the page was written.
    pub written: Timestamp,
}

impl ResponsePage<'_> {
    /// The page as an HTML document, without any reference to the network.
    #[must_use]
    pub fn to_html(&self) -> String {
        let warnings = self.warnings.iter();
        let warnings = warnings.map(|text| format!("<p class=\"warning\">{}</p>\n", escaped(text)));
        let sections = format!(
            "{}<h2>Largest values</h2>\n{}<h2>Response</h2>\n{}<h2>What was asked for</h2>\n<pre>{}</pre>\n",
            warnings.collect::<String>(),
            self.largest(),
            figure(
                "response",
                &format!("<b>{}</b>", escaped(self.name)),
                self.drawn
            ),
            escaped(self.study.trim_end()),
        );
        html::page(
            &format!("{}: response", self.name),
            self.name,
            &format!(
                "Response computed by {TOOL} {VERSION}, <time>{}</time>.",
                self.written
            ),
            &sections,
        )
    }

    /// Of each curve where it is largest; an angle is largest nowhere.
    fn largest(&self) -> String {
        let panels = self.drawn.plot.panels.iter();
        let panels = panels.filter(|panel| !matches!(panel.up.1, Some(Axis::Phase)));
        let rows: Vec<String> = panels.flat_map(rows).collect();
        table(&["", "", "Largest", "At"], &rows)
    }
}

fn rows(panel: &PlotPanel) -> impl Iterator<Item = String> {
    panel.curves.iter().filter_map(move |curve| {
        let PlotPoints::Path(points, _) = &curve.points else {
            return None;
        };
        let finite = points
            .iter()
            .filter(|(x, y)| x.is_finite() && y.is_finite());
        let &(x, y) = finite.max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()))?;
        let title = [panel.title.as_str(), curve.name.as_str()];
        let title: Vec<&str> = title.into_iter().filter(|text| !text.is_empty()).collect();
        Some(
            [
                cell(&escaped(&title.join(", "))),
                cell(&escaped(name(&panel.up.0))),
                number_cell(&quantity(y, &panel.up.0)),
                number_cell(&quantity(x, &panel.across.0)),
            ]
            .concat(),
        )
    })
}

/// Name and unit of a label such as `frequency, Hz`.
fn parted(label: &str) -> (&str, &str) {
    label.rsplit_once(", ").unwrap_or((label, ""))
}

fn name(label: &str) -> &str {
    parted(label).0
}

fn quantity(value: f64, label: &str) -> String {
    let unit = parted(label).1;
    let space = if unit.starts_with("10") { " · " } else { " " };
    format!("{}{space}{}", shown(value, 5), escaped(unit))
        .trim_end()
        .to_owned()
}

#[cfg(test)]
mod tests {
    use bolted_joint_figures::{ResponseCurve, ResponseFigure, ResponsePanel, Scale};

    use super::*;

    #[test]
    fn the_largest_value_is_told_with_its_place_and_the_study_stands_below() {
        // |x| of a mode without damping at 10 Hz, on lines of 1 Hz: largest next to it on the side where it was sampled
        let points = (1..=9).map(|f| (f64::from(f), 1e-6 / (1.0 - f64::from(f * f) / 100.0)));
        let drawn = ResponseFigure {
            title: "r",
            note: None,
            panels: vec![ResponsePanel {
                title: "lap <1>".to_owned(),
                across: ("frequency, Hz".to_owned(), Scale::Linear),
                up: ("b.y amplitude, m".to_owned(), Scale::Logarithmic),
                curves: vec![ResponseCurve {
                    name: "2 N".to_owned(),
                    points: points.collect(),
                    is_dashed: Vec::new(),
                }],
            }],
        }
        .drawn()
        .unwrap();
        let page = ResponsePage {
            name: "r",
            warnings: &["careful".to_owned()],
            drawn: &drawn,
            study: "a < b",
            written: Timestamp::from_environment().unwrap(),
        }
        .to_html();
        // 1e-6/0.19
        for expected in [
            "<td>lap &lt;1&gt;, 2 N</td>",
            "5.2632 × 10<sup>−6</sup> m",
            ">9 Hz</td>",
            "<pre>a &lt; b</pre>",
            "class=\"warning\">careful",
        ] {
            assert!(page.contains(expected), "{expected}");
        }
    }
}
