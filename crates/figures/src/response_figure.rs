//! Curves of responses in panels over one another: several levels or laps in each, unstable motions dashed.

use super::axis::Axis;
use super::curve;
use super::line_figure::{Scale, axis};
use super::look::Look;
use super::plot::{Drawn, Plot, PlotCurve, PlotPanel, PlotPoints};
use super::strip::{FAINT_TEXT, FONTS, Strip, VALUE_LABELS};
use super::svg::{Lettering, Manner, PathData, Point, Svg};
use super::text;

const WIDTH: f64 = 820.0;
const PANEL_HEIGHT: f64 = 250.0;
/// Of a panel with a phase.
const PHASE_HEIGHT: f64 = 120.0;
const MARGIN: f64 = 14.0;
/// Room for the half of the last label that goes beyond the panel.
const RIGHT: f64 = 26.0;
const TITLE: f64 = 34.0;
/// Of a panel's title and of each line of its key.
const LINE: f64 = 20.0;
const LABELS_BELOW: f64 = 52.0;
const FONT: f64 = 12.5;
const TITLE_FONT: f64 = 15.0;
const SAMPLE_WIDTH: f64 = 26.0;
const BETWEEN_ENTRIES: f64 = 22.0;
const STROKE: f64 = 1.6;
const DASHES: &str = "4 3";

/// Colours of curves: the palette of Okabe and Ito, which the colour-blind can tell apart, without its yellow.
pub const COLOURS: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000",
];

/// Panels.
#[derive(Debug)]
pub struct ResponseFigure<'a> {
    /// Heading of the figure.
    pub title: &'a str,
    /// Said once, beside the title.
    pub note: Option<&'a str>,
    /// One below the other.
    pub panels: Vec<ResponsePanel>,
}

/// Curves over one quantity.
#[derive(Debug)]
pub struct ResponsePanel {
    /// Heading of the panel.
    pub title: String,
    /// Name and unit of the abscissa, and how it is spread.
    pub across: (String, Scale),
    /// Name and unit of the ordinate, and how it is spread.
    pub up: (String, Scale),
    /// What is drawn.
    pub curves: Vec<ResponseCurve>,
}

/// A curve, which may turn back.
#[derive(Debug)]
pub struct ResponseCurve {
    /// In the key; none if empty.
    pub name: String,
    /// Abscissa and ordinate, along the curve.
    pub points: Vec<(f64, f64)>,
    /// Whether each point is dashed; none is if empty.
    pub is_dashed: Vec<bool>,
}

impl ResponseFigure<'_> {
    /// The picture, and the same for a page's script; `None` if there is nothing that can be drawn.
    pub fn drawn(&self) -> Option<Drawn> {
        let svg = self.to_svg()?;
        let mut panels: Vec<PlotPanel> = Vec::new();
        for panel in &self.panels {
            let Some(mut plot) = panel.plot() else {
                continue;
            };
            plot.is_below = panel.up.1 == Scale::Phase
                && panels
                    .last()
                    .is_some_and(|above| above.across == plot.across);
            panels.push(plot);
        }
        let plot = Plot {
            title: self.title.to_owned(),
            columns: 1,
            lines: Vec::new(),
            panels,
        };
        Some(Drawn { svg, plot })
    }

    /// The figure as an SVG document; `None` if there is nothing that can be drawn.
    pub fn to_svg(&self) -> Option<String> {
        let room = WIDTH - MARGIN - RIGHT - VALUE_LABELS;
        let mut top = MARGIN + TITLE;
        let mut laid_out = Vec::new();
        for panel in &self.panels {
            let points = || panel.curves.iter().flat_map(|curve| &curve.points);
            let Some(frequency) = axis(panel.across.1, points().map(|point| point.0)) else {
                continue;
            };
            let power = panel.power();
            let factor = 10_f64.powi(-power);
            let value: Option<Axis> = axis(panel.up.1, points().map(|point| factor * point.1));
            let entries = panel.entries(room);
            let lines = entries.last().map_or(0, |entry| entry.line + 1);
            let title = usize::from(!panel.title.is_empty());
            let begin = top;
            top += LINE * (lines + title) as f64;
            let strip = Strip {
                // Half a pixel off, thin lines are sharp.
                left: MARGIN + VALUE_LABELS + 0.5,
                top: top + 0.5,
                width: room,
                height: panel.height(),
                frequency,
                value,
            };
            top += panel.height() + LABELS_BELOW;
            laid_out.push((panel, strip, entries, begin, power));
        }
        if laid_out.is_empty() {
            return None;
        }
        let mut svg = Svg::new(WIDTH, top, self.title);
        svg.paper(WIDTH, top, None, FONTS);
        self.draw_title(room, &mut svg);
        for (panel, strip, entries, begin, power) in &laid_out {
            panel.draw(strip, entries, *begin, *power, &mut svg);
        }
        Some(svg.finish())
    }

    fn draw_title(&self, room: f64, svg: &mut Svg) {
        let left = MARGIN + VALUE_LABELS;
        let note = self.note.unwrap_or_default();
        let for_note = text::width(note, FONT) + BETWEEN_ENTRIES;
        svg.text(
            (left, MARGIN + TITLE_FONT),
            Lettering::new(TITLE_FONT, Manner::Bold),
            &text::shortened(self.title, TITLE_FONT, room - for_note),
        );
        if !note.is_empty() {
            svg.text(
                (left + room, MARGIN + TITLE_FONT),
                Lettering::new(FONT, Manner::End).in_colour(FAINT_TEXT),
                note,
            );
        }
    }
}

