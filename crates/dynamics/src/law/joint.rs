//! The whole law of the massless joint: the linear one, and on each relative DOF the laws beside it.

use super::{
    DOF_AT_REST, DOF_PARAMETER_COUNT, Declaration, DofLaws, DofMemory, INNER_COUNT, Law, Linear,
    Outside, Polynomial,
};
use crate::{
    condensation::{condensed, following},
    motion::Motion,
    number::{Dual, Number},
};

/// Load law of a joint with `D` DOFs, of the relative motion `r = x_a − x_b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLaw<const D: usize, N = f64> {
    /// Stiffness and viscous damping.
    pub linear: Linear<D, N>,
    /// The laws on each relative DOF beside it.
    pub on: [DofLaws<N>; D],
}

/// What a joint remembers of its motion, on each relative DOF.
pub type JointMemory<const D: usize, N = f64> = [DofMemory<N>; D];

impl<const D: usize> From<Linear<D>> for JointLaw<D> {
    /// The linear law alone.
    fn from(linear: Linear<D>) -> Self {
        Self {
            linear,
            ..Self::NONE
        }
    }
}

impl<const D: usize> Linear<D> {
    /// The joint with these polynomials beside the linear law, one on each relative DOF.
    #[must_use]
    pub fn beside(self, polynomials: [Polynomial; D]) -> JointLaw<D> {
        JointLaw {
            linear: self,
            on: polynomials.map(DofLaws::from),
        }
    }
}

impl<const D: usize, N: Number> JointLaw<D, N> {
    /// Nothing between the sides.
    pub const NONE: Self = Self {
        linear: Linear::NONE,
        on: [DofLaws::NONE; D],
    };

    /// Load on side b (N, N·m) at the relative motion x_a − x_b; the load on side a is its opposite. A joint with memory is
    /// taken as it is before its first motion.
    #[inline]
    #[must_use]
    pub fn load_on_b(&self, relative: &Motion<D, N>) -> [N; D] {
        self.load_on_b_after(&const { [DOF_AT_REST; D] }, relative)
    }

    /// The same of a joint that remembers `memory`.
    #[inline]
    #[must_use]
    pub fn load_on_b_after<M: Number + Into<N>>(
        &self,
        memory: &JointMemory<D, M>,
        relative: &Motion<D, N>,
    ) -> [N; D] {
        // F_b = K r + C ṙ + Σ f(r, ṙ)
        let linear = self.linear.load(relative);
        std::array::from_fn(|i| {
            if self.on[i].are_none() {
                return linear[i];
            }
            let (r, velocity) = (relative.displacement[i], relative.velocity[i]);
            linear[i] + self.on[i].load(&memory[i], r, velocity)
        })
    }

    /// Energy stored in the joint's springs (J) at the relative displacement r.
    #[inline]
    #[must_use]
    pub fn stored_energy(&self, r: &[N; D]) -> N {
        self.stored_energy_after(&const { [DOF_AT_REST; D] }, r)
    }

    /// The same of a joint that remembers `memory`.
    #[inline]
    #[must_use]
    pub fn stored_energy_after<M: Number + Into<N>>(
        &self,
        memory: &JointMemory<D, M>,
        r: &[N; D],
    ) -> N {
        (0..D).fold(self.linear.stored_energy(r), |sum, i| {
            if self.on[i].are_none() {
                return sum;
            }
            sum + self.on[i].stored_energy(&memory[i], r[i])
        })
    }

    /// What the elongations of laws that remember `memory` would store in the springs of these laws, J, at the relative
    /// displacement r: the same joint at another preload.
    #[must_use]
    pub fn energy_in<M: Number + Into<N>>(
        &self,
        springs: &Self,
        memory: &JointMemory<D, M>,
        r: &[N; D],
    ) -> N {
        (0..D).fold(N::ZERO, |sum, i| {
            if !self.on[i].have_memory() {
                return sum;
            }
            sum + self.on[i].energy_in(&springs.on[i], &memory[i], r[i])
        })
    }

