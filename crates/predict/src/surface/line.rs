//! A straight line through the logarithms of a spectrum's band means, by generalised least squares.

use bolted_joint_statistics::{digamma_less_log, trigamma};
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

use super::bands::Bands;
use super::{Spectrum, Welch};

/// A straight line through the logarithms of band means.
#[derive(Debug)]
pub(super) struct Line {
    /// ln S at the reference frequency, and the slope.
    pub(super) at_reference: Vector2<f64>,
    pub(super) covariance: Matrix2<f64>,
    pub(super) chi_squared: f64,
    pub(super) log_standard_deviation: Vec<f64>,
    /// ln of each band's mean over the line.
    pub(super) residual: DVector<f64>,
}

impl Line {
    /// Fits ln S = a + k (ln f − reference) to band means; `None` if there is no power in a band.
    pub(super) fn fitted(
        spectrum: &Spectrum,
        bands: &Bands,
        welch: &Welch,
        points: &[usize],
        reference: f64,
    ) -> Option<Self> {
        let count = bands.count();
        let relative = bands.covariance(welch, points);
        // A mean of gamma variables is nearly one itself, of shape 1/variance: the mean and the variance of its logarithm.
        let shape = |band: usize| 1.0 / relative[band][band];
        let bias = DVector::from_fn(count, |band, _| digamma_less_log(shape(band)));
        let log_variance: Vec<f64> = (0..count).map(|band| trigamma(shape(band))).collect();
        let covariance = DMatrix::from_fn(count, count, |a, b| {
            relative[a][b] * (log_variance[a] * log_variance[b] * shape(a) * shape(b)).sqrt()
        });
        let weight = covariance.cholesky()?.inverse();
        let design = DMatrix::from_fn(count, 2, |band, column| match column {
            0 => 1.0,
            _ => bands.centre()[band] - reference,
        });
        let normal = design.transpose() * &weight;
        let information = &normal * &design;
        let information = Matrix2::from_fn(|row, column| information[(row, column)]);
        let line_covariance = information.try_inverse()?;

        let (frequency, density) = (&spectrum.frequency_per_m, &spectrum.density_m3);
        let smoothing = welch.smoothing();
        let residual = |line: &Vector2<f64>| -> Option<DVector<f64>> {
            let slope = line[1];
            // Mean of S/S_line over the band. The window's main lobe lifts a spectrum f^k by ½ k (k − 1) σ²/n², n the line's number.
            let means = bands.means(|place| {
                let lift = 1.0 + 0.5 * slope * (slope - 1.0) * smoothing / (place as f64).powi(2);
                let on_line = (line[0] + slope * (frequency[place].ln() - reference)).exp();
                density[place] / (on_line * lift.max(1.0))
            });
            let valid = means.iter().all(|mean| mean.is_finite() && *mean > 0.0);
            valid.then(|| DVector::from_iterator(count, means.iter().map(|mean| mean.ln())) - &bias)
        };
        let start = bands.means(|place| density[place]);
        let logarithms = start.iter().map(|mean| mean.ln()).sum::<f64>() / count as f64;
        let mut line = Vector2::new(logarithms, -2.0);
        let mut rest = residual(&line)?;
        // The weighted mean ratio of each band depends on the line a little: Newton with the slope at the band's middle.
        for _ in 0..100 {
            let step = line_covariance * (&normal * &rest).fixed_rows::<2>(0).into_owned();
            line += step;
            rest = residual(&line)?;
            if step.amax() < 1e-13 * line.amax() {
                break;
            }
        }
        let chi_squared = rest.dot(&(&weight * &rest));
        Some(Self {
            at_reference: line,
            covariance: line_covariance,
            chi_squared,
            log_standard_deviation: log_variance
                .iter()
                .map(|variance| variance.sqrt())
                .collect(),
            residual: rest,
        })
    }
}
