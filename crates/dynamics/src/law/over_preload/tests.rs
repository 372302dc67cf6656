//! Reference values are SciPy's `PchipInterpolator` (1.17), and what the definitions ask for.

use super::*;
use crate::{
    law::{
        Dahl, Iwan, Jenkins, Law, Linear, LuGre, Polynomial, Valanis,
        trials::{assert_balance_between, way_over_preload},
    },
    random::Random,
};

type Matrix = [[f64; 2]; 2];

fn law(stiffness: Matrix, damping: Matrix, cubic: [f64; 2]) -> JointLaw<2> {
    Linear { stiffness, damping }.beside(cubic.map(Polynomial::cubic))
}

/// k3 of the first DOF.
fn cubic<const D: usize>(law: &JointLaw<D>) -> f64 {
    law.on[0].polynomial().springs[0]
}

/// One DOF, with the numbers of a table of four torques: K, C, k3.
fn four_torques(beyond: Beyond) -> JointOverPreload<1> {
    let table = [
        (2.0, 4.14e6, 0.34, 2.04e3),
        (4.0, 4.23e6, 0.38, 2.24e3),
        (6.0, 4.56e6, 0.54, 1.67e3),
        (8.0, 4.07e6, 0.69, 1.97e3),
    ]
    .map(|(preload, k, c, k3)| {
        let law = Linear {
            stiffness: [[k]],
            damping: [[c]],
        }
        .beside([k3].map(Polynomial::cubic));
        (preload, law)
    });
    JointOverPreload::new(&table, beyond).unwrap()
}

/// A table in which monotone slopes alone would make K indefinite: its direction turns, and at 3 it is singular.
fn turning() -> [(f64, JointLaw<2>); 4] {
    let c = [[8.0, -0.3], [-0.3, 0.06]];
    [
        (1.0, law([[1.0, 0.0], [0.0, 4.0]], c, [0.0, 5.0])),
        (2.0, law([[4.0, 3.9], [3.9, 4.0]], c, [-1.0, 6.0])),
        (3.0, law([[9.0, 6.0], [6.0, 4.0]], c, [-4.0, 9.0])),
        (6.0, law([[9.5, 6.1], [6.1, 7.0]], c, [-4.0, 8.0])),
    ]
}

#[test]
fn it_is_the_monotone_cubic_of_fritsch_and_butland() {
    let joint = four_torques(Beyond::Refused);
    let references = REFERENCES;
    for (preload, [k, c, k3], [dk, dc, dk3]) in references {
        let (law, slope) = (joint.law(preload), joint.slope(preload));
        for (found, expected) in [
            (law.linear.stiffness[0][0], k),
            (law.linear.damping[0][0], c),
            (cubic(&law), k3),
            (slope.linear.stiffness[0][0], dk),
            (slope.linear.damping[0][0], dc),
            (cubic(&slope), dk3),
        ] {
            let tolerance = 1e-13 * expected.abs().max(1e-3);
            assert!(
                (found - expected).abs() <= tolerance,
                "{preload}: {found} {expected}"
            );
        }
    }
}

#[test]
fn the_table_itself_is_met_to_the_last_bit() {
    let table = turning();
    let joint = JointOverPreload::new(&table, Beyond::Refused).unwrap();
    for (preload, law) in table {
        assert_eq!(joint.law(preload), law);
    }
    assert_eq!(joint.range_n_m(), [1.0, 6.0]);
    let samples: Vec<f64> = joint.samples_n_m(1).collect();
    assert_eq!(samples, [1.0, 1.5, 2.0, 2.5, 3.0, 4.5, 6.0]);
}

#[test]
fn two_preloads_give_a_straight_line() {
    let [(_, first), .., (_, last)] = turning();
    let joint = JointOverPreload::new(&[(10.0, first), (15.0, last)], Beyond::Refused).unwrap();
    let found = joint.law(12.0);
    let expected = JointLaw::each([&first, &last], |[a, b]| a + 0.4 * (b - a));
    let difference = JointLaw::each([&found, &expected], |[a, b]| (a - b).abs());
    assert!(
        difference
            .linear
            .stiffness
            .iter()
            .flatten()
            .all(|d| *d < 1e-14),
        "{difference:?}"
    );
    assert!((joint.slope(13.7).linear.stiffness[0][0] - 8.5 / 5.0).abs() < 1e-14);
}

