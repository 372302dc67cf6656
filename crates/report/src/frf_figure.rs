//! Measured frequency response functions against regenerated ones: magnitude, phase and what is left between them.

use num_complex::Complex64;

use super::frf_column::{self, Column, ColumnAxes};
use super::legend::{Key, draw_legend};
use bolted_joint_figures::curve::{self, Sample};
use bolted_joint_figures::text::wrapped;
use bolted_joint_figures::{Axis, FAINT_TEXT, Lettering, Manner, Svg, VALUE_LABELS};
use bolted_joint_frf::resonances;

pub(super) const FONTS: &str = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif";
const PAGE_WIDTH: f64 = 960.0;
const MARGIN: f64 = 18.0;
/// Distance between columns that share their magnitude axis (pixels).
const BETWEEN_COLUMNS: f64 = 26.0;
const MOST_COLUMNS: usize = 3;

const TITLE_FONT: f64 = 18.0;
const SUBTITLE_FONT: f64 = 13.0;
const TITLE_LINE: f64 = 24.0;
const SUBTITLE_LINE: f64 = 18.0;
const LEGEND: f64 = 34.0;

/// Powers of ten that magnitudes and residuals show at most.
pub(super) const MAGNITUDE_DECADES: i32 = 10;
const RESIDUAL_DECADES: i32 = 5;
/// One in so many residuals, the smallest ones, may fall below their axis.
const RESIDUALS_ABOVE_AXIS: usize = 50;

/// A figure of frequency response functions: a column for each, magnitude over phase over residual.
///
/// Its texts can be selected, its colours can be told apart by the colour-blind, and it brings its own white page,
/// so that it looks the same in a dark document. The same data give the same file to the last byte.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfFigure<'a> {
    /// First line, in bold.
    pub title: &'a str,
    /// Below the title, wrapped if long. May be empty.
    pub subtitle: &'a str,
    /// Frequencies of the lines, ascending (Hz).
    pub frequency_hz: &'a [f64],
    /// One for each function. Up to three stand side by side, more in several rows. Panels of the same unit share
    /// one magnitude axis.
    pub panels: Vec<FrfPanel<'a>>,
}

/// One function in an [`FrfFigure`].
///
/// Each curve has one value for each line, or none at all if there is no such curve. Values that are zero or not
/// finite leave a gap.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfPanel<'a> {
    /// Between which degrees of freedom, as in "12:+Y / 12:+Y".
    pub label: String,
    /// Unit of the values, as in "m/N".
    pub unit: &'a str,
    /// What was measured, drawn as dots.
    pub measured: &'a [Complex64],
    /// What the identified model gives, drawn as a line. Its resonances are marked.
    pub regenerated: &'a [Complex64],
    /// The structure without the joint, drawn as a dashed line. The axes do not stretch for it.
    pub uncoupled: Option<&'a [Complex64]>,
}

impl FrfPanel<'_> {
    pub(super) fn residuals(&self, frequency_hz: &[f64]) -> Vec<Sample> {
        curve::residual(frequency_hz, self.measured, self.regenerated)
    }
}

