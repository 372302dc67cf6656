//! The Iwan law against closed forms, against many sliders, and against itself turned and turned again.

use super::{
    super::trials::{
        Tried, assert_balance, assert_balance_over_preload, assert_changes, way, way_over_preload,
    },
    *,
};
use crate::{number::Dual, random::Random};

impl Tried for Iwan {
    type Changing = Iwan<Dual<1>>;
}

const fn law(slip_force: f64, stiffness: f64, exponent: f64, ratio: f64) -> Iwan {
    Iwan {
        slip_force,
        stiffness,
        exponent,
        ratio,
    }
}

/// What the parameters give: φ_max.
fn span(law: &Iwan) -> f64 {
    law.curve::<f64>(&[]).unwrap().span
}

/// By mpmath with 30 digits from Segalman's formulas: parameters, φ_max, amplitude/φ_max, load and stiffness at the
/// tip, heat of a cycle, energy stored at the tip.
#[rustfmt::skip]
const CLOSED_FORMS: [(Iwan, f64, f64, [f64; 4]); 9] = [
    (law(3.0, 2.0, -0.1, 0.1), 2.87614678899, 0.1, [0.54058003454, 1.7711044706, 0.012371156669, 0.076192981943]),
    (law(3.0, 2.0, -0.1, 0.1), 2.87614678899, 0.5, [2.1386879845, 1.0256604886, 1.316507445, 1.3732317142]),
    (law(3.0, 2.0, -0.1, 0.1), 2.87614678899, 1.0, [3.0, 0.0, 9.8267590386, 3.0858753037]),
    (law(3.0, 2.0, -0.1, 0.1), 2.87614678899, 1.5, [3.0, 0.0, 27.083639773, 3.0858753037]),
    (law(4000.0, 1.5e7, -0.3, 0.5), 4.38709677419e-4, 0.1, [606.57387574, 13_004_737.685, 0.0023426088243, 0.013012665365]),
    (law(4000.0, 1.5e7, -0.3, 0.5), 4.38709677419e-4, 0.5, [2496.0358624, 8_844_277.933_3, 0.18068362146, 0.25117331932]),
    (law(4000.0, 1.5e7, -0.3, 0.5), 4.38709677419e-4, 1.5, [4000.0, 0.0, 4.6837630555, 0.73065865033]),
    (law(1.0, 1.0, -0.5, 0.0), 3.0, 0.5, [0.79289321881, 0.29289321881, 0.84852813742, 0.48860389693]),
    (law(1.0, 1.0, 0.7, 2.0), 1.14084507042, 0.5, [0.54874745751, 0.89740463222, 0.02272294023, 0.15366859042]),
];

#[test]
fn tip_and_cycle_are_those_of_the_closed_forms() {
    for (law, expected_span, part, [load, stiffness, heat, stored]) in CLOSED_FORMS {
        assert!((span(&law) / expected_span - 1.0).abs() < 1e-11);
        let amplitude = part * span(&law);
        let mut memory = Iwan::at_rest();
        let near = |found: f64, expected: f64, what: &str| {
            let size = if expected == 0.0 {
                law.stiffness
            } else {
                expected
            };
            let error = ((found - expected) / size).abs();
            assert!(
                error < 1e-10,
                "{law:?} {part}: {what} {found:e} {expected:e}"
            );
        };
        let changing = Iwan::new(&law.parameters().map(Dual::<1>::from));
        let tip = changing.load(&memory, Dual::along(amplitude, 0), Dual::ZERO);
        near(tip.value, load, "load");
        // at φ_max itself the stiffness is that on its far side
        near(tip.change[0], stiffness, "stiffness");
        near(law.commit(&mut memory, amplitude, 0.0), heat / 4.0, "heat");
        near(law.stored_energy(&memory, amplitude), stored, "stored");
        near(law.load(&memory, amplitude, 0.0), load, "load");
        let there = law.commit(&mut memory, -amplitude, 0.0);
        near(there, heat / 2.0, "heat back");
        near(law.load(&memory, -amplitude, 0.0), -load, "load back");
        near(
            there + law.commit(&mut memory, amplitude, 0.0),
            heat,
            "heat of the cycle",
        );
        near(
            law.stored_energy(&memory, amplitude),
            stored,
            "stored again",
        );
    }
}

