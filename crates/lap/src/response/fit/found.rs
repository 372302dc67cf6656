//! A fitted model: its values, how well they are determined, and the limits that it stands at.

use nalgebra::{DMatrix, DVector};

use crate::response::model::Values;
use crate::response::passive::Limit;

/// A fitted model.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The values.
    pub values: Values,
    /// The relative amplitude of each line, m.
    pub amplitudes_m: Vec<f64>,
    /// χ²: sum of the squared residuals in standard deviations.
    pub chi_squared: f64,
    /// Data less unknowns: two for each line, less the model's.
    pub degrees_of_freedom: usize,
    /// Information matrix of the unknowns in the order of the model's.
    pub information: DMatrix<f64>,
    /// Largest amplitude of the relative motion that was fitted, m: a passive joint takes energy up to there.
    pub amplitude_m: f64,
    /// Limits that the estimate stands at because the joint has to be passive.
    pub at_limits: Vec<AtLimit>,
    /// By how much a further step within the limits would lower χ²: nothing where the conditions of Karush, Kuhn and Tucker hold.
    pub left: f64,
}

impl Fit {
    /// χ² per degree of freedom.
    #[must_use]
    pub fn reduced_chi_squared(&self) -> f64 {
        self.chi_squared / self.degrees_of_freedom.max(1) as f64
    }

    /// Whether a limit of nothing else but this unknown holds the estimate.
    pub(in crate::response) fn is_held(&self, place: usize) -> bool {
        self.at_limits.iter().any(|at| {
            let mut others = at.gradient.clone();
            others[place] = 0.0;
            at.gradient[place] != 0.0 && others.norm_squared() == 0.0
        })
    }

    /// A covariance of the unknowns without the directions that the limits take away: Σ − ΣAᵀ(AΣAᵀ)⁻¹AΣ.
    pub(in crate::response) fn within_limits(&self, covariance: &DMatrix<f64>) -> DMatrix<f64> {
        let mut left = covariance.clone();
        // one limit after the other
        for at in &self.at_limits {
            let along = &left * &at.gradient;
            let variance = at.gradient.dot(&along);
            if variance > 0.0 {
                left.ger(-variance.recip(), &along, &along, 1.0);
            }
        }
        left
    }
}

/// A limit that an estimate stands at.
#[derive(Clone, Debug)]
pub struct AtLimit {
    /// Which.
    pub limit: Limit,
    /// By how much χ² falls with what is limited, in the reciprocal of its unit; not negative.
    pub multiplier: f64,
    /// What is limited, by the unknowns.
    pub(in crate::response) gradient: DVector<f64>,
}
