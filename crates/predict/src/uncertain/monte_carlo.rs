//! Seeded draws on all processors: the same seed gives the same draws, however many processors share them.

use std::ops::Range;

use bolted_joint_draws::Draw;
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
            bolted_joint_wanted::look();
            let scores = self.scores(inputs, number);
            let result = result(inputs, &scores, &model);
            progress();
            (scores, result)
        };
        let batches = (0..self.draws).step_by(BATCH as usize).map(|first| {
            let numbers = first..self.draws.min(first + BATCH);
            numbers.into_par_iter().map(one).collect::<Vec<_>>()
        });
        self.outcome(inputs, names, batches.flatten())
    }

    /// The draws of these numbers alone.
    pub fn part(
        self,
        numbers: Range<u64>,
        inputs: &Inputs,
        model: impl Fn(&Drawn) -> Result<Vec<f64>, Refusal> + Sync,
        progress: &(dyn Fn() + Sync),
    ) -> Vec<Draw> {
        let one = |number: u64| {
            bolted_joint_wanted::look();
            let result = result(inputs, &self.scores(inputs, number), &model);
            progress();
            match result {
                Ok(results) => Draw::Values(results),
                Err(Refusal { reason }) => Draw::Refused(reason),
            }
        };
        numbers.into_par_iter().map(one).collect()
    }

    /// What all draws come to that were made in parts: the same as [`MonteCarlo::run`] gives, to the bit.
    ///
    /// # Errors
    /// As there.
    pub fn of_parts(
        self,
        inputs: &Inputs,
        names: &[String],
        draws: &[Draw],
    ) -> Result<Outcome, MonteCarloError> {
        let draws = (0..).zip(draws).map(|(number, draw)| {
            let result = match draw {
                Draw::Values(values) => Ok(values.clone()),
                Draw::Refused(reason) => Err(Refusal {
                    reason: reason.clone(),
                }),
            };
            (self.scores(inputs, number), result)
        });
        self.outcome(inputs, names, draws)
    }

    /// The scores of a draw, from a stream of random numbers of its own.
    fn scores(self, inputs: &Inputs, number: u64) -> Vec<f64> {
        let mut generator = ChaCha8Rng::seed_from_u64(self.seed);
        generator.set_stream(number);
        inputs.scores(&mut generator)
    }

    fn outcome(
        self,
        inputs: &Inputs,
        names: &[String],
        draws: impl Iterator<Item = (Vec<f64>, Result<Vec<f64>, Refusal>)>,
    ) -> Result<Outcome, MonteCarloError> {
        let varying: Vec<usize> = inputs.varying().collect();
        let mut taken = Taken {
            varying: &varying,
            results: names.len(),
            moments: Moments::new(names.len() + varying.len()),
            samples: vec![Vec::new(); names.len()],
            refused: Vec::new(),
        };
        for (scores, result) in draws {
            taken.take(&scores, result)?;
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

/// What the model gives at these scores.
fn result(
    inputs: &Inputs,
    scores: &[f64],
    model: impl Fn(&Drawn) -> Result<Vec<f64>, Refusal>,
) -> Result<Vec<f64>, Refusal> {
    match inputs.at(scores) {
        Ok(drawn) => model(&drawn),
        Err(name) => Err(Refusal {
            reason: format!("{name} outside its range"),
        }),
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
    fn take(
        &mut self,
        scores: &[f64],
        result: Result<Vec<f64>, Refusal>,
    ) -> Result<(), MonteCarloError> {
        let mut vector = match result {
            Ok(vector) => vector,
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
