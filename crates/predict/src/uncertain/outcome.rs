//! What a Monte Carlo run came to.

use bolted_joint_statistics::quantile;

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
