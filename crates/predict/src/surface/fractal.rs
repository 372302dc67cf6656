//! D and G from a straight line through a spectrum, and how well they are known.

use nalgebra::{Matrix2, Vector2};

use super::{Roughness, SurfaceError};

/// D and G from the line.
#[derive(Debug)]
pub(super) struct Fractal {
    pub(super) roughness: Roughness,
    /// Of D and ln G.
    pub(super) covariance: [[f64; 2]; 2],
    pub(super) dimension_interval: [f64; 2],
    pub(super) roughness_interval_m: [f64; 2],
}

impl Fractal {
    pub(super) fn from_line(
        line: Vector2<f64>,
        covariance: Matrix2<f64>,
        reference: f64,
        quantile: f64,
        gamma: f64,
        wavelength_m: [f64; 2],
    ) -> Result<Self, SurfaceError> {
        let [at_reference, slope] = [line[0], line[1]];
        // Zhao (31): the slope is 2D − 5, ln S(1) = 2(D − 1) ln G − ln(2 ln γ)
        let dimension = 0.5 * (5.0 + slope);
        let standard_deviation = 0.5 * covariance[(1, 1)].sqrt();
        let outside = || SurfaceError::Dimension {
            dimension,
            standard_deviation,
            slope,
            wavelength_m,
        };
        if !(dimension > 1.0 && dimension < 2.0) {
            return Err(outside());
        }
        let twice = 2.0 * (dimension - 1.0);
        let log_roughness = (at_reference - slope * reference + (2.0 * gamma.ln()).ln()) / twice;
        // d ln G = (da − (ln f₀ + ln G) dk)/(2(D − 1))
        let lever = reference + log_roughness;
        let [aa, ak, kk] = [covariance[(0, 0)], covariance[(0, 1)], covariance[(1, 1)]];
        let numerator = aa - 2.0 * lever * ak + lever * lever * kk;
        let with_slope = ak - lever * kk;
        // Fieller: all g with (u − g q)² ≤ z² var(u − g q), where q = 2(D − 1) and g is ln G.
        let z_squared = quantile * quantile;
        let leading = twice * twice - z_squared * kk;
        if leading <= 0.0 {
            return Err(SurfaceError::Undetermined {
                dimension,
                standard_deviation,
            });
        }
        let middle = -z_squared * with_slope / leading;
        let half = (middle * middle + z_squared * numerator / leading).sqrt();
        let roughness = Roughness::new(dimension, log_roughness.exp()).map_err(|_| outside())?;
        Ok(Self {
            roughness,
            covariance: [
                [0.25 * kk, 0.5 * with_slope / twice],
                [0.5 * with_slope / twice, numerator / (twice * twice)],
            ],
            dimension_interval: [
                dimension - quantile * standard_deviation,
                dimension + quantile * standard_deviation,
            ],
            roughness_interval_m: [
                (log_roughness + middle - half).exp(),
                (log_roughness + middle + half).exp(),
            ],
        })
    }
}
