//! The linear lap under held loads: all Runge–Kutta steps of an interval are one constant matrix, computed beforehand.

use std::num::NonZeroU32;

use crate::{
    integrator::LapIntegrator,
    lap::{LapLoads, LapState},
    motion::Motion,
};

impl<const D: usize> LapState<D> {
    /// `factor · self`
    #[inline]
    fn times(&self, factor: f64) -> Self {
        let scaled = |motion: &Motion<D>| Motion {
            displacement: motion.displacement.map(|x| factor * x),
            velocity: motion.velocity.map(|v| factor * v),
        };
        Self {
            a: scaled(&self.a),
            b: scaled(&self.b),
        }
    }

    /// `self + factor · rate`
    #[inline]
    fn plus(&self, factor: f64, rate: &Self) -> Self {
        let sum =
            |of: &[f64; D], rate: &[f64; D]| std::array::from_fn(|i| of[i] + factor * rate[i]);
        let moved = |motion: &Motion<D>, rate: &Motion<D>| Motion {
            displacement: sum(&motion.displacement, &rate.displacement),
            velocity: sum(&motion.velocity, &rate.velocity),
        };
        Self {
            a: moved(&self.a, &rate.a),
            b: moved(&self.b, &rate.b),
        }
    }
}

/// Change of a linear lap's state over a fixed interval, for any state at its start and any held loads.
///
/// It is a function of the model, the interval and the number of steps alone, and gives what
/// [`LapIntegrator::advance`] gives, to rounding, at a cost that does not depend on the number of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapPropagator<const D: usize> {
    change: Change<D>,
}

/// Change of the state per unit of each state and of each load: P = R − I and Q in x ← x + P x + Q F.
///
/// The identity is left out, because P is small for short steps and keeps its digits on its own.
#[derive(Clone, Copy, Debug, PartialEq)]
// so that two numbers at a time can be read without a load of their own
#[repr(align(16))]
struct Change<const D: usize> {
    /// Columns of P: displacements of a, velocities of a, displacements of b, velocities of b.
    per_state: [[LapState<D>; D]; 4],
    /// Columns of Q: loads on a, loads on b.
    per_load: [[LapState<D>; D]; 2],
}

impl<const D: usize> LapPropagator<D> {
    /// The propagator for `interval_s` (s) in `substeps` equal RK4 steps.
    ///
    /// `None` where the model has a cubic term, and where a growing mode takes the matrices past what is finite.
    #[must_use]
    pub fn new(
        integrator: &LapIntegrator<D>,
        interval_s: f64,
        substeps: NonZeroU32,
    ) -> Option<Self> {
        if !integrator.is_linear() {
            return None;
        }
        let step_s = interval_s / f64::from(substeps.get());
        let change = Change::of_one_step(integrator, step_s).repeated(substeps);
        change.is_finite().then_some(Self { change })
    }

    /// State at the interval's end.
    #[inline]
    #[must_use]
    pub fn advance(&self, state: &LapState<D>, loads: &LapLoads<D>) -> LapState<D> {
        // x(t+H) = x + (P x + Q F); the state last, because the rest is small beside it
        let change = self.change.of_state(state);
        state.plus(1.0, &change.plus(1.0, &self.change.of_loads(loads)))
    }
}

impl<const D: usize> Change<D> {
    /// Change over one RK4 step: the Taylor polynomial of fourth order of the exponential.
    fn of_one_step(integrator: &LapIntegrator<D>, step_s: f64) -> Self {
        let unloaded = LapLoads {
            a: [0.0; D],
            b: [0.0; D],
        };
        let rate = |state: &LapState<D>| integrator.rate(state, &unloaded);
        // φ(hA) x = x + hA/2 (x + hA/3 (x + hA/4 x))
        let averaged = |x: &LapState<D>| {
            let mut sum = *x;
            for order in [4.0, 3.0, 2.0] {
                sum = x.plus(step_s / order, &rate(&sum));
            }
            sum
        };
        let scaled = |x: &LapState<D>| x.times(step_s);
        // P = R(hA) − I = hA φ(hA)
        let per_state = |unit: LapState<D>| scaled(&rate(&averaged(&unit)));
        // Q F = h φ(hA) M⁻¹F, with M⁻¹F the accelerations from rest
        let per_load =
            |loads: LapLoads<D>| scaled(&averaged(&integrator.rate(&LapState::REST, &loads)));
        let unit = |i: usize| std::array::from_fn(|j| f64::from(u8::from(i == j)));
        let displaced = |i| Motion {
            displacement: unit(i),
            velocity: [0.0; D],
        };
        let moving = |i| Motion {
            displacement: [0.0; D],
            velocity: unit(i),
        };
        let of_a = |a| LapState { a, b: Motion::REST };
        let of_b = |b| LapState { a: Motion::REST, b };
        Self {
            per_state: [
                std::array::from_fn(|i| per_state(of_a(displaced(i)))),
                std::array::from_fn(|i| per_state(of_a(moving(i)))),
                std::array::from_fn(|i| per_state(of_b(displaced(i)))),
                std::array::from_fn(|i| per_state(of_b(moving(i)))),
            ],
            per_load: [
                std::array::from_fn(|i| {
                    per_load(LapLoads {
                        a: unit(i),
                        ..unloaded
                    })
                }),
                std::array::from_fn(|i| {
                    per_load(LapLoads {
                        b: unit(i),
                        ..unloaded
                    })
                }),
            ],
        }
    }

