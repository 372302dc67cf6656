//! Frequency and decay of a mode over a few periods, from its complex amplitude at their half-periods, with their errors.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::{AT_THE_EDGE, LEAST};

/// A mode's complex amplitude at one time, and the largest sample about it.
pub(super) struct Point {
    pub(super) time_s: f64,
    pub(super) z: Complex64,
    pub(super) largest: f64,
}

impl Point {
    /// Whether it stands clear of noise and of other modes.
    pub(super) fn is_clear(&self, of_noise: f64) -> bool {
        self.z.norm() > LEAST * of_noise.max(AT_THE_EDGE * self.largest)
    }
}

/// Ten half-periods: amplitude, by how much the mode turns faster than the phasor (rad/s), and how it decays (1/s).
pub(super) struct Stretch {
    /// The middle of its times.
    pub(super) middle_s: f64,
    pub(super) amplitude: f64,
    pub(super) detuning: f64,
    pub(super) decay: f64,
    /// Times of its points, and by how much an error of each one's z moves slope and mean of ln z.
    points: Vec<(f64, [f64; 2])>,
}

impl Stretch {
    pub(super) fn of(points: &[Point], sigma_s: f64) -> Self {
        let count = points.len() as f64;
        let middle_s = points.iter().map(|point| point.time_s).sum::<f64>() / count;
        // ln z = ln A − δt + j Δω t: a straight line by least squares; the phase is unwrapped from point to point
        let mut before = points.first().map_or(Complex64::ONE, |point| point.z);
        let mut logarithm = before.ln();
        let (mut mean, mut slope, mut square) = (Complex64::ZERO, Complex64::ZERO, 0.0);
        for &Point { time_s, z, .. } in points {
            logarithm += (z / before).ln();
            before = z;
            mean += logarithm / count;
            slope += logarithm * (time_s - middle_s);
            square += (time_s - middle_s).powi(2);
        }
        let slope = slope / square;
        // the window averages e^{(−δ + jΔω)t} to exp(½ (−δ + jΔω)² σ²) of it
        let averaged = 0.5 * slope * slope * sigma_s * sigma_s;
        Self {
            middle_s,
            amplitude: (mean - averaged).re.exp(),
            detuning: slope.im,
            decay: -slope.re,
            points: points
                .iter()
                .map(|Point { time_s, z, .. }| {
                    let by = [(time_s - middle_s) / square, count.recip()];
                    (*time_s, by.map(|by| by / z.norm()))
                })
                .collect(),
        }
    }
}

/// Which of a stretch's numbers an error is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// The slope of ln z: its real part is −δ, its imaginary one Δω.
    Slope,
    /// The mean of ln z: its real part is ln A.
    Mean,
}

/// Covariance of one part's errors with another's, which is the same of real and imaginary parts: the window makes noise of
/// one point noise of its neighbours, `of_noise` being the root mean square of the noise of |z|.
pub(super) fn covariance(
    stretches: &[Stretch],
    (sigma_s, of_noise): (f64, f64),
    [one, other]: [Part; 2],
) -> DMatrix<f64> {
    let count = stretches.len();
    let between = |a: &Stretch, b: &Stretch| -> f64 {
        let pairs = a
            .points
            .iter()
            .flat_map(|a| b.points.iter().map(move |b| (a, b)));
        // each part of z has half of its variance, and neighbours have e^(−Δt²/4σ²) in common
        let of_pair = pairs.map(|((t, by), (other_t, other_by))| {
            let distance = (t - other_t) / sigma_s;
            by[one as usize] * other_by[other as usize] * (-0.25 * distance * distance).exp()
        });
        0.5 * of_noise * of_noise * of_pair.sum::<f64>()
    };
    DMatrix::from_fn(count, count, |i, j| between(&stretches[i], &stretches[j]))
}
