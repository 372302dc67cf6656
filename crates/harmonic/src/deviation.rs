//! The equations of small deviations from a periodic motion, over τ = ωt.

use bolted_joint_dynamics::Body;

/// Deviations of the bodies: displacements and their rates over τ = ωt, one row a deviation.
#[derive(Clone, Copy)]
pub(super) struct Deviation<const D: usize> {
    pub(super) x: [[f64; D]; 2],
    pub(super) rate: [[f64; D]; 2],
}

/// The equations of small deviations about a motion, over τ.
pub(super) struct Linearised<'a, const D: usize> {
    pub(super) bodies: [&'a Body<D>; 2],
    pub(super) joint_stiffness: &'a [[f64; D]; D],
    pub(super) joint_damping: &'a [[f64; D]; D],
    pub(super) omega: f64,
}

/// The joint's laws beside the linear one at a moment.
#[derive(Clone, Copy)]
pub(super) struct Tangent<const D: usize> {
    /// ∂f/∂r and ∂f/∂ṙ of each DOF.
    pub(super) by_motion: [[f64; D]; 2],
    /// Change of each DOF's load with what it remembers, N or N·m.
    pub(super) remembered: [f64; D],
}

impl<const D: usize> Deviation<D> {
    pub(super) const NONE: Self = Self {
        x: [[0.0; D]; 2],
        rate: [[0.0; D]; 2],
    };

    /// That of one state alone: displacements of a, of b, then rates.
    pub(super) fn unit(state: usize) -> Self {
        let mut unit = Self::NONE;
        *unit.entry_mut(state) = 1.0;
        unit
    }

    fn entry_mut(&mut self, state: usize) -> &mut f64 {
        let (side, dof) = (state / D % 2, state % D);
        if state < 2 * D {
            &mut self.x[side][dof]
        } else {
            &mut self.rate[side][dof]
        }
    }

    /// One of its states.
    pub(super) fn entry(&self, state: usize) -> f64 {
        let mut own = *self;
        *own.entry_mut(state)
    }

    /// Deviation of the relative displacement.
    pub(super) fn relative(&self, dof: usize) -> f64 {
        self.x[0][dof] - self.x[1][dof]
    }

    /// `self + factor · by`
    fn moved(&self, factor: f64, by: &Self) -> Self {
        let sum = |one: &[[f64; D]; 2], other: &[[f64; D]; 2]| {
            std::array::from_fn(|side| {
                std::array::from_fn(|dof| one[side][dof] + factor * other[side][dof])
            })
        };
        Self {
            x: sum(&self.x, &by.x),
            rate: sum(&self.rate, &by.rate),
        }
    }
}

impl<const D: usize> Linearised<'_, D> {
    /// x'' = −M⁻¹ (K x + …)/ω² − M⁻¹ (C x' + …)/ω, the joint's tangent added to its K and C
    fn rate(&self, deviation: &Deviation<D>, tangent: &Tangent<D>) -> Deviation<D> {
        let [stiffness, damping] = &tangent.by_motion;
        let (x, rate) = (&deviation.x, &deviation.rate);
        let by_stiffness = 1.0 / (self.omega * self.omega);
        let by_damping = 1.0 / self.omega;
        let mut second = [[0.0; D]; 2];
        for i in 0..D {
            let mut joint = by_stiffness * stiffness[i] * (x[0][i] - x[1][i])
                + by_damping * damping[i] * (rate[0][i] - rate[1][i])
                + by_stiffness * tangent.remembered[i];
            for j in 0..D {
                joint += by_stiffness * self.joint_stiffness[i][j] * (x[0][j] - x[1][j])
                    + by_damping * self.joint_damping[i][j] * (rate[0][j] - rate[1][j]);
            }
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                let body = self.bodies[side];
                let own = by_stiffness * body.stiffness[i] * x[side][i]
                    + by_damping * body.damping[i] * rate[side][i];
                second[side][i] = -(own + sign * joint) / body.inertia[i];
            }
        }
        Deviation {
            x: *rate,
            rate: second,
        }
    }

    pub(super) fn step(
        &self,
        start: &Deviation<D>,
        [first, middle, last]: &[Tangent<D>; 3],
        step: f64,
    ) -> Deviation<D> {
        let one = self.rate(start, first);
        let two = self.rate(&start.moved(0.5 * step, &one), middle);
        let three = self.rate(&start.moved(0.5 * step, &two), middle);
        let four = self.rate(&start.moved(step, &three), last);
        start
            .moved(step / 6.0, &one)
            .moved(step / 3.0, &two)
            .moved(step / 3.0, &three)
            .moved(step / 6.0, &four)
    }
}
