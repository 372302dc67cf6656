//! One function in a figure: its name and resonances above, its magnitude, phase and residual over one another.

use bolted_joint_statistics::upper_median;
use num_complex::Complex64;

use super::frf_figure::FrfPanel;
use super::legend::Key;
use super::resonance_labels::{RESONANCE_LABELS, draw_resonance_labels};
use bolted_joint_figures::curve::{self, Sample};
use bolted_joint_figures::{Axis, FAINT_TEXT, Lettering, Manner, PathData, Strip, Svg, text};
use bolted_joint_frf::Resonance;

// Heights of what stands in a column, from the top.
const PANEL_LABEL: f64 = 22.0;
const MAGNITUDE: f64 = 230.0;
const PHASE: f64 = 120.0;
const RESIDUAL: f64 = 84.0;
const BETWEEN_STRIPS: f64 = 14.0;
const FREQUENCY_LABELS: f64 = 48.0;

const PANEL_FONT: f64 = 13.0;
const NOTE_FONT: f64 = 11.5;

/// The axes of a column.
#[derive(Debug, Clone, Copy)]
pub(super) struct ColumnAxes {
    pub(super) frequency: Axis,
    /// `None` if no magnitude can be drawn.
    pub(super) magnitude: Option<Axis>,
    /// `None` if the figure has no strip for residuals.
    pub(super) residual: Option<Option<Axis>>,
}

/// A function and where it is drawn.
#[derive(Debug)]
pub(super) struct Column<'a> {
    panel: &'a FrfPanel<'a>,
    frequency_hz: &'a [f64],
    magnitude: Strip,
    phase: Strip,
    residual: Option<Strip>,
}

/// Height of a column, with or without a strip for residuals (pixels).
pub(super) fn height(with_residual: bool) -> f64 {
    let residual = if with_residual {
        BETWEEN_STRIPS + RESIDUAL
    } else {
        0.0
    };
    PANEL_LABEL
        + RESONANCE_LABELS
        + MAGNITUDE
        + BETWEEN_STRIPS
        + PHASE
        + residual
        + FREQUENCY_LABELS
}

impl<'a> Column<'a> {
    /// Lays out a column whose strips begin at `left`, whose labels begin at `top`.
    pub(super) fn new(
        panel: &'a FrfPanel<'a>,
        frequency_hz: &'a [f64],
        axes: ColumnAxes,
        (left, top): (f64, f64),
        width: f64,
    ) -> Self {
        let mut below = top + PANEL_LABEL + RESONANCE_LABELS;
        let mut strip = |height, value| {
            let strip = Strip {
                left,
                top: below,
                width,
                height,
                frequency: axes.frequency,
                value,
            };
            below += height + BETWEEN_STRIPS;
            strip
        };
        Self {
            panel,
            frequency_hz,
            magnitude: strip(MAGNITUDE, axes.magnitude),
            phase: strip(PHASE, Some(Axis::Phase)),
            residual: axes.residual.map(|axis| strip(RESIDUAL, axis)),
        }
    }

    /// Draws everything but the labels of the value axes.
    pub(super) fn draw(&self, svg: &mut Svg) {
        self.draw_name(svg);
        let marked = draw_resonance_labels(
            self.frequency_hz,
            self.panel.regenerated,
            &self.magnitude,
            svg,
        );
        self.draw_magnitude(&marked, svg);
        self.draw_phase(&marked, svg);
        self.draw_residual(&marked, svg);
        let lowest = self.residual.as_ref().unwrap_or(&self.phase);
        lowest.draw_frequency_labels(svg);
    }

    /// Labels the magnitude axis.
    pub(super) fn draw_magnitude_labels(&self, svg: &mut Svg) {
        let name = match self.panel.unit {
            "" => "magnitude".to_owned(),
            unit => format!("magnitude, {unit}"),
        };
        self.magnitude.draw_value_labels(&name, svg);
    }

    /// Labels the axes of phase and residual, which all columns share.
    pub(super) fn draw_common_labels(&self, svg: &mut Svg) {
        self.phase.draw_value_labels("phase, °", svg);
        if let Some(residual) = &self.residual {
            residual.draw_value_labels("residual, %", svg);
        }
    }

    /// The function's name to the left, its median residual to the right.
    fn draw_name(&self, svg: &mut Svg) {
        let strip = &self.magnitude;
        let baseline = strip.top - RESONANCE_LABELS - 7.0;
        let note = median(&self.residuals())
            .map(|percent| format!("median residual {}", percentage(percent)))
            .unwrap_or_default();
        let room = strip.width - text::width(&note, NOTE_FONT);
        svg.text(
            (strip.left, baseline),
            Lettering::new(PANEL_FONT, Manner::Bold),
            &text::shortened(&self.panel.label, PANEL_FONT, room),
        );
        svg.text(
            (strip.left + strip.width, baseline),
            Lettering::new(NOTE_FONT, Manner::End).in_colour(FAINT_TEXT),
            &note,
        );
    }

