//! A small figure of calculated curves over one quantity, for a page rather than for a report.

use super::axis::Axis;
use super::curve;
use super::look::Look;
use super::plot::{Drawn, Plot, PlotCurve, PlotPanel, PlotPoints};
use super::strip::{FONTS, LABELS_BELOW, Strip, VALUE_LABELS};
use super::svg::{Lettering, Manner, PathData, Point, Svg};
use super::text;

const WIDTH: f64 = 640.0;
const STRIP_HEIGHT: f64 = 240.0;
const MARGIN: f64 = 14.0;
/// Room for the half of the last label that goes beyond the strip.
const RIGHT: f64 = 24.0;
const LEGEND: f64 = 30.0;
const FONT: f64 = 12.5;
const SAMPLE_WIDTH: f64 = 26.0;
const BETWEEN_ENTRIES: f64 = 24.0;
/// Width of a curve.
const STROKE: f64 = 1.8;
/// Radius of a point.
const MARK: f64 = 2.6;
/// Beyond the ends of a roomy axis, as a part of what is between them.
const ROOM: f64 = 0.06;
/// Decades that a logarithmic axis shows at most.
const DECADES: i32 = 9;

/// Blue, vermilion, green and orange of the palette of Okabe and Ito, which the colour-blind can tell apart, and the
/// dashes that tell them apart in print.
const LOOKS: [(&str, Option<&str>); 4] = [
    ("#0072b2", None),
    ("#d55e00", Some("7 3")),
    ("#009e73", Some("2 3")),
    ("#e69f00", Some("9 3 2 3")),
];

/// How an axis spreads its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// Evenly, with room beyond both ends: a closed loop would lie on the frame without it.
    Roomy,
    /// By decades.
    Logarithmic,
    /// An angle over one turn, degrees.
    Phase,
}

/// How the points of a line are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Connected.
    Curve,
    /// One by one, as what was measured.
    Marks,
}

/// A curve, or points, and its name.
#[derive(Debug)]
pub struct Line {
    /// Its name in the key.
    pub name: String,
    /// How its points are shown.
    pub shape: Shape,
    /// Abscissa and ordinate, by abscissa.
    pub points: Vec<(f64, f64)>,
}

impl Line {
    /// Points that are connected.
    pub fn curve(name: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self {
            name: name.into(),
            shape: Shape::Curve,
            points: points.into_iter().collect(),
        }
    }

    /// Points one by one, as what was measured.
    pub fn marks(name: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self {
            shape: Shape::Marks,
            ..Self::curve(name, points)
        }
    }
}

