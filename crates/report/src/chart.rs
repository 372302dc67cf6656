//! A picture of curves over one frequency axis, strips over one another: drawn here for paper and for browsers without
//! scripts, and described for the script that zooms into it.

use super::frf_figure::FONTS;
use super::legend::Key;
use super::resonance_labels::{RESONANCE_LABELS, draw_resonance_labels};
use bolted_joint_figures::curve::{self, Sample};
use bolted_joint_figures::{Axis, Look, PathData, Strip, Svg, VALUE_LABELS};
use num_complex::Complex64;

pub(super) const WIDTH: f64 = 960.0;
const RIGHT_MARGIN: f64 = 24.0;
const TOP_MARGIN: f64 = 6.0;
const BETWEEN_STRIPS: f64 = 14.0;
const FREQUENCY_LABELS: f64 = 44.0;
/// Sides of the squares that show one dot at most, and how far a line may pass from its points (pixels).
const DOT_CELL: f64 = 2.0;
const LINE_TOLERANCE: f64 = 0.15;

const BAND_COLOUR: &str = "#f0e442";
const LEVEL_COLOUR: &str = "#009e73";

/// Curves over frequency.
#[derive(Debug)]
pub(super) struct Chart<'a> {
    /// Name within the page, letters, digits and hyphens.
    pub(super) id: String,
    /// Read out to those who cannot see the picture.
    pub(super) title: String,
    /// Ascending (Hz).
    pub(super) frequency_hz: &'a [f64],
    /// From top to bottom.
    pub(super) strips: Vec<ChartStrip>,
    /// A function whose resonances are marked, where there is one.
    pub(super) resonating: Option<&'a [Complex64]>,
}

/// One strip of a [`Chart`].
#[derive(Debug)]
pub(super) struct ChartStrip {
    /// What is shown.
    pub(super) name: String,
    /// Its unit, with a power of ten where the values are scaled; may be empty.
    pub(super) unit: String,
    /// Pixels.
    pub(super) height: f64,
    /// `None` if nothing can be drawn.
    pub(super) axis: Option<Axis>,
    pub(super) curves: Vec<Curve>,
    /// Ranges of frequency (Hz) that are shaded.
    pub(super) bands: Vec<[f64; 2]>,
    /// A value with its interval, drawn across.
    pub(super) level: Option<Level>,
}

/// A curve of a [`ChartStrip`].
#[derive(Debug)]
pub(super) struct Curve {
    pub(super) name: String,
    pub(super) look: Look,
    /// One for each line; what is not finite leaves a gap.
    pub(super) values: Vec<f64>,
}

/// A value that does not depend on frequency.
#[derive(Debug, Clone, Copy)]
pub(super) struct Level {
    pub(super) value: f64,
    pub(super) interval: [f64; 2],
}

impl Level {
    pub(super) const LOOK: Look = Look::line(LEVEL_COLOUR, 1.6);
}

