//! The equations of an assembly at one point: loads in its joints, accelerations, energies and powers.
//!
//! Written once for any kind of number, so that partial derivatives follow from them. Nothing is allocated.

use super::{
    matrix::Matrix,
    system::{Assembly, AssemblyJoint},
};
use crate::{
    dof::SPACE_COUNT,
    law::{DofLaws, DofMemory, JointLaw},
    motion::Motion,
    number::Number,
};

/// Coordinates and their rates.
#[derive(Clone, Copy, Debug)]
pub struct AssemblyMotion<'a, N> {
    /// q.
    pub coordinates: &'a [N],
    /// q̇.
    pub rates: &'a [N],
    /// The laws of the joints over the preload at present, in their order; without them they are as they stand in the assembly.
    pub laws: &'a [JointLaw<SPACE_COUNT, N>],
}

/// A joint at a motion, with what its laws remember on the DOFs that have any.
struct At<'a, N, M> {
    joint: &'a AssemblyJoint,
    /// Its law, if it follows a preload.
    law: Option<&'a JointLaw<SPACE_COUNT, N>>,
    /// Relative motion of its DOFs, and the rate.
    relative: Motion<SPACE_COUNT, N>,
    /// Place of its first DOF among those of all joints.
    first: usize,
    memory: &'a [DofMemory<M>],
}

impl Assembly {
    /// Number of coordinates, n.
    #[must_use]
    pub fn size(&self) -> usize {
        self.frequencies_rad_per_s.len()
    }

    /// Calls `of` for every DOF of [`Assembly::laws`], with the laws, the relative motion and its rate.
    pub fn each_law<N: Number>(
        &self,
        motion: AssemblyMotion<'_, N>,
        mut of: impl FnMut(&DofLaws<N>, N, N),
    ) {
        self.each(motion, &[], |at: At<'_, N, N>| {
            at.each_law(|_, laws, r, v| of(laws, r, v));
        });
    }

    /// Loads on side b of all joints' DOFs, joint by joint, N or N·m; `memory` is what the laws remember on the DOFs that have any.
    pub fn joint_loads<N: Number, M: Number + Into<N>>(
        &self,
        motion: AssemblyMotion<'_, N>,
        memory: &[DofMemory<M>],
        loads: &mut [N],
    ) {
        self.each(motion, memory, |at| at.loads_among(loads));
    }

    /// The same at relative motions: `relative` has those of all joints' DOFs, joint by joint, and then their rates.
    pub fn joint_loads_at(
        &self,
        relative: &[f64],
        laws: &[JointLaw<SPACE_COUNT>],
        memory: &[DofMemory],
        loads: &mut [f64],
    ) {
        let (displacements, velocities) = relative.split_at(relative.len() / 2);
        let seen = |place: usize, _: &[f64]| [displacements[place], velocities[place]];
        self.each_seen(laws, memory, seen, |at| at.loads_among(loads));
    }

    /// Rows of S of all joints, joint by joint.
    #[must_use]
    pub fn relative(&self) -> Matrix {
        let all: Vec<&[f64]> = self
            .joints
            .iter()
            .flat_map(|joint| rows(&joint.relative))
            .collect();
        Matrix::from_fn(all.len(), self.size(), |i, j| all[i][j])
    }

    /// q̈ = B u − Sᵀ f − C q̇ − Ω² q, of the joints' loads f.
    pub fn accelerations<N: Number>(
        &self,
        motion: AssemblyMotion<'_, N>,
        loads: &[N],
        joint_loads: &[N],
        accelerations: &mut [N],
    ) {
        for (i, own) in accelerations.iter_mut().enumerate() {
            let square = self.frequencies_rad_per_s[i].powi(2);
            *own = sum(self.loads.row(i), loads)
                - sum(self.damping_per_s.row(i), motion.rates)
                - N::from(square) * motion.coordinates[i];
        }
        let rows = self.joints.iter().flat_map(|joint| rows(&joint.relative));
        for (row, &load) in rows.zip(joint_loads) {
            for (own, &entry) in accelerations.iter_mut().zip(row) {
                *own = *own - N::from(entry) * load;
            }
        }
    }

    /// Energy of motion, and stored in structures and joints, J.
    pub fn stored_energy<N: Number, M: Number + Into<N>>(
        &self,
        motion: AssemblyMotion<'_, N>,
        memory: &[DofMemory<M>],
    ) -> N {
        let half = N::from(0.5);
        let mut energy = N::ZERO;
        let both = motion.coordinates.iter().zip(motion.rates);
        for ((&q, &rate), frequency) in both.zip(&self.frequencies_rad_per_s) {
            energy = energy + half * (rate * rate + N::from(frequency.powi(2)) * q * q);
        }
        self.each(motion, memory, |at| {
            energy = energy
                + match at.law {
                    Some(law) => law.linear.stored_energy(&at.relative.displacement),
                    None => half * form(&at.joint.stiffness, &at.relative.displacement),
                };
            at.each_memory(|_, laws, memory, r, _| {
                energy = energy + laws.stored_energy(memory, r);
            });
        });
        energy
    }

    /// Power of the loads, W.
    #[must_use]
    pub fn supplied_power<N: Number>(&self, rates: &[N], loads: &[N]) -> N {
        let of_coordinate = |(i, &rate): (usize, &N)| rate * sum(self.loads.row(i), loads);
        let powers = rates.iter().enumerate().map(of_coordinate);
        powers.fold(N::ZERO, |sum, power| sum + power)
    }

    /// Power that structures and joints turn into heat, W.
    pub fn dissipated_power<N: Number, M: Number + Into<N>>(
        &self,
        motion: AssemblyMotion<'_, N>,
        memory: &[DofMemory<M>],
    ) -> N {
        let mut power = self.linear_power(motion);
        self.each(motion, memory, |at| {
            at.each_memory(|_, laws, memory, r, v| {
                power = power + laws.dissipated_power(memory, r, v);
            });
        });
        power
    }

    /// That of structures, of linear dampers, and of laws that remember nothing, W: the others tell their heat where they move on.
    #[must_use]
    pub fn viscous_power<N: Number>(&self, motion: AssemblyMotion<'_, N>) -> N {
        let mut power = self.linear_power(motion);
        self.each_law(motion, |laws, r, v| {
            power = power + laws.viscous_power(r, v);
        });
        power
    }

    fn linear_power<N: Number>(&self, motion: AssemblyMotion<'_, N>) -> N {
        let mut power = form(&self.damping_per_s, motion.rates);
        self.each(motion, &[], |at: At<'_, N, N>| {
            power = power
                + match at.law {
                    Some(law) => law.linear.dissipated_power(&at.relative.velocity),
                    None => form(&at.joint.damping, &at.relative.velocity),
                };
        });
        power
    }

    /// Calls `of` for every joint.
    fn each<'a, N: Number + 'a, M>(
        &'a self,
        motion: AssemblyMotion<'a, N>,
        memory: &'a [DofMemory<M>],
        of: impl FnMut(At<'a, N, M>),
    ) {
        let seen = |_: usize, row: &[f64]| [motion.coordinates, motion.rates].map(|q| sum(row, q));
        self.each_seen(motion.laws, memory, seen, of);
    }

    /// The same with relative displacement and rate of each DOF by its place among all of them and its row of S.
    fn each_seen<'a, N: Number + 'a, M>(
        &'a self,
        laws: &'a [JointLaw<SPACE_COUNT, N>],
        memory: &'a [DofMemory<M>],
        seen: impl Fn(usize, &[f64]) -> [N; 2],
        mut of: impl FnMut(At<'a, N, M>),
    ) {
        let mut rest = memory;
        let mut laws = laws.iter();
        let mut first = 0;
        for joint in &self.joints {
            let mut at = At {
                joint,
                law: joint.over_preload.as_ref().and_then(|_| laws.next()),
                relative: Motion::REST,
                first,
                memory: rest,
            };
            for (dof, row) in rows(&joint.relative).take(SPACE_COUNT).enumerate() {
                let [r, rate] = seen(first + dof, row);
                at.relative.displacement[dof] = r;
                at.relative.velocity[dof] = rate;
            }
            first += joint.laws.len();
            rest = rest.get(joint.with_laws().count()..).unwrap_or_default();
            of(at);
        }
    }
}

impl<N: Number, M> At<'_, N, M> {
    fn each_law(&self, mut of: impl FnMut(usize, &DofLaws<N>, N, N)) {
        for (dof, laws) in self.joint.with_laws() {
            let (r, v) = (self.relative.displacement[dof], self.relative.velocity[dof]);
            match self.law {
                Some(law) => of(dof, &law.on[dof], r, v),
                None => of(dof, &of_numbers(laws), r, v),
            }
        }
    }
}

