//! The look of the curves, and the key that explains it.

use bolted_joint_figures::{Lettering, Look, Manner, PathData, Point, Svg, text};

// Blue and vermilion from the palette of Okabe and Ito, which the colour-blind can tell apart.
pub(super) const REGENERATED_COLOUR: &str = "#0072b2";
const UNCOUPLED_COLOUR: &str = "#d55e00";
// Three times as dark as white paper at least, so that dots stay visible below a line (WCAG 2.2, 1.4.11).
const MEASURED_COLOUR: &str = "#858d96";
const RESIDUAL_COLOUR: &str = "#858d96";

const FONT: f64 = 12.5;
const SAMPLE_WIDTH: f64 = 26.0;
const BETWEEN_ENTRIES: f64 = 24.0;

/// A kind of curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Key {
    Measured,
    Regenerated,
    Uncoupled,
    /// Its name is in the axis' label.
    Residual,
    /// Upright lines, with the frequency above them.
    Resonance,
}

impl Key {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::Regenerated => "regenerated",
            Self::Uncoupled => "uncoupled",
            Self::Residual => "residual",
            Self::Resonance => "resonance, Hz",
        }
    }

    /// Draws `path` in the look of this kind of curve.
    pub(super) fn draw(self, path: &PathData, svg: &mut Svg) {
        self.look().draw(path, svg);
    }

    /// How this kind of curve is drawn.
    pub(super) fn look(self) -> Look {
        match self {
            Self::Measured => Look::dots(MEASURED_COLOUR, 4.2),
            Self::Regenerated => Look::line(REGENERATED_COLOUR, 1.5),
            Self::Uncoupled => Look::dashed(UNCOUPLED_COLOUR, 1.2, "6 3"),
            Self::Residual => Look::dots(RESIDUAL_COLOUR, 1.9),
            Self::Resonance => Look::dashed(REGENERATED_COLOUR, 1.0, "1 3"),
        }
    }

    fn sample(self, left: f64, middle: f64) -> PathData {
        let mut path = PathData::default();
        let at = |x| Point {
            x: left + x,
            y: middle,
        };
        match self {
            Self::Measured | Self::Residual => {
                for dot in [4.0, 10.0, 16.0, 22.0] {
                    path.move_to(at(dot));
                    path.dot();
                }
            }
            Self::Regenerated | Self::Uncoupled => path.polyline(&[at(0.0), at(SAMPLE_WIDTH)]),
            Self::Resonance => {
                let x = left + 0.8 * SAMPLE_WIDTH;
                let ends = [middle - 8.0, middle + 8.0];
                path.polyline(&ends.map(|y| Point { x, y }));
            }
        }
        path
    }
}

/// Draws samples of `keys` with their names in one line.
pub(super) fn draw_legend(keys: &[Key], left: f64, baseline: f64, svg: &mut Svg) {
    let mut x = left;
    for key in keys {
        key.draw(&key.sample(x, baseline - 0.36 * FONT), svg);
        x += SAMPLE_WIDTH + 7.0;
        svg.text(
            (x, baseline),
            Lettering::new(FONT, Manner::Plain),
            key.name(),
        );
        x += text::width(key.name(), FONT) + BETWEEN_ENTRIES;
    }
}
