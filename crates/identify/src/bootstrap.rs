//! Parametric bootstrap: the estimate repeated on data drawn from the fitted model, all noise included.

use bolted_joint_draws::{Draw, Share};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::assessment::reached;
use super::estimator::{Estimate, Free, estimate};
use super::layout::Place;
use super::noise::Noise;
use super::objective::Objective;
use super::parallel;

/// How many draws to take, and from which seed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bootstrap {
    /// Draws.
    pub draws: usize,
    /// The same seed gives the same draws, on any number of processors.
    pub seed: u64,
    /// Which of them are made here.
    pub share: Share,
}

/// Why a draw has no estimate.
const NOT_CONVERGED: &str = "the estimate did not converge";

impl Bootstrap {
    /// The draws of this share, in their order: those that `make` gives for their numbers, or those that were made before.
    pub(super) fn made(&self, make: impl Fn(ChaCha8Rng) -> Option<Vec<f64>> + Sync) -> Vec<Draw> {
        if let Share::Made(draws) = &self.share {
            return draws.to_vec();
        }
        let numbers: Vec<u64> = self.share.numbers(self.draws as u64).collect();
        parallel::map(&numbers, |&number| {
            let mut generator = ChaCha8Rng::seed_from_u64(self.seed);
            generator.set_stream(number);
            match make(generator) {
                Some(values) => Draw::Values(values),
                None => Draw::Refused(NOT_CONVERGED.to_owned()),
            }
        })
    }
}

/// The estimate from each draw, in the order of the unknowns. `progress` is called after each.
pub(super) fn draws(
    objective: &Objective<'_>,
    entries: &[Place],
    noise: &Noise,
    found: &Estimate,
    bootstrap: &Bootstrap,
    progress: &(dyn Fn() + Sync),
) -> Option<Vec<Draw>> {
    let (weights, state) = reached(objective, found)?;
    Some(bootstrap.made(|mut generator| {
        let drawn = objective.drawn(&weights, &state, &mut generator)?;
        let objective = drawn.objective(entries);
        let found = estimate(&objective, noise, None, &Free, &found.unknowns, None);
        progress();
        let found = found.filter(|estimate| estimate.converged)?;
        Some(found.unknowns.as_slice().to_vec())
    }))
}
