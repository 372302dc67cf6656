//! The whole law of the massless joint: the linear one, and on each relative DOF the laws beside it.

use super::{DOF_PARAMETER_COUNT, DofLaws, DofMemory, Linear, Polynomial};
use crate::{
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointMemory<const D: usize> {
    /// On each relative DOF.
    pub on: [DofMemory; D],
}

impl<const D: usize> JointMemory<D> {
    /// Nothing has moved yet.
    pub const REST: Self = Self {
        on: [DofMemory::REST; D],
    };
}

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
        self.load_on_b_after(&JointMemory::REST, relative)
    }

    /// The same of a joint that remembers `memory`.
    #[inline]
    #[must_use]
    pub fn load_on_b_after(&self, memory: &JointMemory<D>, relative: &Motion<D, N>) -> [N; D] {
        // F_b = K r + C ṙ + Σ f(r, ṙ)
        let linear = self.linear.load(relative);
        std::array::from_fn(|i| {
            if self.on[i].are_none() {
                return linear[i];
            }
            let (r, velocity) = (relative.displacement[i], relative.velocity[i]);
            linear[i] + self.on[i].load(&memory.on[i], r, velocity)
        })
    }

    /// Energy stored in the joint's springs (J) at the relative displacement r.
    #[inline]
    #[must_use]
    pub fn stored_energy(&self, r: &[N; D]) -> N {
        self.stored_energy_after(&JointMemory::REST, r)
    }

    /// The same of a joint that remembers `memory`.
    #[inline]
    #[must_use]
    pub fn stored_energy_after(&self, memory: &JointMemory<D>, r: &[N; D]) -> N {
        (0..D).fold(self.linear.stored_energy(r), |sum, i| {
            if self.on[i].are_none() {
                return sum;
            }
            sum + self.on[i].stored_energy(&memory.on[i], r[i])
        })
    }

    /// Power that the joint turns into heat (W) at the relative motion.
    #[inline]
    #[must_use]
    pub fn dissipated_power(&self, relative: &Motion<D, N>) -> N {
        self.dissipated_power_after(&JointMemory::REST, relative)
    }

    /// The same of a joint that remembers `memory`.
    #[inline]
    #[must_use]
    pub fn dissipated_power_after(&self, memory: &JointMemory<D>, relative: &Motion<D, N>) -> N {
        let linear = self.linear.dissipated_power(&relative.velocity);
        (0..D).fold(linear, |sum, i| {
            if self.on[i].are_none() {
                return sum;
            }
            let (r, velocity) = (relative.displacement[i], relative.velocity[i]);
            sum + self.on[i].dissipated_power(&memory.on[i], r, velocity)
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

    /// Every coefficient times `factor`: the change of the law when what it depends on changes by `factor`.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        Self::each([self], |[coefficient]| factor * coefficient)
    }

    /// Moves what the joint remembers on to the relative displacement r (m, rad); returns the heat of that way, J, beside
    /// that of dampers.
    pub fn commit(&self, memory: &mut JointMemory<D>, r: &[f64; D]) -> f64 {
        (0..D).fold(0.0, |heat, i| {
            heat + self.on[i].commit(&mut memory.on[i], r[i])
        })
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
            let [stiffness, damping] = laws.load(&DofMemory::REST, r, velocity).change;
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
        std::array::from_fn(|i| {
            // C + (c2 u + c4 u²) eᵢeᵢᵀ is semidefinite as long as C_ii − C_ij²/C_jj + c2 u + c4 u² is not negative
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
