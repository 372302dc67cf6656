//! Errors of a curve that was read from a record: those of neighbouring points are alike.

use nalgebra::{DMatrix, DVector};

use crate::response::backbone::{BackboneLine, Row};

/// Errors of the points of a decay: of the logarithm of the frequency, and of the damping ratio.
///
/// Both are compared with a model at the amplitude that was read, so that an error of that moves them as well, by the
/// slopes of the model's curves.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::response) struct ReadingErrors {
    /// Of the window that the record was read through.
    pub(super) sigma_s: f64,
    /// Covariance of the slopes of ln z, 1/s².
    pub(super) of_slopes: DMatrix<f64>,
    /// Covariance of the logarithms of the amplitudes.
    pub(super) of_amplitudes: DMatrix<f64>,
    /// Covariance of the logarithms of the amplitudes (rows) with the slopes, 1/s.
    pub(super) between: DMatrix<f64>,
    /// Errors beside those of the noise, as parts of frequencies and damping ratios.
    pub(super) beside: [f64; 2],
    /// Variances of all: frequencies, then damping ratios.
    variances: DVector<f64>,
    /// L⁻¹ of the Cholesky factor of their covariance.
    whitening: DMatrix<f64>,
}

impl ReadingErrors {
    /// `None` where the covariance is not definite. The parts are in the order of the fields.
    pub(super) fn of(
        lines: &[BackboneLine],
        sigma_s: f64,
        [of_slopes, of_amplitudes, between]: [DMatrix<f64>; 3],
        beside: [f64; 2],
    ) -> Option<Self> {
        let mut own = Self {
            sigma_s,
            of_slopes,
            of_amplitudes,
            between,
            beside,
            variances: DVector::zeros(0),
            whitening: DMatrix::zeros(0, 0),
        };
        own.follow(lines, &vec![[0.0; 2]; lines.len()])?;
        Some(own)
    }

    /// Takes the slopes of the model's ln ω and ζ over ln A at each line into account.
    pub(super) fn follow(&mut self, lines: &[BackboneLine], slopes: &[[f64; 2]]) -> Option<()> {
        let count = lines.len();
        let ratio = |i: usize| lines[i].damping_ratio.unwrap_or(0.0);
        // e = Δω/ω − (d ln ω/d ln A) ΔlnA, d = Δδ/ω − (dζ/d ln A) ΔlnA, where Δδ is less the slope's
        let covariance = DMatrix::from_fn(2 * count, 2 * count, |row, column| {
            let ((kind, i), (other, j)) =
                ((row / count, row % count), (column / count, column % count));
            let mut sum = slopes[i][kind] * slopes[j][other] * self.of_amplitudes[(i, j)];
            if kind == other {
                sum += self.of_slopes[(i, j)] / (lines[i].omega * lines[j].omega);
            }
            if other == 1 {
                sum += slopes[i][kind] * self.between[(i, j)] / lines[j].omega;
            }
            if kind == 1 {
                sum += slopes[j][other] * self.between[(j, i)] / lines[i].omega;
            }
            if row == column {
                let size = [1.0, ratio(i)][kind];
                sum += (self.beside[kind] * size).powi(2);
            }
            sum
        });
        self.variances = covariance.diagonal();
        let factor = covariance.cholesky()?.unpack();
        self.whitening = factor.solve_lower_triangular(&DMatrix::identity(2 * count, 2 * count))?;
        Some(())
    }

    /// Variances of a line's logarithm of the frequency and of its damping ratio.
    pub(in crate::response) fn variances_of(&self, line: usize) -> [f64; 2] {
        let count = self.of_slopes.nrows();
        [line, count + line].map(|place| self.variances.get(place).copied().unwrap_or(0.0))
    }

    /// Covariance of the logarithms of the amplitudes of two lines.
    pub(in crate::response) fn of_amplitudes(&self, line: usize, other: usize) -> f64 {
        let entry = self.of_amplitudes.get((line, other));
        entry.copied().unwrap_or(0.0)
    }

    /// Deviations of frequencies, then of damping ratios, with their derivatives, in parts that are independent and have a
    /// standard deviation of one.
    pub(in crate::response) fn whitened(&self, deviations: &[Row]) -> Vec<Row> {
        let unknowns = deviations.first().map_or(0, |(_, by)| by.len());
        let values = DVector::from_iterator(deviations.len(), deviations.iter().map(|row| row.0));
        let by = DMatrix::from_fn(deviations.len(), unknowns, |i, j| deviations[i].1[j]);
        let (values, by) = (&self.whitening * values, &self.whitening * by);
        let rows = values.iter().enumerate();
        rows.map(|(i, value)| (*value, by.row(i).iter().copied().collect()))
            .collect()
    }
}
