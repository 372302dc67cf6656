//! Trials that every law with memory stands: its energy along ways that only look random, and its changes against
//! differences.

use std::f64::consts::FRAC_PI_2;

use super::Law;
use crate::{
    number::{Dual, Number},
    random::Random,
};

/// A law by its numbers, as real ones and with their changes.
pub(super) trait Tried: Law<f64> {
    /// The same with changes.
    type Changing: Law<Dual<1>>;

    /// Its parameters.
    fn parameters(&self) -> Vec<f64> {
        let mut parameters = vec![0.0; Self::DECLARATION.parameters.len()];
        self.write(&mut parameters);
        parameters
    }

    /// Nothing has moved yet.
    fn at_rest() -> Vec<f64> {
        vec![0.0; Self::DECLARATION.memory_count()]
    }
}

/// ∫ f over an interval by the double exponential rule, which bears singular ends.
pub(super) fn integral(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (half, middle) = (0.5 * (to - from), 0.5 * (to + from));
    let h = 1.0 / 24.0;
    (-88..=88)
        .map(|k| {
            let t = h * f64::from(k);
            let (inner, slope) = (FRAC_PI_2 * t.sinh(), FRAC_PI_2 * t.cosh());
            let weight = slope / inner.cosh().powi(2);
            // from the nearer end, so that a point close to it is told from it
            let from_end = half * (-inner.abs()).exp() / inner.cosh();
            let x = if t < 0.0 {
                from + from_end
            } else {
                to - from_end
            };
            let x = if t == 0.0 { middle } else { x };
            half * h * weight * f(x)
        })
        .sum()
}

/// A way of so many points, each within `amplitude` of zero.
pub(super) fn way(random: &mut Random, count: usize, amplitude: f64) -> Vec<f64> {
    let size = |random: &mut Random| amplitude * random.unit().powi(2);
    (0..count)
        .map(|_| {
            let sign = if random.unit() < 0.5 { -1.0 } else { 1.0 };
            sign * size(random)
        })
        .collect()
}

/// Work along the way is what is stored and the heat, and no part of the way gives heat back. On a way the velocity is
/// `speed` towards its end.
pub(super) fn assert_balance<L: Tried + std::fmt::Debug>(law: &L, way: &[f64], speed: f64) {
    let mut memory = L::at_rest();
    let (mut work, mut heat, mut turned) = (0.0, 0.0, 0.0);
    let mut r = 0.0;
    for &target in way {
        if target == r {
            continue;
        }
        let velocity = speed * (target - r).signum();
        // the way begins at this velocity
        turned += law.commit(&mut memory, r, velocity).abs();
        let mut stops = Vec::new();
        law.corners(&memory, target, &mut |corner| stops.push(corner.place()));
        stops.retain(|stop| (stop - r) * (target - stop) > 0.0);
        stops.extend([r, target]);
        stops.sort_by(f64::total_cmp);
        let of_way: f64 = stops
            .windows(2)
            .map(|ends| integral(ends[0], ends[1], |at| law.load(&memory, at, velocity)))
            .sum();
        work += of_way * (target - r).signum();
        let of_step = law.commit(&mut memory, target, velocity);
        assert!(of_step >= 0.0, "{law:?}: heat {of_step:e}");
        heat += of_step;
        r = target;
        let stored = law.stored_energy(&memory, r);
        let missing = work - heat - stored;
        assert!(
            missing.abs() <= 1e-12 * (heat + stored.abs()),
            "{law:?}: {missing:e} of heat {heat:e} and {stored:e} at {r:e}"
        );
        assert!(stored >= 0.0);
    }
    assert_eq!(turned, 0.0);
}

/// Along a way its inner state changes as its rate says, and where somebody else integrates that, the load is that of the state
/// wherever the joint is.
pub(super) fn assert_inner<L: Tried + std::fmt::Debug>(law: &L, way: &[f64], speed: f64) {
    let mut memory = L::at_rest();
    for (index, &r) in way.iter().enumerate() {
        let velocity = if index % 3 == 0 { -speed } else { speed };
        law.commit(&mut memory, r, velocity);
        law.settle(&mut memory, r, velocity);
        let rate = law.inner_rate(&memory, velocity);
        let small_s = 1e-7 * way[0].abs() / speed;
        let state_after = |time_s: f64| {
            let mut memory = memory.clone();
            law.commit(&mut memory, r + velocity * time_s, velocity);
            memory[0]
        };
        let found = (state_after(small_s) - memory[0]) / small_s;
        let scale = rate.abs() + memory[0].abs() / small_s * 1e-8;
        assert!(
            (found - rate).abs() < 1e-5 * scale,
            "{law:?}: {found:e} {rate:e}"
        );
        let load = law.load(&memory, r, velocity);
        let elsewhere = r + 0.3 * way[0];
        let mut moved = memory.clone();
        law.settle(&mut moved, elsewhere, velocity);
        assert_eq!(law.load(&moved, elsewhere, velocity), load);
        assert_eq!(moved[0], memory[0]);
    }
}

