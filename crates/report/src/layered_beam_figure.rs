//! Damping of a layered beam's mode over the amplitude: what friction gives, and what the joint file has in its place.

use bolted_joint_figures::{Line, LineFigure, Scale};
use bolted_joint_predict::layered_beam::{AmplitudeRow, Outcome};

/// The figure of a study of method `layered-beam`.
#[derive(Debug, Clone, Copy)]
pub struct LayeredBeamFigure<'a> {
    /// What was computed.
    pub outcome: &'a Outcome,
}

impl LayeredBeamFigure<'_> {
    /// The figure as an SVG document; `None` if there is nothing to draw.
    #[must_use]
    pub fn to_svg(&self) -> Option<String> {
        let own = || {
            let rows = self.outcome.amplitudes.iter();
            rows.filter(|row| row.mode == self.outcome.mode)
        };
        let line = |name: &str, of: &dyn Fn(&AmplitudeRow) -> Option<f64>| {
            let point = |row: &AmplitudeRow| Some((1e3 * row.amplitude_m, of(row)?));
            Line::curve(name, own().filter_map(point))
        };
        LineFigure {
            title: "Damping ratio over the amplitude",
            across: ("amplitude of the drive point, mm", Scale::Linear),
            up: ("damping ratio", Scale::Linear),
            lines: vec![
                line("friction between the layers", &|row| {
                    Some(row.damping_ratio)
                }),
                line("joint file", &|row| row.joint_damping_ratio),
            ],
        }
        .to_svg()
    }
}
