//! Pictures of what was measured and what was found, for people who read structural dynamics every day.

mod axis;
mod curve;
mod frf_column;
mod frf_figure;
mod legend;
mod strip;
mod svg;
mod text;

pub use frf_figure::{FrfFigure, FrfPanel};
