//! Arithmetic of 60 digits, where nothing is lost between large terms of opposite sign.

use bolted_joint::predict::fractal::{Regime, StoredEnergy, domain_extension_factor};

use super::{Numbers, ZHAO, relative};

/// Written by `fractal_references.py`.
const TABLE: &str = include_str!("../data/fractal.csv");

#[test]
fn twelve_digits_are_right() {
    let mut rows = 0;
    let mut regimes = [0; 2];
    for line in TABLE.lines().skip(1) {
        let values: Vec<f64> = line.split(',').map(|text| text.parse().unwrap()).collect();
        let [dimension, roughness_m, pressure_pa] = [values[0], values[1], values[2]];
        let numbers = Numbers {
            dimension,
            roughness_m,
            modulus_pa: [1.5e11, 7e10],
            poisson: [0.28, 0.33],
            hardness_pa: 1.2e9,
            friction: 0.2,
            shear_pa: 4e6,
            area_m2: 0.02,
        };
        assert_ne!(numbers.area_m2, ZHAO.area_m2);
        let contact = numbers.contact();
        let found = contact.at(pressure_pa).unwrap();
        let other = contact
            .clone()
            .with_stored_energy(StoredEnergy::PiLoadings)
            .at(pressure_pa)
            .unwrap();
        let obtained = [
            domain_extension_factor(dimension),
            contact.critical_area_m2(),
            found.largest_contact_area_m2,
            found.real_area_fraction,
            found.normal_stiffness_n_per_m3,
            found.tangential_stiffness_n_per_m3,
            found.elastic_energy_j_per_m2,
            found.plastic_energy_j_per_m2,
            found.normal_loss_factor,
            found.tangential_loss_factor,
            other.tangential_loss_factor,
            found.friction_ratio,
        ];
        for (place, (found, expected)) in obtained.into_iter().zip(&values[3..]).enumerate() {
            let difference = relative(found, *expected);
            assert!(difference < 1e-12, "{place}: {difference:e} in {line}");
        }
        regimes[usize::from(found.regime == Regime::ElasticPlastic)] += 1;
        rows += 1;
    }
    assert_eq!(rows, 66);
    assert!(regimes.iter().all(|&number| number > 5), "{regimes:?}");
}
