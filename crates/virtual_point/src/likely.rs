//! Errors of the set-up that are likely, before anything but the functions near the interface is known.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::search::Start;
use crate::{Role, Tolerance, VirtualPoint, VirtualPointError};

/// Rounds in which σ² follows the errors.
const ROUNDS: usize = 2;

impl VirtualPoint {
    /// η, in m, rad and parts, in the order of [`Places::parameters`](crate::Places::parameters), that explain best
    /// within the budget what is not rigid; `None` where no search leads there.
    ///
    /// # Errors
    ///
    /// Those of [`Self::consistency`].
    pub fn likely_errors(
        &self,
        role: Role,
        lines: &[DMatrix<Complex64>],
        tolerance: &Tolerance,
    ) -> Result<Option<Vec<f64>>, VirtualPointError> {
        let spread = self.spread(role, lines)?;
        let places = self.set_up().places(role);
        let search = self.search(role, lines, &spread, tolerance);
        let parameters = places.parameters();
        let within = vec![1.0; parameters.len()];
        let mut start = Start {
            places: places.clone(),
            errors: DVector::zeros(parameters.len()),
        };
        let Some(mut noise) = search.told(places).map(|told| told.noise) else {
            return Ok(None);
        };
        // what is left at the places that were found is less
        for _ in 0..ROUNDS {
            let Some(found) = search.fitted(&start, &within, noise) else {
                return Ok(None);
            };
            noise = noise.min(found.noise);
            start = found.end;
        }
        let errors = parameters.iter().zip(start.errors.iter());
        Ok(Some(
            errors
                .map(|(one, part)| part * tolerance.of(one.change))
                .collect(),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::trial;

    /// Rows R(η) = R of the drawing cannot be told from others by the functions alone, as a motion of all is no error. What is left of
    /// the rows beside any six motions is: R(η) M for some M, to the noise.
    #[test]
    fn likely_errors_make_the_rows_those_of_the_functions() {
        for seed in 1..=10 {
            let (point, lines) = trial(1000 * seed, None);
            for role in [Role::Channel, Role::Impact] {
                let found = point.likely_errors(role, &lines, &Tolerance::TYPICAL);
                let errors = found.unwrap().unwrap();
                let places = point.set_up().places(role);
                let left = |matrix: &DMatrix<f64>| {
                    let inverse =
                        (matrix.transpose() * matrix).try_inverse().unwrap() * matrix.transpose();
                    let rest = (DMatrix::identity(places.count(), places.count())
                        - matrix * inverse)
                        .map(Complex64::from);
                    let of = |line: &DMatrix<Complex64>| {
                        let seen = match role {
                            Role::Channel => line.clone(),
                            Role::Impact => line.transpose(),
                        };
                        (&rest * &seen).norm() / seen.norm()
                    };
                    lines.iter().map(of).sum::<f64>() / lines.len() as f64
                };
                let (before, after) = (
                    left(places.matrix()),
                    left(places.displaced(&errors).unwrap().matrix()),
                );
                // the functions have noise of 0.002 at most
                assert!(before > 0.005 && after < 0.002, "{seed}: {before} {after}");
            }
        }
    }
}
