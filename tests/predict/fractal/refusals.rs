//! What is outside the model is an error with its reason.

use bolted_joint::predict::ContactError;
use bolted_joint::predict::fractal::StoredEnergy;

use super::{Numbers, ZHAO, relative};

/// Which number is refused, and its bits.
fn number(error: &ContactError) -> (String, u64) {
    let ContactError::Number(number) = error else {
        panic!("{error}");
    };
    (number.quantity.to_string(), number.found.to_bits())
}

#[test]
fn numbers_that_are_none() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let cases = [
            Numbers {
                hardness_pa: bad,
                ..ZHAO
            },
            Numbers {
                friction: bad,
                ..ZHAO
            },
            Numbers {
                area_m2: bad,
                ..ZHAO
            },
        ];
        let found = cases.map(|numbers| number(&numbers.try_contact().unwrap_err()));
        let names = [
            "the hardness",
            "the coefficient of friction",
            "the nominal area",
        ];
        assert_eq!(found, names.map(|name| (name.to_owned(), bad.to_bits())));
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let numbers = Numbers {
            shear_pa: bad,
            ..ZHAO
        };
        let error = numbers.try_contact().unwrap_err();
        assert_eq!(number(&error).0, "the shear stress in the contacts");
        let error = ZHAO.contact().at(bad).unwrap_err();
        assert_eq!(number(&error).0, "the pressure");
    }
}

#[test]
fn pressures_beyond_the_model() {
    let contact = ZHAO.contact();
    assert!(matches!(
        contact.at(1.96e9),
        Err(ContactError::BeyondHardness { .. })
    ));
    // Somewhere below the hardness the contacts fill the nominal area: the last pressure before has all but that.
    let [mut low, mut high] = [1e6, 1.96e9];
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        match contact.at(middle) {
            Ok(_) => low = middle,
            Err(ContactError::RealArea { fraction, .. }) => {
                assert!(fraction > 1.0);
                high = middle;
            }
            Err(other) => panic!("{other}"),
        }
    }
    let last = contact.at(low).unwrap();
    assert!(relative(last.real_area_fraction, 1.0) < 1e-12);
}

#[test]
fn friction_that_is_used_up() {
    let numbers = Numbers {
        shear_pa: 8e7,
        ..ZHAO
    };
    let contact = numbers.contact();
    let limit = StoredEnergy::OneLoading.largest_friction_ratio();
    // T = τ_b A_r grows faster than P = p A₀.
    let [mut low, mut high]: [f64; 2] = [1e5, 1e9];
    for _ in 0..100 {
        let middle = (low * high).sqrt();
        match contact.at(middle) {
            Ok(_) => low = middle,
            Err(ContactError::FrictionRatio { found, limit: told }) => {
                assert_eq!(told, limit);
                assert!(found >= limit);
                high = middle;
            }
            Err(ContactError::RealArea { .. }) => high = middle,
            Err(other) => panic!("{other}"),
        }
    }
    let last = contact.at(low).unwrap();
    assert!(
        relative(last.friction_ratio, limit) < 1e-9,
        "{}",
        last.friction_ratio
    );
    assert!(last.tangential_loss_factor > 1e6);
    let error = contact.at(1.01 * low).unwrap_err();
    assert!(error.to_string().contains("less than 0.958286"), "{error}");
    // With the other definition the range goes on to gross slip.
    let contact = contact.with_stored_energy(StoredEnergy::PiLoadings);
    assert!(contact.at(1.01 * low).unwrap().tangential_loss_factor < 0.74);
}

/// Surfaces whose dimension is close to 1 have a critical area beyond any size: no contact is elastic.
#[test]
fn dimensions_close_to_one() {
    for dimension in [1.0 + 1e-12, 1.001, 1.01] {
        let numbers = Numbers { dimension, ..ZHAO };
        let found = numbers.contact().at(1e6).unwrap();
        assert_eq!(found.normal_stiffness_n_per_m3, 0.0);
        assert!(found.largest_contact_area_m2 > 0.0 && found.largest_contact_area_m2 < 0.06);
        assert!(found.plastic_energy_j_per_m2.is_finite());
    }
    let harder = Numbers {
        dimension: 1.001,
        hardness_pa: 1e12,
        ..ZHAO
    };
    assert!(matches!(
        harder.try_contact(),
        Err(ContactError::CriticalArea { .. })
    ));
}