/// In every state the power of the load is what is stored and the heat per second, and loads and energies change as
/// their differences, with the motion, with each point that it passed before and with every parameter.
pub(super) fn assert_changes<L: Tried + std::fmt::Debug>(
    law: &L,
    way: &[f64],
    amplitude: f64,
    speed: f64,
) {
    let mut memory = L::at_rest();
    let parameters = law.parameters();
    let towards = |index: usize| {
        if index.is_multiple_of(2) {
            speed
        } else {
            -speed
        }
    };
    for (index, &r) in way.iter().enumerate() {
        let trial = r + 0.1 * amplitude * if index % 2 == 0 { 1.0 } else { -0.3 };
        let velocity = towards(index);
        law.commit(&mut memory, r, velocity);
        let plain = |numbers: &[f64], at: f64, rate: f64| {
            let law = L::new(numbers);
            [law.load(&memory, at, rate), law.stored_energy(&memory, at)]
        };
        let changed = |numbers: &[Dual<1>], at: Dual<1>, rate: Dual<1>| {
            let law = L::Changing::new(numbers);
            [
                law.load(&memory, at, rate).change[0],
                law.stored_energy(&memory, at).change[0],
            ]
        };
        let constant: Vec<Dual<1>> = parameters.iter().map(|&p| Dual::from(p)).collect();
        let (at, rate) = (Dual::from(trial), Dual::from(velocity));
        let sizes = {
            let [load, stored] = plain(&parameters, trial, velocity);
            [load.abs(), stored.abs()]
        };
        let check = |found: [f64; 2], above: [f64; 2], below: [f64; 2], step: f64, size: f64| {
            for k in 0..2 {
                let expected = (above[k] - below[k]) / (2.0 * step);
                let scale = expected.abs() + sizes[k] / size;
                let error = (found[k] - expected).abs();
                assert!(
                    error <= 2e-5 * scale,
                    "{law:?} at {trial:e}: {found:?} {above:?} {below:?} by {step:e}"
                );
            }
        };
        // with the displacement
        let step = 1e-6 * amplitude;
        let [above, below] = [step, -step].map(|step| plain(&parameters, trial + step, velocity));
        let found = changed(&constant, Dual::along(trial, 0), rate);
        check(found, above, below, step, amplitude);
        // P = f ṙ = dE/dt + heat, in the direction in which it moved, at constant velocity
        let load = law.load(&memory, trial, velocity);
        let power = law.dissipated_power(&memory, trial, velocity);
        assert!(power >= 0.0, "{law:?}: power {power:e}");
        let left = load * velocity - found[1] * velocity - power;
        assert!(
            left.abs() <= 1e-10 * (load * velocity).abs() + 1e-12 * power,
            "{law:?}: {left:e} of {:e}",
            load * velocity
        );
        // with each earlier point of the way
        for past in 0..=index {
            let step = 1e-6 * amplitude;
            let with = |step: f64| {
                let mut memory = L::at_rest();
                for (k, &point) in way[..=index].iter().enumerate() {
                    let at = if k == past { point + step } else { point };
                    law.commit(&mut memory, at, towards(k));
                }
                [
                    law.load(&memory, trial, velocity),
                    law.stored_energy(&memory, trial),
                ]
            };
            let mut changing = vec![Dual::ZERO; memory.len()];
            let own = L::Changing::new(&constant);
            for (k, &point) in way[..=index].iter().enumerate() {
                let at = if k == past {
                    Dual::along(point, 0)
                } else {
                    Dual::from(point)
                };
                own.commit(&mut changing, at, towards(k).into());
            }
            let found = [
                own.load(&changing, at, rate).change[0],
                own.stored_energy(&changing, at).change[0],
            ];
            check(found, with(step), with(-step), step, amplitude);
        }
        // with the velocity
        let step = 1e-6 * speed;
        let [above, below] = [step, -step].map(|step| plain(&parameters, trial, velocity + step));
        let found = changed(&constant, at, Dual::along(velocity, 0));
        check(found, above, below, step, speed);
        // with each parameter
        for k in 0..parameters.len() {
            let size = parameters[k].abs() + 0.1;
            let step = 1e-6 * parameters[k].abs().max(1e-3);
            let with = |step: f64| {
                let mut numbers = parameters.clone();
                numbers[k] += step;
                plain(&numbers, trial, velocity)
            };
            let mut numbers = constant.clone();
            numbers[k] = Dual::along(parameters[k], 0);
            let found = changed(&numbers, at, rate);
            check(
                found,
                with(step),
                with(-step),
                step,
                size.min(parameters[k].abs().max(1e-3)),
            );
        }
    }
}