impl<N: Number, M: Number + Into<N>> At<'_, N, M> {
    /// Writes its loads where they stand among those of all joints.
    fn loads_among(&self, all: &mut [N]) {
        if let Some(own) = all.get_mut(self.first..self.first + self.joint.laws.len()) {
            self.loads(own);
        }
    }

    /// K r + C ṙ + f
    fn loads(&self, loads: &mut [N]) {
        let linear = self.law.map(|law| law.linear.load(&self.relative));
        for (dof, load) in loads.iter_mut().enumerate() {
            *load = match &linear {
                Some(linear) => linear[dof],
                None => {
                    sum(self.joint.stiffness.row(dof), &self.relative.displacement)
                        + sum(self.joint.damping.row(dof), &self.relative.velocity)
                }
            };
        }
        self.each_memory(|dof, laws, memory, r, v| {
            if let Some(load) = loads.get_mut(dof) {
                *load = *load + laws.load(memory, r, v);
            }
        });
    }

    /// The same as [`At::each_law`] with what the laws remember.
    fn each_memory(&self, mut of: impl FnMut(usize, &DofLaws<N>, &DofMemory<M>, N, N)) {
        let mut memory = self.memory.iter();
        self.each_law(|dof, laws, r, v| {
            if let Some(memory) = memory.next() {
                of(dof, laws, memory, r, v);
            }
        });
    }
}

fn of_numbers<N: Number>(laws: &DofLaws) -> DofLaws<N> {
    DofLaws::new(laws.parameters().map(N::from))
}

fn rows(matrix: &Matrix) -> impl Iterator<Item = &[f64]> {
    (0..matrix.rows()).map(|row| matrix.row(row))
}

/// Σ aᵢ xᵢ
fn sum<N: Number>(factors: &[f64], numbers: &[N]) -> N {
    let mut sum = N::ZERO;
    for (&factor, &number) in factors.iter().zip(numbers) {
        // most matrices are nearly diagonal
        if factor != 0.0 {
            sum = sum + N::from(factor) * number;
        }
    }
    sum
}

/// xᵀ A x
fn form<N: Number>(matrix: &Matrix, x: &[N]) -> N {
    let of_row = |(&own, row): (&N, &[f64])| own * sum(row, x);
    x.iter()
        .zip(rows(matrix))
        .map(of_row)
        .fold(N::ZERO, |sum, own| sum + own)
}
