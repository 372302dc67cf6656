//! The law of Valanis against its closed forms and against the printed equation.

use super::{
    super::trials::{
        Tried, assert_balance, assert_balance_over_preload, assert_changes, way, way_over_preload,
    },
    *,
};
use crate::{number::Dual, random::Random};

impl Tried for Valanis {
    type Changing = Valanis<Dual<1>>;
}

const fn law(kappa: f64) -> Valanis {
    Valanis {
        stiffness: 1000.0,
        slip_stiffness: 100.0,
        slip_force: 5.0,
        kappa,
    }
}

/// κ, load at the tip of a steady loop of 6 mm, heat of the loop, and load of the slider after a way, by mpmath with 30
/// digits from the equation of the loop and by the step of Lambert's W.
#[rustfmt::skip]
const CLOSED_FORMS: [(f64, f64, f64, f64); 4] = [
    (0.0, 4.3514457315547, 0.032971085368906, -3.4657448972292),
    (0.5, 4.6483770884788, 0.027032458230425, -3.896051151761),
    (0.9, 5.07125928497, 0.018574814300601, -4.4697512831095),
    (0.99, 5.1, 0.018, -4.5),
];

#[test]
fn loops_and_ways_are_those_of_the_closed_forms() {
    for (kappa, tip, heat, after_way) in CLOSED_FORMS {
        let law = law(kappa);
        let mut memory = Valanis::at_rest();
        for r in [4e-3, 6e-3, -2e-3, 3e-3, -6e-3] {
            law.commit(&mut memory, r, 0.0);
        }
        let load = memory[0];
        assert!((load / after_way - 1.0).abs() < 1e-12, "{kappa}: {load}");
        let mut found = 0.0;
        for _ in 0..60 {
            found = law.commit(&mut memory, 6e-3, 0.0) + law.commit(&mut memory, -6e-3, 0.0);
        }
        assert!((found / heat - 1.0).abs() < 1e-12, "{kappa}: {found}");
        let found = law.load(&memory, 6e-3, 0.0);
        assert!((found / tip - 1.0).abs() < 1e-12, "{kappa}: {found}");
    }
}

#[test]
fn the_load_follows_the_printed_equation() {
    for kappa in [0.0, 0.3, 0.7, 0.95] {
        let law = law(kappa);
        let Valanis {
            stiffness: e0,
            slip_stiffness: et,
            slip_force: s0,
            ..
        } = law;
        let mut memory = Valanis::at_rest();
        let mut random = Random(31);
        for r in way(&mut random, 40, 0.01) {
            let at = r + 1e-3 * (random.unit() - 0.5);
            law.commit(&mut memory, r, 0.0);
            let changing = Valanis::new(&law.parameters().map(Dual::<1>::from));
            let load = changing.load(&memory, Dual::along(at, 0), Dual::ZERO);
            // Ḟ/ẋ = E₀ (1 + (λ/E₀) s (E_t x − F))/(1 + κ (λ/E₀) s (E_t x − F)), λ = E₀/(σ₀ (1 − κ E_t/E₀))   (Tol 2.3)
            let lambda = e0 / (s0 * (1.0 - kappa * et / e0));
            let part = lambda / e0 * (at - r).signum() * (et * at - load.value);
            let expected = e0 * (1.0 + part) / (1.0 + kappa * part);
            let error = (load.change[0] - expected).abs() / e0;
            assert!(error < 1e-11, "{kappa}: {} {expected}", load.change[0]);
        }
    }
}

#[test]
fn a_way_in_parts_is_the_way_in_one() {
    for kappa in [0.0, 0.5, 0.999, 1.0] {
        let law = law(kappa);
        let [mut whole, mut parts] = [Valanis::at_rest(), Valanis::at_rest()];
        let (mut from, mut heats) = (0.0, [0.0; 2]);
        for r in [3e-3, -7e-3, 1e-3, 9e-3, 8.9e-3, -1.0] {
            heats[0] += law.commit(&mut whole, r, 0.0);
            for part in 1..=100 {
                let at = from + (r - from) * f64::from(part) / 100.0;
                heats[1] += law.commit(&mut parts, at, 0.0);
            }
            from = r;
        }
        assert!((whole[0] - parts[0]).abs() < 1e-12, "{kappa}");
        assert!(
            (heats[0] / heats[1] - 1.0).abs() < 1e-12,
            "{kappa}: {heats:?}"
        );
    }
}

#[test]
fn energies_balance_and_changes_are_those_of_differences() {
    let mut random = Random(37);
    for index in 0..60 {
        let stiffness = 10.0_f64.powf(3.0 + 5.0 * random.unit());
        let law = Valanis {
            stiffness,
            slip_stiffness: stiffness * random.unit() * 0.9,
            slip_force: 10.0_f64.powf(4.0 * random.unit()),
            kappa: if index % 10 == 0 { 1.0 } else { random.unit() },
        };
        let way_of = way(&mut random, 20, 4.0 * law.slip_force / stiffness);
        assert_balance(&law, &way_of, 1.0);
        let law = Valanis {
            stiffness: 2.0 + random.unit(),
            slip_stiffness: random.unit(),
            slip_force: 1.0 + random.unit(),
            kappa: 0.1 + 0.8 * random.unit(),
        };
        // so near that the load does not come to its limit, which moves with the parameters
        let way_of = way(&mut random, 10, 0.5);
        assert_changes(&law, &way_of, 0.5, 1.0);
    }
}

#[test]
fn parameters_out_of_range_are_named() {
    for (parameters, parameter) in [
        ([0.0, 0.0, 1.0, 0.5], Some(0)),
        ([1.0, 1.1, 1.0, 0.5], Some(1)),
        ([1.0, -0.1, 1.0, 0.5], Some(1)),
        ([1.0, 1.0, 0.0, 0.5], Some(2)),
        ([1.0, 1.0, 1.0, 1.01], Some(3)),
        ([1.0, 1.0, 1.0, -0.01], Some(3)),
        ([1.0, 1.0, 1.0, 1.0], None),
    ] {
        let law = Valanis::<f64>::new(&parameters);
        assert_eq!(law.outside().map(|outside| outside.parameter), parameter);
        assert!(law.load(&Valanis::at_rest(), 0.3, 0.0).is_finite());
    }
}

#[test]
fn what_a_lower_preload_no_longer_holds_is_heat() {
    let mut random = Random(61);
    let mut released = 0.0;
    for _ in 0..30 {
        let law = Valanis {
            stiffness: 1000.0,
            slip_stiffness: 900.0 * random.unit(),
            slip_force: 5.0 * (0.1 + random.unit()),
            kappa: random.unit(),
        };
        let way = way_over_preload(&mut random, 25, 0.03);
        released += assert_balance_over_preload(&law, &way, 1.0);
    }
    assert!(released > 0.0);
}