    /// Power that the joint turns into heat (W) at the relative motion.
    #[inline]
    #[must_use]
    pub fn dissipated_power(&self, relative: &Motion<D, N>) -> N {
        self.dissipated_power_after(&const { [DOF_AT_REST; D] }, relative)
    }

    /// The same of a joint that remembers `memory`.
    #[inline]
    #[must_use]
    pub fn dissipated_power_after<M: Number + Into<N>>(
        &self,
        memory: &JointMemory<D, M>,
        relative: &Motion<D, N>,
    ) -> N {
        let linear = self.linear.dissipated_power(&relative.velocity);
        (0..D).fold(linear, |sum, i| {
            if self.on[i].are_none() {
                return sum;
            }
            let (r, velocity) = (relative.displacement[i], relative.velocity[i]);
            sum + self.on[i].dissipated_power(&memory[i], r, velocity)
        })
    }

    /// Power that the dampers turn into heat (W) at the relative motion. Laws that remember have no part in it: they tell their
    /// heat where they move on, in [`JointLaw::commit`].
    #[must_use]
    pub fn viscous_power(&self, relative: &Motion<D, N>) -> N {
        let linear = self.linear.dissipated_power(&relative.velocity);
        (0..D).fold(linear, |sum, i| {
            let (r, velocity) = (relative.displacement[i], relative.velocity[i]);
            sum + self.on[i].viscous_power(r, velocity)
        })
    }

    /// Whether the joint is linear.
    #[inline]
    #[must_use]
    pub fn is_linear(&self) -> bool {
        self.on.iter().all(DofLaws::are_none)
    }

    /// Whether the joint remembers its motion.
    #[inline]
    #[must_use]
    pub fn has_memory(&self) -> bool {
        self.on.iter().any(DofLaws::have_memory)
    }

    /// Whether the joint remembers its motion in DOF `i`.
    #[inline]
    #[must_use]
    pub fn remembers(&self, i: usize) -> bool {
        self.on[i].have_memory()
    }

    /// Whether a law of the joint has an inner state.
    #[inline]
    #[must_use]
    pub fn has_inner(&self) -> bool {
        self.on.iter().any(DofLaws::have_inner)
    }

    /// Takes the inner states as those at this relative motion: where somebody else integrates them.
    pub fn settle(&self, memory: &mut JointMemory<D, N>, relative: &Motion<D, N>) {
        for (i, memory) in memory.iter_mut().enumerate() {
            self.on[i].settle(memory, relative.displacement[i], relative.velocity[i]);
        }
    }

    /// Rates of the inner states on each DOF, in the order of [`super::INNER_PLACES`].
    #[must_use]
    pub fn inner_rates(
        &self,
        memory: &JointMemory<D, N>,
        relative: &Motion<D, N>,
    ) -> [[N; INNER_COUNT]; D] {
        std::array::from_fn(|i| self.on[i].inner_rates(&memory[i], relative.velocity[i]))
    }

    /// Moves the inner states alone on to the relative motion.
    pub fn commit_inner(&self, memory: &mut JointMemory<D, N>, relative: &Motion<D, N>) {
        for (i, memory) in memory.iter_mut().enumerate() {
            self.on[i].commit_inner(memory, relative.displacement[i], relative.velocity[i]);
        }
    }

    /// A function of each coefficient of several laws.
    #[inline]
    #[must_use]
    pub fn each<const L: usize, M: Number>(
        laws: [&Self; L],
        of: impl Fn([N; L]) -> M,
    ) -> JointLaw<D, M> {
        let matrix = |part: fn(&Self) -> &[[N; D]; D]| {
            std::array::from_fn(|i| std::array::from_fn(|j| of(laws.map(|law| part(law)[i][j]))))
        };
        JointLaw {
            linear: Linear {
                stiffness: matrix(|law| &law.linear.stiffness),
                damping: matrix(|law| &law.linear.damping),
            },
            on: std::array::from_fn(|i| {
                if laws.iter().all(|law| law.on[i].are_none()) {
                    return DofLaws::NONE;
                }
                let parameters: [M; DOF_PARAMETER_COUNT] =
                    std::array::from_fn(|p| of(laws.map(|law| law.on[i].parameters()[p])));
                DofLaws::new(parameters)
            }),
        }
    }

