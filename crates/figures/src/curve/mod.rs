//! Geometry of curves on the page: broken where the phase wraps or data are missing, cut at the edge of their strip,
//! and thinned to what a page can show without losing a peak.

mod polyline;
mod samples;

use std::collections::HashSet;

use super::svg::{PathData, Point};
use polyline::{cut, simplified, thin};
pub use samples::{Sample, magnitude, phase, residual, turned_towards, unwrapped_pieces};

/// Side of the squares that show one dot at most (pixels).
const DOT_CELL: f64 = 1.0;

/// A path through `points`, with gaps where there is none, cut at y = 0 and y = `height`, and thinned.
pub fn line(points: impl Iterator<Item = Option<Point>>, height: f64, path: &mut PathData) {
    line_within(points, height, 0.0, path);
}

/// As [`line()`], and points are left out that are nearer than `tolerance` (pixels) to the line through the others.
pub fn line_within(
    points: impl Iterator<Item = Option<Point>>,
    height: f64,
    tolerance: f64,
    path: &mut PathData,
) {
    let points: Vec<Option<Point>> = points.collect();
    for piece in points.split(Option::is_none) {
        let piece: Vec<Point> = piece.iter().flatten().copied().collect();
        for inside in cut(&piece, height) {
            path.polyline(&simplified(&thin(&inside), tolerance));
        }
    }
}

/// Dots at `points` between y = 0 and y = `height`, one at most in each pixel.
pub fn dots(points: impl Iterator<Item = Option<Point>>, height: f64, path: &mut PathData) {
    dots_apart(points, height, DOT_CELL, path);
}

/// As [`dots`], one at most in each square of side `cell_size` (pixels).
pub fn dots_apart(
    points: impl Iterator<Item = Option<Point>>,
    height: f64,
    cell_size: f64,
    path: &mut PathData,
) {
    let cell = |length: f64| cell(length / cell_size);
    let mut taken = HashSet::new();
    for point in points
        .flatten()
        .filter(|point| (0.0..=height).contains(&point.y))
    {
        if taken.insert((cell(point.x), cell(point.y))) {
            path.move_to(Point {
                x: to_tenth(point.x),
                y: to_tenth(point.y),
            });
            path.dot();
        }
    }
}

fn to_tenth(length: f64) -> f64 {
    (10.0 * length).round() / 10.0
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "lengths on a page are small; `as` saturates for any other"
)]
fn cell(length: f64) -> i64 {
    length.floor() as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f64, y: f64) -> Point {
        Point { x, y }
    }

    #[test]
    fn gaps_break_lines_and_single_points_are_dots() {
        let mut path = PathData::default();
        let points = [
            Some(point(1.0, 1.0)),
            Some(point(2.0, 2.0)),
            None,
            Some(point(5.0, 5.0)),
            None,
        ];
        line(points.into_iter(), 10.0, &mut path);
        assert_eq!(path.as_str(), "m1 1l1 1m3 3h0");
    }

    #[test]
    fn dots_fall_on_each_pixel_once() {
        let mut path = PathData::default();
        let points =
            [(1.02, 1.0), (1.3, 1.2), (1.5, 2.0), (7.0, 30.0)].map(|(x, y)| Some(point(x, y)));
        dots(points.into_iter(), 10.0, &mut path);
        assert_eq!(path.as_str(), "m1 1h0m.5 1h0");
    }
}
