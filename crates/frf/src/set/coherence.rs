//! Coherences of a set's functions, and the variances that follow from them.

use super::FrfSet;
use super::axis::first_difference;
use crate::{Coherence, Dof, FrfError, relative_variance};

impl FrfSet {
    /// The same set with the ordinary coherences of its functions, and the number of averages behind them if it is known.
    ///
    /// A coherence belongs to the function of the same two degrees of freedom, whatever their signs; one whose function is
    /// not in the set is left out. Lines that the set does not have (0 Hz of an accelerance) are left out of it.
    ///
    /// # Errors
    /// [`FrfError::CoherenceAxis`] if a line of the set has no coherence; [`FrfError::DuplicateCoherence`];
    /// [`FrfError::Averages`] if the number is below 1 or not finite.
    pub fn with_coherences(
        mut self,
        coherences: Vec<Coherence>,
        averages: Option<f64>,
    ) -> Result<Self, FrfError> {
        if let Some(found) = averages.filter(|n| !(n.is_finite() && *n >= 1.0)) {
            return Err(FrfError::Averages { found });
        }
        self.averages = averages;
        for coherence in coherences {
            let (response, reference) = (coherence.response, coherence.reference);
            let Some(pair) = self.measured_pair(response, reference) else {
                continue;
            };
            let values = self.on_own_lines(&coherence)?;
            if self.gamma_squared.insert(pair, values).is_some() {
                return Err(FrfError::DuplicateCoherence {
                    response,
                    reference,
                });
            }
        }
        Ok(self)
    }

    /// Ordinary coherence γ² at each line of the measured function behind [`FrfSet::receptance`], if it came with the set.
    #[must_use]
    pub fn coherence(&self, response: Dof, reference: Dof) -> Option<&[f64]> {
        let measured = self
            .measured_pair(response, reference)
            .or_else(|| self.measured_pair(reference, response))?;
        self.gamma_squared.get(&measured).map(Vec::as_slice)
    }

    /// The number of averages behind the functions, where it is known.
    #[must_use]
    pub fn averages(&self) -> Option<f64> {
        self.averages
    }

    /// σ²/|H|² at each line of the measured function behind [`FrfSet::receptance`], from its coherence and the averages.
    ///
    /// σ² is that of the complex error, E|Ĥ − H|²: real and imaginary part have half of it each. See
    /// [`relative_variance`](crate::relative_variance()). `None` without coherence or without the number of averages.
    #[must_use]
    pub fn relative_variance(&self, response: Dof, reference: Dof) -> Option<Vec<f64>> {
        let averages = self.averages?;
        let gamma_squared = self.coherence(response, reference)?;
        Some(
            gamma_squared
                .iter()
                .map(|&gamma_squared| relative_variance(gamma_squared, averages))
                .collect(),
        )
    }

    fn on_own_lines(&self, coherence: &Coherence) -> Result<Vec<f64>, FrfError> {
        let missing = |line: usize| FrfError::CoherenceAxis {
            response: coherence.response,
            reference: coherence.reference,
            line: line + 1,
            frequency_hz: self.frequency_hz[line],
        };
        // Only lines before the set's first one may be more: 0 Hz of a mobility or accelerance.
        let surplus = coherence
            .frequency_hz
            .len()
            .checked_sub(self.frequency_hz.len())
            .ok_or_else(|| missing(coherence.frequency_hz.len()))?;
        match first_difference(&self.frequency_hz, &coherence.frequency_hz[surplus..]) {
            Some(line) => Err(missing(line)),
            None => Ok(coherence.gamma_squared[surplus..].to_vec()),
        }
    }
}