/// First and third Fourier coefficients at half of φ_max for u = U cos θ, by mpmath with 30 digits.
#[test]
fn a_steady_cycle_has_the_closed_form_s_coefficients() {
    let law = law(3.0, 2.0, -0.1, 0.1);
    let amplitude = 0.5 * span(&law);
    let mut memory = Iwan::at_rest();
    law.commit(&mut memory, amplitude, 0.0);
    let unloading = |turn: f64| law.load(&memory, amplitude * turn.cos(), 0.0);
    let coefficient = |wave: fn(f64) -> f64, n: f64| {
        let pi = std::f64::consts::PI;
        2.0 / pi * crate::law::trials::integral(0.0, pi, |turn| unloading(turn) * wave(n * turn))
    };
    for (found, expected) in [
        (coefficient(f64::cos, 1.0), 2.1349452966),
        (coefficient(f64::cos, 3.0), 0.0034907448622),
        (coefficient(f64::sin, 3.0), 0.057385794046),
        (coefficient(f64::cos, 5.0), 0.0001980746900457),
        (coefficient(f64::sin, 5.0), 0.008514970638568),
    ] {
        assert!((found - expected).abs() < 1e-10, "{found} {expected}");
    }
}

/// Sliders side by side, as the law is derived: in equal intervals of φ, each with the stiffness ∫ρ and the mean
/// ∫φρ/∫ρ.
struct Sliders {
    /// Stiffness, displacement at which it slips, and place of each.
    all: Vec<[f64; 3]>,
}

impl Sliders {
    fn of(law: &Iwan, count: usize) -> Self {
        let Iwan {
            slip_force,
            exponent,
            ratio,
            ..
        } = *law;
        let (top, p) = (span(law), exponent + 1.0);
        let g = ratio + p / (p + 1.0);
        // R and S of Segalman's eq. 25 and 26
        let density = slip_force * p / (top.powf(p + 1.0) * g);
        let rest = slip_force / top * ratio / g;
        let edge = |k: usize| top * k as f64 / count as f64;
        let mut all: Vec<[f64; 3]> = (0..count)
            .map(|k| {
                let between =
                    |power: f64| density * (edge(k + 1).powf(power) - edge(k).powf(power)) / power;
                [between(p), between(p + 1.0) / between(p), 0.0]
            })
            .collect();
        all.push([rest, top, 0.0]);
        Self { all }
    }

    /// Load at u, and heat of the way there.
    fn commit(&mut self, u: f64) -> [f64; 2] {
        let [mut load, mut heat] = [0.0; 2];
        for [stiffness, limit, place] in &mut self.all {
            let elastic = (u - *place).clamp(-*limit, *limit);
            heat += *stiffness * elastic.abs() * (u - elastic - *place).abs();
            *place = u - elastic;
            load += *stiffness * elastic;
        }
        [load, heat]
    }

    fn stored(&self, u: f64) -> f64 {
        let each = self.all.iter();
        each.map(|[k, _, place]| 0.5 * k * (u - place).powi(2))
            .sum()
    }
}

#[test]
fn a_random_walk_is_that_of_forty_thousand_sliders() {
    let law = law(4000.0, 1.5e7, -0.3, 0.5);
    let mut sliders = Sliders::of(&law, 40_000);
    let (mut memory, mut random) = (Iwan::at_rest(), Random(5));
    let (mut u, mut deepest): (f64, f64) = (0.0, 0.0);
    let (mut heat, mut expected_heat, mut reached) = (0.0, 0.0, 0.0_f64);
    let mut worst = [0.0_f64; 3];
    for _ in 0..400 {
        // twelve uniform numbers make nearly a normal one; drawn back so that loops lie in loops
        let step = (0..12).map(|_| random.unit()).sum::<f64>() - 6.0;
        u = 0.97 * u + 0.9e-4 * step;
        reached = reached.max(u.abs() / span(&law));
        let [load, of_step] = sliders.commit(u);
        expected_heat += of_step;
        worst[0] = worst[0].max((law.load(&memory, u, 0.0) - load).abs() / law.slip_force);
        heat += law.commit(&mut memory, u, 0.0);
        worst[0] = worst[0].max((law.load(&memory, u, 0.0) - load).abs() / law.slip_force);
        worst[1] = worst[1].max((heat - expected_heat).abs());
        let stored = sliders.stored(u);
        worst[2] = worst[2].max((law.stored_energy(&memory, u) - stored).abs());
        deepest = deepest.max(memory[2]);
    }
    assert!(deepest >= 6.0 && reached > 1.5, "{deepest} {reached}");
    assert!(worst[0] < 1e-9, "load {:e}", worst[0]);
    assert!(
        worst[1] < 1e-9 * expected_heat,
        "heat {:e}",
        worst[1] / expected_heat
    );
    assert!(worst[2] < 1e-8 * 0.73, "stored {:e}", worst[2]);
}

