//! A pressure field seen from above: colours in true proportions, with the plate's outline and its bolts.

use std::collections::BTreeMap;

use bolted_joint_figures::{
    Axis, FONTS, LABELS_BELOW, Lettering, Manner, PathData, Point, Strip, Svg, TEXT, TickLabel,
    VALUE_LABELS,
};
use bolted_joint_predict::pressure::{Bolt, PressureField, Rectangle};

/// Largest width and height of the plate on the page, pixels.
const LARGEST: [f64; 2] = [560.0, 440.0];
/// Smallest side, so that a strip of a plate still has room for its ticks.
const SMALLEST: f64 = 60.0;
const MARGIN: f64 = 14.0;
const BAR: f64 = 18.0;
const BAR_DISTANCE: f64 = 26.0;
const BAR_LABELS: f64 = 74.0;
const FONT: f64 = 12.0;
/// Steps of the colour scale.
const COLOURS: usize = 60;
/// Where nothing presses.
const OPEN: &str = "#eef0f2";
const EDGE: &str = "#1f2328";
/// From little to much: each darker than the one before, also in grey.
const RAMP: [[f64; 3]; 6] = [
    [255.0, 250.0, 219.0],
    [252.0, 215.0, 122.0],
    [245.0, 152.0, 73.0],
    [214.0, 80.0, 68.0],
    [140.0, 35.0, 88.0],
    [56.0, 15.0, 76.0],
];
/// Distance between labelled ticks of the colour scale, pixels.
const TICK_DISTANCE: f64 = 30.0;

/// A pressure field to be drawn.
#[derive(Debug, Clone, Copy)]
pub struct PressureFigure<'a> {
    /// Read out to those who cannot see the picture.
    pub title: &'a str,
    /// The pressures.
    pub field: &'a PressureField,
    /// Width and height of the cells (m), if the field is a grid; otherwise each element is drawn as a square of its area.
    pub cell_m: Option<[f64; 2]>,
    /// The plate; `None`: what the elements span.
    pub outline: Option<Rectangle>,
    /// Bolts, drawn with their preloads.
    pub bolts: &'a [Bolt],
    /// How much wider than its bolt each hole is (m).
    pub clearance_m: f64,
}

/// Where things are on the page.
struct Place {
    strip: Strip,
    /// Pixels in a metre.
    scale: f64,
    x_m: [f64; 2],
    y_m: [f64; 2],
}

impl Place {
    /// A point counted from the plate's upper left corner, pixels.
    fn at(&self, x_m: f64, y_m: f64) -> Point {
        Point {
            x: (x_m - self.x_m[0]) * self.strip.width / (self.x_m[1] - self.x_m[0]),
            y: (self.y_m[1] - y_m) * self.strip.height / (self.y_m[1] - self.y_m[0]),
        }
    }
}

