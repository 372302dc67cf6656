//! The fitted surface, its layers, and how well it is determined.

use super::problem::{Problem, Unknowns};
use super::search::bounds;
use super::{Fit, FittedLayer, Magnitudes, Observation};
use crate::least_squares::{normal_equations, solved};
use crate::surface::Roughness;
use crate::virtual_material::{LayerContact, Moduli};
use crate::{ContactError, Pair};

/// Finds D and G by least squares on the logarithms of both moduli, for a pair of materials of a hardness (Pa) under β/f times the friction force.
///
/// All surfaces with elastic contacts in every layer are searched on a grid; the best minima of it are refined by the method of
/// Levenberg and Marquardt.
///
/// # Errors
/// Too few layers, or numbers that are not positive.
pub fn fit(
    observations: &[Observation],
    pair: &Pair,
    hardness_pa: f64,
    friction_ratio: f64,
    magnitudes: Magnitudes,
) -> Result<Fit, ContactError> {
    let problem = Problem {
        observations,
        pair,
        hardness_pa,
        friction_ratio,
        magnitudes,
    };
    problem.check()?;
    let best = problem
        .starts()
        .into_iter()
        .map(|start| problem.squares().refined(start))
        .min_by(|one, other| one.1.total_cmp(&other.1))
        .ok_or(ContactError::NothingFits)?;
    problem.result(best.0)
}

impl Problem<'_> {
    pub(super) fn result(&self, at: Unknowns) -> Result<Fit, ContactError> {
        let roughness_m = self.roughness_at(at).ok_or(ContactError::NothingFits)?;
        let roughness = Roughness::new(at[0], roughness_m)?;
        let contact =
            LayerContact::new(self.pair, roughness, self.hardness_pa, self.friction_ratio)?;
        let (_, means) = self.differences(contact).ok_or(ContactError::NothingFits)?;
        let magnitudes = match self.magnitudes {
            Magnitudes::Stated => [1.0; 2],
            Magnitudes::Free => means.map(|mean| (-mean).exp()),
        };
        let layers = self.observations.iter().map(|observation| {
            let moduli = contact.moduli(observation.loading)?;
            Ok(FittedLayer {
                moduli: Moduli {
                    youngs_modulus_pa: magnitudes[0] * moduli.youngs_modulus_pa,
                    shear_modulus_pa: magnitudes[1] * moduli.shear_modulus_pa,
                },
                area_ratio: contact.real_area_m2(observation.loading)?
                    / contact.critical_real_area_m2(),
            })
        });
        let layers = layers.collect::<Result<Vec<_>, ContactError>>()?;
        let count = 2 * self.observations.len();
        let sum = self.squares().objective(at);
        let is_at_bound = (0..2).any(|n| bounds()[n].contains(&at[n]));
        let deviations = self.deviations(at, roughness_m, sum, is_at_bound);
        Ok(Fit {
            roughness,
            dimension_deviation: deviations.map(|of| of[0]),
            log_roughness_deviation: deviations.map(|of| of[1]),
            magnitudes,
            log_residual: (sum / count as f64).sqrt(),
            is_at_bound,
            layers,
        })
    }

    /// Standard deviations of D and ln G: the diagonal of s² (JᵀJ)⁻¹.
    pub(super) fn deviations(
        &self,
        at: Unknowns,
        roughness_m: f64,
        sum: f64,
        is_at_bound: bool,
    ) -> Option<[f64; 2]> {
        let freedom = (2 * self.observations.len()).checked_sub(self.unknowns())?;
        if freedom == 0 || is_at_bound {
            return None;
        }
        let (matrix, _) = normal_equations(|[d, log_roughness]| {
            self.residuals_of(self.contact(at[0] + d, roughness_m * log_roughness.exp())?)
        })?;
        let variance = sum / freedom as f64;
        let first = solved(matrix, [1.0, 0.0])?;
        let second = solved(matrix, [0.0, 1.0])?;
        let variances = [variance * first[0], variance * second[1]];
        variances
            .iter()
            .all(|value| value.is_finite() && *value >= 0.0)
            .then(|| variances.map(f64::sqrt))
    }
}
