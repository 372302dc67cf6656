//! What a Monte Carlo run came to.

use super::inputs::Inputs;
use super::monte_carlo::{MonteCarlo, Taken};

/// Mean, standard deviation and interval of one result.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Name of the result.
    pub name: String,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub standard_deviation: f64,
    /// From the 2.5th to the 97.5th percentile.
    pub interval_95: [f64; 2],
    /// Squared correlation with the score of each of [`Outcome::inputs`]: the share of the scatter that a straight line through
    /// this input alone accounts for. Inputs that are correlated share theirs, so that the sum can be above one.
    pub shares: Vec<f64>,
}

/// Results of all draws.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Draws and seed.
    pub of: MonteCarlo,
    /// Draws that gave a result.
    pub accepted: u64,
    /// Draws refused, by reason, in the order of their first appearance.
    pub refused: Vec<(String, u64)>,
    /// Names of the inputs that vary.
    pub inputs: Vec<String>,
    /// The results, in the order of their names.
    pub estimates: Vec<Estimate>,
    /// Correlations of the results.
    pub correlation: Vec<Vec<f64>>,
}

impl Outcome {
    pub(super) fn new(of: MonteCarlo, inputs: &Inputs, names: &[String], taken: Taken<'_>) -> Self {
        let moments = &taken.moments;
        let count = names.len();
        let estimates = names.iter().zip(taken.samples).enumerate();
        Self {
            of,
            accepted: moments.count() as u64,
            refused: taken.refused,
            inputs: taken
                .varying
                .iter()
                .map(|&place| inputs.name(place).to_owned())
                .collect(),
            estimates: estimates
                .map(|(result, (name, mut samples))| {
                    samples.sort_by(f64::total_cmp);
                    Estimate {
                        name: name.clone(),
                        mean: moments.mean(result),
                        standard_deviation: moments.standard_deviation(result),
                        interval_95: [quantile(&samples, 0.025), quantile(&samples, 0.975)],
                        shares: (0..taken.varying.len())
                            .map(|input| moments.correlation(result, count + input).powi(2))
                            .collect(),
                    }
                })
                .collect(),
            correlation: (0..count)
                .map(|i| (0..count).map(|j| moments.correlation(i, j)).collect())
                .collect(),
        }
    }

    /// Share of the draws that were refused.
    #[must_use]
    pub fn refused_share(&self) -> f64 {
        1.0 - self.accepted as f64 / self.of.draws.max(1) as f64
    }

    /// The result of this name.
    #[must_use]
    pub fn estimate(&self, name: &str) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.name == name)
    }
}

/// Quantile of ascending values, linear between order statistics (type 7 of Hyndman and Fan, as NumPy has it).
fn quantile(ascending: &[f64], share: f64) -> f64 {
    let last = ascending.len().saturating_sub(1);
    // h = (n − 1) p
    let place = share * last as f64;
    let low = place.floor() as usize;
    match (ascending.get(low), ascending.get((low + 1).min(last))) {
        (Some(low_value), Some(high_value)) => {
            low_value + (place - low as f64) * (high_value - low_value)
        }
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::quantile;

    #[test]
    fn quantiles_are_those_of_numpy() {
        // numpy.quantile([1, 2, 4, 8, 16], q)
        let ascending = [1.0, 2.0, 4.0, 8.0, 16.0];
        for (share, expected) in [
            (0.0, 1.0),
            (0.025, 1.1),
            (0.5, 4.0),
            (0.975, 15.2),
            (1.0, 16.0),
        ] {
            assert!(
                (quantile(&ascending, share) - expected).abs() < 1e-14,
                "{share}"
            );
        }
    }
}