impl PressureFigure<'_> {
    /// The figure as an SVG document; `None` if its elements span no area to draw.
    #[must_use]
    pub fn to_svg(&self) -> Option<String> {
        let place = self.place()?;
        let highest_pa = self
            .field
            .elements()
            .iter()
            .fold(0.0_f64, |highest, element| highest.max(element.pressure_pa));
        let (unit, unit_pa) = match highest_pa {
            high if high >= 1e5 => ("MPa", 1e6),
            high if high >= 1e2 => ("kPa", 1e3),
            _ => ("Pa", 1.0),
        };
        let strip = &place.strip;
        let width = strip.left + strip.width + BAR_DISTANCE + BAR + BAR_LABELS + MARGIN;
        let height = strip.top + strip.height + LABELS_BELOW;
        let mut svg = Svg::new(width, height, self.title);
        svg.paper(width, height, Some(6.0), FONTS);
        strip.draw_grid(&mut svg);
        svg.element("rect")
            .number("width", strip.width)
            .number("height", strip.height)
            .word("fill", OPEN)
            .empty();
        self.draw_cells(&place, highest_pa, &mut svg);
        self.draw_bolts(&place, &mut svg);
        strip.draw_axes("x, mm", "y, mm", &mut svg);
        draw_scale(strip, highest_pa / unit_pa, unit, &mut svg);
        Some(svg.finish())
    }

    fn place(&self) -> Option<Place> {
        let (x_m, y_m) = match &self.outline {
            Some(outline) => (outline.x_m(), outline.y_m()),
            None => {
                let span = |centre: fn(&bolted_joint_predict::pressure::Element) -> f64,
                            axis: usize| {
                    let ends = self.field.elements().iter().map(|element| {
                        let half = 0.5 * self.size_m(element.area_m2)[axis];
                        (centre(element) - half, centre(element) + half)
                    });
                    ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (a, b)| {
                        [low.min(a), high.max(b)]
                    })
                };
                (span(|e| e.x_m, 0), span(|e| e.y_m, 1))
            }
        };
        let (width_m, height_m) = (x_m[1] - x_m[0], y_m[1] - y_m[0]);
        if !(width_m.is_finite() && height_m.is_finite() && width_m > 0.0 && height_m > 0.0) {
            return None;
        }
        let scale = (LARGEST[0] / width_m).min(LARGEST[1] / height_m);
        let axis = |[low, high]: [f64; 2]| Axis::Linear {
            low: 1e3 * low,
            high: 1e3 * high,
        };
        Some(Place {
            strip: Strip {
                // Half a pixel off, thin lines are sharp.
                left: MARGIN + VALUE_LABELS + 0.5,
                top: MARGIN + 0.5,
                width: (width_m * scale).max(SMALLEST),
                height: (height_m * scale).max(SMALLEST),
                frequency: axis(x_m),
                value: Some(axis(y_m)),
            },
            scale,
            x_m,
            y_m,
        })
    }

    fn size_m(&self, area_m2: f64) -> [f64; 2] {
        self.cell_m.unwrap_or([area_m2.sqrt(); 2])
    }

    /// One path for each colour; neighbours in a row that have the same colour are one rectangle of it.
    fn draw_cells(&self, place: &Place, highest_pa: f64, svg: &mut Svg) {
        let mut runs: BTreeMap<usize, Vec<[Point; 2]>> = BTreeMap::new();
        for element in self.field.elements() {
            if element.pressure_pa <= 0.0 {
                continue;
            }
            let [width_m, height_m] = self.size_m(element.area_m2);
            let (x_m, y_m) = (element.x_m, element.y_m);
            let upper = place.at(x_m - 0.5 * width_m, y_m + 0.5 * height_m);
            let lower = place.at(x_m + 0.5 * width_m, y_m - 0.5 * height_m);
            let runs = runs
                .entry(colour(element.pressure_pa / highest_pa))
                .or_default();
            let near = |a: f64, b: f64| (a - b).abs() < 1e-3;
            match runs.last_mut() {
                Some([from, to])
                    if near(to.x, upper.x) && near(from.y, upper.y) && near(to.y, lower.y) =>
                {
                    to.x = lower.x;
                }
                _ => runs.push([upper, lower]),
            }
        }
        svg.element("g")
            .word("shape-rendering", "crispEdges")
            .open();
        for (colour, runs) in runs {
            let mut path = PathData::default();
            for [from, to] in runs {
                path.move_to(from);
                path.line_to(Point { x: to.x, y: from.y });
                path.line_to(to);
                path.line_to(Point { x: from.x, y: to.y });
            }
            svg.element("path")
                .word("d", path.as_str())
                .word("fill", &shade(colour))
                .empty();
        }
        svg.close();
    }

    fn draw_bolts(&self, place: &Place, svg: &mut Svg) {
        let circle = |svg: &mut Svg, centre: Point, radius: f64, fill: &str, stroke: &str| {
            svg.element("circle")
                .number("cx", centre.x)
                .number("cy", centre.y)
                .number("r", radius)
                .word("fill", fill)
                .word("stroke", stroke)
                .empty();
        };
        for bolt in self.bolts {
            let centre = place.at(bolt.x_m, bolt.y_m);
            let radius = 0.5 * bolt.diameter_m * place.scale;
            let hole = radius + 0.5 * self.clearance_m * place.scale;
            circle(svg, centre, hole, "#ffffff", EDGE);
            circle(svg, centre, radius, "#c9ced4", "#6e7781");
        }
        for (number, bolt) in (1..).zip(self.bolts) {
            let centre = place.at(bolt.x_m, bolt.y_m);
            let radius = 0.5 * (bolt.diameter_m + self.clearance_m) * place.scale;
            // The white edge keeps the text legible on any colour.
            let label = format!("{number}: {} kN", three_digits(1e-3 * bolt.preload_n));
            svg.element("text")
                .number("x", centre.x)
                .number("y", centre.y + radius + 1.2 * FONT)
                .number("font-size", FONT)
                .word("text-anchor", "middle")
                .word("fill", TEXT)
                .word("stroke", "#ffffff")
                .number("stroke-width", 3.0)
                .word("stroke-linejoin", "round")
                .word("paint-order", "stroke")
                .containing(&label);
        }
    }
}

