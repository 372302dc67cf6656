//! Layers between parts.

use bolted_joint::predict::pressure::{Element, PressureField};
use bolted_joint::predict::virtual_material::{
    Interface, JointStiffness, Layers, Loading, Moduli, VirtualMaterial,
};
use bolted_joint_testing::has;

use super::{FRICTION_RATIO, pair, try_contact};
use crate::fractal::relative;

const MODULI: Moduli = Moduli {
    youngs_modulus_pa: 3e8,
    shear_modulus_pa: 1.2e8,
};

/// Squares of a rectangle, of which those beyond x = `untouched` carry nothing.
fn squares(width_m: f64, depth_m: f64, across: u32, untouched: f64) -> PressureField {
    let side = width_m / f64::from(across);
    let rows = (depth_m / side).round() as u32;
    let elements = (0..across * rows).map(|n| {
        let x_m = (f64::from(n % across) + 0.5) * side - 0.5 * width_m + 3.0;
        let y_m = (f64::from(n / across) + 0.5) * side - 0.5 * depth_m - 2.0;
        Element {
            x_m,
            y_m,
            area_m2: side * side,
            pressure_pa: if x_m < untouched { 1e6 } else { 0.0 },
        }
    });
    PressureField::new(elements.collect()).unwrap()
}

#[test]
fn a_rectangle_is_the_textbook_layer() {
    let interface = Interface::rectangle(0.2, 0.05).unwrap();
    let joint = JointStiffness::new(MODULI, 2e-3, &interface).unwrap();
    let expected = [
        (joint.normal_n_per_m, 3e8 * 0.01 / 2e-3),
        (joint.tangential_n_per_m, 1.2e8 * 0.01 / 2e-3),
        (
            joint.bending_n_m_per_rad[0],
            3e8 * 0.2 * 0.05_f64.powi(3) / 12.0 / 2e-3,
        ),
        (
            joint.bending_n_m_per_rad[1],
            3e8 * 0.05 * 0.2_f64.powi(3) / 12.0 / 2e-3,
        ),
        (
            joint.torsion_n_m_per_rad,
            1.2e8 * 0.2 * 0.05 * (0.2_f64.powi(2) + 0.05_f64.powi(2)) / 12.0 / 2e-3,
        ),
    ];
    for (found, expected) in expected {
        assert!(relative(found, expected) < 1e-14);
    }
}

/// The same rectangle as a field, anywhere: elements as points lack their own moment, 1/n² of it.
#[test]
fn a_field_is_the_rectangle_that_touches() {
    let field = squares(0.4, 0.05, 160, 3.0);
    let found = Interface::in_contact(&field).unwrap();
    let expected = Interface::rectangle(0.2, 0.05).unwrap();
    assert!(relative(found.area_m2, expected.area_m2) < 1e-12);
    assert!((found.centre_m[0] - 2.9).abs() < 1e-12 && (found.centre_m[1] + 2.0).abs() < 1e-12);
    for (place, across) in [(0, 20.0_f64), (1, 80.0)] {
        let missing = 1.0 - across.powi(-2);
        let expected = expected.second_moments_m4[place] * missing;
        assert!(relative(found.second_moments_m4[place], expected) < 1e-9);
    }
}

#[test]
fn nothing_to_stand_for() {
    assert!(Interface::in_contact(&squares(0.4, 0.05, 16, 0.0)).is_err());
    assert!(Interface::rectangle(0.0, 1.0).is_err());
    let interface = Interface::rectangle(1.0, 1.0).unwrap();
    let error = JointStiffness::new(MODULI, -1e-3, &interface).unwrap_err();
    has(&error.to_string(), &["thickness is -0.001 m"]);
}

/// A layer of surfaces hard enough to have a Poisson's ratio.
#[test]
fn a_material_has_the_mean_density_of_its_slices() {
    let contact = try_contact(1.42, 1.21e-8, 1.2e10).unwrap();
    let layers = Layers {
        thickness_m: [1e-3, 3e-3],
        density_kg_per_m3: [7850.0, 7200.0],
    };
    let loading = Loading::Force(1.001 * contact.critical_load_n());
    let material = VirtualMaterial::new(&contact, loading, &layers).unwrap();
    assert_eq!(material.moduli(), contact.moduli(loading).unwrap());
    assert!(relative(material.density_kg_per_m3, (7850.0 + 3.0 * 7200.0) / 4.0) < 1e-15);
    assert!(relative(material.thickness_m, 4e-3) < 1e-15);
    let isotropic = 2.0 * material.shear_modulus_pa * (1.0 + material.poissons_ratio);
    assert!(relative(isotropic, material.youngs_modulus_pa) < 1e-15);
    // Next to the critical load Poisson's ratio depends on neither D nor G: E'²/(24π H G' (1 − β/f)^(1/3)) − 1
    let modulus = pair().equivalent_youngs_modulus_pa();
    let shear = pair().equivalent_shear_modulus_pa() * (1.0 - FRICTION_RATIO).cbrt();
    let limit = modulus * modulus / (24.0 * std::f64::consts::PI * 1.2e10 * shear) - 1.0;
    assert!((material.poissons_ratio - limit).abs() < 1e-3);
}
