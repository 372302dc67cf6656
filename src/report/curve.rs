//! Geometry of curves on the page: broken where the phase wraps or data are missing, cut at the edge of their strip,
//! and thinned to what a page can show without losing a peak.

use std::collections::HashSet;

use num_complex::Complex64;

use super::axis::PHASE_END;
use super::svg::{PathData, Point};

/// Side of the squares that show one dot at most (pixels).
const DOT_CELL: f64 = 1.0;

/// A value over frequency (Hz).
pub(super) type Sample = (f64, f64);

/// Magnitude over frequency. What cannot be drawn stays: it makes a gap.
pub(super) fn magnitude(frequency_hz: &[f64], function: &[Complex64]) -> Vec<Sample> {
    let samples = frequency_hz.iter().zip(function);
    samples
        .map(|(&frequency, value)| (frequency, value.norm()))
        .collect()
}

/// Phase in degrees over frequency, NaN where the value is zero and has none.
pub(super) fn phase(frequency_hz: &[f64], function: &[Complex64]) -> Vec<Sample> {
    let degrees = |value: &Complex64| match value.norm() {
        norm if norm > 0.0 => value.arg().to_degrees(),
        _ => f64::NAN,
    };
    let samples = frequency_hz.iter().zip(function);
    samples
        .map(|(&frequency, value)| (frequency, degrees(value)))
        .collect()
}

/// Takes a turn off the phases in `samples`, or adds one, where that brings them nearer to `reference` and they stay
/// on the axis: noise about ±180° then lies on both sides of the reference and not at both ends of the axis.
pub(super) fn turned_towards(reference: &[Sample], mut samples: Vec<Sample>) -> Vec<Sample> {
    for (sample, reference) in samples.iter_mut().zip(reference) {
        let away = sample.1 - reference.1;
        let turned = sample.1 - 360_f64.copysign(away);
        if away.abs() > 180.0 && turned.abs() <= PHASE_END {
            sample.1 = turned;
        }
    }
    samples
}

/// |measured − regenerated| / |regenerated| in per cent over frequency.
pub(super) fn residual(
    frequency_hz: &[f64],
    measured: &[Complex64],
    regenerated: &[Complex64],
) -> Vec<Sample> {
    let samples = frequency_hz.iter().zip(measured.iter().zip(regenerated));
    samples
        .map(|(&frequency, (measured, regenerated))| {
            (
                frequency,
                100.0 * (measured - regenerated).norm() / regenerated.norm(),
            )
        })
        .collect()
}

/// Cuts a phase where it passes ±180° and carries both ends to the edge. Samples must not be outside ±180°.
pub(super) fn unwrapped_pieces(samples: &[Sample]) -> Vec<Vec<Sample>> {
    let mut pieces = Vec::new();
    let mut piece: Vec<Sample> = Vec::new();
    for &(frequency, degrees) in samples {
        if let Some(&(before, degrees_before)) = piece.last() {
            let jump = degrees - degrees_before;
            if jump.abs() > 180.0 {
                let edge = 180_f64.copysign(degrees_before);
                let turn = 360_f64.copysign(jump);
                let share = (edge - degrees_before) / (jump - turn);
                let crossing = if share.is_finite() {
                    before + share * (frequency - before)
                } else {
                    before
                };
                piece.push((crossing, edge));
                pieces.push(std::mem::take(&mut piece));
                piece.push((crossing, -edge));
            }
        }
        piece.push((frequency, degrees));
    }
    pieces.push(piece);
    pieces
}

/// A path through `points`, with gaps where there is none, cut at y = 0 and y = `height`, and thinned.
pub(super) fn line(points: impl Iterator<Item = Option<Point>>, height: f64, path: &mut PathData) {
    line_within(points, height, 0.0, path);
}