    /// Whether every coefficient is a finite number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let matrices = self.linear.stiffness.iter().chain(&self.linear.damping);
        let parameters = self.on.iter().flat_map(DofLaws::parameters);
        matrices.flatten().chain(parameters).all(|c| c.is_finite())
    }
}

impl<const D: usize> JointLaw<D> {
    /// The law with its change along one direction.
    #[must_use]
    pub fn with_change(&self, change: &Self) -> JointLaw<D, Dual<1>> {
        Self::each([self, change], |[value, change]| Dual::new(value, [change]))
    }

    /// Power (W) that the joint's springs take up at the relative displacement r because its law changes at this rate, with
    /// the elongations of laws that remember `memory` held.
    #[must_use]
    pub fn power_of_change(&self, rate: &Self, memory: &JointMemory<D>, r: &[f64; D]) -> f64 {
        // ∂U/∂t at constant r = ½ rᵀ (dK/dt) r + ¼ Σ (dk3/dt) r⁴: U is linear in these coefficients
        let springs = rate.linear.stored_energy(r);
        let springs = (0..D).fold(springs, |sum, i| {
            sum + rate.on[i].polynomial().stored_energy::<f64>(&[], r[i])
        });
        if !rate.has_memory() {
            return springs;
        }
        // ½ Σ (dk/dt) e²
        let own = Self::each([self], |[value]| Dual::<1>::from(value));
        let of_sliders = own.energy_in(&self.with_change(rate), memory, &r.map(Dual::from));
        springs + of_sliders.change[0]
    }

    /// First-order change of that part of [`JointLaw::power_of_change`] which laws that remember have, along the change of this
    /// law and of r at the same rate.
    #[must_use]
    pub fn change_of_slider_power(
        &self,
        law_change: &Self,
        rate: &Self,
        memory: &JointMemory<D>,
        [r, r_change]: [&[f64; D]; 2],
    ) -> f64 {
        /// Part of the springs by which their change is taken: its square is the error.
        const PART: f64 = 1e-5;
        if !rate.has_memory() {
            return 0.0;
        }
        let own = self.with_change(law_change);
        let r = std::array::from_fn(|i| Dual::new(r[i], [r_change[i]]));
        let largest = |law: &Self| {
            let all = law.on.iter().flat_map(DofLaws::parameters);
            all.fold(0.0, |most: f64, number| most.max(number.abs()))
        };
        // of springs so much stiffer and softer
        let step = PART * largest(self) / largest(rate);
        if !(step > 0.0 && step.is_finite()) {
            return 0.0;
        }
        let [above, below] = [step, -step].map(|step| {
            let springs = Self::each([self, rate], |[own, rate]| own + step * rate);
            let springs = springs.with_change(law_change);
            own.energy_in(&springs, memory, &r).change[0]
        });
        (above - below) / (2.0 * step)
    }