/// The colour scale, to the right of the plate.
fn draw_scale(strip: &Strip, highest: f64, unit: &str, svg: &mut Svg) {
    let (left, top) = (strip.left + strip.width + BAR_DISTANCE, strip.top);
    // A thin strip of a plate has a scale that goes down beside its labels.
    let height = (2.0 * SMALLEST)
        .max(strip.height)
        .min(strip.height + LABELS_BELOW - MARGIN);
    svg.element("g")
        .word("shape-rendering", "crispEdges")
        .open();
    for place in 0..COLOURS {
        let step = height / COLOURS as f64;
        svg.element("rect")
            .number("x", left)
            .number("y", top + height - (place + 1) as f64 * step)
            .number("width", BAR)
            .number("height", step + 0.3)
            .word("fill", &shade(place))
            .empty();
    }
    svg.close();
    svg.element("rect")
        .number("x", left)
        .number("y", top)
        .number("width", BAR)
        .number("height", height)
        .word("fill", "none")
        .word("stroke", "#6e7781")
        .empty();
    let axis = Axis::Linear {
        low: 0.0,
        high: if highest > 0.0 { highest } else { 1.0 },
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a few ticks"
    )]
    let ticks = axis.ticks((height / TICK_DISTANCE).max(2.0) as u32);
    for tick in ticks.major {
        let (Some(up), TickLabel::Plain(label)) = (axis.position(tick.value), tick.label) else {
            continue;
        };
        let y = top + height * (1.0 - up);
        let mut mark = PathData::default();
        mark.polyline(&[
            Point { x: left + BAR, y },
            Point {
                x: left + BAR + 4.0,
                y,
            },
        ]);
        bolted_joint_figures::draw_path(svg, &mark, "#6e7781", 1.0);
        svg.text(
            (left + BAR + 7.0, y + 0.36 * FONT),
            Lettering::new(FONT, Manner::Plain),
            &label,
        );
    }
    let (x, y) = (left + BAR + 46.0, top + 0.5 * height);
    svg.element("text")
        .word("transform", &format!("translate({x} {y}) rotate(90)"))
        .number("font-size", FONT)
        .word("text-anchor", "middle")
        .word("fill", TEXT)
        .containing(&format!("pressure, {unit}"));
}

/// Step of the colour scale for a part of the highest pressure.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between zero and the number of colours"
)]
fn colour(part: f64) -> usize {
    ((part * COLOURS as f64) as usize).min(COLOURS - 1)
}

fn shade(colour: usize) -> String {
    let along = (colour as f64 + 0.5) / COLOURS as f64 * (RAMP.len() - 1) as f64;
    let mut start = 0;
    while start + 2 < RAMP.len() && along >= (start + 1) as f64 {
        start += 1;
    }
    let part = along - start as f64;
    let channel = |channel: usize| {
        (RAMP[start][channel] * (1.0 - part) + RAMP[start + 1][channel] * part).round()
    };
    format!("rgb({} {} {})", channel(0), channel(1), channel(2))
}

/// A number with three digits that count.
fn three_digits(value: f64) -> String {
    match value.abs() {
        size if size >= 99.95 => format!("{value:.0}"),
        size if size >= 9.995 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bolted_joint_predict::pressure::{Element, bolts_in_rows};

    #[test]
    fn a_plate_keeps_its_proportions_and_its_rows_are_merged() {
        let outline = Rectangle::centred(0.3, 0.1).expect("a rectangle");
        let field = PressureField::uniform(&outline, [60, 20], 3e4).expect("a field");
        let bolts = bolts_in_rows([2, 1], [0.2, 0.0], 0.016, 15e3).expect("bolts");
        let svg = PressureFigure {
            title: "a < b",
            field: &field,
            cell_m: Some([0.005, 0.005]),
            outline: Some(outline),
            bolts: &bolts,
            clearance_m: 0.001,
        }
        .to_svg()
        .expect("drawable");
        let plate = format!("width=\"560\" height=\"186.67\" fill=\"{OPEN}\"");
        assert!(svg.contains(&plate), "{svg}");
        // One colour, and one rectangle for each of 20 rows.
        let cells = svg
            .split("<path d=\"")
            .find(|path| path.contains("fill=\"rgb("))
            .and_then(|path| path.split('"').next())
            .expect("cells");
        assert_eq!(cells.matches('m').count(), 20);
        assert!(svg.contains(">1: 15.0 kN</text>") && svg.contains(">pressure, MPa</text>"));
        assert_eq!(svg.matches("<circle ").count(), 4);
    }

    #[test]
    fn elements_without_a_grid_are_squares_of_their_area() {
        let element = Element {
            x_m: 0.0,
            y_m: 0.0,
            area_m2: 4e-6,
            pressure_pa: 50.0,
        };
        let field = PressureField::new(vec![element]).expect("a field");
        let svg = PressureFigure {
            title: "",
            field: &field,
            cell_m: None,
            outline: None,
            bolts: &[],
            clearance_m: 0.0,
        }
        .to_svg()
        .expect("drawable");
        assert!(
            svg.contains("width=\"440\" height=\"440\"") && svg.contains(">pressure, Pa</text>")
        );
        assert!(svg.contains(">−1.0</text>") && svg.contains(">1.0</text>"));
    }

    #[test]
    fn more_pressure_is_darker() {
        let lightness = |colour: usize| -> f64 {
            let text = shade(colour);
            let inner = text.trim_start_matches("rgb(").trim_end_matches(')');
            let channels: Vec<f64> = inner.split(' ').map(|c| c.parse().expect("c")).collect();
            0.2126 * channels[0] + 0.7152 * channels[1] + 0.0722 * channels[2]
        };
        assert!((1..COLOURS).all(|step| lightness(step) < lightness(step - 1)));
    }
}
