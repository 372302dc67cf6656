//! Whether what is not rigid is noise, or the interface bends and sensors are wrong.

use bolted_joint_statistics::chi_squared_tail;
use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::point::sized;
use crate::{Role, VirtualPoint, VirtualPointError};

/// Noise of the functions at one line: complex, circular and independent, E|ε|² = σ².
#[derive(Clone, Debug, PartialEq)]
pub enum Noise {
    /// σ of all functions, in the unit of the functions.
    White(f64),
    /// σ of each function, channels × impacts.
    Each(DMatrix<f64>),
}

impl Noise {
    /// σ² of each function.
    pub(crate) fn variances(
        &self,
        channels: usize,
        impacts: usize,
    ) -> Result<DMatrix<f64>, VirtualPointError> {
        let deviations = match self {
            Self::White(deviation) => DMatrix::from_element(channels, impacts, *deviation),
            Self::Each(deviations) => {
                sized("rows of the noise", deviations.nrows(), channels)?;
                sized("columns of the noise", deviations.ncols(), impacts)?;
                deviations.clone()
            }
        };
        let wrong = deviations.iter().copied();
        let mut wrong = wrong.filter(|deviation| !(*deviation >= 0.0 && deviation.is_finite()));
        if let Some(found) = wrong.next() {
            let (what, expected) = (
                "noise of a function",
                "a finite number that is not negative",
            );
            return Err(VirtualPointError::Deviation {
                what,
                found,
                expected,
            });
        }
        Ok(deviations.map(|deviation| deviation * deviation))
    }
}

/// What is left of the functions beside the noise that would leave something too.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseTest {
    /// ‖(I − F) Y‖² over its expectation from noise alone, at each line: about 1 if there is nothing but noise.
    pub ratios: Vec<f64>,
    /// The mean of them.
    pub ratio: f64,
    /// Degrees of freedom of all lines: 2 (n − 6) for each function's partner with white noise and equal weights;
    /// otherwise those of the χ² with the same variance (Satterthwaite 1946), rounded.
    pub degrees_of_freedom: usize,
    /// Probability that noise alone leaves this much or more.
    pub probability: f64,
}

impl VirtualPoint {
    /// Compares what is not rigid with noise: (I − F_u) Y for channels, Y (I − F_f) for impacts. The noise is that of
    /// each line. None for six places alone, which leave nothing.
    ///
    /// E‖(I − F) ε‖² = (n − 6) m σ² for white noise and equal weights, with n places and m functions of each; in
    /// general Σ_j tr(P S_j Pᵀ), P = I − F, S_j the variances of the functions of partner j.
    ///
    /// # Errors
    ///
    /// Those of [`Self::consistency`]; [`VirtualPointError::Size`] unless there is noise for each line,
    /// [`VirtualPointError::Deviation`] for noise that is negative or 0 throughout.
    pub fn noise_test(
        &self,
        role: Role,
        lines: &[DMatrix<Complex64>],
        noise: &[Noise],
    ) -> Result<Option<NoiseTest>, VirtualPointError> {
        self.all_checked(lines)?;
        sized("lines with noise", noise.len(), lines.len())?;
        let what = "lines";
        if lines.is_empty() {
            return Err(VirtualPointError::Nothing { what });
        }
        let (channels, impacts) = (self.count(Role::Channel), self.count(Role::Impact));
        if self.count(role) == self.motion_count() {
            return Ok(None);
        }
        let rest = self.projection(role).rest();
        let of_rest = rest.map(Complex64::from);
        let mut ratios = Vec::with_capacity(lines.len());
        let mut degrees = 0.0;
        let mut scaled = 0.0;
        for (line, noise) in lines.iter().zip(noise) {
            let variances = noise.variances(channels, impacts)?;
            let (functions, variances) = match role {
                Role::Channel => (line.clone(), variances),
                Role::Impact => (line.transpose(), variances.transpose()),
            };
            let (expected, variance) = moments(&rest, &variances);
            if expected <= 0.0 {
                let (what, expected) = ("noise of a line", "a positive number for some function");
                return Err(VirtualPointError::Deviation {
                    what,
                    found: 0.0,
                    expected,
                });
            }
            let ratio = (&of_rest * functions).norm_squared() / expected;
            // 2 E²/Var of a real χ²
            let own = 2.0 * expected * expected / variance;
            degrees += own;
            scaled += own * ratio;
            ratios.push(ratio);
        }
        let degrees_of_freedom = degrees.round() as usize;
        Ok(Some(NoiseTest {
            ratio: ratios.iter().sum::<f64>() / ratios.len() as f64,
            ratios,
            degrees_of_freedom,
            probability: chi_squared_tail(scaled, degrees_of_freedom),
        }))
    }
}

