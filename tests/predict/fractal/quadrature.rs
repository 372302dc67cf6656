//! The sums over contacts by quadrature of what each contact does.

use std::f64::consts::PI;

use bolted_joint::predict::ContactError;
use bolted_joint::predict::fractal::{FractalContact, PerArea, Regime};
use proptest::prelude::*;

use super::{Numbers, relative};

/// Nodes and weights of Gauss and Legendre on (0, 1), by Newton's method on the polynomial.
fn gauss() -> Vec<(f64, f64)> {
    const ORDER: usize = 20;
    let mut nodes = Vec::new();
    for place in 0..ORDER {
        let mut x = (PI * (place as f64 + 0.75) / (ORDER as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..100 {
            let [mut before, mut now] = [1.0, x];
            for order in 2..=ORDER {
                let n = order as f64;
                [before, now] = [now, ((2.0 * n - 1.0) * x * now - (n - 1.0) * before) / n];
            }
            slope = ORDER as f64 * (x * now - before) / (x * x - 1.0);
            x -= now / slope;
        }
        nodes.push((0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope)));
    }
    nodes
}

/// ∫ f(a')/a' da' over ln a' from `low` to `high`, in panels over which f changes by a few powers of e.
fn integral(f: &dyn Fn(f64) -> f64, low: f64, high: f64, nodes: &[(f64, f64)]) -> f64 {
    let panels = ((high - low) / 2.0).ceil().max(1.0);
    let width = (high - low) / panels;
    let mut sum = 0.0;
    for panel in 0..panels as usize {
        for &(place, weight) in nodes {
            let area = (low + width * (panel as f64 + place)).exp();
            sum += width * weight * f(area);
        }
    }
    sum
}

/// What the contacts up to a'_L sum up to, for the whole nominal area.
struct Sums {
    load: f64,
    elastic_load: f64,
    real_area: f64,
    normal: f64,
    /// Without tangential force.
    tangential: f64,
    elastic_energy: f64,
    plastic_energy: f64,
}

/// Where an increasing function vanishes.
fn bisected(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

fn sums(numbers: &Numbers, largest: f64) -> Sums {
    let d = numbers.dimension;
    let hardness = numbers.hardness_pa;
    let [e1, e2] = numbers.modulus_pa;
    let [nu1, nu2] = numbers.poisson;
    let modulus = 1.0 / ((1.0 - nu1 * nu1) / e1 + (1.0 - nu2 * nu2) / e2);
    let shear = 1.0 / ((2.0 - nu1) * 2.0 * (1.0 + nu1) / e1 + (2.0 - nu2) * 2.0 * (1.0 + nu2) / e2);
    let psi = bisected(
        |psi| {
            psi.powf(0.5 * (2.0 - d))
                - (1.0 + psi.powf(-0.5 * d)).powf(-(2.0 - d) / d)
                - (2.0 - d) / d
        },
        1.0,
        3.0,
    );
    // n(a') a'² as one power, since n alone overflows where a' is very small
    let number_by_square =
        |a: f64| 0.5 * d * psi.powf(0.5 * (2.0 - d)) * largest * (a / largest).powf(1.0 - 0.5 * d);
    let log_gamma = 1.5_f64.ln();
    let rough = numbers.roughness_m.powf(d - 1.0) * log_gamma.sqrt();
    let depth =
        |a: f64| 2.0_f64.powf(3.0 - d) * rough * PI.powf(0.5 * (d - 2.0)) * a.powf(0.5 * (2.0 - d));
    let radius = |a: f64| a.powf(0.5 * d) / (2.0_f64.powf(4.0 - d) * PI.powf(0.5 * d) * rough);
    // Hertz
    let elastic = |a: f64| 4.0 / 3.0 * modulus * radius(a).sqrt() * depth(a).powf(1.5);
    let log_critical = bisected(
        |t| (hardness * t.exp() / elastic(t.exp())).ln(),
        -300.0,
        100.0,
    );
    // (df_e/da')/(dδ/da') by the logarithmic derivatives (3−D)/2 and (2−D)/2
    let normal = |a: f64| elastic(a) * (3.0 - d) / (depth(a) * (2.0 - d));
    // Mindlin: 8 G' r with the radius of the real area a'/2
    let tangential = |a: f64| 8.0 * shear * (a / (2.0 * PI)).sqrt();
    let energy = |a: f64| 8.0 / 15.0 * modulus * radius(a).sqrt() * depth(a).powf(2.5);

    let nodes = gauss();
    // The plastic integrands fall with (1 − D/2) or faster towards small contacts.
    let lowest = log_critical.min(largest.ln()) - 28.0 / (1.0 - 0.5 * d);
    let flowing = |f: &dyn Fn(f64) -> f64| {
        integral(
            &|a| f(a) / a * number_by_square(a),
            lowest,
            log_critical.min(largest.ln()),
            &nodes,
        )
    };
    let springy = |f: &dyn Fn(f64) -> f64| {
        if largest.ln() <= log_critical {
            return 0.0;
        }
        integral(
            &|a| f(a) / a * number_by_square(a),
            log_critical,
            largest.ln(),
            &nodes,
        )
    };
    let elastic_load = springy(&elastic);
    Sums {
        load: elastic_load + flowing(&|a| hardness * a),
        elastic_load,
        real_area: springy(&|a| 0.5 * a) + flowing(&|a| a),
        normal: springy(&normal),
        tangential: springy(&tangential),
        elastic_energy: springy(&energy),
        plastic_energy: flowing(&|a| hardness * a * depth(a)),
    }
}

fn compare(numbers: &Numbers, found: &PerArea) {
    let sums = sums(numbers, found.largest_contact_area_m2);
    let a0 = numbers.area_m2;
    let check = |name: &str, found: f64, expected: f64| {
        let difference = relative(found, expected);
        assert!(
            difference < 1e-10,
            "{name} {difference:e} {numbers:?} {found}"
        );
    };
    check("load", found.pressure_pa * a0, sums.load);
    check("area", found.real_area_fraction * a0, sums.real_area);
    let q = numbers.shear_pa * sums.real_area / (numbers.friction * sums.load);
    check("q", found.friction_ratio, q);
    check(
        "plastic energy",
        found.plastic_energy_j_per_m2 * a0,
        sums.plastic_energy,
    );
    check("K_N", found.normal_stiffness_n_per_m3 * a0, sums.normal);
    check(
        "K_T",
        found.tangential_stiffness_n_per_m3 * a0,
        sums.tangential * (1.0 - q).cbrt(),
    );
    check(
        "share",
        found.elastic_load_fraction,
        sums.elastic_load / sums.load,
    );
    check(
        "elastic energy",
        found.elastic_energy_j_per_m2 * a0,
        sums.elastic_energy,
    );
    if found.regime == Regime::ElasticPlastic {
        let expected = sums.plastic_energy / sums.elastic_energy;
        check("η_N", found.normal_loss_factor, expected);
    } else {
        assert_eq!(found.normal_loss_factor, 0.0);
        assert_eq!(found.tangential_loss_factor, 0.0);
    }
}

fn numbers() -> impl Strategy<Value = Numbers> {
    let dimension = prop_oneof![6 => 1.15..1.9, 1 => Just(1.5), 1 => Just(5.0 / 3.0)];
    (
        dimension,
        -12.0..-7.5,
        (10.3..11.6, 10.3..11.6),
        (0.0..0.45, 0.0..0.45),
        8.7..9.7,
        0.0..0.25,
        -4.0..0.0,
    )
        .prop_map(
            |(dimension, roughness, (e1, e2), (nu1, nu2), hardness, slip, area)| {
                let power = |exponent: f64| 10.0_f64.powf(exponent);
                Numbers {
                    dimension,
                    roughness_m: power(roughness),
                    modulus_pa: [power(e1), power(e2)],
                    poisson: [nu1, nu2],
                    hardness_pa: power(hardness),
                    friction: 0.2,
                    // q is slip where all is plastic; above that it falls first, then grows with the pressure.
                    shear_pa: slip * 0.2 * power(hardness),
                    area_m2: power(area),
                }
            },
        )
}

/// A pressure by its ratio to the critical one, if the model holds for it.
fn inside(contact: &FractalContact, numbers: &Numbers, log_ratio: f64) -> Option<PerArea> {
    let pressure = contact.critical_pressure_pa() * log_ratio.exp();
    if pressure >= numbers.hardness_pa {
        return None;
    }
    match contact.at(pressure) {
        Ok(found) => Some(found),
        Err(ContactError::RealArea { .. } | ContactError::FrictionRatio { .. }) => None,
        Err(other) => panic!("{other}"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, max_global_rejects: 100_000, ..ProptestConfig::default() })]

    #[test]
    fn closed_forms_are_the_integrals(numbers in numbers(), log_ratio in 1e-4..15.0) {
        let found = inside(&numbers.contact(), &numbers, log_ratio);
        prop_assume!(found.is_some());
        let found = found.unwrap();
        prop_assert_eq!(found.regime, Regime::ElasticPlastic);
        compare(&numbers, &found);
    }

    #[test]
    fn plastic_contacts_are_the_integrals(numbers in numbers(), log_ratio in -12.0..0.0) {
        let found = inside(&numbers.contact(), &numbers, log_ratio);
        prop_assume!(found.is_some());
        let found = found.unwrap();
        prop_assert_eq!(found.regime, Regime::Plastic);
        compare(&numbers, &found);
    }
}
