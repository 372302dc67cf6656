//! Coherences of a set's functions, and the variances that follow from them.

use std::collections::BTreeMap;

use super::FrfSet;
use super::axis::first_difference;
use crate::coherence::{lifted, pooled, window};
use crate::{Coherence, Dof, FrfError, absolute_variances, relative_variance};

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
        self.relative_variances = self.pooled_variances();
        Ok(self)
    }

    /// σ²/|H|² of each function with coherence, where the averages are known and tell it.
    fn pooled_variances(&self) -> BTreeMap<(Dof, Dof), Vec<f64>> {
        let of = |averages: f64, pair: &(Dof, Dof), gamma_squared: &[f64]| {
            let function = self.receptances.get(pair)?;
            let power = |line: usize| function[line].norm_sqr();
            let relative = gamma_squared.iter();
            let relative: Vec<f64> = relative
                .map(|&gamma_squared| relative_variance(gamma_squared, averages))
                .collect();
            let variances = pooled(&absolute_variances(&relative, power), averages)?;
            let lines = variances.len();
            let variances = variances.iter().enumerate();
            let relative = variances.map(|(line, own)| own / lifted(lines, line, power));
            Some(relative.collect())
        };
        let all = self.gamma_squared.iter();
        let told = all.filter_map(|(&pair, own)| Some((pair, of(self.averages?, &pair, own)?)));
        told.collect()
    }

    /// Whether the coherence of some function tells its noise.
    #[must_use]
    pub fn tells_noise(&self) -> bool {
        !self.relative_variances.is_empty()
    }

    /// What is to be known where there is coherence with averages that tell no noise.
    pub(crate) fn tells_too_little(&self) -> Option<String> {
        let (averages, lines) = (self.averages?, self.line_count());
        let tells_nothing = !self.gamma_squared.is_empty() && window(lines, averages).is_none();
        tells_nothing.then(|| {
            format!(
                "coherence does not tell how large the noise is, and is not used: it is that of {lines} lines with averages = {averages}"
            )
        })
    }

    /// Ordinary coherence γ² at each line of the measured function behind [`FrfSet::receptance`], if it came with the set.
    #[must_use]
    pub fn coherence(&self, response: Dof, reference: Dof) -> Option<&[f64]> {
        self.of_measured(&self.gamma_squared, response, reference)
    }

    /// What `all` has of the measured function behind [`FrfSet::receptance`].
    fn of_measured<'a>(
        &self,
        all: &'a BTreeMap<(Dof, Dof), Vec<f64>>,
        response: Dof,
        reference: Dof,
    ) -> Option<&'a [f64]> {
        let measured = self
            .measured_pair(response, reference)
            .or_else(|| self.measured_pair(reference, response))?;
        all.get(&measured).map(Vec::as_slice)
    }

    /// The number of averages behind the functions, where it is known.
    #[must_use]
    pub fn averages(&self) -> Option<f64> {
        self.averages
    }

    /// σ²/|H|² at each line of the measured function behind [`FrfSet::receptance`], from its coherence and the averages.
    ///
    /// σ² is that of the complex error, E|Ĥ − H|²: real and imaginary part have half of it each. It is told by as many neighbouring
    /// lines of the file together as it takes, see [`relative_variance`](crate::relative_variance()) for that of one. `None` without
    /// coherence or without averages that tell it. With |H|² it is to be taken times by [`absolute_variances`].
    #[must_use]
    pub fn relative_variance(&self, response: Dof, reference: Dof) -> Option<&[f64]> {
        self.of_measured(&self.relative_variances, response, reference)
    }

    /// σ at each line of that function, in its unit.
    #[must_use]
    pub fn noise_deviations(&self, response: Dof, reference: Dof) -> Option<Vec<f64>> {
        let relative = self.relative_variance(response, reference)?;
        let function = self.receptance(response, reference).ok()?;
        let power = |line: usize| function.values()[line].norm_sqr();
        let variances = absolute_variances(relative, power).into_iter();
        Some(variances.map(f64::sqrt).collect())
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
