//! What speaks against a result.

use bolted_joint_space::semidefinite;
use bolted_joint_statistics::chi_squared_tail;
use nalgebra::Matrix6;

use crate::identification::{SpatialIdentification, Unknown};
use crate::problem::Level;

/// Squares of the errors of the set-up over those of the budget beyond which it does not hold.
const BEYOND_BUDGET: f64 = 2.0;

/// χ² over degrees of freedom beyond which stated noise does not explain the residuals.
const MISFIT: f64 = 1.5;

/// Likewise from which on a level that is stated too small may be why no search is confirmed.
const REMARKABLE: f64 = 1.1;

/// Residual over computed functions, r.m.s., beyond which the model is not that of the data.
const RESIDUAL_MAX: f64 = 0.5;

/// Probability below which noise does not make a passive joint look like one that feeds energy.
const UNLIKELY: f64 = 1e-6;

/// Negative eigenvalues of a scaled matrix that noise does not excuse.
const NOT_PASSIVE: f64 = 1e-9;

impl SpatialIdentification {
    pub(crate) fn reasons(&self, level: Level, has_converged: bool) -> Vec<String> {
        let mut reasons = of_search(has_converged, self.relative_rms);
        let of_level = self.reduced_chi_squared.filter(|_| !has_converged);
        reasons.extend(of_level.and_then(|chi| of_small_noise(level, chi)));
        if let Some(used) = self.budget_used.filter(|&used| used > BEYOND_BUDGET) {
            reasons.push(format!(
                "the errors of the set-up would be {:.1} times as large as the budget says: check positions, directions, signs and gains \
                 of sensors and impacts, or state larger ones in budget",
                used.sqrt()
            ));
        }
        reasons.extend(of_noise(level, self.reduced_chi_squared));
        for (name, matrix) in [("stiffness", &self.stiffness), ("damping", &self.damping)] {
            if let Err(refused) = semidefinite(matrix)
                && !is_excused(matrix)
            {
                reasons.push(format!("joint.{name} is not passive: {refused}"));
            }
        }
        reasons
    }
}

/// What else may be behind reasons of the search, of noise or of energy, where the parts are taken as exact.
pub(crate) fn of_exact_parts() -> String {
    "the functions of a and b are taken as exact: where they were measured, state the noise of all in noise.relative, noise.a and noise.b, or \
     name their coherence"
        .to_owned()
}

/// Of a joint none of whose stiffnesses the functions determine.
pub(crate) fn of_nothing(unknowns: &[Unknown]) -> Option<String> {
    let mut stiffnesses = unknowns.iter().filter(|own| own.is_stiffness());
    stiffnesses.all(|own| !own.is_determined).then(|| {
        "the functions determine no stiffness: the assembly moves as the structures do apart; name the file that was measured with both \
         bolted together in assembly.frf"
            .to_owned()
    })
}

/// Of a search, and of how far its functions are from the measured ones.
pub(crate) fn of_search(has_converged: bool, relative_rms: f64) -> Vec<String> {
    let mut reasons = Vec::new();
    if !has_converged {
        reasons.push(
            "the search has not converged, or its starts lead to different minima".to_owned(),
        );
    }
    if relative_rms > RESIDUAL_MAX {
        reasons.push(format!(
            "the residual is {:.0} % of the functions: the model is not that of the data; check units, directions and signs",
            100.0 * relative_rms
        ));
    }
    reasons
}

/// Of a search that noise does not confirm, where its level may be the reason.
fn of_small_noise(level: Level, reduced_chi_squared: f64) -> Option<String> {
    let advice = match level {
        Level::OfCoherence => "if there were fewer independent averages than stated, state these",
        Level::Relative(_) | Level::OfResiduals => {
            "if the noise is larger than stated, state it as it is"
        }
    };
    (REMARKABLE..=MISFIT).contains(&reduced_chi_squared).then(|| {
        format!(
            "χ² over degrees of freedom is {reduced_chi_squared:.2}: {advice}, so that minima can be told apart by it"
        )
    })
}

/// Of other joints that searches came to.
pub(crate) fn of_rivals(rivals: usize) -> Option<String> {
    (rivals > 0).then(|| {
        "other joints explain the functions as well: measure at more points, on every part, with at least as many sensors and \
         impacts as all joints have motions; or take models with fewer unknowns (joint.model)"
            .to_owned()
    })
}

/// Of noise that is stated.
pub(crate) fn of_noise(level: Level, reduced_chi_squared: Option<f64>) -> Option<String> {
    let chi = reduced_chi_squared.filter(|&chi| chi > MISFIT)?;
    let noise = match level {
        Level::OfCoherence => "noise as coherence tells it",
        Level::Relative(_) | Level::OfResiduals => "the stated noise",
    };
    Some(format!(
        "χ² over degrees of freedom is {chi:.2}: {noise} does not explain the residuals, and the deviations are too small"
    ))
}

/// Of a joint that feeds energy, by χ² of the passive one that is nearest, and of how many numbers that is.
pub(crate) fn of_energy(squares_from_free: f64, numbers: usize) -> Option<String> {
    // χ² of a passive joint is less than that of as many numbers
    (chi_squared_tail(squares_from_free, numbers) < UNLIKELY).then(|| {
        format!(
            "the functions ask for a joint that feeds energy, and the nearest one that does not is {:.0} standard deviations away: check \
             signs, and whether phases are counted as in e^(+jωt); errors of the set-up that budget does not have do it too",
            squares_from_free.sqrt()
        )
    })
}

/// Likewise, where the joint's damping is not viscous.
pub(crate) fn of_lossy_energy(squares_from_free: f64, numbers: usize) -> Option<String> {
    of_energy(squares_from_free, numbers).map(|_| {
        "viscous damping that stands for damping of another kind feeds energy in a direction that hardly moves: identify the joint over a \
         narrower range of frequencies"
            .to_owned()
    })
}

/// Whether a negative eigenvalue is rounding.
fn is_excused(matrix: &Matrix6<f64>) -> bool {
    let scale = matrix.diagonal().map(|own| own.abs().sqrt());
    let scaled = Matrix6::from_fn(|i, j| {
        let size = scale[i] * scale[j];
        if size > 0.0 {
            matrix[(i, j)] / size
        } else {
            0.0
        }
    });
    scaled.symmetric_eigenvalues().min() > -NOT_PASSIVE
}
