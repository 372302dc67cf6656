//! The laws of an assembly's joints at one time: those of joints over the preload follow it.
//!
//! What is propagated exactly has K₀ and C₀ of one preload. At another the joint has (K(p) − K₀) r + (C(p) − C₀) ṙ beside it,
//! which is a force of the joint like those of its other laws.

use super::{matrix::Matrix, system::System};
use crate::{
    dof::SPACE_COUNT,
    law::{DofLaws, DofMemory, JointLaw, JointOverPreload, Linear},
    number::Dual,
};

/// The law over the preload of a joint in an assembly: its D degrees of freedom are the first ones, the others have nothing.
pub type LawOverPreload = JointOverPreload<SPACE_COUNT>;

/// Part of its table's range that a preload may go through in one step.
const LARGEST_SHARE: f64 = 1.0 / 16.0;

/// A joint over the preload, and what of it is propagated exactly.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Following {
    pub(super) law: Box<LawOverPreload>,
    /// K₀ and C₀.
    pub(super) linear: Linear<SPACE_COUNT>,
    /// The first of its degrees of freedom among those that have forces of laws, and how many they are.
    pub(super) first: usize,
    pub(super) count: usize,
}

/// The laws of all joints at one time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LawsAt {
    /// Preloads of the joints that follow one, N·m; NaN at first.
    preloads_n_m: Vec<f64>,
    /// The laws on each DOF that has forces of laws; and for changes along r and ṙ.
    pub(super) on: Vec<DofLaws>,
    along: Vec<DofLaws<Dual<2>>>,
    /// K(p) − K₀ and C(p) − C₀ of each joint that follows its preload.
    beyond: Vec<Linear<SPACE_COUNT>>,
    /// Square of the frequency (1/s²), and rate (1/s), that these give the joints at most.
    square: f64,
    rate: f64,
}

/// How fast the joints' forces may let them move.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// An upper bound of √λmax(S M⁻¹Sᵀ K_t), rad/s.
    pub(super) frequency_rad_per_s: f64,
    /// The same of S M⁻¹Sᵀ C_t, 1/s.
    pub(super) rate_per_s: f64,
}

impl LawsAt {
    /// Those that are propagated, with nothing beyond.
    pub(super) fn propagated(laws: Vec<DofLaws>, following: usize) -> Self {
        Self {
            preloads_n_m: vec![f64::NAN; following],
            along: laws.iter().map(along).collect(),
            on: laws,
            beyond: vec![Linear::NONE; following],
            square: 0.0,
            rate: 0.0,
        }
    }

    /// Lets the joints follow these preloads (N·m).
    pub(super) fn follow(&mut self, system: &System, preload_n_m: impl Fn(usize) -> f64) {
        let mut has_moved = false;
        for (which, own) in system.following.iter().enumerate() {
            let preload_n_m = preload_n_m(which);
            if self.preloads_n_m[which].to_bits() == preload_n_m.to_bits() {
                continue;
            }
            has_moved = true;
            self.preloads_n_m[which] = preload_n_m;
            let law = own.law.law(preload_n_m);
            for (i, laws) in law.on.iter().take(own.count).enumerate() {
                self.on[own.first + i] = *laws;
                self.along[own.first + i] = along(laws);
            }
            let linear = JointLaw::from(own.linear);
            self.beyond[which] =
                JointLaw::each([&law, &linear], |[law, propagated]| law - propagated).linear;
        }
        if has_moved {
            self.square = self.largest(system, |beyond| &beyond.stiffness);
            self.rate = self.largest(system, |beyond| &beyond.damping);
        }
    }

    /// Whether preloads go so far from here to there that what they do to the joints is no parabola of time.
    pub(super) fn are_far_from(&self, other: &Self, system: &System) -> bool {
        let all = system.following.iter().enumerate();
        all.fold(false, |far, (which, own)| {
            let [first, last] = own.law.range_n_m();
            let way = (self.preloads_n_m[which] - other.preloads_n_m[which]).abs();
            far || way > LARGEST_SHARE * (last - first)
        })
    }

