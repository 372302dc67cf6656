//! A rectangle of the figure with a frequency axis and one other: its grid, its frame, its ticks and their labels.

use super::axis::{Axis, TickLabel, Ticks};
use super::curve::Sample;
use super::svg::{Lettering, Manner, PathData, Point, Svg};

/// Colour of text.
pub const TEXT: &str = "#1f2328";
/// Colour of text that may be overlooked.
pub const FAINT_TEXT: &str = "#57606a";
/// Of the texts of a small figure.
pub const FONTS: &str = "system-ui, sans-serif";
/// Room below a strip for the labels of its ticks and the name of its axis (pixels).
pub const LABELS_BELOW: f64 = 46.0;
const GRID: &str = "#e3e6ea";
const MINOR_GRID: &str = "#f3f4f6";
const FRAME: &str = "#6e7781";

const TICK_FONT: f64 = 12.0;
const EXPONENT_FONT: f64 = 9.5;
/// Room to the left of a strip for the labels of its value axis (pixels).
pub const VALUE_LABELS: f64 = 64.0;
/// Least distance of the value axis' name from the strip (pixels), and of its baseline from the longest label.
const NAME_DISTANCE: f64 = 50.0;
const NAME_GAP: f64 = 5.0;
/// Distance of the labels from the strip (pixels).
const LABEL_GAP: f64 = 6.0;
/// Widths of a digit and of a point, parts of the font size, in the widest of the usual fonts.
const DIGIT: f64 = 0.64;
const FULL_STOP: f64 = 0.32;
/// How far the baseline of a text lies below its middle, part of the font size.
const MIDDLE: f64 = 0.36;
const TICK: f64 = 5.0;
const MINOR_TICK: f64 = 3.0;
/// Distance between labelled ticks at which they are easy to read (pixels).
const FREQUENCY_TICK_DISTANCE: f64 = 44.0;
const VALUE_TICK_DISTANCE: f64 = 26.0;

/// Where a strip lies on the page (pixels) and what its axes show. Its own points count from its upper left corner.
#[derive(Debug)]
pub struct Strip {
    /// Distance from the left edge of the page.
    pub left: f64,
    /// Distance from the upper edge of the page.
    pub top: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
    /// Abscissa.
    pub frequency: Axis,
    /// `None` if there is nothing to scale it by.
    pub value: Option<Axis>,
}

impl Strip {
    /// Where `sample` lies, counted from the strip's corner; `None` if it cannot be drawn.
    pub fn place(&self, (frequency_hz, value): Sample) -> Option<Point> {
        let up = self.value?.position(value)?;
        Some(Point {
            x: self.place_frequency(frequency_hz)?,
            y: self.height * (1.0 - up),
        })
    }

    /// How far from the strip's left edge `frequency_hz` lies.
    pub fn place_frequency(&self, frequency_hz: f64) -> Option<f64> {
        Some(self.width * self.frequency.position(frequency_hz)?)
    }

    /// Opens a group that counts from the strip's corner, and draws the grid. Close it by [`Strip::draw_frame`].
    pub fn draw_grid(&self, svg: &mut Svg) {
        let place = format!("translate({} {})", self.left, self.top);
        svg.element("g").word("transform", &place).open();
        let (across, up) = (self.frequency_ticks(), self.value_ticks());
        let mut minor = PathData::default();
        let mut major = PathData::default();
        for &value in &up.minor {
            self.level(value, 0.0, self.width, &mut minor);
        }
        for tick in &up.major {
            self.level(tick.value, 0.0, self.width, &mut major);
        }
        for tick in &across.major {
            self.upright(tick.value, 0.0, self.height, &mut major);
        }
        for (path, colour) in [(minor, MINOR_GRID), (major, GRID)] {
            draw_path(svg, &path, colour, 1.0);
        }
    }

