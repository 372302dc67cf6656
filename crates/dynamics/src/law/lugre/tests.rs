//! The LuGre law against steady sliding, its transient, and its energy.

use super::{
    super::trials::{
        Tried, assert_balance, assert_balance_over_preload, assert_changes, assert_inner, way,
        way_over_preload,
    },
    *,
};
use crate::{number::Dual, random::Random};

impl Tried for LuGre {
    type Changing = LuGre<Dual<1>>;
}

/// The set of the literature, with this damping beside the bristles.
const fn law(damping: f64) -> LuGre {
    LuGre {
        stiffness: 1e5,
        bristle_damping: 316.227_766_016_837_96,
        damping,
        slip_force: 1.0,
        static_force: 1.5,
        stribeck_velocity: 1e-3,
    }
}

/// Velocity, load of steady sliding, and deflection 3 ms after rest, with 14 digits from the closed forms.
#[rustfmt::skip]
const SLIDING: [(f64, f64, f64); 3] = [
    (1e-4, 1.4950649168746, 2.97010049456189e-7),
    (1e-3, 1.1843397205857, 2.65008182456761e-6),
    (1e-2, 1.004, 9.50212931632136e-6),
];

#[test]
fn sliding_and_its_transient_are_those_of_the_closed_forms() {
    let law = law(0.4);
    for (velocity, load, deflection) in SLIDING {
        let mut memory = LuGre::at_rest();
        // it moves at this velocity from the start
        law.commit(&mut memory, 0.0, velocity);
        let mut r = 0.0;
        for _ in 0..7 {
            r += velocity * 3e-3 / 7.0;
            law.commit(&mut memory, r, velocity);
        }
        let found = memory[DEFLECTION];
        assert!(
            (found / deflection - 1.0).abs() < 1e-12,
            "{velocity}: {found:e}"
        );
        law.commit(&mut memory, r + 1e-3, velocity);
        let found = law.load(&memory, r + 1e-3, velocity);
        assert!((found / load - 1.0).abs() < 1e-12, "{velocity}: {found}");
    }
}

#[test]
fn the_set_of_the_literature_gives_energy_and_is_refused_with_its_bound() {
    let outside = law(0.4).outside().unwrap();
    assert_eq!(outside.parameter, 2);
    assert!(
        outside.expected.starts_with("158.11388300841898 or more"),
        "{outside:?}"
    );
    assert_eq!(law(158.113_883_008_418_98).outside(), None);
    for (parameters, parameter) in [
        ([0.0, 0.0, 0.0, 1.0, 1.0, 1.0], Some(0)),
        ([1.0, -1.0, 0.0, 1.0, 1.0, 1.0], Some(1)),
        ([1.0, 0.0, -1.0, 1.0, 1.0, 1.0], Some(2)),
        ([1.0, 0.0, 0.0, 0.0, 1.0, 1.0], Some(3)),
        ([1.0, 0.0, 0.0, 1.0, 0.9, 1.0], Some(4)),
        ([1.0, 0.0, 0.0, 1.0, 1.0, 0.0], Some(5)),
        ([1.0, 1.0, 0.1, 1.0, 1.2, 1.0], Some(2)),
        ([1.0, 1.0, 0.2, 1.0, 1.2, 1.0], None),
    ] {
        let law = LuGre::<f64>::new(&parameters);
        assert_eq!(law.outside().map(|outside| outside.parameter), parameter);
        assert!(law.load(&LuGre::at_rest(), 0.3, 0.1).is_finite());
    }
}

fn random_law(random: &mut Random) -> LuGre {
    let slip_force = 1.0 + random.unit();
    let static_force = slip_force * (1.0 + random.unit());
    let bristle_damping = 0.5 * random.unit();
    LuGre {
        stiffness: 1.0 + random.unit(),
        bristle_damping,
        damping: bristle_damping * (static_force / slip_force - 1.0) + 0.3 * random.unit(),
        slip_force,
        static_force,
        stribeck_velocity: 0.3 + random.unit(),
    }
}

#[test]
fn energies_balance_and_changes_are_those_of_differences() {
    let mut random = Random(41);
    for _ in 0..40 {
        let law = random_law(&mut random);
        let way_of = way(&mut random, 15, 6.0);
        assert_balance(&law, &way_of, 0.1 + random.unit());
        let way_of = way(&mut random, 10, 2.0);
        assert_changes(&law, &way_of, 2.0, 0.1 + random.unit());
    }
}

/// However the velocity changes within its passive range, the load's work is never less than what is stored: by many
/// small steps of a motion of two tones.
#[test]
fn no_motion_takes_energy_out() {
    let mut random = Random(43);
    for _ in 0..20 {
        let law = random_law(&mut random);
        let mut memory = LuGre::at_rest();
        let (size, rate) = (0.2 + 3.0 * random.unit(), 0.2 + random.unit());
        let motion = |t: f64| {
            (
                size * ((rate * t).sin() + 0.4 * (3.7 * rate * t).sin()),
                size * rate * ((rate * t).cos() + 1.48 * (3.7 * rate * t).cos()),
            )
        };
        let (mut r, mut velocity) = motion(0.0);
        law.commit(&mut memory, r, velocity);
        let (mut work, mut heat) = (0.0, 0.0);
        for step in 1..=40_000 {
            let next = motion(1e-3 * f64::from(step));
            let before = law.load(&memory, r, velocity);
            let of_step = law.commit(&mut memory, next.0, next.1);
            assert!(of_step >= 0.0);
            heat += of_step;
            work += 0.5 * (before + law.load(&memory, next.0, next.1)) * (next.0 - r);
            (r, velocity) = next;
        }
        let stored = law.stored_energy(&memory, r);
        assert!(
            (work - heat - stored).abs() < 1e-5 * heat,
            "{work} {heat} {stored}"
        );
    }
}

#[test]
fn what_a_lower_preload_no_longer_holds_is_heat() {
    let mut random = Random(63);
    let mut released = 0.0;
    for _ in 0..30 {
        let law = random_law(&mut random);
        let way = way_over_preload(&mut random, 25, 6.0);
        released += assert_balance_over_preload(&law, &way, 1.0);
    }
    assert!(released > 0.0);
}

#[test]
fn its_inner_state_follows_the_equation() {
    let mut random = Random(41);
    assert_inner(&law(160.0), &way(&mut random, 60, 3e-5), 2e-3);
}
