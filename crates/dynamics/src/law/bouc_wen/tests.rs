//! The Bouc–Wen law against the closed forms of its loop, its equation, and its energy.

use super::{
    super::trials::{
        Tried, assert_balance, assert_balance_over_preload, assert_changes, assert_inner, integral,
        way, way_over_preload,
    },
    *,
};
use crate::{number::Dual, random::Random};

impl Tried for BoucWen {
    type Changing = BoucWen<Dual<1>>;
}

const fn law(exponent: f64, beta: f64, gamma: f64) -> BoucWen {
    BoucWen {
        stiffness: 1.0,
        slip_force: 1.0,
        exponent,
        beta,
        gamma,
    }
}

/// Exponent, β, γ, and of the steady loop of amplitude 1 the load at its tip and its heat, with 14 digits from
/// hypergeometric functions (mpmath).
#[rustfmt::skip]
const LOOPS: [(BoucWen, f64, f64); 6] = [
    (law(1.0, 0.6, 0.4), 0.73202144188549, 0.68095622771471),
    (law(2.0, 0.6, 0.4), 0.83414437470863, 0.53860653662405),
    (law(2.0, 0.5, 0.5), 0.82565886174634, 0.46308783649238),
    (law(1.0, 0.5, 0.5), 0.72153545723893, 0.59324475499131),
    (law(1.5, 0.8, -0.3), 0.987082735703, 0.77576353358281),
    (law(3.0, 0.9, 0.1), 0.89563583370348, 0.60466440873172),
];

#[test]
fn a_steady_loop_is_that_of_the_closed_form() {
    for (law, tip, heat) in LOOPS {
        let mut memory = BoucWen::at_rest();
        let mut found = 0.0;
        for _ in 0..80 {
            found = law.commit(&mut memory, 1.0, 0.0) + law.commit(&mut memory, -1.0, 0.0);
        }
        assert!((found / heat - 1.0).abs() < 1e-11, "{law:?}: {found}");
        let load = law.load(&memory, 1.0, 0.0);
        assert!((load / tip - 1.0).abs() < 1e-11, "{law:?}: {load}");
    }
}

#[test]
fn the_way_is_the_integral_of_the_equation() {
    let mut random = Random(47);
    for _ in 0..60 {
        let beta = 0.3 + random.unit();
        let law = law(
            1.0 + 3.0 * random.unit(),
            beta,
            beta * (1.9 * random.unit() - 0.9),
        );
        let mut memory = BoucWen::at_rest();
        let limit = (law.beta + law.gamma).powf(-1.0 / law.exponent);
        for r in way(&mut random, 12, 2.0) {
            let (from, place) = (memory[LOAD], memory[PLACE]);
            law.commit(&mut memory, r, 0.0);
            let (to, sign) = (memory[LOAD], (r - place).signum());
            if 1.0 - to.abs() / limit < 1e-6 {
                // too near the limit to be told from it
                continue;
            }
            // Δu = ∫ dz/(A − (β s sgn z + γ)|z|ⁿ)
            let rate = |z: f64| {
                let against = (z * sign).signum();
                1.0 - (law.beta * against + law.gamma) * z.abs().powf(law.exponent)
            };
            let crossing = if from * to < 0.0 { 0.0 } else { from };
            let length = integral(from, crossing, |z| 1.0 / rate(z))
                + integral(crossing, to, |z| 1.0 / rate(z));
            let error = (length - (r - place)).abs() / (r - place).abs();
            assert!(error < 1e-9, "{law:?} {from} {to}: {length} {}", r - place);
        }
    }
}

#[test]
fn a_way_in_parts_is_the_way_in_one() {
    for law in LOOPS.map(|(law, ..)| law) {
        let [mut whole, mut parts] = [BoucWen::at_rest(), BoucWen::at_rest()];
        let (mut from, mut heats) = (0.0, [0.0; 2]);
        for r in [0.5, -1.3, 0.2, 3.0, 2.9, -30.0, -29.5] {
            heats[0] += law.commit(&mut whole, r, 0.0);
            for part in 1..=100 {
                let at = from + (r - from) * f64::from(part) / 100.0;
                heats[1] += law.commit(&mut parts, at, 0.0);
            }
            from = r;
        }
        assert!((whole[LOAD] - parts[LOAD]).abs() < 1e-12, "{law:?}");
        assert!(
            (heats[0] / heats[1] - 1.0).abs() < 1e-12,
            "{law:?}: {heats:?}"
        );
    }
}

#[test]
fn energies_balance_and_changes_are_those_of_differences() {
    let mut random = Random(53);
    for _ in 0..30 {
        let beta = 0.3 + random.unit();
        let law = BoucWen {
            stiffness: 10.0_f64.powf(3.0 + 5.0 * random.unit()),
            slip_force: 10.0_f64.powf(4.0 * random.unit()),
            exponent: 1.0 + 3.0 * random.unit(),
            beta,
            gamma: beta * (1.9 * random.unit() - 0.9),
        };
        let way_of = way(&mut random, 15, 3.0 * law.slip_force / law.stiffness);
        assert_balance(&law, &way_of, 1.0);
        let law = BoucWen {
            stiffness: 1.0 + random.unit(),
            slip_force: 1.0 + random.unit(),
            exponent: 1.2 + 2.0 * random.unit(),
            beta,
            gamma: beta * (1.6 * random.unit() - 0.8),
        };
        let way_of = way(&mut random, 10, 2.0);
        assert_changes(&law, &way_of, 2.0, 1.0);
    }
}

#[test]
fn an_active_law_is_refused_with_its_bound() {
    let outside = law(1.5, 0.3, -0.5).outside().unwrap();
    assert_eq!(outside.parameter, 4);
    assert!(
        outside.expected.starts_with("-0.3 to 0.3, beta"),
        "{outside:?}"
    );
    for (law, parameter) in [
        (law(0.5, 0.6, 0.4), Some(2)),
        (law(1.0, 0.0, 0.0), Some(3)),
        (law(1.0, 0.5, 0.50001), Some(4)),
        (law(1.0, 0.5, -0.5), None),
        (law(1.0, 0.5, 0.5), None),
    ] {
        assert_eq!(law.outside().map(|outside| outside.parameter), parameter);
        assert!(law.load(&BoucWen::at_rest(), 0.3, 0.0).is_finite());
    }
}

#[test]
fn what_a_lower_preload_no_longer_holds_is_heat() {
    let mut random = Random(64);
    let mut released = 0.0;
    for _ in 0..30 {
        let beta = 0.2 + random.unit();
        let law = BoucWen {
            stiffness: 1e5,
            slip_force: 2.0,
            exponent: 1.0 + 3.0 * random.unit(),
            beta,
            gamma: beta * (1.9 * random.unit() - 0.9),
        };
        let way = way_over_preload(&mut random, 25, 1e-4);
        released += assert_balance_over_preload(&law, &way, 1.0);
    }
    assert!(released > 0.0);
}

#[test]
fn its_inner_state_follows_the_equation() {
    let mut random = Random(43);
    for (law, ..) in LOOPS {
        assert_inner(&law, &way(&mut random, 40, 2.0), 0.7);
    }
}