/// A name in the key of a panel.
#[derive(Debug)]
struct Entry<'a> {
    name: &'a str,
    colour: &'static str,
    left: f64,
    line: usize,
}

fn colour(curve: usize) -> &'static str {
    COLOURS[curve % COLOURS.len()]
}

impl ResponsePanel {
    fn height(&self) -> f64 {
        match self.up.1 {
            Scale::Phase => PHASE_HEIGHT,
            Scale::Linear | Scale::Roomy | Scale::Logarithmic => PANEL_HEIGHT,
        }
    }

    fn plot(&self) -> Option<PlotPanel> {
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let across = axis(self.across.1, points().map(|point| point.0))?;
        let power = self.power();
        let factor = 10_f64.powi(-power);
        let up = axis(self.up.1, points().map(|point| factor * point.1));
        let curves = self.curves.iter().enumerate().map(|(n, curve)| {
            let points = curve.points.iter().map(|&(x, y)| (x, factor * y));
            PlotCurve {
                name: curve.name.clone(),
                look: Look::line(colour(n), STROKE),
                points: PlotPoints::Path(points.collect(), curve.is_dashed.clone()),
            }
        });
        Some(PlotPanel::new(
            self.title.clone(),
            self.height(),
            (self.across.0.clone(), across),
            (with_power(&self.up.0, power), up),
            curves.collect(),
        ))
    }

    fn entries(&self, room: f64) -> Vec<Entry<'_>> {
        let (mut left, mut line) = (0.0, 0);
        let mut entries = Vec::new();
        for (n, curve) in self.curves.iter().enumerate() {
            if curve.name.is_empty() {
                continue;
            }
            let width = SAMPLE_WIDTH + 7.0 + text::width(&curve.name, FONT) + BETWEEN_ENTRIES;
            if left > 0.0 && left + width > room {
                (left, line) = (0.0, line + 1);
            }
            entries.push(Entry {
                name: &curve.name,
                colour: colour(n),
                left,
                line,
            });
            left += width;
        }
        entries
    }

    /// Power of ten, a multiple of three, that is taken out of a linear ordinate so that its labels are short.
    fn power(&self) -> i32 {
        if matches!(self.up.1, Scale::Logarithmic | Scale::Phase) {
            return 0;
        }
        let values = self.curves.iter().flat_map(|curve| &curve.points);
        let largest = values
            .map(|point| point.1.abs())
            .filter(|value| value.is_finite())
            .fold(0.0, f64::max);
        if largest == 0.0 || (1e-2..1e4).contains(&largest) {
            return 0;
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the exponent of a double is a small number"
        )]
        let thousands = (largest.log10() / 3.0).floor() as i32;
        3 * thousands
    }

    fn draw(&self, strip: &Strip, entries: &[Entry<'_>], begin: f64, power: i32, svg: &mut Svg) {
        let mut key = begin;
        if !self.title.is_empty() {
            svg.text(
                (strip.left, key + LINE - 7.0),
                Lettering::new(FONT, Manner::Bold),
                &text::shortened(&self.title, FONT, strip.width),
            );
            key += LINE;
        }
        for entry in entries {
            let baseline = key + LINE * (entry.line + 1) as f64 - 7.0;
            let left = strip.left + entry.left;
            let mut sample = PathData::default();
            let y = baseline - 0.36 * FONT;
            sample.polyline(&[left, left + SAMPLE_WIDTH].map(|x| Point { x, y }));
            Look::line(entry.colour, STROKE).draw(&sample, svg);
            svg.text(
                (left + SAMPLE_WIDTH + 7.0, baseline),
                Lettering::new(FONT, Manner::Plain),
                entry.name,
            );
        }
        strip.draw_grid(svg);
        for (n, drawn) in self.curves.iter().enumerate() {
            for (look, piece) in drawn.pieces(colour(n)) {
                let mut path = PathData::default();
                let factor = 10_f64.powi(-power);
                let pieces = match self.up.1 {
                    Scale::Phase => curve::unwrapped_pieces(piece),
                    Scale::Linear | Scale::Roomy | Scale::Logarithmic => vec![piece.to_vec()],
                };
                for piece in pieces {
                    let points = piece.iter().map(|&(x, y)| strip.place((x, factor * y)));
                    curve::line_within(points, strip.height, 0.1, &mut path);
                }
                look.draw(&path, svg);
            }
        }
        strip.draw_axes(&self.across.0, &with_power(&self.up.0, power), svg);
    }
}