/// Mean and variance of ‖P ε‖² with such variances of ε: Σ_j tr(P S_j Pᵀ) and Σ_j tr((P S_j Pᵀ)²).
fn moments(rest: &DMatrix<f64>, variances: &DMatrix<f64>) -> (f64, f64) {
    let mut sums = (0.0, 0.0);
    for partner in variances.column_iter() {
        let spread = DMatrix::from_diagonal(&partner.into_owned());
        let covariance = rest * spread * rest.transpose();
        sums.0 += covariance.trace();
        sums.1 += covariance.norm_squared();
    }
    sums
}

#[cfg(test)]
mod tests {
    use bolted_joint_testing::{close, near};

    use super::*;
    use crate::Weights;
    use crate::samples::*;

    #[test]
    fn white_noise_leaves_what_it_should() {
        let point = equal(disordered(2));
        let mut mixed = Mixed(9_000_000);
        let deviation = 3e-7;
        let lines: Vec<_> = (0..400)
            .map(|line| {
                let rigid = point.set_up().functions(&full_receptance(line));
                rigid + mixed.noise(12, 12) * Complex64::from(deviation)
            })
            .collect();
        let noise = vec![Noise::White(deviation); lines.len()];
        for role in [Role::Channel, Role::Impact] {
            let test = point.noise_test(role, &lines, &noise).unwrap().unwrap();
            assert_eq!(test.degrees_of_freedom, 2 * 6 * 12 * 400);
            // one standard deviation is √(2/57600) = 0.006
            near(test.ratio, 1.0, 0.02);
            assert!(test.probability > 0.01, "{}", test.probability);
            let less = vec![Noise::White(deviation * 0.9); lines.len()];
            let wrong = point.noise_test(role, &lines, &less).unwrap().unwrap();
            close(wrong.ratio, test.ratio / 0.81, 1e-12);
            assert!(wrong.probability < 1e-9);
        }
    }

    #[test]
    fn noise_of_each_function_and_weights_leave_what_they_should() {
        let mut mixed = Mixed(8_000_000);
        let weights = [mixed.definite(12), mixed.definite(12)].map(Weights::Full);
        let point = VirtualPoint::new(disordered(2), &weights[0], &weights[1]).unwrap();
        let each = DMatrix::from_fn(12, 12, |_, _| 1.0 + 0.9 * mixed.next());
        let lines: Vec<_> = (0..800)
            .map(|_| {
                mixed
                    .noise(12, 12)
                    .component_mul(&each.map(Complex64::from))
            })
            .collect();
        let noise = vec![Noise::Each(each); lines.len()];
        for role in [Role::Channel, Role::Impact] {
            let test = point.noise_test(role, &lines, &noise).unwrap().unwrap();
            near(test.ratio, 1.0, 0.04);
            assert!(test.probability > 0.01, "{}", test.probability);
            // the variance of the ratios is 2/ν of one line
            let spread = test
                .ratios
                .iter()
                .map(|ratio| (ratio - 1.0).powi(2))
                .sum::<f64>()
                / 800.0;
            close(spread, 2.0 * 800.0 / test.degrees_of_freedom as f64, 0.2);
        }
    }

    #[test]
    fn what_is_no_noise_is_refused() {
        let point = equal(check_set_up());
        let lines = [check_functions()];
        for wrong in [-1.0, f64::NAN, 0.0] {
            let test = point.noise_test(Role::Channel, &lines, &[Noise::White(wrong)]);
            assert!(
                matches!(test, Err(VirtualPointError::Deviation { .. })),
                "{test:?}"
            );
        }
        let small = [Noise::Each(DMatrix::from_element(8, 7, 1.0))];
        let test = point.noise_test(Role::Channel, &lines, &small);
        assert!(matches!(
            test,
            Err(VirtualPointError::Size {
                found: 8,
                expected: 9,
                ..
            })
        ));
        let test = point.noise_test(Role::Channel, &lines, &[]);
        assert!(matches!(
            test,
            Err(VirtualPointError::Size {
                found: 0,
                expected: 1,
                ..
            })
        ));
    }
}
