//! What the script of a page needs of a figure to draw any part of it again: axes, looks and the values themselves.
//!
//! The picture that stands in a page is for paper and for readers without scripts. The script draws the same from here, at the
//! width that the reader's screen has, with a cursor and zoom; and what it saves are these values.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Value, json};

use super::axis::Axis;
use super::look::Look;

/// A figure: its picture, and what the script needs of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// The picture as an SVG document.
    pub svg: String,
    /// The same for the script.
    pub plot: Plot,
}

/// Panels with curves.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// Read out to those who cannot see the picture.
    pub title: String,
    /// Panels beside each other where there is room.
    pub columns: usize,
    /// The abscissae of every curve that has none of its own, ascending.
    pub lines: Vec<f64>,
    /// Row by row.
    pub panels: Vec<PlotPanel>,
}

/// One panel.
#[derive(Debug, Clone, PartialEq)]
pub struct PlotPanel {
    /// Above it; may be empty.
    pub title: String,
    /// Pixels.
    pub height: f64,
    /// Whether it stands below the one before it, with one abscissa for both.
    pub is_below: bool,
    /// Whether a unit is as long across as up.
    pub is_square: bool,
    /// Name and unit of the abscissa.
    pub across: (String, Axis),
    /// Name and unit of the ordinate; no axis if nothing can be drawn.
    pub up: (String, Option<Axis>),
    /// What is drawn.
    pub curves: Vec<PlotCurve>,
    /// Ranges of the abscissa that are shaded.
    pub bands: Vec<[f64; 2]>,
    /// A value with its interval, drawn across.
    pub level: Option<PlotLevel>,
    /// Places on the abscissa that are marked, the most important first.
    pub marks: Vec<f64>,
}

/// A curve of a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct PlotCurve {
    /// In the key. Curves of one name and look are one there.
    pub name: String,
    /// How it is drawn.
    pub look: Look,
    /// Where it is drawn.
    pub points: PlotPoints,
}

/// The points of a curve; what is not finite leaves a gap.
#[derive(Debug, Clone, PartialEq)]
pub enum PlotPoints {
    /// An ordinate for each of the [`Plot::lines`].
    Lines(Vec<f64>),
    /// Abscissa and ordinate, along a curve that may turn back; and whether it is dashed there, nowhere if empty.
    Path(Vec<(f64, f64)>, Vec<bool>),
    /// Abscissa, ordinate and its interval; and whether a dashed line joins them.
    Intervals(Vec<(f64, f64, [f64; 2])>, bool),
}

/// A value that does not depend on the abscissa.
#[derive(Debug, Clone, PartialEq)]
pub struct PlotLevel {
    /// In the key.
    pub name: String,
    /// How it is drawn.
    pub look: Look,
    /// The value.
    pub value: f64,
    /// Its interval.
    pub interval: [f64; 2],
}

impl PlotPanel {
    /// A panel of its own, without anything but curves.
    pub fn new(
        title: impl Into<String>,
        height: f64,
        across: (impl Into<String>, Axis),
        up: (impl Into<String>, Option<Axis>),
        curves: Vec<PlotCurve>,
    ) -> Self {
        Self {
            title: title.into(),
            height,
            is_below: false,
            is_square: false,
            across: (across.0.into(), across.1),
            up: (up.0.into(), up.1),
            curves,
            bands: Vec::new(),
            level: None,
            marks: Vec::new(),
        }
    }
}

impl Plot {
    /// As JSON for a `script` element of type `application/json`.
    #[must_use]
    pub fn to_json(&self) -> String {
        let plot = json!({
            "title": self.title,
            "columns": self.columns,
            "lines": base64_of_floats(self.lines.iter().copied()),
            "panels": self.panels.iter().map(panel).collect::<Vec<_>>(),
        });
        // "</script>" in a name would end the element.
        plot.to_string().replace('<', "\\u003c")
    }
}