    /// Change over `times` such intervals, by repeated doubling.
    fn repeated(self, times: NonZeroU32) -> Self {
        let mut doubled = self;
        let mut total: Option<Self> = None;
        let mut rest = times.get();
        loop {
            if rest & 1 == 1 {
                total = Some(total.map_or(doubled, |total| total.followed_by(&doubled)));
            }
            rest >>= 1;
            if rest == 0 {
                return total.unwrap_or(doubled);
            }
            doubled = doubled.followed_by(&doubled);
        }
    }

    /// Change over this interval and then `next`.
    fn followed_by(&self, next: &Self) -> Self {
        // I + P = (I + P₂)(I + P₁)  ⇒  P = P₁ + P₂ + P₂P₁, Q = Q₁ + Q₂ + P₂Q₁
        let joined = |first: &LapState<D>, second: &LapState<D>| {
            first.plus(1.0, second).plus(1.0, &next.of_state(first))
        };
        Self {
            per_state: std::array::from_fn(|group| {
                std::array::from_fn(|i| {
                    joined(&self.per_state[group][i], &next.per_state[group][i])
                })
            }),
            per_load: std::array::from_fn(|side| {
                std::array::from_fn(|i| joined(&self.per_load[side][i], &next.per_load[side][i]))
            }),
        }
    }

    /// P x
    #[inline]
    fn of_state(&self, state: &LapState<D>) -> LapState<D> {
        let [x_a, v_a, x_b, v_b] = &self.per_state;
        // two sums, so that neither waits for the other
        let of_a = of_two([x_a, v_a], [&state.a.displacement, &state.a.velocity]);
        let of_b = of_two([x_b, v_b], [&state.b.displacement, &state.b.velocity]);
        of_a.plus(1.0, &of_b)
    }

    /// Q F
    #[inline]
    fn of_loads(&self, loads: &LapLoads<D>) -> LapState<D> {
        let [on_a, on_b] = &self.per_load;
        of_two([on_a, on_b], [&loads.a, &loads.b])
    }

    fn is_finite(&self) -> bool {
        let columns = self.per_state.iter().chain(&self.per_load).flatten();
        columns
            .flat_map(|column| [&column.a, &column.b])
            .all(|motion| {
                let mut numbers = motion.displacement.iter().chain(&motion.velocity);
                numbers.all(|number| number.is_finite())
            })
    }
}

