//! Limits, dimensions and monotony.

use bolted_joint::predict::fractal::{PerArea, Regime, StoredEnergy};
use proptest::prelude::*;

use super::{Numbers, ZHAO, relative};

fn all(found: &PerArea) -> [f64; 10] {
    [
        found.normal_stiffness_n_per_m3,
        found.tangential_stiffness_n_per_m3,
        found.normal_loss_factor,
        found.tangential_loss_factor,
        found.real_area_fraction,
        found.largest_contact_area_m2,
        found.elastic_load_fraction,
        found.friction_ratio,
        found.elastic_energy_j_per_m2,
        found.plastic_energy_j_per_m2,
    ]
}

/// Values on both sides of D: their mean is that at D but for the curvature, their distance that of a smooth function.
#[test]
fn exceptional_dimensions_are_passed_smoothly() {
    for dimension in [1.5, 5.0 / 3.0] {
        for pressure_pa in [1e5, 5e6, 3e7] {
            for distance in [1e-6, 1e-7, 1e-9, 1e-12] {
                let at = |d: f64| {
                    let numbers = Numbers {
                        dimension: d,
                        roughness_m: 2e-9,
                        shear_pa: 1e7,
                        ..ZHAO
                    };
                    all(&numbers.contact().at(pressure_pa).unwrap())
                };
                let [below, here, above] = [
                    at(dimension - distance),
                    at(dimension),
                    at(dimension + distance),
                ];
                for place in 0..here.len() {
                    let [low, mid, high] = [below[place], here[place], above[place]];
                    let mean = relative(0.5 * (low + high), mid);
                    // Derivatives of ln K with respect to D are of the order of ln(a'/G²), 50; squared for the second.
                    let curvature = 1e5 * distance * distance;
                    assert!(
                        mean < 1e-12 + curvature,
                        "{place} {dimension} {distance}: {mean:e}"
                    );
                    assert!(relative(low, high) < 400.0 * distance, "{place} {distance}");
                }
            }
        }
    }
}

#[test]
fn no_pressure_is_no_stiffness() {
    let found = ZHAO.contact().at(0.0).unwrap();
    assert_eq!(found.regime, Regime::Apart);
    assert_eq!(all(&found), [0.0; 10]);
}

/// Stiffness begins at the critical pressure without a jump, as do all else but the loss factors.
#[test]
fn the_first_elastic_contact() {
    let numbers = Numbers {
        shear_pa: 1e7,
        ..ZHAO
    };
    let contact = numbers.contact();
    let critical = contact.critical_pressure_pa();
    let before = contact.at(critical * (1.0 - 1e-9)).unwrap();
    let after = contact.at(critical * (1.0 + 1e-9)).unwrap();
    assert_eq!(before.regime, Regime::Plastic);
    assert_eq!(after.regime, Regime::ElasticPlastic);
    assert_eq!(before.normal_stiffness_n_per_m3, 0.0);
    for place in [4, 5, 7, 9] {
        let [low, high] = [all(&before)[place], all(&after)[place]];
        assert!(relative(low, high) < 1e-8, "{place}: {low} {high}");
    }
    // dx = dp/p there, so that K_N = (D/2) ψ^((2−D)/2) k_n(a'_c) x, and η_N = 5/(2(2 − D) x)
    let x: f64 = 1e-9;
    assert!(relative(after.normal_loss_factor, 2.5 / (0.58 * x)) < 1e-6);
    assert!(after.normal_stiffness_n_per_m3 > 0.0);
    assert!(
        after.normal_stiffness_n_per_m3 < 1e-6 * contact.at(1e6).unwrap().normal_stiffness_n_per_m3
    );
}

#[test]
fn without_tangential_load_there_is_no_microslip() {
    for stored in [StoredEnergy::OneLoading, StoredEnergy::PiLoadings] {
        assert_eq!(stored.loss_factor(0.0).unwrap(), 0.0);
        // 4q/9 over c
        let slope = match stored {
            StoredEnergy::OneLoading => 4.0 / 9.0,
            StoredEnergy::PiLoadings => 4.0 / (9.0 * std::f64::consts::PI),
        };
        for q in [1e-300, 1e-100, 1e-20, 1e-9] {
            assert!(relative(stored.loss_factor(q).unwrap(), slope * q) < 2e-9);
        }
    }
    let found = ZHAO.contact().at(1e6).unwrap();
    assert_eq!(found.tangential_loss_factor, 0.0);
    assert_eq!(found.friction_ratio, 0.0);
}