/// Curves in one strip.
///
/// ```
/// use bolted_joint_figures::{Line, LineFigure, Scale};
///
/// let figure = LineFigure {
///     title: "hardening spring",
///     across: ("displacement / µm", Scale::Linear),
///     up: ("load / N", Scale::Linear),
///     lines: vec![Line::curve("cubic", (0..=50).map(f64::from).map(|r| (r, r + 1e-3 * r.powi(3))))],
/// };
/// assert!(figure.to_svg().is_some_and(|svg| svg.contains("hardening spring")));
/// ```
#[derive(Debug)]
pub struct LineFigure<'a> {
    /// Read out to those who cannot see the picture.
    pub title: &'a str,
    /// Name and unit of the abscissa, and how it is spread.
    pub across: (&'a str, Scale),
    /// Name and unit of the ordinate, and how it is spread.
    pub up: (&'a str, Scale),
    /// At most four.
    pub lines: Vec<Line>,
}

impl LineFigure<'_> {
    /// The picture, and the same for a page's script; `None` if there is nothing that can be drawn.
    pub fn drawn(&self) -> Option<Drawn> {
        let svg = self.to_svg()?;
        let [across, up] = self.axes()?;
        let curves = self
            .lines
            .iter()
            .zip(LOOKS)
            .map(|(line, (colour, dashes))| {
                let look = match (line.shape, dashes) {
                    (Shape::Marks, _) => Look::dots(colour, 2.0 * MARK),
                    (Shape::Curve, Some(dashes)) => Look::dashed(colour, STROKE, dashes),
                    (Shape::Curve, None) => Look::line(colour, STROKE),
                };
                PlotCurve {
                    name: line.name.clone(),
                    look,
                    points: PlotPoints::Path(line.points.clone(), Vec::new()),
                }
            });
        let panel = PlotPanel::new(
            "",
            STRIP_HEIGHT,
            (self.across.0, across),
            (self.up.0, Some(up)),
            curves.collect(),
        );
        let plot = Plot {
            title: self.title.to_owned(),
            columns: 1,
            lines: Vec::new(),
            panels: vec![panel],
        };
        Some(Drawn { svg, plot })
    }

    fn axes(&self) -> Option<[Axis; 2]> {
        let points = || self.lines.iter().flat_map(|line| &line.points);
        Some([
            axis(self.across.1, points().map(|point| point.0))?,
            axis(self.up.1, points().map(|point| point.1))?,
        ])
    }

    /// The figure as an SVG document; `None` if there is nothing that can be drawn.
    pub fn to_svg(&self) -> Option<String> {
        let [across, up] = self.axes()?;
        let strip = Strip {
            // Half a pixel off, thin lines are sharp.
            left: MARGIN + VALUE_LABELS + 0.5,
            top: LEGEND + 0.5,
            width: WIDTH - MARGIN - RIGHT - VALUE_LABELS,
            height: STRIP_HEIGHT,
            frequency: across,
            value: Some(up),
        };
        let height = LEGEND + STRIP_HEIGHT + LABELS_BELOW;
        let mut svg = Svg::new(WIDTH, height, self.title);
        svg.paper(WIDTH, height, Some(6.0), FONTS);
        self.draw_legend(&strip, &mut svg);
        strip.draw_grid(&mut svg);
        for (line, look) in self.lines.iter().zip(LOOKS) {
            let points = line.points.iter().map(|&point| strip.place(point));
            match line.shape {
                Shape::Curve => {
                    let mut path = PathData::default();
                    curve::line(points, strip.height, &mut path);
                    draw(&path, look, &mut svg);
                }
                Shape::Marks => points
                    .flatten()
                    .filter(|point| (0.0..=strip.height).contains(&point.y))
                    .for_each(|point| draw_mark(point, look.0, &mut svg)),
            }
        }
        strip.draw_axes(self.across.0, self.up.0, &mut svg);
        Some(svg.finish())
    }

    fn draw_legend(&self, strip: &Strip, svg: &mut Svg) {
        let (mut x, baseline) = (strip.left, LEGEND - 10.0);
        for (line, look) in self.lines.iter().zip(LOOKS) {
            let y = baseline - 0.36 * FONT;
            match line.shape {
                Shape::Curve => {
                    let end = x + SAMPLE_WIDTH;
                    let mut sample = PathData::default();
                    sample.polyline(&[Point { x, y }, Point { x: end, y }]);
                    draw(&sample, look, svg);
                }
                Shape::Marks => draw_mark(
                    Point {
                        x: x + 0.5 * SAMPLE_WIDTH,
                        y,
                    },
                    look.0,
                    svg,
                ),
            }
            x += SAMPLE_WIDTH + 7.0;
            svg.text(
                (x, baseline),
                Lettering::new(FONT, Manner::Plain),
                &line.name,
            );
            x += text::width(&line.name, FONT) + BETWEEN_ENTRIES;
        }
    }
}

pub(crate) fn axis(scale: Scale, values: impl Iterator<Item = f64>) -> Option<Axis> {
    match scale {
        Scale::Linear => Some(Axis::linear(values)),
        Scale::Roomy => {
            let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let room = ROOM * (high - low);
            let ends = [low - room, high + room];
            Some(Axis::linear(ends.into_iter()))
        }
        Scale::Logarithmic => Axis::logarithmic(values, DECADES),
        Scale::Phase => Some(Axis::Phase),
    }
}