    /// f of every law, at relative motions and from what they remember.
    pub(super) fn forces(
        &self,
        system: &System,
        memory: &[DofMemory],
        relative: &[f64],
        forces: &mut [f64],
    ) {
        let (r, velocity) = relative.split_at(self.on.len());
        for (i, force) in forces.iter_mut().enumerate() {
            *force = self.on[i].load(&memory[i], r[i], velocity[i]);
        }
        for (own, beyond) in system.following.iter().zip(&self.beyond) {
            let places = own.first..own.first + own.count;
            let (r, velocity) = (&r[places.clone()], &velocity[places.clone()]);
            for (i, force) in forces[places].iter_mut().enumerate() {
                *force += sum(&beyond.stiffness[i], r) + sum(&beyond.damping[i], velocity);
            }
        }
    }

    /// Power that dampers among them turn into heat, W.
    pub(super) fn viscous_power(&self, system: &System, r: &[f64], velocity: &[f64]) -> f64 {
        let mut power: f64 = (0..self.on.len())
            .map(|i| self.on[i].viscous_power(r[i], velocity[i]))
            .sum();
        for (own, beyond) in system.following.iter().zip(&self.beyond) {
            let velocity = &velocity[own.first..own.first + own.count];
            let of_row = |(i, own): (usize, &f64)| own * sum(&beyond.damping[i], velocity);
            power += velocity.iter().enumerate().map(of_row).sum::<f64>();
        }
        power
    }

    /// How fast the forces may let the joints move at relative motions (r, ṙ), from what the laws remember; `tangents` is room
    /// for those of each DOF.
    pub(super) fn pace(
        &self,
        system: &System,
        memory: &[DofMemory],
        relative: &[f64],
        tangents: &mut [[f64; 2]],
    ) -> Pace {
        let count = self.on.len();
        let (r, velocity) = relative.split_at(count);
        for (i, tangent) in tangents.iter_mut().enumerate() {
            *tangent = match self.on[i].are_none() {
                true => [0.0; 2],
                false => {
                    let (r, velocity) = (Dual::along(r[i], 0), Dual::along(velocity[i], 1));
                    self.along[i].load(&memory[i], r, velocity).change
                }
            };
        }
        // √K_t (S Sᵀ) √K_t is symmetric and similar to S Sᵀ K_t; its rows' sums bound its eigenvalues
        let bound = |which: usize| {
            let row = |i: usize| -> f64 {
                let entry = |j: usize| {
                    let product: f64 = tangents[i][which] * tangents[j][which];
                    system.mobility[(i, j)].abs() * product.abs().sqrt()
                };
                (0..count).map(entry).sum()
            };
            (0..count).map(row).fold(0.0, f64::max)
        };
        // all these matrices are symmetric in the same coordinates, so that their bounds add
        Pace {
            frequency_rad_per_s: (bound(0) + self.square).sqrt(),
            rate_per_s: bound(1) + self.rate,
        }
    }

    /// A bound of the eigenvalues of S Sᵀ times what the joints have beyond: the largest sum of a row's moduli, with each DOF
    /// in the unit in which a load of one moves it by one.
    fn largest(
        &self,
        system: &System,
        part: impl Fn(&Linear<SPACE_COUNT>) -> &[[f64; SPACE_COUNT]; SPACE_COUNT],
    ) -> f64 {
        let count = self.on.len();
        let mut beyond = Matrix::zeros(count, count);
        for (own, linear) in system.following.iter().zip(&self.beyond) {
            for i in 0..own.count {
                for j in 0..own.count {
                    beyond[(own.first + i, own.first + j)] = part(linear)[i][j];
                }
            }
        }
        let product = system.mobility.product(&beyond);
        let unit = |i: usize| system.mobility[(i, i)].sqrt();
        let row = |i: usize| -> f64 {
            let entries = (0..count).map(|j| match unit(j) {
                // what nothing moves has no part
                0.0 => 0.0,
                own => product[(i, j)].abs() * own,
            });
            entries.sum::<f64>()
        };
        let rows = (0..count).filter(|&i| unit(i) > 0.0);
        rows.map(|i| row(i) / unit(i)).fold(0.0, f64::max)
    }
}

/// Laws for changes along r and ṙ.
fn along(laws: &DofLaws) -> DofLaws<Dual<2>> {
    DofLaws::new(laws.parameters().map(Dual::from))
}

/// Σ aᵢ xᵢ
fn sum(factors: &[f64], numbers: &[f64]) -> f64 {
    factors.iter().zip(numbers).map(|(a, x)| a * x).sum()
}
