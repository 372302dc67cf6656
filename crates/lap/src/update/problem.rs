//! What updating minimises: the weighted squares of the relative errors of the natural frequencies, within bounds.

use super::super::parameter::{LapParameter, LapParameters};

/// What is known of a parameter beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// Known, and not changed.
    Known(f64),
    /// Between two bounds above zero, with the most plausible value where there is one.
    Between {
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
        /// Most plausible value; without it the geometric mean of the bounds.
        prior: Option<f64>,
    },
    /// Nothing is known: the parameter is no part of the problem and zero in the model.
    Absent,
}

impl Range {
    /// The value to begin with.
    #[must_use]
    pub fn prior(self) -> f64 {
        match self {
            Self::Known(value) => value,
            Self::Between { low, high, prior } => prior.unwrap_or((low * high).sqrt()),
            Self::Absent => 0.0,
        }
    }
}

/// An updating problem at one torque.
#[derive(Clone, Debug, PartialEq)]
pub struct UpdateProblem {
    /// Measured natural frequencies, rad/s, ascending: the first, or both.
    pub omega_rad_per_s: Vec<f64>,
    /// Weight of each.
    pub weights: Vec<f64>,
    /// What is known of each parameter, in the order of [`LapParameter::ALL`].
    pub ranges: [Range; 6],
}

impl UpdateProblem {
    /// The parameters that are searched for.
    #[must_use]
    pub fn free(&self) -> Vec<LapParameter> {
        let is_free = |parameter: &LapParameter| {
            matches!(self.ranges[parameter.index()], Range::Between { .. })
        };
        LapParameter::ALL.into_iter().filter(is_free).collect()
    }

    /// Relative errors ω_model/ω_measured − 1.
    #[must_use]
    pub fn errors(&self, parameters: &LapParameters) -> Vec<f64> {
        let measured = self.omega_rad_per_s.iter();
        let pairs = parameters.natural_frequencies().into_iter().zip(measured);
        pairs
            .map(|(model, measured)| model / measured - 1.0)
            .collect()
    }

    /// The objective.
    #[must_use]
    pub fn objective(&self, parameters: &LapParameters) -> f64 {
        // Σ W_i (ω_i^model/ω_i^measured − 1)² (Pirdayr 4)
        let errors = self.errors(parameters);
        let terms = errors.iter().zip(&self.weights);
        terms.map(|(error, weight)| weight * error * error).sum()
    }

    /// Parameters at a place in the unit cube: each free one ln-evenly between its bounds.
    #[must_use]
    pub fn parameters(&self, place: &[f64]) -> LapParameters {
        let mut places = place.iter();
        LapParameters(self.ranges.map(|range| match range {
            Range::Between { low, high, .. } => {
                // p = low (high/low)^z
                let z = places.next().copied().unwrap_or(0.5);
                (low * (high / low).powf(z)).clamp(low, high)
            }
            known => known.prior(),
        }))
    }

    /// The place of the priors.
    #[must_use]
    pub fn prior_place(&self) -> Vec<f64> {
        let ranges = self.ranges.iter();
        let places = ranges.filter_map(|&range| match range {
            Range::Between { low, high, .. } => {
                Some((range.prior() / low).ln() / (high / low).ln())
            }
            _ => None,
        });
        places.collect()
    }

    /// d ln ω_i/d ln p of every free parameter, line by frequency.
    #[must_use]
    pub fn sensitivity(&self, parameters: &LapParameters) -> Vec<Vec<f64>> {
        let [k, _, k12, ..] = parameters.0;
        let share = k / (k + 2.0 * k12);
        let of = |mode: usize, parameter: LapParameter| match (parameter, mode) {
            // ln ω₁ = ½(ln k − ln m), ln ω₂ = ½(ln(k + 2 k₁₂) − ln m)
            (LapParameter::Mass, _) => -0.5,
            (LapParameter::SupportStiffness, 0) => 0.5,
            (LapParameter::SupportStiffness, _) => 0.5 * share,
            (LapParameter::JointStiffness, 1) => 0.5 * (1.0 - share),
            _ => 0.0,
        };
        let free = self.free();
        let rows = (0..self.omega_rad_per_s.len()).map(|mode| {
            let row = free.iter().map(|&parameter| of(mode, parameter));
            row.collect()
        });
        rows.collect()
    }

    /// ln(high/low) of every free parameter.
    pub(super) fn widths(&self) -> Vec<f64> {
        let ranges = self.ranges.iter();
        let widths = ranges.filter_map(|range| match range {
            Range::Between { low, high, .. } => Some((high / low).ln()),
            _ => None,
        });
        widths.collect()
    }
}
