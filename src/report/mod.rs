//! Pictures and pages of what was measured and what was found, for people who read structural dynamics every day.

mod axis;
mod chart;
mod chart_data;
mod curve;
mod frf_column;
mod frf_figure;
mod interval_figure;
mod kavi_figure;
mod lap;
mod layered_beam_figure;
mod legend;
mod line_figure;
mod look;
mod page;
mod prediction;
mod pressure_figure;
mod resonance_labels;
mod response_figure;
mod spectrum_figure;
mod strip;
mod svg;
mod text;

pub use frf_figure::{FrfFigure, FrfPanel};
pub use kavi_figure::KaviFigure;
pub use lap::{LapResponseReport, LapUpdateReport};
pub(crate) use lap::{convergence_figure, level_figure};
pub use layered_beam_figure::LayeredBeamFigure;
pub(crate) use line_figure::{Line, LineFigure, Scale, Shape};
pub use page::IdentificationReport;
pub use prediction::PredictionReport;
pub use pressure_figure::PressureFigure;
pub(crate) use response_figure::{ResponseCurve, ResponseFigure, ResponsePanel};
pub use spectrum_figure::spectrum_figure;

#[cfg(test)]
mod tests;