impl FrfFigure<'_> {
    /// The figure as an SVG document, 960 pixels wide.
    #[must_use]
    pub fn to_svg(&self) -> String {
        let room = PAGE_WIDTH - 2.0 * MARGIN;
        let title = wrapped(self.title, TITLE_FONT, room);
        let subtitle = wrapped(self.subtitle, SUBTITLE_FONT, room);
        let columns = self.columns();
        let row_height = frf_column::height(self.has_residuals());
        let head = MARGIN
            + TITLE_LINE * length(title.len())
            + SUBTITLE_LINE * length(subtitle.len())
            + LEGEND;
        let rows = self.panels.len().div_ceil(columns).max(1);
        let height = head + row_height * length(rows);

        let mut svg = Svg::new(PAGE_WIDTH, height, self.title);
        svg.paper(PAGE_WIDTH, height, Some(6.0), FONTS);
        self.draw_head(&title, &subtitle, &mut svg);
        for (row, panels) in self.panels.chunks(columns).enumerate() {
            self.draw_row(panels, columns, head + row_height * length(row), &mut svg);
        }
        if self.panels.is_empty() {
            svg.text(
                (0.5 * PAGE_WIDTH, head + 0.5 * row_height),
                Lettering::new(SUBTITLE_FONT, Manner::Middle).in_colour(FAINT_TEXT),
                "no functions",
            );
        }
        svg.finish()
    }

    fn draw_head(&self, title: &[String], subtitle: &[String], svg: &mut Svg) {
        let mut baseline = MARGIN - 6.0;
        for line in title {
            baseline += TITLE_LINE;
            svg.text(
                (MARGIN, baseline),
                Lettering::new(TITLE_FONT, Manner::Bold),
                line,
            );
        }
        for line in subtitle {
            baseline += SUBTITLE_LINE;
            svg.text(
                (MARGIN, baseline),
                Lettering::new(SUBTITLE_FONT, Manner::Plain).in_colour(FAINT_TEXT),
                line,
            );
        }
        draw_legend(&self.keys(), MARGIN, baseline + 24.0, svg);
    }

    fn draw_row(&self, panels: &[FrfPanel<'_>], columns: usize, top: f64, svg: &mut Svg) {
        let frequency = Axis::linear(self.frequency_hz.iter().copied());
        let residual = self.has_residuals().then(|| self.residual_axis());
        let gap = |column: usize| match column {
            0 => VALUE_LABELS,
            _ if self
                .panels
                .chunks(columns)
                .any(|row| has_own_axis(row, column)) =>
            {
                VALUE_LABELS + BETWEEN_COLUMNS
            }
            _ => BETWEEN_COLUMNS,
        };
        let gaps: f64 = (0..columns).map(gap).sum();
        let width = ((PAGE_WIDTH - 2.0 * MARGIN - gaps) / length(columns)).floor();

        // Half a pixel off, thin lines are sharp.
        let mut left = MARGIN + 0.5;
        for (column, panel) in panels.iter().enumerate() {
            left += gap(column);
            let axes = ColumnAxes {
                frequency,
                magnitude: self.magnitude_axis(panel.unit),
                residual,
            };
            let drawn = Column::new(panel, self.frequency_hz, axes, (left, top + 0.5), width);
            drawn.draw(svg);
            if has_own_axis(panels, column) {
                drawn.draw_magnitude_labels(svg);
            }
            if column == 0 {
                drawn.draw_common_labels(svg);
            }
            left += width;
        }
    }

    /// As few rows as will do, filled evenly.
    fn columns(&self) -> usize {
        let panels = self.panels.len().max(1);
        panels.div_ceil(panels.div_ceil(MOST_COLUMNS))
    }

    fn keys(&self) -> Vec<Key> {
        let any = |has: fn(&FrfPanel<'_>) -> bool| self.panels.iter().any(has);
        let keys = [
            (Key::Measured, any(|panel| !panel.measured.is_empty())),
            (Key::Regenerated, any(|panel| !panel.regenerated.is_empty())),
            (Key::Uncoupled, any(|panel| panel.uncoupled.is_some())),
            (Key::Resonance, self.has_resonances()),
        ];
        let shown = keys.into_iter().filter(|(_, shown)| *shown);
        shown.map(|(key, _)| key).collect()
    }

    fn has_resonances(&self) -> bool {
        let mut panels = self.panels.iter();
        panels.any(|panel| !resonances(self.frequency_hz, panel.regenerated).is_empty())
    }

    fn has_residuals(&self) -> bool {
        let mut panels = self.panels.iter();
        panels.any(|panel| !panel.measured.is_empty() && !panel.regenerated.is_empty())
    }

    /// The axis that all panels of one unit share.
    fn magnitude_axis(&self, unit: &str) -> Option<Axis> {
        let panels = self.panels.iter().filter(|panel| panel.unit == unit);
        let values = panels.flat_map(|panel| panel.measured.iter().chain(panel.regenerated));
        Axis::logarithmic(values.map(|value| value.norm()), MAGNITUDE_DECADES)
    }

    fn residual_axis(&self) -> Option<Axis> {
        let panels = self.panels.iter();
        let samples = panels.flat_map(|panel| panel.residuals(self.frequency_hz));
        residual_axis(samples.map(|sample| sample.1))
    }
}

/// An axis for residuals (%), of which the smallest few may fall below it.
pub(super) fn residual_axis(residuals: impl Iterator<Item = f64>) -> Option<Axis> {
    let mut values: Vec<f64> = residuals.collect();
    values.retain(|value| value.is_finite() && *value > 0.0);
    values.sort_by(f64::total_cmp);
    let below = values.len() / RESIDUALS_ABOVE_AXIS;
    Axis::logarithmic(values.into_iter().skip(below), RESIDUAL_DECADES)
}

/// Whether a panel cannot be read by the magnitude axis of its neighbour to the left.
fn has_own_axis(row: &[FrfPanel<'_>], column: usize) -> bool {
    let unit = |column: usize| row.get(column).map(|panel| panel.unit);
    match column.checked_sub(1) {
        None => true,
        Some(neighbour) => unit(column).is_some_and(|own| Some(own) != unit(neighbour)),
    }
}

#[expect(
    clippy::cast_precision_loss,
    reason = "a handful of lines, rows or columns"
)]
fn length(count: usize) -> f64 {
    count as f64
}
