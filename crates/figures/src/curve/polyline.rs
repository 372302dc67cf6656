//! Polylines cut at the edges of their strip, and thinned without losing a peak.

use super::super::svg::Point;

/// The parts of a polyline between y = 0 and y = `height`.
pub(super) fn cut(line: &[Point], height: f64) -> Vec<Vec<Point>> {
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
pub(super) fn thin(line: &[Point]) -> Vec<Point> {
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
pub(super) fn simplified(line: &[Point], tolerance: f64) -> Vec<Point> {
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
        let length = dx.hypot(dy);
        let distance = |point: &Point| {
            let (x, y) = (point.x - from.x, point.y - from.y);
            // Beyond an end of the line the end itself is nearest.
            let along = (x * dx + y * dy) / length;
            // A closed line begins and ends at one point.
            if length > 0.0 && (0.0..=length).contains(&along) {
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
    fn a_closed_line_stays_closed() {
        let circle = |k: u32| {
            let angle = std::f64::consts::TAU * f64::from(k % 360) / 360.0;
            point(50.0 + 40.0 * angle.cos(), 50.0 + 40.0 * angle.sin())
        };
        let line: Vec<Point> = (0..=360).map(circle).collect();
        let simple = simplified(&line, 0.1);
        assert!((20..100).contains(&simple.len()), "{}", simple.len());
        assert_eq!(simple.first(), simple.last());
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
}
