//! Drawing of charts as SVG and writing of HTML, for reports, FMU documentation and responses alike; knows nothing of joints.
#![forbid(unsafe_code)]

mod axis;
pub mod curve;
pub mod html;
mod line_figure;
mod look;
mod plot;
mod response_figure;
mod strip;
mod svg;
pub mod text;

pub use axis::{Axis, Tick, TickLabel, Ticks};
pub use line_figure::{Line, LineFigure, Scale, Shape};
pub use look::Look;
pub use plot::{Drawn, Plot, PlotCurve, PlotLevel, PlotPanel, PlotPoints};
pub use response_figure::{COLOURS, ResponseCurve, ResponseFigure, ResponsePanel};
pub use strip::{FAINT_TEXT, FONTS, LABELS_BELOW, Strip, TEXT, VALUE_LABELS, draw_path};
pub use svg::{Lettering, Manner, PathData, Point, Svg};
