//! The Jenkins element: a spring and a slider in series, which sticks until the spring bears the slip force (Tol 2.2).

use super::{
    Corner, Law,
    declaration::{Declaration, Parameter, Remembered, RememberedAs},
    slider_parameters::{SLIP_FORCE, STIFFNESS},
};
use crate::number::Number;

/// Part of the slip force that rounding may leave between it and the load of a slider that has just slipped.
const ROUNDING: f64 = 1e-9;

/// A spring and a slider in series on one relative DOF.
///
/// Its load depends on where it slipped, and a closed loop leaves heat:
///
/// ```
/// use bolted_joint_dynamics::law::{Jenkins, Law};
///
/// let element = Jenkins { stiffness: 1e6, slip_force: 100.0 };
/// let mut slider = [0.0];
/// let mut heat = element.commit(&mut slider, 3e-4, 0.0);
/// assert!((element.load(&slider, 3e-4, 0.0) - 100.0).abs() < 1e-9);
/// heat += element.commit(&mut slider, -3e-4, 0.0) + element.commit(&mut slider, 3e-4, 0.0);
/// // h(X − h/k) on the first way, twice that on each from end to end: h = 100 N, X = 0.3 mm, h/k = 0.1 mm
/// assert!((heat - 5.0 * 100.0 * 2e-4).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jenkins<N = f64> {
    /// k: N/m, N·m/rad.
    pub stiffness: N,
    /// h: N, N·m.
    pub slip_force: N,
}

/// How the element bears a trial motion.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Bearing<N> {
    /// The slider stays, and the spring is elongated so far (m, rad).
    Sticks(N),
    /// It slips towards a larger or a smaller displacement, 1 or −1.
    Slips(f64),
}

impl<N: Number> Jenkins<N> {
    /// Return mapping from the slider's committed place x to the displacement r.
    fn bearing<M: Number + Into<N>>(&self, memory: &[M], r: N) -> Bearing<N> {
        // e* = r − x; it sticks if |k e*| ≤ h. A spring that can bear nothing, h = 0, never does; without a spring nothing slips.
        let elongation = r - slider(memory);
        let (stiffness, slip_force) = (self.stiffness.value(), self.slip_force.value());
        let holds = slip_force > 0.0 || stiffness <= 0.0;
        if holds && (stiffness * elongation.value()).abs() <= slip_force {
            Bearing::Sticks(elongation)
        } else {
            Bearing::Slips(elongation.value().signum())
        }
    }
}

impl<N: Number> Jenkins<N> {
    /// Heat (J) of the way to r, on which it slips so far and slip force and motion change at the same pace. Known are the
    /// slider's place before, the slip force then and where the joint was.
    fn heat(&self, known: Option<[f64; 3]>, r: f64, sign: f64, slipped: f64) -> f64 {
        let (stiffness, now) = (self.stiffness.value(), self.slip_force.value());
        let has_moved = |known: &[f64; 3]| known.iter().any(|&number| number != 0.0);
        let Some([slider, before, place]) = known.filter(has_moved) else {
            return now * slipped;
        };
        if before == now {
            return now * slipped;
        }
        // e₀ + t Δr = h/k with h = h₀ + t Δh
        let load = |at: f64| sign * stiffness * (at - slider);
        let (short, beyond) = (before - load(place), load(r) - now);
        if short < 0.0 {
            // a stiffness that has grown first takes the load of what was held beyond the slip force: ½ (k e₀ + h₀)(e₀ − h₀/k)
            let at_once = (-short / stiffness).min(slipped);
            return 0.5 * (load(place) + before) * at_once
                + 0.5 * (before + now) * (slipped - at_once);
        }
        let begins = (short / (short + beyond)).clamp(0.0, 1.0);
        (now - 0.5 * (1.0 - begins) * (now - before)) * slipped
    }
}

impl<N: Number> Law<N> for Jenkins<N> {
    const DECLARATION: Declaration = Declaration {
        name: "jenkins",
        summary: "A spring and a slider in series, which slips at its slip force",
        parameters: &[
            Parameter {
                symbol: "jenkins_k",
                description: "Stiffness of the joint's elastic slider in {motion}",
                ..STIFFNESS
            },
            Parameter {
                symbol: "jenkins_h",
                description: "Load at which the joint's elastic slider slips in {motion}",
                ..SLIP_FORCE
            },
        ],
        memory: &[Remembered {
            symbol: "jenkins_slider",
            quantity: RememberedAs::Displacement,
            description: "Relative {motion} at which the joint's elastic slider is without load, as of the last step",
            rate: None,
        }],
        // its slip force there, and where the joint was
        hidden_memory: 2,
        at_most: 4,
        number: 1,
    };

    by_numbers!(stiffness, slip_force);

    fn load<M: Number + Into<N>>(&self, memory: &[M], r: N, _: N) -> N {
        match self.bearing(memory, r) {
            // f = k e*
            Bearing::Sticks(elongation) => self.stiffness * elongation,
            // f = h sgn e*
            Bearing::Slips(sign) => self.slip_force * N::from(sign),
        }
    }