fn draw_mark(point: Point, colour: &str, svg: &mut Svg) {
    svg.element("circle")
        .number("cx", point.x)
        .number("cy", point.y)
        .number("r", MARK)
        .word("fill", colour)
        .empty();
}

fn draw(path: &PathData, (colour, dashes): (&str, Option<&str>), svg: &mut Svg) {
    if path.is_empty() {
        return;
    }
    let element = svg
        .element("path")
        .word("d", path.as_str())
        .word("fill", "none")
        .word("stroke", colour)
        .number("stroke-width", STROKE)
        .word("stroke-linejoin", "round");
    match dashes {
        Some(dashes) => element.word("stroke-dasharray", dashes),
        None => element,
    }
    .empty();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_roomy_axis_goes_beyond_what_is_finite() {
        let ends = |scale, values: &[f64]| axis(scale, values.iter().copied());
        let found = ends(Scale::Roomy, &[-1.0, f64::NAN, 3.0]);
        assert_eq!(found, ends(Scale::Linear, &[-1.24, 3.24]));
        // nothing, and a single value, are as without room
        for values in [&[][..], &[2.0]] {
            assert_eq!(ends(Scale::Roomy, values), ends(Scale::Linear, values));
        }
    }

    fn figure(points: Vec<(f64, f64)>) -> Option<String> {
        LineFigure {
            title: "a < b",
            across: ("frequency, Hz", Scale::Logarithmic),
            up: ("force, N", Scale::Linear),
            lines: vec![Line::curve("F & M", points)],
        }
        .to_svg()
    }

    #[test]
    fn a_power_law_is_straight_between_the_ends_of_its_axes() {
        let frequencies = (0..=100).map(|k| 10_f64.powf(1.0 + 0.02 * f64::from(k)));
        let svg = figure(frequencies.map(|f| (f, f.log10())).collect()).expect("drawable");
        assert!(svg.contains("<title>a &lt; b</title>") && svg.contains(">F &amp; M</text>"));
        assert!(svg.contains(">100</text>") && svg.contains(">frequency, Hz</text>"));
        // The axis goes from 5 to 2000 Hz; the curve from 10 to 1000 Hz, from the bottom to the top.
        let curves: Vec<&str> = svg.split("<path d=\"m").skip(1).collect();
        let curve = curves.iter().find(|path| path.matches('l').count() > 50);
        let start = curve
            .and_then(|path| path.split('l').next())
            .expect("a curve");
        let (x, y) = start.split_once(' ').expect("a point");
        let width = WIDTH - MARGIN - RIGHT - VALUE_LABELS;
        let expected = width * 2_f64.log10() / 400_f64.log10();
        assert!(
            (x.parse::<f64>().expect("x") - expected).abs() < 0.01,
            "{x}"
        );
        assert!(
            (y.parse::<f64>().expect("y") - STRIP_HEIGHT).abs() < 0.01,
            "{y}"
        );
    }

    #[test]
    fn what_was_measured_is_drawn_point_by_point() {
        let points = vec![(1.0, 1.0), (2.0, 4.0), (3.0, 9.0)];
        let svg = LineFigure {
            title: "points",
            across: ("x", Scale::Linear),
            up: ("y", Scale::Linear),
            lines: vec![Line::marks("measured", points)],
        }
        .to_svg()
        .expect("drawable");
        // Three points and the one of the legend.
        assert_eq!(svg.matches("<circle ").count(), 4);
    }

    #[test]
    fn nothing_to_draw_is_no_figure() {
        assert_eq!(figure(vec![(-1.0, 1.0)]), None);
        assert_eq!(figure(Vec::new()), None);
    }
}
