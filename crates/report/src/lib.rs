//! Pictures and pages of what was measured and what was found, for people who read structural dynamics every day.
#![forbid(unsafe_code)]

mod chart;
mod chart_data;
mod comparison;
mod frf_column;
mod frf_figure;
mod interval_figure;
mod lap;
mod layered_beam_figure;
mod legend;
mod page;
mod prediction;
mod pressure_figure;
mod resonance_labels;
mod shown;
mod spatial;
mod spectrum_figure;

pub use comparison::{comparison_figure, comparison_page};
pub use frf_figure::{FrfFigure, FrfPanel};
pub use lap::{LapResponseReport, LapUpdateReport};
pub use lap::{convergence_figure, level_figure};
pub use layered_beam_figure::LayeredBeamFigure;
pub use page::IdentificationReport;
pub use prediction::PredictionReport;
pub use pressure_figure::PressureFigure;
pub use shown::{DrawnFunction, FunctionGroup, ShownFile, ShownPicture, shown_page, shown_svg};
pub use spatial::{SpatialReport, spatial_figure};
pub use spectrum_figure::spectrum_figure;

#[cfg(test)]
mod tests;