/// Where η_T is infinite: 6c³ + 12c² − 2c − 1 = 0 with c = (1 − q)^(1/3).
#[test]
fn the_pole_of_the_tangential_loss_factor() {
    let limit = StoredEnergy::OneLoading.largest_friction_ratio();
    let c = (1.0 - limit).cbrt();
    assert!((((6.0 * c + 12.0) * c - 2.0) * c - 1.0).abs() < 1e-13);
    // The printed functions
    let h1 = |q: f64| {
        let rest = 1.0 - q;
        1.0 - rest.powf(5.0 / 3.0) - 5.0 * q / 6.0 * (1.0 + rest.powf(2.0 / 3.0))
    };
    let h2 = |q: f64| {
        let rest = 1.0 - q;
        0.6 + 0.4 * rest.powf(5.0 / 3.0) - rest.powf(2.0 / 3.0)
    };
    assert!((5.0 / 24.0 * h2(limit) / h1(limit) - 1.0).abs() < 1e-13);
    for q in [0.5, 0.7, 0.9, 0.95, 0.958] {
        let expected = 1.0 / (5.0 / 24.0 * h2(q) / h1(q) - 1.0);
        let found = StoredEnergy::OneLoading.loss_factor(q).unwrap();
        assert!(relative(found, expected) < 1e-10, "{q}: {found} {expected}");
    }
    assert!(StoredEnergy::OneLoading.loss_factor(limit - 1e-12).unwrap() > 1e10);
    assert!(StoredEnergy::PiLoadings.loss_factor(1.0 - 1e-12).unwrap() < 0.74);
}

fn scaled(length: f64, pressure: f64) -> Numbers {
    Numbers {
        roughness_m: ZHAO.roughness_m * length,
        modulus_pa: ZHAO.modulus_pa.map(|modulus| modulus * pressure),
        hardness_pa: ZHAO.hardness_pa * pressure,
        shear_pa: 2e7 * pressure,
        area_m2: ZHAO.area_m2 * length * length,
        ..ZHAO
    }
}

proptest! {
    /// Lengths and pressures are the only dimensions: K/A₀ goes with pressure over length, energy with pressure times length.
    #[test]
    fn units_do_not_matter(length in -4.0..4.0, pressure in -4.0..4.0, load in 4.0..7.3) {
        let [length, pressure, load] = [length, pressure, load].map(|power: f64| 10.0_f64.powf(power));
        let plain = all(&scaled(1.0, 1.0).contact().at(load).unwrap());
        let other = all(&scaled(length, pressure).contact().at(load * pressure).unwrap());
        let stiffness = pressure / length;
        let factors = [
            stiffness, stiffness, 1.0, 1.0, 1.0, length * length, 1.0, 1.0, pressure * length, pressure * length,
        ];
        for place in 0..plain.len() {
            let difference = relative(other[place], plain[place] * factors[place]);
            prop_assert!(difference < 2e-12, "{}: {:e}", place, difference);
        }
    }

    /// More pressure: more area, stiffness, elastic share and energy; less normal damping.
    #[test]
    fn pressure_grows(dimension in 1.2..1.9, roughness in -13.0..-8.0, low in 2.0..8.0, step in 1e-6..1.0) {
        let numbers = Numbers { dimension, roughness_m: 10.0_f64.powf(roughness), ..ZHAO };
        let contact = numbers.contact();
        let pressure = 10.0_f64.powf(low);
        let (Ok(less), Ok(more)) = (contact.at(pressure), contact.at(pressure * (1.0 + step))) else {
            return Ok(());
        };
        for place in [4, 5, 9] {
            prop_assert!(all(&more)[place] > all(&less)[place]);
        }
        if less.regime == Regime::ElasticPlastic {
            prop_assert_eq!(more.regime, Regime::ElasticPlastic);
            for place in [0, 1, 6, 8] {
                prop_assert!(all(&more)[place] > all(&less)[place]);
            }
            prop_assert!(more.normal_loss_factor < less.normal_loss_factor);
        }
    }
}
