//! Following a curve of solutions along its own length, through folds: Keller's continuation by arc length.

use nalgebra::{DMatrix, DVector};

/// Lengths are relative changes of the unknowns, each over its scale.
const FIRST: f64 = 0.02;
const LONGEST: f64 = 0.1;
const SHORTEST: f64 = 1e-9;
/// Steps that are tried, those among them that were too long: a curve has some hundreds.
const MOST_TRIALS: usize = 50_000;
/// So many of them in which it gets on by no more than the first step are as good as none.
const CREEPING: usize = 1000;
const MOST_ITERATIONS: usize = 10;
const USUAL_ITERATIONS: f64 = 3.0;
/// The most by which a step is longer than the one before.
const FASTEST: f64 = 1.5;
/// First change of the unknowns below which the next step is that much longer, however many iterations there are.
const STRAIGHT: f64 = 1e-6;
/// Change of the unknowns at which a point is one of the curve.
const CONVERGED: f64 = 1e-10;
/// Part of the change before that is no progress.
const LITTLE_LESS: f64 = 0.3;
/// Smallest cosine between the tangents of neighbouring points …
const SMALLEST_COSINE: f64 = 0.97;
/// … that are farther from each other than this: where something begins to slide the curve has a kink.
const KINK: f64 = 1e-4;

/// Equations in one unknown more than they are.
pub(super) trait Curve {
    /// Residuals (N) and derivatives (N × (N + 1)); `None` where there are none.
    fn at(&self, unknowns: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)>;

    /// What counts as much of each unknown.
    fn scale(&self, unknowns: &DVector<f64>) -> DVector<f64>;
}

/// A curve that ends where it should not.
#[derive(Clone, Debug)]
pub(super) struct Lost {
    /// The last point.
    pub(super) last: DVector<f64>,
    /// How many points there are up to there.
    pub(super) points: usize,
    /// Whether it went on, but did not come to its end.
    pub(super) is_too_long: bool,
}

/// A point of a curve.
struct Point {
    unknowns: DVector<f64>,
    /// The direction in which the closing row grows there, of length one, of scaled unknowns.
    tangent: DVector<f64>,
    /// Iterations to it.
    iterations: usize,
    /// The first change of the unknowns on the way to it, the largest of them.
    first_change: f64,
}

/// The point near `start` in the plane across a row: the product of that with the scaled change of the unknowns is zero.
fn solve(
    curve: &dyn Curve,
    start: &DVector<f64>,
    scale: &DVector<f64>,
    row: &DVector<f64>,
) -> Option<Point> {
    let mut unknowns = start.clone();
    let (mut first_change, mut last) = (0.0, f64::INFINITY);
    for iteration in 1..=MOST_ITERATIONS {
        let (residual, derivatives) = curve.at(&unknowns)?;
        let count = residual.len();
        let factors = closed(&derivatives, scale, row).lu();
        let mut right = DVector::zeros(count + 1);
        right.rows_mut(0, count).copy_from(&-residual);
        let change = factors.solve(&right)?;
        let size = change.amax();
        if !size.is_finite() {
            return None;
        }
        if iteration == 1 {
            first_change = size;
        }
        unknowns += change.component_mul(scale);
        // or where rounding, or the corners of what slides, allow no less
        if size < CONVERGED || size < CONVERGED.sqrt() && size > LITTLE_LESS * last {
            // the derivatives of the point before, from which this one cannot be told
            right.fill(0.0);
            right[count] = 1.0;
            let tangent = factors.solve(&right)?;
            let norm = tangent.norm();
            return (norm.is_finite() && norm > 0.0).then(|| Point {
                unknowns,
                tangent: tangent / norm,
                iterations: iteration,
                first_change,
            });
        }
        last = size;
    }
    None
}

/// The derivatives by scaled unknowns, and the row below them.
fn closed(derivatives: &DMatrix<f64>, scale: &DVector<f64>, row: &DVector<f64>) -> DMatrix<f64> {
    let count = derivatives.nrows();
    let mut matrix = DMatrix::zeros(count + 1, count + 1);
    for i in 0..count {
        for j in 0..=count {
            matrix[(i, j)] = derivatives[(i, j)] * scale[j];
        }
    }
    matrix.row_mut(count).copy_from(&row.transpose());
    matrix
}

/// The point on the curve near `start` at which its unknown of this place is what it is there.
pub(super) fn point(curve: &dyn Curve, start: &DVector<f64>, held: usize) -> Option<DVector<f64>> {
    let mut row = DVector::zeros(start.len());
    row[held] = 1.0;
    solve(curve, start, &curve.scale(start), &row).map(|point| point.unknowns)
}

