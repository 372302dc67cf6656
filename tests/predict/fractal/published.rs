//! Numbers that are known of Zhao's specimen.

use bolted_joint::predict::fractal::domain_extension_factor;

use super::{ZHAO, relative};

#[test]
fn domain_extension_factor_is_that_of_the_equation() {
    assert!((domain_extension_factor(1.42) - 2.066_95).abs() < 5e-6);
    for step in 1..100 {
        let d = 1.0 + 0.01 * f64::from(step);
        let psi = domain_extension_factor(d);
        // (3) as printed
        let left = psi.powf(0.5 * (2.0 - d)) - (1.0 + psi.powf(-0.5 * d)).powf(-(2.0 - d) / d);
        assert!((left - (2.0 - d) / d).abs() < 2e-15, "{d}: {left}");
    }
    // D → 1: the golden ratio squared; D → 2: ln(1 + ψ) = 1
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    assert!((domain_extension_factor(1.0 + 1e-14) - golden.powi(2)).abs() < 1e-12);
    let end = domain_extension_factor(2.0 - 1e-15);
    assert!((end - (1.0_f64.exp() - 1.0)).abs() < 1e-12, "{end}");
}

#[test]
fn stiffness_of_the_specimen() {
    let contact = ZHAO.contact();
    assert!(relative(contact.critical_area_m2(), 1.6256e-9) < 5e-5);
    for (pressure_mpa, stiffness) in [
        (0.62, 2.181e11),
        (2.0, 6.200e11),
        (4.0, 1.148e12),
        (7.98, 2.119e12),
    ] {
        let found = contact.at(1e6 * pressure_mpa).unwrap();
        assert!(relative(found.normal_stiffness_n_per_m3, stiffness) < 3e-4);
        let ratio = found.tangential_stiffness_n_per_m3 / found.normal_stiffness_n_per_m3;
        assert!((ratio - 0.461).abs() < 5e-4);
        // 6 G'(2 − D)/(E*(3 − D)), which Mindlin's and Hertz's contacts of one size would make 4 G'/(2 E*)
        let moduli =
            ZHAO.pair().equivalent_shear_modulus_pa() / ZHAO.pair().equivalent_youngs_modulus_pa();
        assert!(relative(ratio, 6.0 * moduli * 0.58 / 1.58) < 1e-14);
    }
}
