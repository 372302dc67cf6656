//! Parametric bootstrap: the estimate repeated on data drawn from the fitted model, all noise included.

use nalgebra::DVector;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::assessment::reached;
use super::estimator::{Estimate, Free, estimate};
use super::layout::Place;
use super::noise::Noise;
use super::objective::Objective;
use super::parallel;

/// How many draws to take, and from which seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bootstrap {
    /// Draws.
    pub draws: usize,
    /// The same seed gives the same draws, on any number of processors.
    pub seed: u64,
}

/// Estimates from the draws that could be estimated, each in the order of the unknowns. `progress` is called after each.
pub(super) fn draws(
    objective: &Objective<'_>,
    entries: &[Place],
    noise: &Noise,
    found: &Estimate,
    bootstrap: Bootstrap,
    progress: &(dyn Fn() + Sync),
) -> Option<Vec<DVector<f64>>> {
    let (weights, state) = reached(objective, found)?;
    let numbers: Vec<u64> = (0..bootstrap.draws as u64).collect();
    let one = |&number: &u64| {
        let mut generator = ChaCha8Rng::seed_from_u64(bootstrap.seed);
        generator.set_stream(number);
        let drawn = objective.drawn(&weights, &state, &mut generator)?;
        let objective = drawn.objective(entries);
        let found = estimate(&objective, noise, None, &Free, &found.unknowns, None);
        progress();
        found.filter(|estimate| estimate.converged)
    };
    let found = parallel::map(&numbers, one);
    Some(found.into_iter().flatten().map(|e| e.unknowns).collect())
}
