//! Least squares with two unknowns within bounds, by the method of Levenberg and Marquardt.

const MOST_STEPS: usize = 500;
/// A change of the unknowns that is none.
const SMALL_STEP: f64 = 1e-13;
const DIFFERENCE: f64 = 1e-6;

/// A sum of squares over pairs of residuals; `None` where the unknowns have none.
pub(crate) struct TwoUnknowns<R> {
    /// Residuals at the unknowns.
    pub(crate) residuals: R,
    /// Lowest and highest value of each unknown.
    pub(crate) bounds: [[f64; 2]; 2],
}

impl<R: Fn([f64; 2]) -> Option<Vec<[f64; 2]>>> TwoUnknowns<R> {
    /// The sum of squares; infinite where there is none.
    pub(crate) fn objective(&self, at: [f64; 2]) -> f64 {
        let sum = (self.residuals)(at).map(|all| all.iter().map(|[a, b]| a * a + b * b).sum());
        sum.filter(|sum: &f64| sum.is_finite())
            .unwrap_or(f64::INFINITY)
    }

    /// The minimum near a start, and its sum of squares.
    pub(crate) fn refined(&self, start: [f64; 2]) -> ([f64; 2], f64) {
        let mut at = start;
        let mut least = self.objective(at);
        let mut damping = 1e-3;
        for _ in 0..MOST_STEPS {
            let shifted = |shift: [f64; 2]| (self.residuals)([at[0] + shift[0], at[1] + shift[1]]);
            let Some((matrix, gradient)) = normal_equations(shifted) else {
                break;
            };
            let Some(trial) = self.within(at, step(matrix, gradient, damping), |held| {
                gradient[1 - held] / (matrix[1 - held][1 - held] * (1.0 + damping))
            }) else {
                break;
            };
            let value = self.objective(trial);
            let change = (trial[0] - at[0]).abs().max((trial[1] - at[1]).abs());
            if value < least {
                (at, least) = (trial, value);
                damping = (0.2 * damping).max(1e-12);
            } else {
                damping *= 5.0;
            }
            if change < SMALL_STEP {
                break;
            }
        }
        (at, least)
    }

    /// Where a step leads within the bounds. An unknown that would leave them is held at its bound; the other one then takes
    /// the step `alone`.
    fn within(
        &self,
        at: [f64; 2],
        step: Option<[f64; 2]>,
        alone: impl Fn(usize) -> f64,
    ) -> Option<[f64; 2]> {
        let clamped = |n: usize, value: f64| value.clamp(self.bounds[n][0], self.bounds[n][1]);
        let step = step?;
        let mut trial = [0, 1].map(|n| clamped(n, at[n] - step[n]));
        for held in [0, 1] {
            let other = 1 - held;
            if trial[held] == at[held] && step[held] != 0.0 && self.bounds[held].contains(&at[held])
            {
                trial[other] = clamped(other, at[other] - alone(held));
            }
        }
        Some(trial)
    }
}

/// JᵀJ and Jᵀr by central differences, of residuals at shifts of the unknowns.
pub(crate) fn normal_equations(
    residuals: impl Fn([f64; 2]) -> Option<Vec<[f64; 2]>>,
) -> Option<([[f64; 2]; 2], [f64; 2])> {
    let here = residuals([0.0; 2])?;
    let mut columns = Vec::new();
    for unknown in 0..2 {
        let shifted = |sign: f64| {
            let mut shift = [0.0; 2];
            shift[unknown] = sign * DIFFERENCE;
            residuals(shift)
        };
        let (above, below) = (shifted(1.0)?, shifted(-1.0)?);
        let slopes = above
            .iter()
            .zip(&below)
            .map(|(above, below)| [0, 1].map(|n| (above[n] - below[n]) / (2.0 * DIFFERENCE)));
        columns.push(slopes.collect::<Vec<[f64; 2]>>());
    }
    let product = |one: &[[f64; 2]], other: &[[f64; 2]]| -> f64 {
        let pairs = one.iter().zip(other);
        pairs.map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum()
    };
    let matrix = [0, 1].map(|row| [0, 1].map(|column| product(&columns[row], &columns[column])));
    let gradient = [0, 1].map(|row| product(&columns[row], &here));
    Some((matrix, gradient))
}

/// The step of Levenberg and Marquardt, to be subtracted.
fn step(matrix: [[f64; 2]; 2], gradient: [f64; 2], damping: f64) -> Option<[f64; 2]> {
    let [[a, b], [c, d]] = matrix;
    solved(
        [[a * (1.0 + damping), b], [c, d * (1.0 + damping)]],
        gradient,
    )
}

/// Solution of two equations, if they are independent.
pub(crate) fn solved(matrix: [[f64; 2]; 2], right: [f64; 2]) -> Option<[f64; 2]> {
    let [[a, b], [c, d]] = matrix;
    let determinant = a * d - b * c;
    (determinant.abs() > 1e-13 * (a * d).abs()).then(|| {
        [
            (right[0] * d - right[1] * b) / determinant,
            (right[1] * a - right[0] * c) / determinant,
        ]
    })
}
