//! What no layer can stand for.

use bolted_joint::predict::ContactError;
use bolted_joint::predict::surface::Roughness;
use bolted_joint::predict::virtual_material::{LayerContact, Layers, Loading, VirtualMaterial};

use super::{HARDNESS_PA, contact, pair, try_contact};

const LAYERS: Layers = Layers {
    thickness_m: [1e-3; 2],
    density_kg_per_m3: [7850.0; 2],
};

#[test]
fn contacts_that_are_all_plastic() {
    let contact = contact(1.42, 1.21e-8);
    let [load, area] = [contact.critical_load_n(), contact.critical_real_area_m2()];
    for loading in [Loading::Force(load), Loading::RealArea(0.5 * area)] {
        let error = contact.moduli(loading).unwrap_err();
        assert!(matches!(error, ContactError::NoElasticContact { .. }));
        assert!(error.to_string().contains("A_t > A_rc"));
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = contact.moduli(Loading::Force(bad)).unwrap_err();
        assert!(
            error.to_string().starts_with("the normal load is"),
            "{error}"
        );
    }
    let error = contact.moduli(Loading::RealArea(1e200)).unwrap_err();
    assert!(matches!(error, ContactError::Overflow(_)));
}

#[test]
fn friction_that_is_used_up() {
    let roughness = Roughness::new(1.42, 1e-9).unwrap();
    for bad in [1.0, 1.5, -0.1, f64::NAN] {
        let error = LayerContact::new(&pair(), roughness, HARDNESS_PA, bad).unwrap_err();
        assert!(matches!(error, ContactError::LayerSlips(_)));
    }
    for bad in [0.0, -1.0, f64::NAN] {
        let error = try_contact(1.42, 1e-9, bad).unwrap_err();
        assert!(error.to_string().starts_with("the hardness is"), "{error}");
    }
    let error = try_contact(1.001, 1e-9, HARDNESS_PA).unwrap_err();
    assert!(matches!(error, ContactError::CriticalArea { .. }));
}

/// Metals of ordinary hardness have no such layer that is isotropic.
#[test]
fn poissons_ratios_that_no_material_has() {
    let contact = contact(1.42, 1.21e-8);
    let loading = Loading::Force(2.0 * contact.critical_load_n());
    let error = VirtualMaterial::new(&contact, loading, &LAYERS).unwrap_err();
    let ContactError::PoissonsRatio { found, .. } = error else {
        panic!("{error}");
    };
    assert!(found > 0.5);
    assert_eq!(found, contact.moduli(loading).unwrap().poissons_ratio());
}

#[test]
fn slices_without_thickness_or_mass() {
    let contact = contact(1.42, 1.21e-8);
    let loading = Loading::Force(2.0 * contact.critical_load_n());
    let thin = Layers {
        thickness_m: [1e-3, 0.0],
        ..LAYERS
    };
    let light = Layers {
        density_kg_per_m3: [-1.0, 7850.0],
        ..LAYERS
    };
    for (layers, text) in [
        (thin, "thickness (m) of side b is 0"),
        (light, "density (kg/m³) of side a is -1"),
    ] {
        let error = VirtualMaterial::new(&contact, loading, &layers).unwrap_err();
        assert!(error.to_string().contains(text), "{error}");
    }
}
