//! Sliders whose strength changes, against as many that are followed one by one, and against points of reversal.

use super::super::{Iwan, Law, reversals::ELONGATED};
use super::*;
use crate::{number::Dual, random::Random};

const LAW: Iwan = Iwan {
    slip_force: 4000.0,
    stiffness: 1.5e7,
    exponent: -0.3,
    ratio: 0.5,
};

/// φ_max of [`LAW`], by mpmath.
const SPAN: f64 = 4.387_096_774_193_548e-4;

fn at(share: f64) -> Iwan {
    Iwan {
        slip_force: share * LAW.slip_force,
        ..LAW
    }
}

fn at_rest() -> Vec<f64> {
    vec![0.0; <Iwan as Law<f64>>::DECLARATION.memory_count()]
}

/// Sliders of [`LAW`] side by side, in equal intervals of strength, each with the stiffness and the mean strength of its
/// interval.
struct Sliders {
    /// Stiffness, displacement at which it slips at the full preload, elongation.
    all: Vec<[f64; 3]>,
    place: f64,
    share: f64,
}

impl Sliders {
    fn of(count: usize) -> Self {
        let Iwan {
            stiffness,
            exponent,
            ratio,
            ..
        } = LAW;
        let (p, whole) = (exponent + 1.0, stiffness / (1.0 + ratio));
        let edge = |k: usize| k as f64 / count as f64;
        let mut all: Vec<[f64; 3]> = (0..count)
            .map(|k| {
                let between = |power: f64| edge(k + 1).powf(power) - edge(k).powf(power);
                let mean = p / (p + 1.0) * between(p + 1.0) / between(p);
                [whole * between(p), SPAN * mean, 0.0]
            })
            .collect();
        all.push([whole * ratio, SPAN, 0.0]);
        Self {
            all,
            place: 0.0,
            share: 1.0,
        }
    }

    /// Load, stored energy, and heat of the way to r in which the preload goes to this share: in each of so many parts of it
    /// motion and preload move a little.
    fn move_on(&mut self, r: f64, share: f64, parts: u32) -> [f64; 3] {
        let [mut load, mut stored, mut heat] = [0.0; 3];
        for [stiffness, strength, elongation] in &mut self.all {
            for part in 1..=parts {
                let done = f64::from(part) / f64::from(parts);
                let share = self.share + done * (share - self.share);
                let trial = *elongation + (r - self.place) / f64::from(parts);
                let limit = share * *strength;
                let held = trial.clamp(-limit, limit);
                // in place it is what the spring gives up, on the way the limit times what slips
                let mean = match r == self.place {
                    true => 0.5 * (trial + held).abs(),
                    false => limit,
                };
                heat += *stiffness * mean * (trial - held).abs();
                *elongation = held;
            }
            load += *stiffness * *elongation;
            stored += 0.5 * *stiffness * *elongation * *elongation;
        }
        (self.place, self.share) = (r, share);
        [load, stored, heat]
    }
}

/// Motion and preload by turns, and together: load, stored energy and heat are those of 40,000 sliders.
#[test]
fn they_are_those_of_many_sliders() {
    let mut random = Random(5);
    let (mut sliders, mut memory) = (Sliders::of(40_000), at_rest());
    let (mut r, mut share, mut total, mut expected_total) = (0.0, 1.0, 0.0, 0.0);
    let mut most = 0.0_f64;
    LAW.commit(&mut memory, 0.0, 0.0);
    for step in 0..300 {
        match step % 3 {
            0 => share = 0.1 + 1.4 * random.unit(),
            1 => r = 1.5 * SPAN * (2.0 * random.unit() - 1.0),
            // small ways inside of larger ones
            _ => r += 0.2 * SPAN * (2.0 * random.unit() - 1.0),
        }
        let law = at(share);
        let trial = law.load(&memory, r, 0.0);
        let heat = law.commit(&mut memory, r, 0.0);
        let [load, stored, expected] = sliders.move_on(r, share, 1);
        let energy = LAW.slip_force * SPAN;
        total += heat;
        expected_total += expected;
        for (found, expected, scale) in [
            (trial, load, LAW.slip_force),
            (law.load(&memory, r, 0.0), load, LAW.slip_force),
            (law.stored_energy(&memory, r), stored, energy),
            (heat, expected, energy),
            (total, expected_total, expected_total.max(1e-9)),
        ] {
            let error = (found - expected).abs() / scale.max(energy * 1e-9);
            most = most.max(error);
            assert!(
                error < 1e-8,
                "step {step}: {found:e} {expected:e}, {error:e}"
            );
        }
    }
    println!("largest difference {most:e}");
}

