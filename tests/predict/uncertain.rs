//! Monte Carlo against the moments and quantiles that the distributions have by their definitions.

use bolted_joint_testing::near;
use std::sync::atomic::{AtomicU64, Ordering};

use bolted_joint::predict::uncertain::{
    Distribution, Drawn, Inputs, MonteCarlo, MonteCarloError, Outcome, Refusal, Spread, Uncertain,
};

fn spread(spread: Spread, value: f64, standard_deviation: f64) -> Distribution {
    let uncertain = Uncertain {
        value,
        standard_deviation,
    };
    Distribution::new(spread, uncertain)
}

const WITHIN_1_AND_2: Spread = Spread::NormalWithin {
    low: 1.0,
    high: 2.0,
};

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

const DRAWS: u64 = 40_000;

/// What so many draws give.
fn drawn(
    seed: u64,
    inputs: &Inputs,
    results: &[&str],
    model: impl Fn(&Drawn) -> Vec<f64> + Sync,
) -> Outcome {
    let monte_carlo = MonteCarlo { draws: DRAWS, seed };
    let model = |drawn: &Drawn| Ok(model(drawn));
    let outcome = monte_carlo.run(inputs, &names(results), model, &|| {});
    outcome.unwrap()
}

/// So many standard errors are never met by chance: of a seed that is fixed this is a bound on errors, not on luck.
const MANY: f64 = 4.5;

#[test]
fn draws_have_the_moments_and_quantiles_of_their_distributions() {
    let mut inputs = Inputs::default();
    let normal = inputs.add("normal", spread(Spread::Normal, -2.0, 0.5));
    let lognormal = inputs.add("lognormal", spread(Spread::Lognormal, 3.0, 1.5));
    let exact = Distribution::new(Spread::Lognormal, Uncertain::exact(7.0));
    let exact = inputs.add("exact", exact);
    let results = ["normal", "lognormal", "exact", "logarithm"];
    let outcome = drawn(3, &inputs, &results, |drawn| {
        let positive = drawn.of(lognormal);
        vec![drawn.of(normal), positive, drawn.of(exact), positive.ln()]
    });
    let root = (DRAWS as f64).sqrt();
    let near = |found: f64, expected: f64, error: f64| {
        near(found, expected, MANY * error / root);
    };
    let [normal, lognormal, exact, logarithm] = &outcome.estimates[..] else {
        panic!("four results")
    };
    near(normal.mean, -2.0, 0.5);
    near(normal.standard_deviation, 0.5, 0.5 / 2_f64.sqrt());
    // the standard error of the 97.5th percentile is √(p (1 − p))/φ(1.96) = 2.67 standard deviations over √n
    near(normal.interval_95[0], -2.0 - 1.959_964 * 0.5, 2.67 * 0.5);
    near(normal.interval_95[1], -2.0 + 1.959_964 * 0.5, 2.67 * 0.5);
    near(lognormal.mean, 3.0, 1.5);
    // heavy tails: the fourth moment of this one is 1.9·10² times 1.5⁴… its deviation is known to about 2 %
    assert!((lognormal.standard_deviation / 1.5 - 1.0).abs() < 0.05);
    assert!(lognormal.interval_95[0] > 0.0);
    let variance = (1.0_f64 + 0.25).ln();
    near(logarithm.mean, 3_f64.ln() - 0.5 * variance, variance.sqrt());
    let deviation = variance.sqrt();
    near(logarithm.standard_deviation, deviation, deviation);
    assert_eq!((exact.mean, exact.standard_deviation), (7.0, 0.0));
    // only what varies is an input that can account for something
    assert_eq!(outcome.inputs, ["normal", "lognormal"]);
    assert!(normal.shares[0] > 1.0 - 1e-12 && normal.shares[1] < 1e-3);
    assert!(logarithm.shares[1] > 1.0 - 1e-9);
    assert_eq!(outcome.refused_share(), 0.0);
}