    fn stored_energy<M: Number + Into<N>>(&self, memory: &[M], r: N) -> N {
        let half = N::from(0.5);
        match self.bearing(memory, r) {
            // ½ k e²
            Bearing::Sticks(elongation) => half * self.stiffness * elongation * elongation,
            // ½ h²/k, as e = h/k
            Bearing::Slips(_) => half * self.slip_force * self.slip_force / self.stiffness,
        }
    }

    fn energy_in<M: Number + Into<N>>(&self, springs: &Self, memory: &[M], r: N) -> N {
        let elongation = match self.bearing(memory, r) {
            Bearing::Sticks(elongation) => elongation,
            Bearing::Slips(sign) => N::from(sign) * self.slip_force / self.stiffness,
        };
        N::from(0.5) * springs.stiffness * elongation * elongation
    }

    fn dissipated_power<M: Number + Into<N>>(&self, memory: &[M], r: N, velocity: N) -> N {
        // h |ṙ| while it moves on at the slip force, where a commit has left it, or beyond
        let elongation = r.value() - slider::<N, M>(memory).value();
        let (force, rate) = (self.stiffness.value() * elongation, velocity.value());
        let is_at_slip = force.abs() >= (1.0 - ROUNDING) * self.slip_force.value();
        if is_at_slip && force * rate > 0.0 {
            self.slip_force * N::from(rate.signum()) * velocity
        } else {
            N::ZERO
        }
    }

    fn commit(&self, memory: &mut [N], r: N, _: N) -> f64 {
        let bearing = self.bearing(memory, r);
        let known = memory.first_chunk().map(|known| known.map(Number::value));
        if let Some([_, slip_force, place]) = memory.first_chunk_mut() {
            (*slip_force, *place) = (self.slip_force, r);
        }
        if self.stiffness.value() <= 0.0 {
            // nothing bears, so that nothing is elongated when something does again
            memory.iter_mut().take(1).for_each(|slider| *slider = r);
            return 0.0;
        }
        let (Bearing::Slips(sign), Some(slider)) = (bearing, memory.first_mut()) else {
            return 0.0;
        };
        // x = r − h/k sgn e*
        let place = r - N::from(sign) * self.slip_force / self.stiffness;
        let slipped = (place - *slider).value().abs();
        *slider = place;
        self.heat(known, r.value(), sign, slipped)
    }

    fn corners(&self, memory: &[f64], _: f64, tell: &mut dyn FnMut(Corner)) {
        // x ± h/k
        let span = self.slip_force.value() / self.stiffness.value();
        let slider = slider::<f64, f64>(memory);
        tell(Corner::Sharp(slider - span));
        tell(Corner::Sharp(slider + span));
    }

    fn nonlinear_amplitude(&self, _: f64, _: f64) -> f64 {
        // it slips from h/k on
        self.slip_force.value() / self.stiffness.value()
    }
}