    /// Draws frame and ticks over the curves and closes the group that [`Strip::draw_grid`] opened.
    pub fn draw_frame(&self, svg: &mut Svg) {
        let (across, up) = (self.frequency_ticks(), self.value_ticks());
        let mut ticks = PathData::default();
        for &value in &up.minor {
            self.level(value, 0.0, MINOR_TICK, &mut ticks);
        }
        for tick in &up.major {
            self.level(tick.value, 0.0, TICK, &mut ticks);
        }
        for &value in &across.minor {
            self.upright(value, self.height, self.height - MINOR_TICK, &mut ticks);
        }
        for tick in &across.major {
            self.upright(tick.value, self.height, self.height - TICK, &mut ticks);
        }
        draw_path(svg, &ticks, FRAME, 1.0);
        svg.element("rect")
            .number("width", self.width)
            .number("height", self.height)
            .word("fill", "none")
            .word("stroke", FRAME)
            .empty();
        svg.close();
    }

    /// Says in the middle of the strip that there is nothing to draw, inside of the group that [`Strip::draw_grid`] opened.
    pub fn draw_no_data(&self, svg: &mut Svg) {
        let middle = (0.5 * self.width, 0.5 * self.height);
        let lettering = Lettering::new(13.0, Manner::Middle).in_colour(FAINT_TEXT);
        svg.text(middle, lettering, "no data");
    }

    /// Draws the frame as [`Strip::draw_frame`] does, and names and labels both axes.
    pub fn draw_axes(&self, across: &str, up: &str, svg: &mut Svg) {
        self.draw_frame(svg);
        self.draw_value_labels(up, svg);
        self.draw_labels_below(across, svg);
    }

    /// Writes the value ticks' labels to the left of the strip and `name` upright beside them.
    pub fn draw_value_labels(&self, name: &str, svg: &mut Svg) {
        svg.element("g")
            .number("font-size", TICK_FONT)
            .word("text-anchor", "end")
            .word("fill", TEXT)
            .open();
        let ticks = self.value_ticks().major;
        let widest = ticks.iter().map(|tick| width(&tick.label));
        let widest = widest.fold(0.0, f64::max);
        for tick in ticks {
            let Some(up) = self.value.and_then(|axis| axis.position(tick.value)) else {
                continue;
            };
            let baseline = self.top + self.height * (1.0 - up) + MIDDLE * TICK_FONT;
            let text = svg
                .element("text")
                .number("x", self.left - LABEL_GAP)
                .number("y", baseline);
            text.open();
            write_label(tick.label, svg);
            svg.close();
        }
        svg.close();
        let distance = NAME_DISTANCE
            .max(LABEL_GAP + widest + NAME_GAP)
            .min((self.left - TICK_FONT).max(NAME_DISTANCE));
        let (x, y) = (self.left - distance, self.top + 0.5 * self.height);
        svg.element("text")
            .word("transform", &format!("translate({x} {y}) rotate(-90)"))
            .number("font-size", TICK_FONT)
            .word("text-anchor", "middle")
            .word("fill", TEXT)
            .containing(name);
    }

    /// Writes the frequency ticks' labels below the strip and the axis' name below them.
    pub fn draw_frequency_labels(&self, svg: &mut Svg) {
        self.draw_labels_below("frequency, Hz", svg);
    }

    /// Writes the labels of the ticks below the strip and `name` below them.
    pub fn draw_labels_below(&self, name: &str, svg: &mut Svg) {
        let below = self.top + self.height;
        svg.element("g")
            .number("font-size", TICK_FONT)
            .word("text-anchor", "middle")
            .word("fill", TEXT)
            .open();
        for tick in self.frequency_ticks().major {
            if let Some(x) = self.place_frequency(tick.value) {
                svg.element("text")
                    .number("x", self.left + x)
                    .number("y", below + 16.0)
                    .open();
                write_label(tick.label, svg);
                svg.close();
            }
        }
        svg.element("text")
            .number("x", self.left + 0.5 * self.width)
            .number("y", below + 34.0)
            .containing(name);
        svg.close();
    }

    fn frequency_ticks(&self) -> Ticks {
        self.frequency
            .ticks(count(self.width / FREQUENCY_TICK_DISTANCE))
    }

