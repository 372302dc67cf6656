//! Pictures of what was measured and what was found, for people who read structural dynamics every day.

mod axis;
mod curve;
mod frf_column;
mod frf_figure;
mod legend;
mod line_figure;
mod strip;
mod svg;
mod text;

pub use frf_figure::{FrfFigure, FrfPanel};
pub(crate) use line_figure::{Line, LineFigure, Scale};

#[cfg(test)]
mod tests;