/// Where both change on one way, the state is that of the same pace to the last digits, and the heat is that of the preload
/// before or after the motion, which comes to it as the step does.
#[test]
fn motion_and_preload_at_the_same_pace() {
    let ways = |count: usize| {
        (1..=count).map(move |index| {
            let t = 7.0 * index as f64 / count as f64;
            (0.8 * SPAN * (2.1 * t).sin(), 0.8 + 0.6 * (1.3 * t).cos())
        })
    };
    let mut errors = Vec::new();
    for count in [70, 140, 280] {
        let (mut sliders, mut memory) = (Sliders::of(300), at_rest());
        let mut fine = Sliders::of(300);
        let (mut coarse_heat, mut fine_heat, mut heat) = (0.0, 0.0, 0.0);
        for (r, share) in ways(count) {
            heat += at(share).commit(&mut memory, r, 0.0);
            let [one, _, of_one] = sliders.move_on(r, share, 1);
            let [many, _, of_many] = fine.move_on(r, share, 200);
            assert!((one - many).abs() < 1e-9 * LAW.slip_force, "{one} {many}");
            let load = at(share).load(&memory, r, 0.0);
            assert!((load - one).abs() < 2e-4 * LAW.slip_force, "{load} {one}");
            coarse_heat += of_one;
            fine_heat += of_many;
        }
        assert!(coarse_heat > 0.0);
        errors.push((heat / fine_heat - 1.0).abs());
    }
    println!("heat off by {errors:?}");
    let [coarse, middle, fine] = errors[..] else {
        unreachable!()
    };
    assert!(
        middle < 0.6 * coarse && fine < 0.6 * middle && fine < 0.012,
        "{errors:?}"
    );
}

/// A change of strength that is none leaves the line of the same joint: it goes on as the points of reversal do.
#[test]
fn at_one_strength_they_go_on_as_reversals_do() {
    let mut random = Random(8);
    let (mut by_points, mut by_line) = (at_rest(), at_rest());
    let mut r = 0.0;
    for step in 0..400 {
        r = if step % 40 == 0 {
            1.3 * SPAN * (2.0 * random.unit() - 1.0)
        } else {
            r + 0.4 * SPAN * (2.0 * random.unit() - 1.0)
        };
        let law = at(1.0);
        if step == 20 {
            // as little as a number can change
            at(1.0 - 1e-15).commit(&mut by_line, r, 0.0);
        }
        let [one, other] = [&mut by_points, &mut by_line].map(|memory| {
            let heat = law.commit(memory, r, 0.0);
            let changing = Iwan::new(&[4000.0, 1.5e7, -0.3, 0.5].map(Dual::<1>::from));
            let on = r + 1e-3 * SPAN;
            let tangent = changing.load(&memory[..], Dual::along(on, 0), Dual::ZERO);
            [
                law.load(memory, r, 0.0) / LAW.slip_force,
                law.stored_energy(memory, r) / (LAW.slip_force * SPAN),
                heat / (LAW.slip_force * SPAN),
                tangent.change[0] / LAW.stiffness,
                law.dissipated_power(memory, on, 1.0) / LAW.slip_force,
            ]
        });
        if step == 20 {
            continue;
        }
        for (one, other) in one.into_iter().zip(other) {
            assert!((one - other).abs() < 1e-12, "step {step}: {one} {other}");
        }
    }
    assert!(by_line[ELONGATED] != 0.0 && by_points[ELONGATED] == 0.0);
}

/// A vibration that decays while the preload wavers has more corners than are kept.
#[test]
fn corners_that_are_left_out_shift_the_load_little() {
    let (mut sliders, mut memory) = (Sliders::of(4000), at_rest());
    let (mut r, mut total) = (1.2 * SPAN, 0.0);
    let mut off = 0.0_f64;
    let mut fullest = 0.0_f64;
    for step in 0..400 {
        r *= -0.99;
        let share = 1.0 + 0.05 * f64::from(step % 5);
        let law = at(share);
        let heat = law.commit(&mut memory, r, 0.0);
        assert!(heat >= 0.0);
        let [load, ..] = sliders.move_on(r, share, 1);
        off = off.max((law.load(&memory, r, 0.0) - load).abs() / LAW.slip_force);
        fullest = fullest.max(memory[COUNT]);
        total += heat;
    }
    assert!(total > 0.0);
    assert_eq!(fullest, KNOTS_MAX as f64);
    println!("load off by {off:e}");
    assert!(off < 1e-3, "{off:e}");
}
