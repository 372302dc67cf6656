//! Seeded draws on all processors: the same seed gives the same draws, however many processors share them.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;
use thiserror::Error;

use super::inputs::{Drawn, Inputs};
use super::moments::Moments;
use super::outcome::Outcome;

/// Draws that are computed before they are taken into the moments: enough to share, few enough to forget.
const BATCH: u64 = 1024;

/// How many draws to take, and from which seed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MonteCarlo {
    /// Draws.
    pub draws: u64,
    /// The same seed gives the same draws.
    pub seed: u64,
}

/// A draw at which there is no joint: refused, counted by its reason, and left out of the results.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// Why, in a few words that are the same for all draws refused for this reason.
    pub reason: String,
}

/// Why nothing follows from the draws.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MonteCarloError {
    /// Fewer than two draws gave a result.
    #[error(
        "of {draws} draws {accepted} gave a joint, at least 2 are needed; refused: {reasons}; narrow the standard deviations or \
         check the values"
    )]
    TooFew {
        /// Draws taken.
        draws: u64,
        /// Draws that gave a result.
        accepted: u64,
        /// What the others were refused for, with their numbers.
        reasons: String,
    },
    /// Draws gave results of different length.
    #[error("a draw gave {found} results, expected {expected}")]
    Length {
        /// Results of that draw.
        found: usize,
        /// Names of results.
        expected: usize,
    },
}

impl MonteCarlo {
    /// Draws all inputs and computes `model` of each draw: one number for each of `names`. `progress` is called after each draw,
    /// from any thread.
    ///
    /// Each draw has a stream of the generator (ChaCha8) of its own and the results are taken in order, so that they do not
    /// depend on the number of processors. What is kept is eight bytes for each draw and result, for the quantiles; moments and
    /// correlations are running ones.
    ///
    /// # Errors
    /// Fewer than two draws gave a result.
    pub fn run(
        self,
        inputs: &Inputs,
        names: &[String],
        model: impl Fn(&Drawn) -> Result<Vec<f64>, Refusal> + Sync,
        progress: &(dyn Fn() + Sync),
    ) -> Result<Outcome, MonteCarloError> {
        let one = |number: u64| {
            let mut generator = ChaCha8Rng::seed_from_u64(self.seed);
            generator.set_stream(number);
            let scores = inputs.scores(&mut generator);
            let result = match inputs.at(&scores) {
                Ok(drawn) => model(&drawn),
                Err(name) => Err(Refusal {
                    reason: format!("{name} outside its range"),
                }),
            };
            progress();
            result.map(|results| (scores, results))
        };
        let varying: Vec<usize> = inputs.varying().collect();
        let mut taken = Taken {
            varying: &varying,
            results: names.len(),
            moments: Moments::new(names.len() + varying.len()),
            samples: vec![Vec::new(); names.len()],
            refused: Vec::new(),
        };
        for first in (0..self.draws).step_by(BATCH as usize) {
            let numbers = first..self.draws.min(first + BATCH);
            let batch: Vec<_> = numbers.into_par_iter().map(one).collect();
            for draw in batch {
                taken.take(draw)?;
            }
        }
        let accepted = taken.moments.count() as u64;
        if accepted < 2 {
            return Err(MonteCarloError::TooFew {
                draws: self.draws,
                accepted,
                reasons: taken.reasons(),
            });
        }
        Ok(Outcome::new(self, inputs, names, taken))
    }
}

/// What the draws so far have come to.
pub(super) struct Taken<'a> {
    /// Places of the inputs that vary.
    pub(super) varying: &'a [usize],
    /// Number of results.
    results: usize,
    /// Of the results, and after them of the scores of the inputs that vary.
    pub(super) moments: Moments,
    /// Of each result.
    pub(super) samples: Vec<Vec<f64>>,
    /// Draws refused, by reason.
    pub(super) refused: Vec<(String, u64)>,
}

impl Taken<'_> {
    fn take(&mut self, draw: Result<(Vec<f64>, Vec<f64>), Refusal>) -> Result<(), MonteCarloError> {
        let (scores, mut vector) = match draw {
            Ok(draw) => draw,
            Err(Refusal { reason }) => {
                match self.refused.iter_mut().find(|(known, _)| *known == reason) {
                    Some((_, count)) => *count += 1,
                    None => self.refused.push((reason, 1)),
                }
                return Ok(());
            }
        };
        if vector.len() != self.results {
            return Err(MonteCarloError::Length {
                found: vector.len(),
                expected: self.results,
            });
        }
        for (samples, &value) in self.samples.iter_mut().zip(&vector) {
            samples.push(value);
        }
        vector.extend(self.varying.iter().map(|&place| scores[place]));
        self.moments.add(&vector);
        Ok(())
    }

    fn reasons(&self) -> String {
        let reasons = self.refused.iter();
        let reasons: Vec<String> = reasons
            .map(|(reason, count)| format!("{reason} ({count})"))
            .collect();
        reasons.join(", ")
    }
}