    /// Every coefficient times `factor`: the change of the law when what it depends on changes by `factor`.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        Self::each([self], |[coefficient]| factor * coefficient)
    }

    /// Moves what the joint remembers on to the relative motion; returns the heat of that way, J, beside that of dampers.
    pub fn commit(&self, memory: &mut JointMemory<D>, relative: &Motion<D>) -> f64 {
        (0..D).fold(0.0, |heat, i| {
            let (r, velocity) = (relative.displacement[i], relative.velocity[i]);
            heat + self.on[i].commit(&mut memory[i], r, velocity)
        })
    }

    /// The same, if all that is remembered then is finite, and the heat; else nothing moves, and there is `None`.
    pub fn try_commit(&self, memory: &mut JointMemory<D>, relative: &Motion<D>) -> Option<f64> {
        /// Numbers of a DOF for which there is a place that costs little.
        const ROOM: usize = 32;
        let is_finite = |memory: &JointMemory<D>| {
            let mut own = self.on.iter().zip(memory);
            own.all(|(laws, memory)| laws.is_memory_finite(memory))
        };
        let mut before = [[0.0; ROOM]; D];
        let mut places = before.iter_mut().zip(memory.iter()).zip(&self.on);
        if !places.all(|((before, memory), laws)| laws.save(memory, before)) {
            let mut moved = *memory;
            let heat = self.commit(&mut moved, relative);
            return (heat.is_finite() && is_finite(&moved)).then(|| {
                *memory = moved;
                heat
            });
        }
        let heat = self.commit(memory, relative);
        if heat.is_finite() && is_finite(memory) {
            return Some(heat);
        }
        for ((before, memory), laws) in before.iter().zip(memory).zip(&self.on) {
            laws.put_back(memory, before);
        }
        None
    }

    /// Copies what the joint's own laws remember, and nothing else.
    pub fn copy_memory(&self, from: &JointMemory<D>, to: &mut JointMemory<D>) {
        for i in 0..D {
            self.on[i].copy_memory(&from[i], &mut to[i]);
        }
    }

    /// The first parameter that is outside of the range of its law, with the index of its DOF.
    #[must_use]
    pub fn outside(&self) -> Option<(usize, &'static Declaration, Outside)> {
        let mut on = self.on.iter().enumerate();
        on.find_map(|(i, laws)| laws.outside().map(|(law, outside)| (i, law, outside)))
    }

    /// The polynomial law on each relative DOF.
    #[must_use]
    pub fn polynomials(&self) -> [Polynomial; D] {
        self.on.map(|laws| laws.polynomial())
    }

    /// The linear law of small motion about this static relative displacement (m, rad), to which the joint was taken in one
    /// go.
    #[must_use]
    pub fn linearised_about(&self, displacement: &[f64; D]) -> Self {
        let mut linear = self.linear;
        for i in 0..D {
            if self.on[i].are_none() {
                continue;
            }
            // ∂f/∂r and ∂f/∂ṙ at rest there
            let laws = DofLaws::new(self.on[i].parameters().map(Dual::<2>::from));
            let (r, velocity) = (Dual::along(displacement[i], 0), Dual::along(0.0, 1));
            let [stiffness, damping] = laws.load(&DOF_AT_REST, r, velocity).change;
            linear.stiffness[i][i] += stiffness;
            linear.damping[i][i] += damping;
        }
        linear.into()
    }

    /// Displacements of DOF `i` (m, rad), from rest to `amplitude`, at which its stiffness or damping of small motion is
    /// largest or least: rest, the amplitude, and what turns between them.
    pub fn extremes(&self, i: usize, amplitude: f64) -> impl Iterator<Item = f64> {
        let ends = (amplitude > 0.0).then_some(amplitude);
        let between = self.on[i].polynomial().turning_points(amplitude);
        [0.0].into_iter().chain(ends).chain(between)
    }

    /// Relative displacement (m, rad) of each DOF at which the first of its laws beside the linear one is as large as that, or
    /// changes its own stiffness; infinite where it has none, zero where there is no linear one beside it.
    #[must_use]
    pub fn nonlinear_amplitude(&self) -> [f64; D] {
        std::array::from_fn(|i| {
            let (k, c) = (self.linear.stiffness[i][i], self.linear.damping[i][i]);
            self.on[i].nonlinear_amplitude(k.abs(), c.abs())
        })
    }

    /// Relative displacement (m, rad) of each DOF, the other at rest, beyond which the damping that depends on it makes the
    /// joint active: the damping matrix is then no longer positive semidefinite. `None` where that does not happen, zero
    /// where it happens at once.
    #[must_use]
    pub fn active_amplitude(&self) -> [Option<f64>; D] {
        let damping = &self.linear.damping;
        let symmetric: [[f64; D]; D] =
            std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (damping[i][j] + damping[j][i])));
        std::array::from_fn(|i| {
            // C + (c2 u + c4 u²) eᵢeᵢᵀ is semidefinite as long as C_ii − C_ij²/C_jj + c2 u + c4 u² is not negative
            if let Some(motion) = following(&symmetric, i) {
                let condensed = condensed(&symmetric, &motion);
                return self.on[i].polynomial().first_active(condensed);
            }
            let condensed = (0..D).filter(|&j| j != i).fold(damping[i][i], |c, j| {
                let coupling = 0.5 * (damping[i][j] + damping[j][i]);
                if coupling == 0.0 {
                    c
                } else {
                    c - coupling * coupling / damping[j][j]
                }
            });
            self.on[i].polynomial().first_active(condensed)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::{Iwan, Jenkins};

    fn law() -> JointLaw<2> {
        Linear {
            stiffness: [[5.73e5, 5.82e3], [5.82e3, 1.29e3]],
            damping: [[10.83, -0.83], [-0.83, 0.083]],
        }
        .beside(Polynomial::on_each(
            &[[-3e11, 4e6], [5e16, -3e9], [-1e21, 2e12]],
            &[[-4e6, 30.0], [7e11, -2e4]],
        ))
    }

    #[test]
    fn the_linear_law_is_the_difference_quotient_of_the_load() {
        let law = law();
        let about = [1.3e-3, -8e-3];
        let linear = law.linearised_about(&about);
        for j in 0..2 {
            let load = |step: f64, rate: f64| {
                let mut motion = Motion {
                    displacement: about,
                    velocity: [0.0; 2],
                };
                motion.displacement[j] += step;
                motion.velocity[j] += rate;
                law.load_on_b(&motion)
            };
            let step = 1e-6 * about[j].abs();
            let [above, below] = [step, -step].map(|step| load(step, 0.0));
            let [still, moving] = [0.0, 1.0].map(|rate| load(0.0, rate));
            for i in 0..2 {
                let stiffness = (above[i] - below[i]) / (2.0 * step);
                let damping = moving[i] - still[i];
                assert!((linear.linear.stiffness[i][j] / stiffness - 1.0).abs() < 1e-6);
                assert!((linear.linear.damping[i][j] / damping - 1.0).abs() < 1e-9);
            }
        }
        assert!(linear.is_linear());
    }

    #[test]
    fn between_the_extremes_nothing_is_larger_or_smaller() {
        let alone = law().linear.beside([-3e11, 4e6].map(Polynomial::cubic));
        let without_septic = law().linear.beside(law().polynomials().map(|mut terms| {
            terms.springs[2] = 0.0;
            terms
        }));
        for law in [law(), alone, without_septic] {
            for (i, amplitude) in [(0, 8e-3), (1, 0.05)] {
                let at = |r: f64| {
                    let mut displacement = [0.0; 2];
                    displacement[i] = r;
                    let linear = law.linearised_about(&displacement).linear;
                    [linear.stiffness[i][i], linear.damping[i][i]]
                };
                let extremes: Vec<[f64; 2]> = law.extremes(i, amplitude).map(at).collect();
                for kind in 0..2 {
                    let all = || extremes.iter().map(|values| values[kind]);
                    let least = all().fold(f64::INFINITY, f64::min);
                    let most = all().fold(f64::NEG_INFINITY, f64::max);
                    let slack = 1e-12 * most.abs().max(least.abs());
                    for n in 0..=5000 {
                        let value = at(amplitude * f64::from(n) / 5000.0)[kind];
                        assert!(
                            (least - slack..=most + slack).contains(&value),
                            "{i} {kind} {n}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn the_first_term_to_reach_the_linear_one_tells_the_amplitude() {
        let [y, theta] = law().nonlinear_amplitude();
        // c2 r² = c: √(10.83/4e6); c2 θ² = c: √(0.083/30) is past √(1.29e3/4e6)
        assert!((y / (5.73e5_f64 / 3e11).sqrt() - 1.0).abs() < 1e-15);
        assert!((theta / (1.29e3_f64 / 4e6).sqrt() - 1.0).abs() < 1e-15);
        let mut law = law().linear.beside([0.0, -0.0].map(Polynomial::cubic));
        assert_eq!(law.nonlinear_amplitude(), [f64::INFINITY; 2]);
        law.on[0] = Polynomial::with(&[0.0, 0.0, -5.73e5 / 64.0], &[]).into();
        assert!((law.nonlinear_amplitude()[0] - 2.0).abs() < 1e-15);
        law.linear.stiffness[0][0] = 0.0;
        assert_eq!(law.nonlinear_amplitude()[0], 0.0);
    }

    #[test]
    fn with_rotation_the_coupling_takes_its_share_of_the_damping() {
        let law = Linear {
            damping: [[10.0, 2.0], [2.0, 1.0]],
            ..Linear::NONE
        }
        .beside(Polynomial::on_each(&[], &[[-3.0, -1.0]]));
        // 10 − 4/1 = 6 = 3 u and 1 − 4/10 = 0.6 = u
        let [y, theta] = law.active_amplitude().map(Option::unwrap);
        assert!((y - 2.0_f64.sqrt()).abs() < 1e-15 && (theta - 0.6_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn a_commit_that_overflows_leaves_no_trace() {
        let iwan = Iwan {
            slip_force: 1e300,
            stiffness: 1e300,
            exponent: -0.3,
            ratio: 0.5,
        };
        let jenkins = Jenkins {
            stiffness: 1e6,
            slip_force: 10.0,
        };
        let law = JointLaw {
            on: [
                DofLaws::from(jenkins),
                DofLaws::from(iwan).beside(&jenkins.into()),
            ],
            ..JointLaw::NONE
        };
        let at = |r: f64| Motion {
            displacement: [r; 2],
            velocity: [0.0; 2],
        };
        // few reversals, and more than there is room for beside them
        for count in [3, 40] {
            let mut memory = [DOF_AT_REST; 2];
            let mut plain = memory;
            for index in 0..count {
                let r = 1e-3 * (1.0 - 0.02 * f64::from(index)) * (-1.0_f64).powi(index);
                let heat = law.try_commit(&mut memory, &at(r));
                assert_eq!(heat, Some(law.commit(&mut plain, &at(r))));
                assert_eq!(memory, plain);
            }
            assert_eq!(law.try_commit(&mut memory, &at(1e100)), None);
            assert_eq!(memory, plain);
        }
    }

    #[test]
    fn the_next_corner_is_where_the_slider_slips() {
        let laws = DofLaws::from(Jenkins {
            stiffness: 2.0,
            slip_force: 3.0,
        });
        let mut memory = DOF_AT_REST;
        assert_eq!(laws.next_corner(&memory, 0.0, 1.0), Some(1.5));
        assert_eq!(laws.next_corner(&memory, 0.0, -1.0), Some(-1.5));
        laws.commit(&mut memory, 4.0, 1.0);
        // it slips on, and back it sticks for 2 h/k
        assert_eq!(laws.next_corner(&memory, 4.0, 1.0), None);
        assert_eq!(laws.next_corner(&memory, 4.0, -1.0), Some(1.0));
    }

    #[test]
    fn damping_that_does_not_fall_is_never_where_a_joint_turns_active() {
        for (c, dampers) in [(-1.0, [1.0, 0.0]), (0.0, [0.0, 0.0]), (1.0, [0.0, 2.0])] {
            let law = Linear {
                damping: [[c]],
                ..Linear::NONE
            }
            .beside([Polynomial::with(&[], &dampers)]);
            assert_eq!(law.active_amplitude(), [None]);
        }
    }
}
