//! Surfaces from layers.

use bolted_joint::predict::ContactError;
use bolted_joint::predict::virtual_material::{Loading, Magnitudes, Moduli, Observation, fit};
use bolted_joint::predict::{Material, Pair};
use bolted_joint_testing::near;
use proptest::prelude::*;

use super::{FRICTION_RATIO, HARDNESS_PA, contact, pair};
use crate::fractal::relative;

/// Written by `layer_references.py`.
const FITS: &str = include_str!("../data/layer_fits.csv");

/// Layers of a surface under loads, with both moduli off by factors.
fn layers(dimension: f64, roughness_m: f64, first: f64, factors: [f64; 2]) -> Vec<Observation> {
    let contact = contact(dimension, roughness_m);
    [1.0, 2.0, 3.0, 5.0]
        .map(|times| {
            let loading = Loading::Force(times * first * contact.critical_load_n());
            let moduli = contact.moduli(loading).unwrap();
            Observation {
                loading,
                moduli: Moduli {
                    youngs_modulus_pa: factors[0] * moduli.youngs_modulus_pa,
                    shear_modulus_pa: factors[1] * moduli.shear_modulus_pa,
                },
            }
        })
        .to_vec()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_surface_of_exact_layers_comes_back(d in 1.1..1.9, roughness in -11.0..-8.0, first in 1.05..200.0) {
        let roughness_m = 10.0_f64.powf(roughness);
        let known = layers(d, roughness_m, first, [1.0; 2]);
        let found = fit(&known, &pair(), HARDNESS_PA, FRICTION_RATIO, Magnitudes::Stated).unwrap();
        prop_assert!(found.log_residual < 1e-9, "{:?}", found);
        prop_assert!((found.roughness.fractal_dimension() - d).abs() < 1e-6, "{} {:?}", d, found);
        prop_assert!(relative(found.roughness.roughness_m(), roughness_m) < 1e-4, "{:?}", found);
        prop_assert!(!found.is_at_bound);
        prop_assert_eq!(found.magnitudes, [1.0; 2]);
    }

    #[test]
    fn factors_come_back_too(d in 1.2..1.8, first in 1.2..20.0, e in -2.0..2.0, g in -2.0..2.0) {
        let factors = [f64::exp(e), f64::exp(g)];
        let known = layers(d, 1e-9, first, factors);
        let found = fit(&known, &pair(), HARDNESS_PA, FRICTION_RATIO, Magnitudes::Free).unwrap();
        prop_assert!(found.log_residual < 1e-9, "{:?}", found);
        prop_assert!((found.roughness.fractal_dimension() - d).abs() < 1e-4, "{} {:?}", d, found);
        for place in 0..2 {
            prop_assert!(relative(found.magnitudes[place], factors[place]) < 1e-2, "{:?}", found);
        }
    }
}

/// Table I, with the load of eleven M24 bolts.
fn table_1() -> Vec<Observation> {
    [
        (45.0, 0.352e9, 0.23),
        (90.0, 0.541e9, 0.25),
        (135.0, 0.885e9, 0.26),
    ]
    .map(|(torque, young, poisson)| Observation {
        loading: Loading::Force(11.0 * torque / (0.2 * 0.024)),
        moduli: Moduli {
            youngs_modulus_pa: young,
            shear_modulus_pa: young / (2.0 * (1.0 + poisson)),
        },
    })
    .to_vec()
}

#[test]
fn table_1_is_fitted_as_by_scipy() {
    let iron = Material::new(1.1e11, 0.26).unwrap();
    let pair = Pair { a: iron, b: iron };
    let mut lines = FITS.lines().skip(1);
    for magnitudes in [Magnitudes::Stated, Magnitudes::Free] {
        let expected: Vec<f64> = lines
            .next()
            .unwrap()
            .split(',')
            .map(|text| text.parse().unwrap())
            .collect();
        let found = fit(&table_1(), &pair, HARDNESS_PA, 0.0, magnitudes).unwrap();
        assert!(
            relative(found.log_residual, expected[3]) < 1e-8,
            "{found:?} {expected:?}"
        );
        let dimension = found.roughness.fractal_dimension();
        near(dimension, expected[1], 1e-5);
        assert_eq!(found.is_at_bound, magnitudes == Magnitudes::Stated);
    }
}

#[test]
fn layers_that_say_too_little() {
    let one = &table_1()[..1];
    let error = fit(one, &pair(), HARDNESS_PA, 0.0, Magnitudes::Free).unwrap_err();
    assert!(matches!(
        error,
        ContactError::TooFewLayers {
            found: 1,
            unknowns: 4,
            expected: 2
        }
    ));
    let error = fit(&[], &pair(), HARDNESS_PA, 0.0, Magnitudes::Stated).unwrap_err();
    assert!(matches!(error, ContactError::TooFewLayers { .. }));
    let mut bad = table_1();
    bad[1].moduli.shear_modulus_pa = -1.0;
    let error = fit(&bad, &pair(), HARDNESS_PA, 0.0, Magnitudes::Stated).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("layer 2: the shear modulus is -1")
    );
    // One layer determines both, and leaves nothing that would tell how well.
    let known = &layers(1.4, 1e-9, 30.0, [1.0; 2])[..1];
    let found = fit(
        known,
        &pair(),
        HARDNESS_PA,
        FRICTION_RATIO,
        Magnitudes::Stated,
    )
    .unwrap();
    assert!(found.log_residual < 1e-9);
    assert_eq!(found.dimension_deviation, None);
}