/// A way on which the strength changes as well: of each point, the share of the preload and the place.
pub(super) fn way_over_preload(
    random: &mut Random,
    count: usize,
    amplitude: f64,
) -> Vec<(f64, f64)> {
    let mut share = 1.0;
    way(random, count, amplitude)
        .into_iter()
        .enumerate()
        .map(|(index, r)| {
            // now and then it holds, and now and then nothing presses
            share = match random.unit() {
                draw if draw < 0.3 => share,
                draw if draw > 0.97 => 0.0,
                draw => 2.0 * draw,
            };
            (share, if index % 7 == 3 { 0.0 } else { r })
        })
        .collect()
}

/// With the preload going up and down at random, in place and on the way, nothing gives heat back; where it changes in
/// place, what the springs give up is the heat; and on a way at one preload the work is what is stored and the heat. Returns
/// the heat of the changes in place.
pub(super) fn assert_balance_over_preload<L: Tried + std::fmt::Debug>(
    law: &L,
    way: &[(f64, f64)],
    speed: f64,
) -> f64 {
    let at = |share: f64| {
        let mut parameters = law.parameters();
        for (own, declared) in parameters.iter_mut().zip(L::DECLARATION.parameters) {
            if declared.grows_with_preload {
                *own *= share;
            }
        }
        L::new(&parameters)
    };
    assert_balance_along(at, way, speed, true)
}

/// The same where parameters are linear between those of two laws: in place the springs give up what the heat is and what the
/// preload takes, or takes off them.
pub(super) fn assert_balance_between<L: Tried + std::fmt::Debug>(
    [low, high]: [&L; 2],
    way: &[(f64, f64)],
    speed: f64,
) -> f64 {
    let at = |share: f64| {
        let ends = low.parameters().into_iter().zip(high.parameters());
        // shares go up to 2
        let own: Vec<f64> = ends
            .map(|(low, high)| low + 0.5 * share * (high - low))
            .collect();
        let law = L::new(&own);
        assert_eq!(law.outside(), None, "{law:?}");
        law
    };
    assert_balance_along(at, way, speed, false)
}

fn assert_balance_along<L: Tried + std::fmt::Debug>(
    at: impl Fn(f64) -> L,
    way: &[(f64, f64)],
    speed: f64,
    springs_stay: bool,
) -> f64 {
    let mut memory = L::at_rest();
    let (mut r, mut share, mut heat, mut released) = (0.0, 1.0, 0.0, 0.0);
    let mut most = 0.0_f64;
    at(share).commit(&mut memory, r, 0.0);
    for &(next, target) in way {
        // the preload in place
        let (law, springs) = (at(share), at(next));
        let of_preload = law.energy_in(&springs, &memory, r) - law.energy_in(&law, &memory, r);
        assert!(!springs_stay || of_preload == 0.0, "{of_preload:e}");
        let before = at(share).stored_energy(&memory, r) + of_preload;
        let of_change = at(next).commit(&mut memory, r, 0.0);
        let after = at(next).stored_energy(&memory, r);
        assert!(of_change >= 0.0, "{springs:?}: heat {of_change:e}");
        most = most.max(before.abs());
        let scale = most + heat;
        let missing = before - after - of_change;
        assert!(
            missing.abs() <= 1e-12 * scale,
            "{springs:?} from {share} to {next} at {r:e}: {missing:e} of {scale:e}"
        );
        let may_slip = next < share || !springs_stay;
        assert!(may_slip || of_change <= 1e-14 * scale, "{of_change:e}");
        (share, heat, released) = (next, heat + of_change, released + of_change);
        // then the way
        if target == r {
            continue;
        }
        let own = at(share);
        let velocity = speed * (target - r).signum();
        heat += own.commit(&mut memory, r, velocity);
        let mut stops = Vec::new();
        own.corners(&memory, target, &mut |corner| stops.push(corner.place()));
        stops.retain(|stop| (stop - r) * (target - stop) > 0.0);
        stops.extend([r, target]);
        stops.sort_by(f64::total_cmp);
        let of_way: f64 = stops
            .windows(2)
            .map(|ends| integral(ends[0], ends[1], |at| own.load(&memory, at, velocity)))
            .sum();
        let before = own.stored_energy(&memory, r);
        let of_step = own.commit(&mut memory, target, velocity);
        assert!(of_step >= 0.0, "{own:?}: heat {of_step:e}");
        r = target;
        heat += of_step;
        let missing =
            of_way * velocity.signum() - of_step - (own.stored_energy(&memory, r) - before);
        assert!(
            missing.abs() <= 1e-12 * (heat + most + of_way.abs()),
            "{own:?}: {missing:e} of heat {heat:e} and {most:e} at {r:e}"
        );
    }
    released
}
