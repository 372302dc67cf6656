//! The firefly algorithm of the paper, (5) and (6), in the unit cube of the normalised logarithms of the parameters.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;

use super::super::parameter::LapParameters;
use super::problem::UpdateProblem;

/// How the fireflies search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Firefly {
    /// Fireflies, at least two.
    pub population: usize,
    /// Generations.
    pub iterations: usize,
    /// β0, attractiveness at no distance.
    pub attractiveness: f64,
    /// γ, absorption of light over the distance in the unit cube.
    pub absorption: f64,
    /// α, length of the random step in the first generation, as a fraction of the cube's side.
    pub step: f64,
    /// Factor of α from one generation to the next.
    pub decay: f64,
    /// Seed.
    pub seed: u64,
}

impl Default for Firefly {
    fn default() -> Self {
        Self {
            population: 25,
            iterations: 120,
            attractiveness: 1.0,
            absorption: 1.0,
            step: 0.2,
            decay: 0.96,
            seed: 1,
        }
    }
}

/// Where the brightest firefly came to rest.
#[derive(Clone, Debug, PartialEq)]
pub struct FireflyResult {
    /// The parameters there.
    pub parameters: LapParameters,
    /// The objective there.
    pub objective: f64,
    /// The lowest objective so far, before the first generation and after each.
    pub history: Vec<f64>,
}

struct Fly {
    place: Vec<f64>,
    objective: f64,
}

/// Searches with fireflies. `generation_done` is called after each generation.
#[must_use]
pub fn fireflies(
    problem: &UpdateProblem,
    settings: &Firefly,
    generator: &mut ChaCha8Rng,
    generation_done: &dyn Fn(),
) -> FireflyResult {
    let dimensions = problem.free().len();
    let at = |place: Vec<f64>| Fly {
        objective: problem.objective(&problem.parameters(&place)),
        place,
    };
    let mut flies: Vec<Fly> = (0..settings.population.max(2))
        .map(|_| at((0..dimensions).map(|_| uniform(generator)).collect()))
        .collect();
    sort(&mut flies);
    let mut best = (flies[0].place.clone(), flies[0].objective);
    let mut history = vec![best.1];
    let mut step = settings.step;
    for _ in 0..settings.iterations {
        bolted_joint_wanted::look();
        for i in 0..flies.len() {
            for j in 0..flies.len() {
                if flies[j].objective >= flies[i].objective {
                    continue;
                }
                // r² = ‖x_i − x_j‖² (5)
                let pairs = flies[i].place.iter().zip(&flies[j].place);
                let distance: f64 = pairs.clone().map(|(a, b)| (a - b).powi(2)).sum();
                let pull = settings.attractiveness * (-settings.absorption * distance).exp();
                // x_i ← x_i + β0 e^(−γ r²)(x_j − x_i) + α ε (6)
                let moved = pairs.map(|(a, b)| {
                    let random = step * (uniform(generator) - 0.5);
                    (a + pull * (b - a) + random).clamp(0.0, 1.0)
                });
                flies[i] = at(moved.collect());
            }
        }
        // The brightest sees no light and moves at random.
        sort(&mut flies);
        let moved = flies[0]
            .place
            .iter()
            .map(|z| (z + step * (uniform(generator) - 0.5)).clamp(0.0, 1.0));
        flies[0] = at(moved.collect());
        for fly in &flies {
            if fly.objective < best.1 {
                best = (fly.place.clone(), fly.objective);
            }
        }
        history.push(best.1);
        step *= settings.decay;
        generation_done();
    }
    FireflyResult {
        parameters: problem.parameters(&best.0),
        objective: best.1,
        history,
    }
}

/// The brightest first.
fn sort(flies: &mut [Fly]) {
    flies.sort_by(|a, b| a.objective.total_cmp(&b.objective));
}

/// Evenly in [0, 1).
fn uniform(generator: &mut ChaCha8Rng) -> f64 {
    // 53 random bits
    (generator.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}