#[test]
fn stiffness_and_damping_stay_positive_semidefinite_and_monotone() {
    let table = turning();
    // this table is one that needs care: monotone cubics of the entries alone leave the cone
    let unlimited = |p: f64| {
        let entry = |i: usize, j: usize| {
            let scalar = table.map(|(preload, law)| {
                let law = Linear {
                    stiffness: [[law.linear.stiffness[i][j] + 100.0]],
                    ..Linear::NONE
                };
                (preload, law.into())
            });
            let joint = JointOverPreload::new(&scalar, Beyond::Refused).unwrap();
            joint.law(p).linear.stiffness[0][0] - 100.0
        };
        [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
    };
    let joint = JointOverPreload::new(&table, Beyond::Refused).unwrap();
    let (mut left, mut before) = (0, joint.law(1.0));
    for step in 1..=5000 {
        let preload = 1.0 + 1e-3 * f64::from(step);
        let law = joint.law(preload);
        assert!(
            is_positive_semidefinite(&law.linear.stiffness),
            "{preload}: {law:?}"
        );
        assert!(is_positive_semidefinite(&law.linear.damping), "{preload}");
        let [[a, b], [_, d]] = unlimited(preload);
        left += u32::from(a * d - b * b < -1e-9);
        // each entry goes the way that the table goes there
        let gap = table
            .windows(2)
            .find(|pair| preload <= pair[1].0 + 1e-12)
            .unwrap();
        let way = JointLaw::each(
            [&gap[0].1, &gap[1].1, &before, &law],
            |[low, high, old, new]| (new - old) * (high - low).signum() + 1e-14 * (1.0 + new.abs()),
        );
        let entries = way
            .linear
            .stiffness
            .iter()
            .chain(&way.linear.damping)
            .flatten();
        assert!(
            entries
                .chain(way.on.iter().flat_map(|laws| laws.parameters()))
                .all(|way| *way >= 0.0),
            "{preload}: {way:?}"
        );
        before = law;
    }
    assert!(left > 0, "the table needs no care");
}

#[test]
fn slope_and_curvature_are_the_derivatives_and_the_slope_has_no_jump() {
    let joint = JointOverPreload::new(&turning(), Beyond::Refused).unwrap();
    let h = 1e-4;
    for step in 0..120 {
        let p = 1.013 + 0.041 * f64::from(step);
        if [2.0, 3.0]
            .iter()
            .any(|knot: &f64| (knot - p).abs() < 2.0 * h)
        {
            continue;
        }
        for (of, change) in [
            (joint.law(p + h), joint.slope(p)),
            (joint.slope(p + h), joint.curvature(p)),
        ]
        .iter()
        .zip([joint.law(p - h), joint.slope(p - h)])
        .map(|((above, change), below)| {
            (
                JointLaw::each([above, &below], |[a, b]| (a - b) / (2.0 * h)),
                *change,
            )
        }) {
            let error = JointLaw::each([&of, &change], |[a, b]| (a - b).abs());
            let entries = error
                .linear
                .stiffness
                .iter()
                .flatten()
                .chain(error.on.iter().flat_map(|laws| laws.parameters()));
            assert!(
                entries.copied().fold(0.0, f64::max) < 1e-6,
                "{p}: {error:?}"
            );
        }
    }
    for knot in [2.0, 3.0] {
        let [below, above] = [knot - 1e-9, knot + 1e-9].map(|p| joint.slope(p));
        let jump = JointLaw::each([&below, &above], |[a, b]| (a - b).abs());
        assert!(
            jump.linear
                .stiffness
                .iter()
                .flatten()
                .all(|jump| *jump < 1e-6),
            "{jump:?}"
        );
    }
}

#[test]
fn beyond_the_table_is_refused_or_held() {
    let refused = four_torques(Beyond::Refused);
    let held = four_torques(Beyond::Held);
    for outside in [1.999, 8.001, -1.0, 1e300] {
        assert!(!refused.covers(outside) && held.covers(outside));
        let end = if outside < 5.0 { 2.0 } else { 8.0 };
        assert_eq!(held.law(outside), held.law(end));
        assert_eq!(held.slope(outside), JointLaw::NONE);
        assert_eq!(held.curvature(outside), JointLaw::NONE);
    }
    for table in [&refused, &held] {
        assert!(table.covers(2.0) && table.covers(8.0) && table.covers(5.5));
        assert!(table.covers(2.0_f64.next_down()) && table.covers(8.0_f64.next_up()));
        assert!(!table.covers(f64::NAN) && !table.covers(f64::INFINITY));
    }
}

#[test]
fn what_is_no_table_is_refused() {
    let [first, second, ..] = turning();
    let of = |table: &[(f64, JointLaw<2>)]| JointOverPreload::new(table, Beyond::Refused);
    assert_eq!(of(&[first]), Err(TableDefect::TooFew { found: 1 }));
    assert_eq!(
        of(&[second, first]),
        Err(TableDefect::NotIncreasing { index: 1 })
    );
    assert_eq!(
        of(&[first, first]),
        Err(TableDefect::NotIncreasing { index: 1 })
    );
    assert_eq!(
        of(&[first, (f64::NAN, second.1)]),
        Err(TableDefect::NotFinite { index: 1 })
    );
    let infinite = law([[f64::INFINITY, 0.0], [0.0, 1.0]], [[0.0; 2]; 2], [0.0; 2]);
    assert_eq!(
        of(&[(0.0, infinite), second]),
        Err(TableDefect::NotFinite { index: 0 })
    );
}

/// Preload; K, C and k3; their derivatives.
const REFERENCES: [(f64, [f64; 3], [f64; 3]); 6] = [
    (2.0, [4140000.0, 0.34, 2040.0], [0.0, 0.0, 292.5]),
    (
        2.7,
        [4154096.25, 0.346174, 2182.8568750000004],
        [37912.50000000001, 0.016659999999999994, 126.99374999999996],
    ),
    (
        4.0,
        [4230000.0, 0.38, 2240.0],
        [70714.28571428571, 0.03199999999999999, 0.0],
    ),
    (
        4.9,
        [4389584.464285715, 0.43950683870967744, 1997.6074999999998],
        [231412.50000000006, 0.08999483870967748, -423.2250000000001],
    ),
    (
        6.3,
        [4547445.0, 0.5631200201612903, 1674.1681250000001],
        [-82799.99999999996, 0.07671229838709676, 29.30624999999998],
    ),
    (
        7.75,
        [4177187.5, 0.671794669858871, 1886.767578125],
        [-406875.0, 0.07314138104838702, 299.4140625],
    ),
];

/// Parameters at a low and at a high preload, at random about those of a law.
fn ends(random: &mut Random, middle: &[f64]) -> [Vec<f64>; 2] {
    let mut spread = || {
        let each = middle.iter();
        each.map(|own| own * (0.3 + 1.4 * random.unit())).collect()
    };
    [spread(), spread()]
}

/// Whatever motion and preload do, no heat is negative, and the energy of the springs is work, heat and what the preload does.
#[test]
fn energies_balance_where_springs_of_friction_follow_the_preload() {
    let mut random = Random(77);
    let mut released = [0.0; 4];
    for _ in 0..25 {
        let way = way_over_preload(&mut random, 25, 6e-3);
        let [low, high] = ends(&mut random, &[5.0, 1000.0, -0.4, 0.5]).map(|own| Iwan::new(&own));
        released[0] += assert_balance_between([&low, &high], &way, 1.0);
        let [low, high] = ends(&mut random, &[1000.0, 5.0]).map(|own| Dahl::new(&own));
        released[1] += assert_balance_between([&low, &high], &way, 1.0);
        let [low, high] =
            ends(&mut random, &[1500.0, 250.0, 5.0, 0.5]).map(|own| Valanis::new(&own));
        released[2] += assert_balance_between([&low, &high], &way, 1.0);
        let [low, high] = ends(&mut random, &[1000.0, 0.2, 1.0, 5.0, 9.0, 0.01]).map(|own| {
            let mut law = LuGre::new(&own);
            law.static_force = law.static_force.max(law.slip_force);
            law.damping += 8.0 * law.bristle_damping;
            law
        });
        // where its heat is more than rounding beside that of its damper
        let way = way_over_preload(&mut random, 25, 5e-2);
        released[3] += assert_balance_between([&low, &high], &way, 0.02);
    }
    assert!(released.iter().all(|&heat| heat > 1e-6), "{released:?}");
}

/// The range of LuGre's law is not convex: between two passive sets there may be an active one.
#[test]
fn a_law_that_leaves_its_range_between_two_preloads_is_found() {
    let low = LuGre {
        stiffness: 1e6,
        bristle_damping: 10.0,
        damping: 0.0,
        slip_force: 10.0,
        static_force: 10.0,
        stribeck_velocity: 1e-3,
    };
    let high = LuGre {
        bristle_damping: 0.0,
        static_force: 30.0,
        ..low
    };
    assert_eq!([low.outside(), high.outside()], [None, None]);
    let (share, outside) = low.outside_towards(&high).unwrap();
    // q = −10 (1 − t) · 20 t has its least value in the middle
    assert!((share - 0.5).abs() < 1e-12, "{share}");
    assert_eq!(outside.parameter, 2);
    let damped = LuGre {
        damping: 5.0,
        ..low
    };
    let other = LuGre {
        damping: 5.0,
        ..high
    };
    assert_eq!(damped.outside_towards(&other), None);
    assert!(DofLaws::from(low).outside_towards(&high.into()).is_some());
}

/// Between two preloads each parameter is linear, and its change is the difference over the gap.
#[test]
fn friction_follows_its_own_table() {
    let sliders = [(1e6, 20.0), (1.5e6, 30.0), (2.2e6, 50.0), (2.3e6, 45.0)];
    let entries = sliders.map(|(stiffness, slip_force)| {
        [DofLaws::from(Jenkins {
            stiffness,
            slip_force,
        })]
    });
    let table = || four_torques(Beyond::Held);
    let joint = table().with_friction_table(&entries).unwrap();
    let at = |preload| joint.law(preload).on[0].jenkins();
    assert_eq!(at(4.0).stiffness, 1.5e6);
    assert_eq!(
        at(5.0),
        Jenkins {
            stiffness: 1.85e6,
            slip_force: 40.0
        }
    );
    assert_eq!(at(9.0).slip_force, 45.0);
    let change = joint.spring_change(7.0).on[0].jenkins();
    assert_eq!(
        change,
        Jenkins {
            stiffness: 0.05e6,
            slip_force: -2.5
        }
    );
    assert_eq!(joint.change(9.0).on[0].jenkins().stiffness, 0.0);
    assert_eq!(joint.law(5.0).linear, table().law(5.0).linear);
    let found = table().with_friction_table(&entries[1..]);
    assert_eq!(found, Err(TableDefect::TooFew { found: 3 }));
}
