//! Damping over what Kavi's thesis varies, one panel each, for its three kinds of ends.

use super::{KaviReproduction, SpecimenRow};
use bolted_joint_figures::Scale;
use bolted_joint_figures::{ResponseCurve, ResponseFigure, ResponsePanel};

/// Names of the ends, in the order of [`SpecimenRow::at`].
const ENDS: [&str; 3] = ["fixed–fixed", "fixed–pinned", "pinned–pinned"];

/// Specimens of steel that differ in one thing, and what that is.
const SERIES: [(&str, &str, [usize; 3]); 5] = [
    ("Length (specimens 1, 2, 3)", "length, mm", [1, 2, 3]),
    (
        "Diameter of the rivets (specimens 6, 3, 7)",
        "diameter, mm",
        [6, 3, 7],
    ),
    (
        "Thickness ratio (specimens 2, 4, 5)",
        "thickness ratio",
        [2, 4, 5],
    ),
    (
        "Number of layers (specimens 2, 10, 11)",
        "layers",
        [2, 10, 11],
    ),
    ("Number of rivets (specimens 8, 1, 9)", "rivets", [8, 1, 9]),
];

/// The figure of `reproduce kavi`.
#[derive(Debug, Clone, Copy)]
pub struct KaviFigure<'a> {
    /// What was computed.
    pub found: &'a KaviReproduction,
}

impl KaviFigure<'_> {
    /// The figure as an SVG document; `None` if there is nothing to draw.
    #[must_use]
    pub fn to_svg(&self) -> Option<String> {
        let panels = SERIES
            .iter()
            .enumerate()
            .map(|(place, (title, across, numbers))| {
                let rows = || {
                    self.found
                        .specimens
                        .iter()
                        .filter(|row| numbers.contains(&row.number))
                };
                let curves = ENDS.iter().enumerate().map(|(end, name)| {
                    let point = |row: &SpecimenRow| {
                        let at = row.at.get(end)?;
                        Some((varied(place, row), at.damping))
                    };
                    let mut points: Vec<(f64, f64)> = rows().filter_map(point).collect();
                    points.sort_by(|a, b| a.0.total_cmp(&b.0));
                    ResponseCurve {
                        name: (*name).to_owned(),
                        points,
                        is_dashed: Vec::new(),
                    }
                });
                ResponsePanel {
                    title: (*title).to_owned(),
                    across: ((*across).to_owned(), Scale::Linear),
                    up: ("ζ/α′μ at 0.1 mm".to_owned(), Scale::Linear),
                    curves: curves.collect(),
                }
            });
        ResponseFigure {
            title: "Damping ratio of Kavi's steel specimens",
            note: None,
            panels: panels.collect(),
        }
        .to_svg()
    }
}

fn varied(series: usize, row: &SpecimenRow) -> f64 {
    match series {
        0 => row.length_mm,
        1 => row.diameter_mm,
        2 => {
            let thickest = row.layers_mm.iter().copied().fold(0.0, f64::max);
            thickest / row.layers_mm.iter().copied().fold(f64::INFINITY, f64::min)
        }
        3 => row.layers_mm.len() as f64,
        _ => row.rivets as f64,
    }
}
