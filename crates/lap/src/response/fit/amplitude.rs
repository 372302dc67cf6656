//! The amplitude of one line of stepped sines: it is unknown beside the model's numbers, and follows them.

use crate::response::model::LineResidual;

/// Longest step of the logarithm of an amplitude.
pub(super) const LONGEST: f64 = 0.5;
/// Iterations of one line's amplitude, shortened steps in each, and the step that is none.
const SETTLING: usize = 12;
const HALVINGS: usize = 4;
const SETTLED: f64 = 1e-8;

/// The amplitude that fits one line best, near a first guess: a force without error, which fixes it, would otherwise hold up every
/// step of the model.
pub(super) fn settled(
    mut log_amplitude: f64,
    residual: impl Fn(f64) -> LineResidual,
) -> (f64, LineResidual) {
    let cost = |line: &LineResidual| dot(&line.residual, &line.residual);
    let mut line = residual(log_amplitude);
    for _ in 0..SETTLING {
        let (direction, length) = unit(line.by_log_amplitude);
        if length == 0.0 {
            break;
        }
        let mut step = (-dot(&line.residual, &direction) / length).clamp(-LONGEST, LONGEST);
        let mut is_better = false;
        for _ in 0..HALVINGS {
            if step.abs() < SETTLED {
                break;
            }
            let trial = residual(log_amplitude + step);
            if cost(&trial) < cost(&line) {
                log_amplitude += step;
                line = trial;
                is_better = true;
                break;
            }
            step *= 0.25;
        }
        if !is_better {
            break;
        }
    }
    (log_amplitude, line)
}

pub(super) fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Direction and length; no direction of what has no length.
pub(super) fn unit(vector: [f64; 3]) -> ([f64; 3], f64) {
    let length = dot(&vector, &vector).sqrt();
    if length > 0.0 && length.is_finite() {
        (vector.map(|entry| entry / length), length)
    } else {
        ([0.0; 3], 0.0)
    }
}