/// A quantity's name with the power of ten before its unit: `y, m` becomes `y, 10⁻⁶ m`.
fn with_power(label: &str, power: i32) -> String {
    if power == 0 {
        return label.to_owned();
    }
    let raised: String = power
        .to_string()
        .chars()
        .map(|character| match character {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => digit
                .to_digit(10)
                .and_then(|digit| char::from_u32(0x2070 + digit))
                .unwrap_or(digit),
        })
        .collect();
    match label.split_once(", ") {
        Some((name, unit)) => format!("{name}, 10{raised} {unit}"),
        None => format!("{label}, 10{raised}"),
    }
}

impl ResponseCurve {
    /// Pieces of one look; neighbours share the point between them.
    fn pieces(&self, colour: &'static str) -> Vec<(Look, &[(f64, f64)])> {
        let is_dashed = |n: usize| self.is_dashed.get(n).copied().unwrap_or(false);
        let look = |dashed: bool| match dashed {
            true => Look::dashed(colour, STROKE, DASHES),
            false => Look::line(colour, STROKE),
        };
        let mut pieces = Vec::new();
        let mut from = 0;
        for n in 1..=self.points.len() {
            if n == self.points.len() || is_dashed(n) != is_dashed(from) {
                let end = (n + 1).min(self.points.len());
                pieces.push((look(is_dashed(from)), &self.points[from..end]));
                from = n;
            }
        }
        pieces
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(points: Vec<(f64, f64)>, is_dashed: Vec<bool>) -> Option<String> {
        ResponseFigure {
            title: "a < b",
            note: Some("dashed: unstable"),
            panels: vec![ResponsePanel {
                title: "M8 & M10".to_owned(),
                across: ("frequency, Hz".to_owned(), Scale::Linear),
                up: ("amplitude, m".to_owned(), Scale::Logarithmic),
                curves: vec![ResponseCurve {
                    name: "5 N".to_owned(),
                    points,
                    is_dashed,
                }],
            }],
        }
        .to_svg()
    }

    #[test]
    fn what_is_unstable_is_dashed_and_nothing_is_left_out_between() {
        let points: Vec<(f64, f64)> = [1.0, 2.0, 3.0, 2.5, 2.0, 3.0, 4.0]
            .into_iter()
            .zip([1e-3, 2e-3, 4e-3, 3e-3, 2e-3, 1e-3, 5e-4])
            .collect();
        let is_dashed = [false, false, false, true, true, false, false].to_vec();
        let curve = ResponseCurve {
            name: String::new(),
            points: points.clone(),
            is_dashed: is_dashed.clone(),
        };
        let pieces = curve.pieces("#000000");
        assert_eq!(pieces.len(), 3);
        for pair in pieces.windows(2) {
            assert_eq!(pair[0].1.last(), pair[1].1.first());
        }
        let svg = figure(points, is_dashed).expect("drawable");
        assert_eq!(svg.matches("stroke-dasharray").count(), 1);
        assert!(svg.contains(">M8 &amp; M10</text>") && svg.contains(">5 N</text>"));
    }

    #[test]
    fn small_ordinates_are_shown_in_powers_of_ten() {
        assert_eq!(with_power("b.y, m", -6), "b.y, 10⁻⁶ m");
        assert_eq!(with_power("damping ratio", -12), "damping ratio, 10⁻¹²");
        let panel = |largest: f64| ResponsePanel {
            title: String::new(),
            across: (String::new(), Scale::Linear),
            up: (String::new(), Scale::Linear),
            curves: vec![ResponseCurve {
                name: String::new(),
                points: vec![(0.0, -largest), (1.0, 0.0)],
                is_dashed: Vec::new(),
            }],
        };
        for (largest, power) in [(2.4e-4, -6), (7e-6, -6), (5.0, 0), (3e7, 6), (0.0, 0)] {
            assert_eq!(panel(largest).power(), power);
        }
    }

    #[test]
    fn nothing_to_draw_is_no_figure() {
        assert_eq!(
            ResponseFigure {
                title: "",
                note: None,
                panels: Vec::new()
            }
            .to_svg(),
            None
        );
    }
}