/// The curve from a point on it until its unknown of the place `monitored` leaves what is between its value there and `to`, the
/// end included.
pub(super) fn follow(
    curve: &dyn Curve,
    start: DVector<f64>,
    monitored: usize,
    to: f64,
    progress: &dyn Fn(f64),
) -> Result<Vec<DVector<f64>>, Lost> {
    let from = start[monitored];
    let direction = (to - from).signum();
    let mut place = start;
    let mut points = vec![place.clone()];
    let lost = |points: &[DVector<f64>], place: &DVector<f64>, is_too_long: bool| Lost {
        last: place.clone(),
        points: points.len(),
        is_too_long,
    };
    let mut scale = curve.scale(&place);
    let mut row = DVector::zeros(place.len());
    row[monitored] = direction;
    let Some(begun) = solve(curve, &place, &scale, &row) else {
        return Err(lost(&points, &place, false));
    };
    let mut along = begun.tangent;
    let mut length = FIRST;
    // the farthest that it came
    let mut reached: f64 = 0.0;
    let mut lately = 0.0;
    for trial in 1..=MOST_TRIALS {
        if trial.is_multiple_of(CREEPING) {
            if lately < FIRST {
                return Err(lost(&points, &place, false));
            }
            lately = 0.0;
        }
        let predicted = &place + (&along * length).component_mul(&scale);
        let found = solve(curve, &predicted, &scale, &along).and_then(|next| {
            let is_smooth = next.tangent.dot(&along) > SMALLEST_COSINE;
            (is_smooth || length < KINK).then_some((next, is_smooth))
        });
        // tells how far it is, and asks whether it is still wanted
        progress(reached);
        let Some((next, is_smooth)) = found else {
            length *= 0.5;
            if length < SHORTEST {
                return Err(lost(&points, &place, false));
            }
            continue;
        };
        let Point {
            unknowns: next,
            tangent: turned,
            iterations,
            first_change,
        } = next;
        if (next[monitored] - to) * direction >= 0.0 {
            let mut last = next;
            last[monitored] = to;
            points.extend(point(curve, &last, monitored));
            return Ok(points);
        }
        if (next[monitored] - from) * direction < 0.0 {
            return Ok(points);
        }
        lately += length;
        reached = reached.max((next[monitored] - from) / (to - from));
        let faster = match first_change < STRAIGHT {
            // so near to a straight line that what iterates is rounding, or a corner
            true => FASTEST,
            false => (USUAL_ITERATIONS / iterations as f64).clamp(0.5, FASTEST),
        };
        length = match is_smooth {
            true => (length * faster).min(LONGEST),
            // beyond the kink it goes on as at the start
            false => FIRST,
        };
        let own = curve.scale(&next);
        // the same direction in the sizes of the new point
        along = turned.component_mul(&scale).component_div(&own);
        along /= along.norm();
        scale = own;
        place = next;
        points.push(place.clone());
    }
    Err(lost(&points, &place, true))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = 1 − e^(−t) as far as there is a t.
    struct Approaching {
        until: f64,
    }

    impl Curve for Approaching {
        fn at(&self, unknowns: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
            let (x, t) = (unknowns[0], unknowns[1]);
            let residual = DVector::from_element(1, x - 1.0 + (-t).exp());
            (t <= self.until)
                .then(|| (residual, DMatrix::from_row_slice(1, 2, &[1.0, -(-t).exp()])))
        }

        fn scale(&self, _: &DVector<f64>) -> DVector<f64> {
            DVector::from_element(2, 1.0)
        }
    }

    fn approached(until: f64, to: f64) -> Result<Vec<DVector<f64>>, Lost> {
        follow(&Approaching { until }, DVector::zeros(2), 0, to, &|_| ())
    }

    #[test]
    fn a_curve_ends_at_its_end() {
        let points = approached(f64::INFINITY, 0.9).unwrap();
        let last = points.last().unwrap();
        assert_eq!(last[0], 0.9);
        assert!((last[1] - 10.0_f64.ln()).abs() < 1e-12);
    }

    #[test]
    fn a_curve_that_comes_to_no_end_is_left() {
        let lost = approached(f64::INFINITY, 1.5).unwrap_err();
        assert!(lost.is_too_long && lost.points > 1000);
    }

    #[test]
    fn a_curve_that_breaks_off_is_left_there() {
        let lost = approached(0.7, 0.9).unwrap_err();
        assert!(!lost.is_too_long && lost.points > 5);
        assert!((lost.last[1] - 0.7).abs() < 1e-6, "{lost:?}");
    }
}