/// Sum of columns times numbers, for two groups of both.
#[inline]
fn of_two<const D: usize>(columns: [&[LapState<D>; D]; 2], numbers: [&[f64; D]; 2]) -> LapState<D> {
    let mut sum = columns[0][0].times(numbers[0][0]);
    for i in 0..D {
        if i > 0 {
            sum = sum.plus(numbers[0][i], &columns[0][i]);
        }
        sum = sum.plus(numbers[1][i], &columns[1][i]);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        alike::alike,
        lap::{Body, Lap},
        law::{Linear, Polynomial},
        random::Random,
    };

    impl Random {
        fn between(&mut self, low: f64, high: f64) -> f64 {
            low + (high - low) * self.unit()
        }

        /// `typical` times something between a tenth and ten.
        fn around(&mut self, typical: f64) -> f64 {
            typical * 10_f64.powf(self.between(-1.0, 1.0))
        }

        fn vector<const D: usize>(&mut self, amplitude: f64) -> [f64; D] {
            std::array::from_fn(|_| self.between(-amplitude, amplitude))
        }

        fn motion<const D: usize>(&mut self, omega: f64) -> Motion<D> {
            Motion {
                displacement: self.vector(1e-4),
                velocity: self.vector(1e-4 * omega),
            }
        }

        fn body<const D: usize>(&mut self) -> Body<D> {
            Body {
                inertia: std::array::from_fn(|i| self.around([1.0, 1e-3][i])),
                stiffness: std::array::from_fn(|i| self.around([1e6, 1e3][i])),
                damping: std::array::from_fn(|i| self.around([10.0, 1e-2][i])),
            }
        }

        fn lap<const D: usize>(&mut self) -> Lap<D> {
            let mut matrix = |diagonal: [f64; 2]| {
                let diagonal = diagonal.map(|typical| self.around(typical));
                let coupling = self.between(-0.9, 0.9) * (diagonal[0] * diagonal[1]).sqrt();
                std::array::from_fn(|i| {
                    std::array::from_fn(|j| if i == j { diagonal[i] } else { coupling })
                })
            };
            let joint = Linear {
                stiffness: matrix([1e6, 1e3]),
                damping: matrix([10.0, 1e-2]),
            }
            .beside([0.0; D].map(Polynomial::cubic));
            Lap {
                joint,
                a: self.body(),
                b: self.body(),
            }
        }
    }

    /// Largest differences of displacement and of velocity, each against the largest of all values on the way.
    fn error<const D: usize>(found: &LapState<D>, expected: &LapState<D>, scale: [f64; 2]) -> f64 {
        let difference = found.plus(-1.0, expected);
        let mut largest = 0.0_f64;
        for motion in [&difference.a, &difference.b] {
            for i in 0..D {
                largest = largest
                    .max(motion.displacement[i].abs() / scale[0])
                    .max(motion.velocity[i].abs() / scale[1]);
            }
        }
        largest
    }

    fn follows_the_steps<const D: usize>() {
        let mut random = Random(D as u64);
        for case in 0..2000 {
            let lap = random.lap::<D>();
            let omega = lap.spectrum().unwrap().largest_modulus();
            let step_s = random.between(0.01, 1.0) / omega;
            let count = match case % 4 {
                0 => 1,
                1 => 1 + (random.unit() * 10.0) as u32,
                _ => 1 + (random.unit() * 1000.0) as u32,
            };
            let interval_s = step_s * f64::from(count);
            let integrator = LapIntegrator::new(&lap);
            let count = NonZeroU32::new(count).unwrap();
            let start = LapState {
                a: random.motion(omega),
                b: random.motion(omega),
            };
            let loads = LapLoads {
                a: random.vector(100.0),
                b: random.vector(100.0),
            };
            // the loads' own share of the motion, so that the scale is that of what is added up
            let scale = {
                let steps = count.get().min(20);
                let mut state = start;
                let mut scale = [1e-4, 1e-4 * omega];
                for _ in 0..steps {
                    let length_s = interval_s / f64::from(steps);
                    let substeps = NonZeroU32::new(count.get().div_ceil(steps)).unwrap();
                    state = integrator.advance(&state, &loads, length_s, substeps);
                    for motion in [&state.a, &state.b] {
                        for i in 0..D {
                            scale[0] = scale[0].max(motion.displacement[i].abs());
                            scale[1] = scale[1].max(motion.velocity[i].abs());
                        }
                    }
                }
                scale
            };
            let stepped = integrator.advance(&start, &loads, interval_s, count);
            let propagator = LapPropagator::new(&integrator, interval_s, count).unwrap();
            let found = propagator.advance(&start, &loads);
            let error = error(&found, &stepped, scale);
            assert!(error < 1e-12, "{count} steps: {error:e}\n{lap:?}");
        }
    }

    #[test]
    fn one_product_is_all_the_steps() {
        follows_the_steps::<1>();
        follows_the_steps::<2>();
    }

    #[test]
    fn an_undamped_oscillator_is_multiplied_by_the_power_of_runge_kutta_s_polynomial() {
        // in phase, the joint carries nothing: x = Re (1 + z + z²/2 + z³/6 + z⁴/24)ⁿ, z = jωh
        let (omega, step_s, count): (f64, f64, u32) = (50.0, 2e-3, 77);
        let bodies = [[2.0], [2.0 * omega * omega], [0.0]];
        let lap = alike(bodies, [[[1e4]], [[1.0]]], [0.0]);
        let z = omega * step_s;
        let (re, im) = (1.0 - z * z / 2.0 + z.powi(4) / 24.0, z - z.powi(3) / 6.0);
        let phase = f64::from(count) * im.atan2(re);
        let modulus = re.hypot(im).powi(count as i32);
        let moved = Motion {
            displacement: [1.0],
            velocity: [0.0],
        };
        let start = LapState { a: moved, b: moved };
        let propagator = LapPropagator::new(
            &LapIntegrator::new(&lap),
            step_s * f64::from(count),
            NonZeroU32::new(count).unwrap(),
        );
        let end = propagator
            .unwrap()
            .advance(&start, &LapLoads { a: [0.0], b: [0.0] });
        for body in [end.a, end.b] {
            assert!((body.displacement[0] - modulus * phase.cos()).abs() < 1e-13);
            assert!((body.velocity[0] + omega * modulus * phase.sin()).abs() < 1e-12 * omega);
        }
    }

    #[test]
    fn a_cubic_term_or_overflow_gives_none() {
        let mut lap = Random(7).lap::<2>();
        let count = NonZeroU32::new(1000).unwrap();
        assert!(LapPropagator::new(&LapIntegrator::new(&lap), 1e-3, count).is_some());
        lap.joint.on[1] = Polynomial::cubic(1.0).into();
        assert!(LapPropagator::new(&LapIntegrator::new(&lap), 1e-3, count).is_none());
        lap.joint.on[1] = Polynomial::NONE.into();
        lap.a.stiffness[0] = -1e8;
        let long_s = 1.0;
        assert!(LapPropagator::new(&LapIntegrator::new(&lap), long_s, count).is_none());
    }
}
