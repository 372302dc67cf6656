//! Dahl's law against its closed forms.

use super::{
    super::trials::{
        Tried, assert_balance, assert_balance_over_preload, assert_changes, way, way_over_preload,
    },
    *,
};
use crate::{number::Dual, random::Random};

impl Tried for Dahl {
    type Changing = Dahl<Dual<1>>;
}

#[test]
fn a_steady_loop_is_that_of_the_closed_form() {
    // F_m = F_c tanh(σ₀X/F_c), D = 4 F_c (X − F_m/σ₀), evaluated with 30 digits
    let law = Dahl {
        stiffness: 1e5,
        slip_force: 2.0,
    };
    let amplitude = 5e-5;
    let mut memory = Dahl::at_rest();
    let mut heat = 0.0;
    for _ in 0..40 {
        heat = law.commit(&mut memory, amplitude, 0.0) + law.commit(&mut memory, -amplitude, 0.0);
    }
    let load = law.load(&memory, amplitude, 0.0);
    assert!((load / 1.973_228_596_302_9 - 1.0).abs() < 1e-12, "{load}");
    assert!(
        (heat / 2.421_417_122_957_7e-4 - 1.0).abs() < 1e-12,
        "{heat:e}"
    );
}

#[test]
fn energies_balance_and_changes_are_those_of_differences() {
    let mut random = Random(29);
    for _ in 0..40 {
        let law = Dahl {
            stiffness: 10.0_f64.powf(3.0 + 5.0 * random.unit()),
            slip_force: 10.0_f64.powf(4.0 * random.unit()),
        };
        let way_of = way(&mut random, 20, 4.0 * law.slip_force / law.stiffness);
        assert_balance(&law, &way_of, 1.0);
        let law = Dahl {
            stiffness: 1.0 + random.unit(),
            slip_force: 1.0 + random.unit(),
        };
        let way_of = way(&mut random, 10, 2.0);
        assert_changes(&law, &way_of, 2.0, 1.0);
    }
}

#[test]
fn parameters_out_of_range_are_named() {
    for (stiffness, slip_force, parameter) in [
        (0.0, 1.0, Some(0)),
        (1.0, -1.0, Some(1)),
        (1.0, f64::INFINITY, Some(1)),
        (1.0, 1.0, None),
    ] {
        let law = Dahl {
            stiffness,
            slip_force,
        };
        assert_eq!(law.outside().map(|outside| outside.parameter), parameter);
    }
}

#[test]
fn what_a_lower_preload_no_longer_holds_is_heat() {
    let mut random = Random(62);
    let mut released = 0.0;
    for _ in 0..30 {
        let law = Dahl {
            stiffness: 1e5,
            slip_force: 2.0 * (0.1 + random.unit()),
        };
        let way = way_over_preload(&mut random, 25, 1e-4);
        released += assert_balance_over_preload(&law, &way, 1.0);
    }
    assert!(released > 0.0);
}