    fn draw_magnitude(&self, marked: &[Resonance], svg: &mut Svg) {
        let samples = |function: &[Complex64]| curve::magnitude(self.frequency_hz, function);
        let strip = &self.magnitude;
        strip.draw_grid(svg);
        Key::Resonance.draw(&mark_lines(marked, strip), svg);
        Key::Measured.draw(&dots(&samples(self.panel.measured), strip), svg);
        self.draw_lines(|function| line(&[samples(function)], strip), svg);
        if strip.value.is_none() {
            strip.draw_no_data(svg);
        }
        strip.draw_frame(svg);
    }

    fn draw_phase(&self, marked: &[Resonance], svg: &mut Svg) {
        let samples = |function: &[Complex64]| curve::phase(self.frequency_hz, function);
        let strip = &self.phase;
        strip.draw_grid(svg);
        Key::Resonance.draw(&mark_lines(marked, strip), svg);
        let regenerated = samples(self.panel.regenerated);
        let measured = curve::turned_towards(&regenerated, samples(self.panel.measured));
        Key::Measured.draw(&dots(&measured, strip), svg);
        let pieces = |function: &[Complex64]| curve::unwrapped_pieces(&samples(function));
        self.draw_lines(|function| line(&pieces(function), strip), svg);
        strip.draw_frame(svg);
    }

    fn draw_residual(&self, marked: &[Resonance], svg: &mut Svg) {
        if let Some(strip) = &self.residual {
            strip.draw_grid(svg);
            Key::Resonance.draw(&mark_lines(marked, strip), svg);
            Key::Residual.draw(&dots(&self.residuals(), strip), svg);
            strip.draw_frame(svg);
        }
    }

    fn draw_lines(&self, line: impl Fn(&[Complex64]) -> PathData, svg: &mut Svg) {
        if let Some(uncoupled) = self.panel.uncoupled {
            Key::Uncoupled.draw(&line(uncoupled), svg);
        }
        Key::Regenerated.draw(&line(self.panel.regenerated), svg);
    }

    fn residuals(&self) -> Vec<Sample> {
        self.panel.residuals(self.frequency_hz)
    }
}

fn mark_lines(marked: &[Resonance], strip: &Strip) -> PathData {
    let mut path = PathData::default();
    for resonance in marked {
        strip.upright(resonance.frequency_hz, 0.0, strip.height, &mut path);
    }
    path
}

fn line(pieces: &[Vec<Sample>], strip: &Strip) -> PathData {
    let mut path = PathData::default();
    for piece in pieces {
        let points = piece.iter().map(|&sample| strip.place(sample));
        curve::line(points, strip.height, &mut path);
    }
    path
}

fn dots(samples: &[Sample], strip: &Strip) -> PathData {
    let mut path = PathData::default();
    let points = samples.iter().map(|&sample| strip.place(sample));
    curve::dots(points, strip.height, &mut path);
    path
}

/// Gaps are left out.
fn median(samples: &[Sample]) -> Option<f64> {
    let values = samples.iter().map(|sample| sample.1);
    upper_median(values.filter(|value| value.is_finite()))
}

/// Two significant figures, or whole per cents.
fn percentage(percent: f64) -> String {
    match percent {
        0.0 => "0 %".to_owned(),
        _ if percent < 0.001 => "< 0.001 %".to_owned(),
        _ if percent < 0.0995 => format!("{percent:.3} %"),
        _ if percent < 0.995 => format!("{percent:.2} %"),
        _ if percent < 9.95 => format!("{percent:.1} %"),
        _ if percent < 1e6 => format!("{percent:.0} %"),
        _ => "> 10⁶ %".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_passes_over_gaps() {
        let samples = [3.0, f64::NAN, 1.0, f64::INFINITY, 2.0].map(|value| (1.0, value));
        assert_eq!(median(&samples), Some(2.0));
        assert_eq!(median(&[(1.0, f64::NAN)]), None);
    }

    #[test]
    fn percentages_have_as_many_digits_as_they_deserve() {
        let written = [0.0, 1e-9, 0.0123, 0.123, 0.999, 1.26, 9.96, 123.4, 1e9].map(percentage);
        let expected = [
            "0 %",
            "< 0.001 %",
            "0.012 %",
            "0.12 %",
            "1.0 %",
            "1.3 %",
            "10 %",
            "123 %",
            "> 10⁶ %",
        ];
        assert_eq!(written, expected);
    }
}