    fn value_ticks(&self) -> Ticks {
        self.value.map_or_else(Ticks::default, |axis| {
            axis.ticks(count(self.height / VALUE_TICK_DISTANCE))
        })
    }

    fn level(&self, value: f64, from: f64, to: f64, path: &mut PathData) {
        if let Some(up) = self.value.and_then(|axis| axis.position(value)) {
            let y = self.height * (1.0 - up);
            path.polyline(&[Point { x: from, y }, Point { x: to, y }]);
        }
    }

    /// Adds an upright line at `frequency_hz` to `path`, between two heights counted from the strip's upper edge.
    pub fn upright(&self, frequency_hz: f64, from: f64, to: f64, path: &mut PathData) {
        if let Some(x) = self.place_frequency(frequency_hz) {
            path.polyline(&[Point { x, y: from }, Point { x, y: to }]);
        }
    }
}

/// The text of a tick, inside an open text element.
fn write_label(label: TickLabel, svg: &mut Svg) {
    match label {
        TickLabel::Plain(label) => svg.characters(&label),
        TickLabel::Power { mantissa, exponent } => {
            if mantissa != 1 {
                svg.characters(&format!("{mantissa}·"));
            }
            svg.characters("10");
            svg.element("tspan")
                .number("dy", -0.36 * TICK_FONT)
                .number("font-size", EXPONENT_FONT)
                .containing_inline(&super::axis::with_minus_sign(&exponent.to_string()));
        }
    }
}

/// How wide a label may be (pixels).
fn width(label: &TickLabel) -> f64 {
    let em: f64 = match label {
        TickLabel::Plain(text) => text
            .chars()
            .map(|character| match character {
                '.' | '·' => FULL_STOP,
                _ => DIGIT,
            })
            .sum(),
        // 10 and an exponent, after the mantissa and a point
        TickLabel::Power { mantissa: 1, .. } => 4.0 * DIGIT,
        TickLabel::Power { .. } => 5.0 * DIGIT + FULL_STOP,
    };
    em * TICK_FONT
}

/// A plain line along `path`, nothing if that is empty.
pub fn draw_path(svg: &mut Svg, path: &PathData, colour: &str, width: f64) {
    if !path.is_empty() {
        svg.element("path")
            .word("d", path.as_str())
            .word("fill", "none")
            .word("stroke", colour)
            .number("stroke-width", width)
            .empty();
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a few ticks; `as` saturates for any other"
)]
fn count(ticks: f64) -> u32 {
    ticks.floor().max(1.0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_the_value_axis_stands_beside_the_longest_label() {
        let name_at = |low: f64, high: f64| {
            let strip = Strip {
                left: 76.0,
                top: 0.0,
                width: 300.0,
                height: 150.0,
                frequency: Axis::Counted { count: 2 },
                value: Some(Axis::Linear { low, high }),
            };
            let mut svg = Svg::new(400.0, 200.0, "");
            strip.draw_value_labels("N", &mut svg);
            let text = svg.finish();
            let (_, after) = text.split_once("translate(").unwrap();
            after.split_once(' ').unwrap().0.parse::<f64>().unwrap()
        };
        assert_eq!(name_at(0.0, 1.0), 76.0 - NAME_DISTANCE);
        // −0.835 is six characters, five of them wide: 5 · 7.68 + 3.84 and both gaps are 53
        assert!(name_at(-0.842, -0.824) < 76.0 - 53.0);
        assert!(name_at(-0.842, -0.824) > TICK_FONT);
    }

    #[test]
    fn things_that_are_counted_have_a_tick_each() {
        let axis = Axis::Counted { count: 3 };
        let ticks = axis.ticks(8);
        let values: Vec<f64> = ticks.major.iter().map(|tick| tick.value).collect();
        assert_eq!((values, ticks.minor.len()), (vec![1.0, 2.0, 3.0], 0));
        assert_eq!(axis.position(2.0), Some(0.5));
        // no two labels on each other
        assert_eq!(Axis::Counted { count: 40 }.ticks(8).major.len(), 8);
    }
}