fn panel(panel: &PlotPanel) -> Value {
    let level = panel.level.as_ref().map(|level| {
        let [low, high] = level.interval;
        json!({ "name": level.name, "look": look(level.look), "value": level.value, "low": low, "high": high })
    });
    json!({
        "title": panel.title,
        "height": panel.height,
        "below": panel.is_below,
        "square": panel.is_square,
        "across": axis(&panel.across.0, Some(panel.across.1)),
        "up": axis(&panel.up.0, panel.up.1),
        "bands": panel.bands,
        "level": level,
        "marks": panel.marks,
        "curves": panel.curves.iter().map(curve).collect::<Vec<_>>(),
    })
}

fn axis(name: &str, axis: Option<Axis>) -> Value {
    let scale = axis.map(|axis| match axis {
        Axis::Linear { .. } => "linear",
        Axis::Counted { .. } => "counted",
        Axis::Logarithmic { .. } => "logarithmic",
        Axis::Phase => "phase",
    });
    let ends = axis.map(|axis| axis.ends());
    json!({ "name": name, "scale": scale, "low": ends.map(|ends| ends.0), "high": ends.map(|ends| ends.1) })
}

fn look(look: Look) -> Value {
    json!({ "colour": look.colour, "width": look.width, "dashes": look.dashes, "dots": look.is_dots })
}

fn curve(curve: &PlotCurve) -> Value {
    let mut value = json!({ "name": curve.name, "look": look(curve.look) });
    let mut add = |key: &str, values: Value| value[key] = values;
    match &curve.points {
        PlotPoints::Lines(up) => add("y", base64_of_floats(up.iter().copied()).into()),
        PlotPoints::Path(points, is_dashed) => {
            add(
                "x",
                base64_of_floats(points.iter().map(|point| point.0)).into(),
            );
            add(
                "y",
                base64_of_floats(points.iter().map(|point| point.1)).into(),
            );
            if is_dashed.contains(&true) {
                let digits = is_dashed
                    .iter()
                    .map(|&dashed| if dashed { '1' } else { '0' });
                add("dashed", digits.collect::<String>().into());
            }
        }
        PlotPoints::Intervals(points, is_joined) => {
            let of = |part: fn(&(f64, f64, [f64; 2])) -> f64| {
                Value::from(base64_of_floats(points.iter().map(part)))
            };
            add("x", of(|point| point.0));
            add("y", of(|point| point.1));
            add("low", of(|point| point.2[0]));
            add("high", of(|point| point.2[1]));
            add("joined", (*is_joined).into());
        }
    }
    value
}

/// Numbers in single precision, little-endian, in Base64 (RFC 4648).
fn base64_of_floats(values: impl Iterator<Item = f64>) -> String {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "seven digits are more than a cursor shows"
    )]
    let bytes: Vec<u8> = values
        .flat_map(|value| (value as f32).to_le_bytes())
        .collect();
    BASE64_STANDARD.encode(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_single_precision_in_base64_and_names_cannot_leave_the_script() {
        let plot = Plot {
            title: "</script>".to_owned(),
            columns: 1,
            lines: vec![1.0, 2.5],
            panels: vec![PlotPanel::new(
                "",
                100.0,
                ("x", Axis::linear([1.0, 2.5].into_iter())),
                ("y", None),
                vec![PlotCurve {
                    name: "c".to_owned(),
                    look: Look::line("#000", 1.0),
                    points: PlotPoints::Path(vec![(1.0, -0.0)], vec![true]),
                }],
            )],
        };
        let json = plot.to_json();
        // 1.0 and 2.5 are 0000803f and 00002040 in little-endian IEEE 754, −0.0 is 00000080.
        assert!(
            json.contains("\"AACAPwAAIEA=\"") && json.contains("\"AAAAgA==\""),
            "{json}"
        );
        assert!(!json.contains('<') && json.contains("\"dashed\":\"1\""));
    }
}
