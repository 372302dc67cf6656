//! Following a curve of solutions along its own length, through folds: Keller's continuation by arc length.

use nalgebra::{DMatrix, DVector};

/// Lengths are relative changes of the unknowns, each over its scale.
const FIRST: f64 = 0.02;
const LONGEST: f64 = 0.1;
const SHORTEST: f64 = 1e-9;
const MOST_POINTS: usize = 100_000;
const MOST_ITERATIONS: usize = 10;
const USUAL_ITERATIONS: f64 = 3.0;
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

/// Why a curve ends where it should not.
#[derive(Clone, Debug)]
pub(super) struct Lost {
    /// The points up to there.
    pub(super) points: Vec<DVector<f64>>,
}

/// A row that closes the equations: its product with the scaled change of the unknowns is zero.
fn solve(
    curve: &dyn Curve,
    start: &DVector<f64>,
    scale: &DVector<f64>,
    row: &DVector<f64>,
) -> Option<(DVector<f64>, usize)> {
    let mut unknowns = start.clone();
    let mut last = f64::INFINITY;
    for iteration in 1..=MOST_ITERATIONS {
        let (residual, derivatives) = curve.at(&unknowns)?;
        let count = residual.len();
        let matrix = closed(&derivatives, scale, row);
        let mut right = DVector::zeros(count + 1);
        right.rows_mut(0, count).copy_from(&-residual);
        let change = matrix.lu().solve(&right)?;
        let size = change.amax();
        if !size.is_finite() {
            return None;
        }
        unknowns += change.component_mul(scale);
        // or where rounding, or the corners of what slides, allow no less
        if size < CONVERGED || size < CONVERGED.sqrt() && size > LITTLE_LESS * last {
            return Some((unknowns, iteration));
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
    solve(curve, start, &curve.scale(start), &row).map(|(unknowns, _)| unknowns)
}

/// The tangent of length one at a point, of scaled unknowns, that has `row` on its side.
fn tangent(
    curve: &dyn Curve,
    unknowns: &DVector<f64>,
    scale: &DVector<f64>,
    row: &DVector<f64>,
) -> Option<DVector<f64>> {
    let (residual, derivatives) = curve.at(unknowns)?;
    let mut right = DVector::zeros(residual.len() + 1);
    right[residual.len()] = 1.0;
    let tangent = closed(&derivatives, scale, row).lu().solve(&right)?;
    let norm = tangent.norm();
    (norm.is_finite() && norm > 0.0).then(|| tangent / norm)
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
    let mut scale = curve.scale(&place);
    let mut row = DVector::zeros(place.len());
    row[monitored] = direction;
    let Some(mut along) = tangent(curve, &place, &scale, &row) else {
        return Err(Lost { points });
    };
    let mut length = FIRST;
    while points.len() < MOST_POINTS {
        let predicted = &place + (&along * length).component_mul(&scale);
        let found = solve(curve, &predicted, &scale, &along).and_then(|(next, iterations)| {
            let turned = tangent(curve, &next, &scale, &along)?;
            let is_smooth = turned.dot(&along) > SMALLEST_COSINE;
            (is_smooth || length < KINK).then_some((next, turned, iterations, is_smooth))
        });
        let Some((next, turned, iterations, is_smooth)) = found else {
            length *= 0.5;
            if length < SHORTEST {
                return Err(Lost { points });
            }
            continue;
        };
        if (next[monitored] - to) * direction >= 0.0 {
            let mut last = next;
            last[monitored] = to;
            points.extend(point(curve, &last, monitored));
            return Ok(points);
        }
        if (next[monitored] - from) * direction < 0.0 {
            return Ok(points);
        }
        progress((next[monitored] - from) / (to - from));
        let faster = (USUAL_ITERATIONS / iterations as f64).clamp(0.5, 1.5);
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
    Err(Lost { points })
}