/// The slider's committed place.
#[inline]
fn slider<N: Number, M: Number + Into<N>>(memory: &[M]) -> N {
    memory.first().map_or(N::ZERO, |&place| place.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Dual;
    use crate::random::Random;
    use std::f64::consts::{PI, TAU};

    /// Loads of a steady cycle u = U cos θ, by equal steps of θ, and the heat of it.
    fn cycle(law: Jenkins, amplitude: f64, count: usize) -> (Vec<f64>, f64) {
        let mut memory = [0.0];
        let mut heat = 0.0;
        let mut loads = Vec::new();
        // the second of two periods is steady
        for index in 0..2 * count {
            let r = amplitude * (TAU * index as f64 / count as f64).cos();
            let load = law.load(&memory, r, 0.0);
            let of_step = law.commit(&mut memory, r, 0.0);
            if index >= count {
                loads.push(load);
                heat += of_step;
            }
        }
        (loads, heat)
    }

    /// Fourier coefficients of two such elements, and their heat in a cycle, by closed forms (θ_s = arccos(1 − 2h/(kU)),
    /// a₁ = (kU/π)(θ_s − ½ sin 2θ_s), D = 4h(U − h/k)), evaluated with 30 digits.
    #[test]
    fn a_steady_cycle_has_the_closed_form_s_coefficients_and_heat() {
        for (k, h, amplitude, a1, b1, a3, b3, expected_heat) in [
            (
                2.0,
                3.0,
                5.0,
                2.52315787734,
                -2.67380304394,
                0.653488258255,
                0.606062023294,
                42.0,
            ),
            (
                1.5e7,
                4000.0,
                6e-4,
                3864.69258139,
                -2829.42121052,
                208.288993044,
                919.852986137,
                5.33333333333,
            ),
        ] {
            let law = Jenkins {
                stiffness: k,
                slip_force: h,
            };
            let count = 200_000;
            let (loads, heat) = cycle(law, amplitude, count);
            let coefficient = |n: f64, wave: fn(f64) -> f64| {
                let sum: f64 = loads
                    .iter()
                    .enumerate()
                    .map(|(index, load)| load * wave(n * TAU * index as f64 / count as f64))
                    .sum();
                2.0 * sum / count as f64
            };
            for (found, expected) in [
                (coefficient(1.0, f64::cos), a1),
                (coefficient(1.0, f64::sin), b1),
                (coefficient(3.0, f64::cos), a3),
                (coefficient(3.0, f64::sin), b3),
                (heat, expected_heat),
                (heat, -PI * amplitude * b1),
            ] {
                assert!((found / expected - 1.0).abs() < 1e-7, "{found} {expected}");
            }
        }
    }

    /// A slider whose slip force falls to nothing while its spring is held gives all that the spring stored as heat; one whose
    /// slip force grows again keeps its load.
    #[test]
    fn a_falling_slip_force_lets_it_slip_and_a_growing_one_does_not() {
        let at = |slip_force| Jenkins {
            stiffness: 2e6,
            slip_force,
        };
        let mut memory = [0.0; 3];
        let r = 1e-4;
        at(500.0).commit(&mut memory, r, 0.0);
        let load = at(500.0).load(&memory, r, 0.0);
        assert!((load - 200.0).abs() < 1e-9, "{load}");
        let stored = at(500.0).stored_energy(&memory, r);
        let heat: f64 = (0..=500)
            .map(|n| at(500.0 - f64::from(n)).commit(&mut memory, r, 0.0))
            .sum();
        assert!((heat / stored - 1.0).abs() < 1e-12, "{heat} {stored}");
        // in one go as well
        let mut at_once = [0.0; 3];
        at(500.0).commit(&mut at_once, r, 0.0);
        let heat = at(0.0).commit(&mut at_once, r, 0.0);
        assert!((heat / stored - 1.0).abs() < 1e-12, "{heat} {stored}");
        assert_eq!(at(0.0).load(&memory, r, 0.0), 0.0);
        assert_eq!(at(500.0).commit(&mut memory, r, 0.0), 0.0);
        assert_eq!(at(500.0).load(&memory, r, 0.0), 0.0);
    }

    #[test]
    fn work_is_what_is_stored_and_the_heat() {
        let law = Jenkins {
            stiffness: 2e6,
            slip_force: 300.0,
        };
        let mut memory = [0.0];
        let (mut work, mut heat, mut r) = (0.0, 0.0, 0.0);
        let mut random = Random(1);
        for _ in 0..2000 {
            let target = 1e-3 * (random.unit() - 0.5);
            // the load is piecewise linear: the trapezoidal rule is exact on either side of where it begins to slip
            let slips_from = memory[0] + (target - memory[0]).signum() * 300.0 / 2e6;
            let between = (slips_from - r) * (target - slips_from) > 0.0;
            let stops = if between {
                vec![slips_from, target]
            } else {
                vec![target]
            };
            for stop in stops {
                let before = law.load(&memory, r, 0.0);
                let of_step = law.commit(&mut memory, stop, 0.0);
                assert!(of_step >= 0.0);
                work += 0.5 * (before + law.load(&memory, stop, 0.0)) * (stop - r);
                heat += of_step;
                r = stop;
            }
        }
        let balance = work - heat - law.stored_energy(&memory, r);
        assert!(balance.abs() < 1e-12 * heat, "{balance:e} of {heat}");
    }

    #[test]
    fn a_loop_inside_another_closes() {
        let law = Jenkins {
            stiffness: 2.0,
            slip_force: 3.0,
        };
        let mut memory = [0.0];
        for r in [5.0, 3.0] {
            law.commit(&mut memory, r, 0.0);
        }
        let before = (law.load(&memory, 3.0, 0.0), memory);
        for r in [4.5, 2.5, 3.0] {
            law.commit(&mut memory, r, 0.0);
        }
        assert_eq!((law.load(&memory, 3.0, 0.0), memory), before);
        // the power of slipping is the slip force times the rate, and none while it turns back
        assert_eq!(law.dissipated_power(&memory, 6.0, 0.5), 1.5);
        assert_eq!(law.dissipated_power(&memory, 6.0, -0.5), 0.0);
    }

    #[test]
    fn a_slider_that_bears_nothing_has_no_stiffness() {
        let law = Jenkins {
            stiffness: Dual::from(1e6),
            slip_force: Dual::from(0.0),
        };
        for r in [0.0, 1e-4] {
            let load = law.load(&[0.0], Dual::<1>::along(r, 0), Dual::from(0.0));
            assert_eq!((load.value, load.change), (0.0, [0.0]));
        }
    }

    #[test]
    fn a_law_of_zeros_gives_zeros() {
        for stiffness in [0.0, 1e6] {
            let law = Jenkins {
                stiffness,
                slip_force: 0.0,
            };
            let mut memory = [0.0];
            for r in [0.0, 1e-4, -2e-4] {
                let told = [
                    law.load(&memory, r, 1.0),
                    law.stored_energy(&memory, r),
                    law.dissipated_power(&memory, r, 1.0),
                    law.commit(&mut memory, r, 1.0),
                ];
                assert!(told.iter().all(|own| *own == 0.0), "{told:?}");
                assert_eq!(memory, [r]);
            }
        }
    }
}