impl Chart<'_> {
    /// The strips where they lie on the page, and the page's height (pixels).
    pub(super) fn laid_out(&self) -> (Vec<Strip>, f64) {
        // Half a pixel off, thin lines are sharp.
        let mut top = TOP_MARGIN + 0.5;
        if self.resonating.is_some() {
            top += RESONANCE_LABELS;
        }
        let left = VALUE_LABELS + 0.5;
        let frequency = Axis::linear(self.frequency_hz.iter().copied());
        let strips = self.strips.iter().map(|strip| {
            let laid_out = Strip {
                left,
                top,
                width: WIDTH - RIGHT_MARGIN - VALUE_LABELS,
                height: strip.height,
                frequency,
                value: strip.axis,
            };
            top += strip.height + BETWEEN_STRIPS;
            laid_out
        });
        let strips = strips.collect();
        (strips, (top - BETWEEN_STRIPS + FREQUENCY_LABELS).ceil())
    }

    /// The picture as an SVG element.
    pub(super) fn to_svg(&self) -> String {
        let (strips, height) = self.laid_out();
        let mut svg = Svg::new(WIDTH, height, &self.title);
        svg.paper(WIDTH, height, None, FONTS);
        let mut marks = Vec::new();
        if let (Some(function), Some(strip)) = (self.resonating, strips.first()) {
            marks = draw_resonance_labels(self.frequency_hz, function, strip, &mut svg);
        }
        for (strip, shown) in strips.iter().zip(&self.strips) {
            strip.draw_grid(&mut svg);
            draw_areas(shown, strip, &mut svg);
            let mut uprights = PathData::default();
            for mark in &marks {
                strip.upright(mark.frequency_hz, 0.0, strip.height, &mut uprights);
            }
            Key::Resonance.draw(&uprights, &mut svg);
            for curve in &shown.curves {
                curve.look.draw(&self.path(curve, strip), &mut svg);
            }
            if strip.value.is_none() {
                strip.draw_no_data(&mut svg);
            }
            strip.draw_frame(&mut svg);
            strip.draw_value_labels(&shown.label(), &mut svg);
        }
        if let Some(lowest) = strips.last() {
            lowest.draw_frequency_labels(&mut svg);
        }
        svg.finish()
    }

    fn path(&self, drawn: &Curve, strip: &Strip) -> PathData {
        let mut path = PathData::default();
        let samples = self.frequency_hz.iter().copied();
        let samples: Vec<Sample> = samples.zip(drawn.values.iter().copied()).collect();
        let place = |samples: &[Sample]| -> Vec<_> {
            samples.iter().map(|&sample| strip.place(sample)).collect()
        };
        if drawn.look.is_dots {
            let points = place(&samples).into_iter();
            curve::dots_apart(points, strip.height, DOT_CELL, &mut path);
            return path;
        }
        let pieces = match strip.value {
            Some(Axis::Phase) => curve::unwrapped_pieces(&samples),
            _ => vec![samples],
        };
        for piece in &pieces {
            let points = place(piece).into_iter();
            curve::line_within(points, strip.height, LINE_TOLERANCE, &mut path);
        }
        path
    }
}

impl ChartStrip {
    /// What stands beside the axis.
    pub(super) fn label(&self) -> String {
        match self.unit.as_str() {
            "" => self.name.clone(),
            unit => format!("{}, {unit}", self.name),
        }
    }
}

/// Shades bands and the interval of the level, and draws the level.
fn draw_areas(shown: &ChartStrip, strip: &Strip, svg: &mut Svg) {
    for band in &shown.bands {
        let ends = band.map(|hz| strip.place_frequency(hz).map(|x| x.clamp(0.0, strip.width)));
        if let [Some(from), Some(to)] = ends {
            svg.element("rect")
                .number("x", from)
                .number("width", to - from)
                .number("height", strip.height)
                .word("fill", BAND_COLOUR)
                .word("fill-opacity", ".3")
                .empty();
        }
    }
    let Some(level) = shown.level else { return };
    let height_of = |value: f64| {
        let up = strip.value.and_then(|axis| axis.position(value))?;
        Some(strip.height * (1.0 - up))
    };
    if let [Some(low), Some(high)] = level.interval.map(height_of) {
        let (top, bottom) = (high.clamp(0.0, strip.height), low.clamp(0.0, strip.height));
        svg.element("rect")
            .number("y", top)
            .number("width", strip.width)
            .number("height", bottom - top)
            .word("fill", LEVEL_COLOUR)
            .word("fill-opacity", ".22")
            .empty();
    }
    if let Some(y) = height_of(level.value).filter(|y| (0.0..=strip.height).contains(y)) {
        let mut path = PathData::default();
        let end = |x| bolted_joint_figures::Point { x, y };
        path.polyline(&[end(0.0), end(strip.width)]);
        Level::LOOK.draw(&path, svg);
    }
}