#[test]
fn a_loop_in_a_loop_closes_and_branches_are_twice_the_first_curve() {
    let mut random = Random(11);
    for law in CLOSED_FORMS.map(|(law, ..)| law) {
        let top = span(&law);
        for _ in 0..20 {
            let mut memory = Iwan::at_rest();
            let outer = top * (0.2 + 1.2 * random.unit());
            let (a, b) = (outer * (0.9 * random.unit() - 0.45), outer * 0.4);
            for u in [outer, -outer, a] {
                law.commit(&mut memory, u, 0.0);
            }
            let before = memory.clone();
            let at_a = law.load(&memory, a, 0.0);
            // down and up again, and smaller loops in that
            for u in [a - b, a - 0.1 * b, a - 0.9 * b, a - 0.2 * b, a - 0.7 * b, a] {
                law.commit(&mut memory, u, 0.0);
            }
            assert!((law.load(&memory, a, 0.0) - at_a).abs() < 1e-12 * law.slip_force);
            let points = |memory: &[f64]| (memory[0], memory[1], memory[2]);
            assert_eq!(points(&memory), points(&before));
            // f = f_r + 2 F((u − u_r)/2)
            let x = a + outer;
            let first = law.load(&Iwan::at_rest(), 0.5 * x, 0.0);
            let tip = law.load(&Iwan::at_rest(), outer, 0.0);
            assert!((at_a - (2.0 * first - tip)).abs() < 1e-12 * law.slip_force);
        }
    }
}

fn random_law(random: &mut Random) -> Iwan {
    law(
        10.0_f64.powf(4.0 * random.unit()),
        10.0_f64.powf(3.0 + 5.0 * random.unit()),
        -0.9 + 2.5 * random.unit(),
        if random.unit() < 0.2 {
            0.0
        } else {
            3.0 * random.unit()
        },
    )
}

#[test]
fn work_is_what_is_stored_and_the_heat() {
    let mut random = Random(3);
    for _ in 0..60 {
        let law = random_law(&mut random);
        let way = way(&mut random, 25, 1.8 * span(&law));
        assert_balance(&law, &way, 1.0);
    }
}

#[test]
fn small_motion_loses_no_digits() {
    // at 10⁻⁹ of φ_max the load is K_T u to eleven digits, and the heat of a cycle 4 R U^(χ+3)/((χ+2)(χ+3)) to as many
    let law = law(4000.0, 1.5e7, -0.3, 0.5);
    let amplitude = 1e-9 * span(&law);
    let mut memory = Iwan::at_rest();
    law.commit(&mut memory, amplitude, 0.0);
    let heat = law.commit(&mut memory, -amplitude, 0.0) + law.commit(&mut memory, amplitude, 0.0);
    let expected = 4.0 * 1.568_823_152_03e9 * amplitude.powf(2.7) / (1.7 * 2.7);
    assert!(
        (heat / expected - 1.0).abs() < 1e-11,
        "{heat:e} {expected:e}"
    );
    let softening = 1.0 - law.load(&memory, amplitude, 0.0) / (law.stiffness * amplitude);
    assert!(
        (softening / (1e-9_f64.powf(0.7) / 1.5 / 1.7) - 1.0).abs() < 1e-8,
        "{softening:e}"
    );
}

#[test]
fn loads_and_energies_change_as_their_differences() {
    let mut random = Random(17);
    for _ in 0..40 {
        let law = law(
            1.0 + random.unit(),
            1.0 + random.unit(),
            -0.5 + random.unit(),
            0.2 + random.unit(),
        );
        let amplitude = 0.9 * span(&law);
        let way = way(&mut random, 12, amplitude);
        assert_changes(&law, &way, amplitude, 1.0);
    }
}