#[test]
fn shares_of_a_sum_are_those_of_its_variances() {
    // y = 3 a + 4 b with a, b of unit variance: shares 9/25 and 16/25
    let mut inputs = Inputs::default();
    let a = inputs.add("a", spread(Spread::Normal, 0.0, 1.0));
    let b = inputs.add("b", spread(Spread::Normal, 0.0, 1.0));
    let outcome = drawn(1, &inputs, &["y", "a"], |drawn| {
        vec![3.0 * drawn.of(a) + 4.0 * drawn.of(b), drawn.of(a)]
    });
    let shares = &outcome.estimates[0].shares;
    assert!((shares[0] - 0.36).abs() < 0.02, "{shares:?}");
    assert!((shares[1] - 0.64).abs() < 0.02, "{shares:?}");
    assert!((outcome.correlation[0][1] - 0.6).abs() < 0.02);
    assert_eq!(outcome.correlation[0][0], 1.0);
}

#[test]
fn correlated_inputs_are_drawn_so() {
    let mut inputs = Inputs::default();
    let dimension = inputs.add("D", spread(WITHIN_1_AND_2, 1.42, 0.02));
    let roughness = Distribution::of_logarithm(1.21e-8, 0.4);
    let roughness = inputs.add_correlated("G", roughness, dimension, -0.9);
    let roughness = roughness.unwrap();
    let outcome = drawn(5, &inputs, &["D", "ln G"], |drawn| {
        vec![drawn.of(dimension), drawn.of(roughness).ln()]
    });
    let found = outcome.correlation[0][1];
    assert!((found + 0.9).abs() < 0.01, "{found}");
    let logarithm = &outcome.estimates[1];
    assert!((logarithm.mean - 1.21e-8_f64.ln()).abs() < 0.01);
    assert!((logarithm.standard_deviation / 0.4 - 1.0).abs() < 0.02);
    let other = Distribution::of_logarithm(1.0, 0.1);
    let refused = inputs.add_correlated("H", other, roughness, -1.1);
    assert!(refused.is_err());
}

#[test]
fn refused_draws_are_counted_by_reason_and_left_out() {
    // P(D ≤ 1) with D = 1.1 ± 0.1 is Φ(−1) = 15.87 %
    let mut inputs = Inputs::default();
    let dimension = inputs.add("D", spread(WITHIN_1_AND_2, 1.1, 0.1));
    let monte_carlo = MonteCarlo {
        draws: DRAWS,
        seed: 2,
    };
    let refused = |reason: &str| {
        let reason = reason.to_owned();
        Err(Refusal { reason })
    };
    let results = names(&["D"]);
    let below = |drawn: &Drawn| match drawn.of(dimension) {
        // Φ(2) to 1 is 2.28 %
        d if d > 1.3 => refused("too large"),
        d => Ok(vec![d]),
    };
    let outcome = monte_carlo.run(&inputs, &results, below, &|| {}).unwrap();
    let share = |reason: &str| {
        let refused = outcome.refused.iter().find(|(known, _)| known == reason);
        refused.unwrap().1 as f64 / DRAWS as f64
    };
    assert!((share("D outside its range") - 0.1587).abs() < 0.008);
    assert!((share("too large") - 0.0228).abs() < 0.003);
    let number: u64 = outcome.refused.iter().map(|(_, count)| count).sum();
    assert_eq!(outcome.accepted + number, DRAWS);
    let estimate = outcome.estimate("D").unwrap();
    assert!(estimate.interval_95[0] > 1.0 && estimate.interval_95[1] < 1.3);

    let nothing = monte_carlo.run(&inputs, &results, |_| refused("never"), &|| {});
    let Err(error @ MonteCarloError::TooFew { .. }) = nothing else {
        panic!("{nothing:?}")
    };
    assert!(error.to_string().contains("never ("), "{error}");
}

#[test]
fn the_draws_do_not_depend_on_the_number_of_threads() {
    let mut inputs = Inputs::default();
    let a = inputs.add("a", spread(Spread::Lognormal, 1.0, 0.3));
    let b = inputs.add("b", spread(Spread::Normal, 1.0, 0.3));
    let run = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let progress = AtomicU64::new(0);
        let outcome = pool.build().unwrap().install(|| {
            MonteCarlo { draws: 3000, seed }
                .run(
                    &inputs,
                    &names(&["product"]),
                    |drawn| Ok(vec![drawn.of(a) * drawn.of(b)]),
                    &|| {
                        progress.fetch_add(1, Ordering::Relaxed);
                    },
                )
                .unwrap()
        });
        assert_eq!(progress.load(Ordering::Relaxed), 3000);
        outcome
    };
    let one = run(1, 11);
    assert_eq!(one, run(2, 11));
    assert_eq!(one, run(5, 11));
    assert_ne!(one.estimates, run(1, 12).estimates);
}
