//! The look of the curves, and the key that explains it.

use super::strip::{TEXT, draw_path};
use super::svg::{PathData, Point, Svg};
use super::text;

// Blue and vermilion from the palette of Okabe and Ito, which the colour-blind can tell apart.
pub(super) const REGENERATED_COLOUR: &str = "#0072b2";
const UNCOUPLED_COLOUR: &str = "#d55e00";
const MEASURED_COLOUR: &str = "#8c959f";
const MARK_COLOUR: &str = "#0072b2";

const FONT: f64 = 12.5;
const SAMPLE_WIDTH: f64 = 26.0;
const BETWEEN_ENTRIES: f64 = 24.0;

/// A kind of curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Key {
    Measured,
    Regenerated,
    Uncoupled,
}

impl Key {
    fn name(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::Regenerated => "regenerated",
            Self::Uncoupled => "uncoupled",
        }
    }

    /// Draws `path` in the look of this kind of curve.
    pub(super) fn draw(self, path: &PathData, svg: &mut Svg) {
        if path.is_empty() {
            return;
        }
        let (colour, width, dashes) = match self {
            Self::Measured => (MEASURED_COLOUR, 2.6, None),
            Self::Regenerated => (REGENERATED_COLOUR, 1.5, None),
            Self::Uncoupled => (UNCOUPLED_COLOUR, 1.2, Some("6 3")),
        };
        let element = svg
            .element("path")
            .word("d", path.as_str())
            .word("fill", "none")
            .word("stroke", colour)
            .number("stroke-width", width)
            .word("stroke-linejoin", "round");
        match dashes {
            Some(dashes) => element.word("stroke-dasharray", dashes),
            None => element.word("stroke-linecap", "round"),
        }
        .empty();
    }

    fn sample(self, left: f64, middle: f64) -> PathData {
        let mut path = PathData::default();
        let at = |x| Point {
            x: left + x,
            y: middle,
        };
        match self {
            Self::Measured => {
                for dot in [4.0, 10.0, 16.0, 22.0] {
                    path.move_to(at(dot));
                    path.dot();
                }
            }
            Self::Regenerated | Self::Uncoupled => path.polyline(&[at(0.0), at(SAMPLE_WIDTH)]),
        }
        path
    }
}

/// Draws the lines that mark resonances.
pub(super) fn draw_marks(path: &PathData, svg: &mut Svg) {
    if !path.is_empty() {
        svg.element("g").word("stroke-dasharray", "1 3").open();
        draw_path(svg, path, MARK_COLOUR, 1.0);
        svg.close();
    }
}

/// Draws samples of `keys` with their names in one line.
pub(super) fn draw_legend(keys: &[Key], left: f64, baseline: f64, svg: &mut Svg) {
    let mut x = left;
    for key in keys {
        key.draw(&key.sample(x, baseline - 0.36 * FONT), svg);
        x += SAMPLE_WIDTH + 7.0;
        svg.element("text")
            .number("x", x)
            .number("y", baseline)
            .number("font-size", FONT)
            .word("fill", TEXT)
            .containing(key.name());
        x += text::width(key.name(), FONT) + BETWEEN_ENTRIES;
    }
}