/// A vibration that decays slowly turns more often than is remembered. What is forgotten changes the load by little,
/// and the energies still balance.
#[test]
fn a_slow_decay_forgets_what_matters_least() {
    let law = law(4000.0, 1.5e7, -0.3, 0.5);
    for (decay, start, most) in [(0.997, 0.8, 2e-3), (0.9, 0.8, 1e-4), (0.9999, 1.1, 2e-6)] {
        let (mut memory, mut sliders) = (Iwan::at_rest(), Sliders::of(&law, 4_000));
        let mut u = start * span(&law);
        let (mut heat, mut expected_heat, mut worst) = (0.0, 0.0, 0.0_f64);
        for _ in 0..600 {
            u *= -decay;
            let [load, of_step] = sliders.commit(u);
            expected_heat += of_step;
            let own = law.commit(&mut memory, u, 0.0);
            assert!(own >= 0.0);
            heat += own;
            worst = worst.max((law.load(&memory, u, 0.0) - load).abs() / law.slip_force);
        }
        assert!(memory[2] <= REVERSALS_MAX as f64);
        assert!(worst < most, "{decay}: {worst:e}");
        assert!(
            (heat / expected_heat - 1.0).abs() < 1e-4,
            "{decay}: {heat} {expected_heat}"
        );
        // back over all of it, and nothing is left but the first curve
        law.commit(&mut memory, 2.0 * span(&law), 0.0);
        let top = law.load(&memory, 2.0 * span(&law), 0.0);
        assert!((top / law.slip_force - 1.0).abs() < 1e-14 && memory[2] == 0.0);
    }
}

#[test]
fn energy_balances_also_where_points_are_forgotten() {
    let law = law(3.0, 2.0, -0.1, 0.1);
    let (mut u, mut way) = (0.9 * span(&law), Vec::new());
    for k in 0..150 {
        u *= -(0.97 + 0.02 * f64::from(k % 3));
        way.push(u);
    }
    assert_balance(&law, &way, 1.0);
}

#[test]
fn parameters_out_of_range_are_named() {
    for (law, parameter) in [
        (law(0.0, 1.0, 0.0, 0.0), Some(0)),
        (law(1.0, f64::NAN, 0.0, 0.0), Some(1)),
        (law(1.0, 1.0, -1.0, 0.0), Some(2)),
        (law(1.0, 1.0, 0.0, -0.1), Some(3)),
        (law(1.0, 1.0, -0.99, 0.0), None),
    ] {
        assert_eq!(law.outside().map(|outside| outside.parameter), parameter);
        if parameter.is_some() {
            assert!(law.load(&Iwan::at_rest(), 0.3, 0.0).is_finite());
        }
    }
}

#[test]
fn what_a_lower_preload_no_longer_holds_is_heat() {
    let mut random = Random(65);
    let mut released = 0.0;
    for _ in 0..30 {
        let law = random_law(&mut random);
        let way = way_over_preload(&mut random, 25, 2.0 * span(&law));
        released += assert_balance_over_preload(&law, &way, 1.0);
    }
    assert!(released > 0.0);
}

/// An assembly sums the same motion up from its coordinates: a hair less far than it was committed is no way back.
#[test]
fn rounding_of_the_motion_does_not_end_the_slip() {
    let law = law(4000.0, 1.5e7, -0.3, 0.5);
    let weaker = Iwan {
        slip_force: 3000.0,
        ..law
    };
    for own in [law, weaker] {
        let mut memory = Iwan::at_rest();
        law.commit(&mut memory, -2e-4, 0.0);
        own.commit(&mut memory, 1.3e-4, 0.0);
        let power = own.dissipated_power(&memory, 1.3e-4, 0.2);
        assert!(power > 10.0, "{power}");
        for r in [1.3e-4 * (1.0 - 1e-13), 1.3e-4 * (1.0 + 1e-13)] {
            let near = own.dissipated_power(&memory, r, 0.2);
            assert!((near / power - 1.0).abs() < 1e-9, "{near} {power}");
        }
        assert_eq!(own.dissipated_power(&memory, 1.3e-4, -0.2), 0.0);
    }
}
