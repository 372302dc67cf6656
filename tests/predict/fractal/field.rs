//! Contacts over a whole field.

use bolted_joint::predict::ContactError;
use bolted_joint::predict::pressure::{Element, PressureField};
use bolted_joint_testing::has;

use super::{Numbers, ZHAO};

fn field(pressures: &[f64]) -> PressureField {
    let elements = pressures
        .iter()
        .enumerate()
        .map(|(place, &pressure_pa)| Element {
            x_m: 0.01 * place as f64,
            y_m: -0.5,
            area_m2: 1e-4,
            pressure_pa,
        });
    PressureField::new(elements.collect()).unwrap()
}

#[test]
fn each_element_is_as_if_alone() {
    let contact = Numbers {
        shear_pa: 1e7,
        ..ZHAO
    }
    .contact();
    let pressures = [7.98e6, 0.0, 1e-3, 0.62e6, 2e7, 10.0, 0.62e6];
    let found = contact.over(&field(&pressures)).unwrap();
    assert_eq!(found.len(), pressures.len());
    for (one, &pressure) in found.iter().zip(&pressures) {
        assert_eq!(*one, contact.at(pressure).unwrap());
    }
}

#[test]
fn the_element_outside_the_model_is_named() {
    let contact = ZHAO.contact();
    let error = contact.over(&field(&[1e6, 2e6, 3e9, 4e9])).unwrap_err();
    let ContactError::Element {
        number,
        x_m,
        y_m,
        reason,
    } = &error
    else {
        panic!("{error}");
    };
    assert_eq!((*number, *x_m, *y_m), (3, 0.02, -0.5));
    assert!(matches!(**reason, ContactError::BeyondHardness { .. }));
    let text = error.to_string();
    has(&text, &["element 3", "3000000000 Pa"]);
}