/// As [`line()`], and points are left out that are nearer than `tolerance` (pixels) to the line through the others.
pub(super) fn line_within(
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
pub(super) fn dots(points: impl Iterator<Item = Option<Point>>, height: f64, path: &mut PathData) {
    dots_apart(points, height, DOT_CELL, path);
}

/// As [`dots`], one at most in each square of side `cell_size` (pixels).
pub(super) fn dots_apart(
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

/// The parts of a polyline between y = 0 and y = `height`.
fn cut(line: &[Point], height: f64) -> Vec<Vec<Point>> {
    if let &[single] = line {
        let inside = (0.0..=height).contains(&single.y);
        return if inside {
            vec![vec![single]]
        } else {
            Vec::new()
        };
    }
    let mut pieces = Vec::new();
    let mut piece: Vec<Point> = Vec::new();
    for ends in line.windows(2) {
        let &[from, to] = ends else { continue };
        let Some((start, end)) = cut_segment(from, to, height) else {
            continue;
        };
        if piece.last() != Some(&start) {
            pieces.push(std::mem::take(&mut piece));
            piece.push(start);
        }
        piece.push(end);
    }
    pieces.push(piece);
    pieces.retain(|piece| !piece.is_empty());
    pieces
}

fn cut_segment(from: Point, to: Point, height: f64) -> Option<(Point, Point)> {
    if from.y.max(to.y) < 0.0 || from.y.min(to.y) > height {
        return None;
    }
    let towards = |point: Point, other: Point| {
        let edge = point.y.clamp(0.0, height);
        if edge == point.y {
            return point;
        }
        let share = (edge - point.y) / (other.y - point.y);
        Point {
            x: point.x + share * (other.x - point.x),
            y: edge,
        }
    };
    Some((towards(from, to), towards(to, from)))
}

/// Keeps of each pixel column the first and the last point, the highest and the lowest, in their order.
fn thin(line: &[Point]) -> Vec<Point> {
    let mut kept = Vec::new();
    for column in line.chunk_by(|a, b| a.x.floor() == b.x.floor()) {
        let by_height = |a: &usize, b: &usize| column[*a].y.total_cmp(&column[*b].y);
        let highest = (0..column.len()).min_by(by_height).unwrap_or(0);
        let lowest = (0..column.len()).max_by(by_height).unwrap_or(0);
        let mut indices = [0, highest, lowest, column.len() - 1];
        indices.sort_unstable();
        let mut previous = None;
        for index in indices {
            if previous.replace(index) != Some(index) {
                kept.push(column[index]);
            }
        }
    }
    kept
}

/// Leaves out points that are not further than `tolerance` from the line through those left (Ramer, Douglas and Peucker).
fn simplified(line: &[Point], tolerance: f64) -> Vec<Point> {
    if tolerance <= 0.0 || line.len() < 3 {
        return line.to_vec();
    }
    let mut kept = vec![false; line.len()];
    kept[0] = true;
    kept[line.len() - 1] = true;
    let mut open = vec![(0, line.len() - 1)];
    while let Some((start, end)) = open.pop() {
        let (from, to) = (line[start], line[end]);
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let length = dx.hypot(dy).max(f64::MIN_POSITIVE);
        let distance = |point: &Point| {
            let (x, y) = (point.x - from.x, point.y - from.y);
            // Beyond an end of the line the end itself is nearest.
            let along = (x * dx + y * dy) / length;
            if (0.0..=length).contains(&along) {
                (x * dy - y * dx).abs() / length
            } else {
                x.hypot(y).min((point.x - to.x).hypot(point.y - to.y))
            }
        };
        let furthest = (start + 1..end)
            .map(|index| (index, distance(&line[index])))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, distance)) = furthest
            && distance > tolerance
        {
            kept[index] = true;
            open.push((start, index));
            open.push((index, end));
        }
    }
    let points = line.iter().zip(kept);
    points
        .filter(|(_, kept)| *kept)
        .map(|(point, _)| *point)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f64, y: f64) -> Point {
        Point { x, y }
    }

    #[test]
    fn a_simplified_line_stays_within_its_tolerance() {
        let wave = |k: u32| {
            let x = 0.5 * f64::from(k);
            point(
                x,
                50.0 + 40.0 * (0.02 * x).sin() + 300.0 / (1.0 + (x - 400.0).powi(2)),
            )
        };
        let line: Vec<Point> = (0..2000).map(wave).collect();
        let simple = simplified(&line, 0.2);
        assert!(simple.len() < 200, "{}", simple.len());
        for original in &line {
            let pairs = simple.windows(2);
            let piece = pairs.filter(|p| (p[0].x..=p[1].x).contains(&original.x));
            let nearest = piece.map(|p| {
                let share = (original.x - p[0].x) / (p[1].x - p[0].x);
                let slope = (p[1].y - p[0].y) / (p[1].x - p[0].x);
                let above = original.y - p[0].y - share * (p[1].y - p[0].y);
                above.abs() / slope.hypot(1.0)
            });
            assert!(nearest.fold(f64::INFINITY, f64::min) <= 0.2 + 1e-9);
        }
        assert_eq!(simplified(&line, 0.0), line);
    }

    #[test]
    fn thinning_keeps_every_peak_and_valley() {
        let wave = |k: u32| 50.0 + 0.1 * f64::from(k * 7919 % 97);
        let mut line: Vec<Point> = (0..20_000)
            .map(|k| point(0.01 * f64::from(k), wave(k)))
            .collect();
        line[12_345].y = 1.25;
        line[777].y = 99.75;
        let thinned = thin(&line);
        assert!(thinned.len() <= 4 * 200);
        assert!(thinned.contains(&line[12_345]) && thinned.contains(&line[777]));
        assert_eq!(
            (thinned[0], thinned[thinned.len() - 1]),
            (line[0], line[19_999])
        );
        assert!(thinned.is_sorted_by_key(|point| point.x));
        for column in 0..200 {
            let range = |points: &[Point]| {
                let of_column = points
                    .iter()
                    .filter(|point| point.x.floor() == f64::from(column));
                of_column.fold((f64::MAX, f64::MIN), |(low, high), point| {
                    (low.min(point.y), high.max(point.y))
                })
            };
            assert_eq!(range(&thinned), range(&line), "column {column}");
        }
    }

    #[test]
    fn few_points_stay_as_they_are() {
        let line = [point(0.0, 1.0), point(2.0, 5.0), point(4.0, 2.0)];
        assert_eq!(thin(&line), line);
        assert!(thin(&[]).is_empty());
    }

    #[test]
    fn lines_are_cut_at_the_edges() {
        let line = [
            point(0.0, 5.0),
            point(1.0, -5.0),
            point(2.0, 5.0),
            point(3.0, 25.0),
            point(4.0, 25.0),
        ];
        let expected = vec![
            vec![point(0.0, 5.0), point(0.5, 0.0)],
            vec![point(1.5, 0.0), point(2.0, 5.0), point(2.25, 10.0)],
        ];
        assert_eq!(cut(&line, 10.0), expected);
        let through = [point(0.0, -10.0), point(3.0, 20.0)];
        assert_eq!(cut(&through, 10.0), [[point(1.0, 0.0), point(2.0, 10.0)]]);
        assert!(cut(&[point(0.0, 11.0)], 10.0).is_empty());
        assert!(cut(&[point(0.0, -2.0), point(1.0, -1.0)], 10.0).is_empty());
    }

    #[test]
    fn a_wrapping_phase_is_carried_to_the_edges() {
        let pieces = unwrapped_pieces(&[(1.0, -90.0), (2.0, -170.0), (3.0, 160.0), (4.0, 150.0)]);
        // From −170° to −200°: a third of the way down lies −180°.
        let crossing = 2.0 + 1.0 / 3.0;
        assert_eq!(pieces.len(), 2);
        assert_eq!(pieces[0][..2], [(1.0, -90.0), (2.0, -170.0)]);
        assert!((pieces[0][2].0 - crossing).abs() < 1e-12 && pieces[0][2].1 == -180.0);
        assert!((pieces[1][0].0 - crossing).abs() < 1e-12 && pieces[1][0].1 == 180.0);
        assert_eq!(pieces[1][1..], [(3.0, 160.0), (4.0, 150.0)]);
    }

    #[test]
    fn noise_about_half_a_turn_stays_together() {
        let reference = [(1.0, -179.0), (2.0, 178.0), (3.0, -100.0), (4.0, f64::NAN)];
        let samples = vec![(1.0, 179.5), (2.0, -170.0), (3.0, 120.0), (4.0, 179.0)];
        let expected = [(1.0, -180.5), (2.0, 190.0), (3.0, 120.0), (4.0, 179.0)];
        assert_eq!(turned_towards(&reference, samples), expected);
    }

    #[test]
    fn no_piece_of_a_phase_jumps() {
        let turning: Vec<Sample> = (0..500)
            .map(|k| {
                (
                    f64::from(k),
                    (f64::from(k) * 47.0 + 180.0).rem_euclid(360.0) - 180.0,
                )
            })
            .collect();
        let pieces = unwrapped_pieces(&turning);
        // The edge is passed at 180°, 540°, … up to 499 · 47°.
        assert_eq!(pieces.len(), 1 + (499 * 47 + 180) / 360);
        for piece in pieces {
            assert!(
                piece
                    .windows(2)
                    .all(|ends| (ends[1].1 - ends[0].1).abs() <= 180.0)
            );
        }
    }

    #[test]
    fn a_jump_from_edge_to_edge_is_cut_without_dividing_by_zero() {
        let pieces = unwrapped_pieces(&[(1.0, 180.0), (2.0, -180.0), (3.0, f64::NAN), (4.0, 10.0)]);
        assert_eq!(pieces[0], [(1.0, 180.0), (1.0, 180.0)]);
        assert_eq!(pieces[1][..2], [(1.0, -180.0), (2.0, -180.0)]);
        assert!(pieces[1][2].1.is_nan());
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

    #[test]
    fn residuals_are_in_per_cent_and_zero_has_no_phase() {
        let measured = [Complex64::new(3.0, 4.0), Complex64::new(1.0, 0.0)];
        let regenerated = [Complex64::new(3.0, 3.5), Complex64::new(0.0, 0.0)];
        let residual = residual(&[1.0, 2.0], &measured, &regenerated);
        // 0.5/√(3² + 3.5²)
        assert!((residual[0].1 - 10.846_522_890_932_809).abs() < 1e-12);
        assert!(residual[1].1.is_infinite());
        let phase = phase(&[1.0, 2.0], &[Complex64::new(-2.0, 0.0), Complex64::ZERO]);
        assert_eq!(phase[0].1, 180.0);
        assert!(phase[1].1.is_nan());
    }
}
