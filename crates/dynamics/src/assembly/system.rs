//! What an assembly is to the integration: structures in coordinates with unit mass, and the joints between them.
//!
//! With q the coordinates, u the loads and r = S q the relative motions of the joints (side a less side b):
//!
//! q̈ + C q̇ + Ω² q = B u − Sᵀ (K_j r + C_j ṙ + f(r, ṙ, memory))

use super::{
    matrix::Matrix,
    preload::{Following, LawOverPreload, LawsAt},
    products::dot,
    state::AssemblyState,
};
use crate::{
    dof::SPACE_COUNT,
    law::{DofLaws, JointLaw, Law, Linear, LuGre},
};

/// Structures, and joints between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    /// ω of each coordinate, rad/s; zero for motions of a free body. n of them.
    pub frequencies_rad_per_s: Vec<f64>,
    /// C of the structures, 1/s: n × n, symmetric; 2ζω on the diagonal where damping is modal.
    pub damping_per_s: Matrix,
    /// B: how each load acts on the coordinates, n × m.
    pub loads: Matrix,
    /// The joints.
    pub joints: Vec<AssemblyJoint>,
}

/// One joint of an assembly.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyJoint {
    /// Rows of S: relative motion x_a − x_b on each of the joint's D DOFs, D × n.
    pub relative: Matrix,
    /// Linear stiffness, D × D: N/m, N/rad, N·m/m, N·m/rad.
    pub stiffness: Matrix,
    /// Linear viscous damping, D × D.
    pub damping: Matrix,
    /// The laws on each relative DOF beside the linear one, D of them.
    pub laws: Vec<DofLaws>,
    /// The same over the preload, where the joint follows one; what stands above is then that at one preload.
    pub over_preload: Option<Box<LawOverPreload>>,
}

impl AssemblyJoint {
    /// Its degrees of freedom that have forces beside those of the linear law at one preload, with their laws.
    pub fn with_laws(&self) -> impl Iterator<Item = (usize, &DofLaws)> {
        let follows = self.over_preload.is_some();
        let all = self.laws.iter().enumerate();
        all.filter(move |(_, laws)| follows || !laws.are_none())
    }
}

impl Assembly {
    /// The laws beside the linear ones, on each DOF that has any, joint by joint; of a joint over the preload on all of its DOFs.
    pub fn laws(&self) -> impl Iterator<Item = &DofLaws> {
        let all = self.joints.iter().flat_map(AssemblyJoint::with_laws);
        all.map(|(_, laws)| laws)
    }

    /// The joints over the preload, in their order.
    pub fn over_preload(&self) -> impl Iterator<Item = &LawOverPreload> {
        self.joints
            .iter()
            .filter_map(|joint| joint.over_preload.as_deref())
    }

    /// The same assembly with these preloads (N·m), one for each joint over the preload, as those at which the linear part is.
    #[must_use]
    pub fn about(&self, preloads_n_m: &[f64]) -> Self {
        let mut assembly = self.clone();
        let mut preloads = preloads_n_m.iter();
        for joint in &mut assembly.joints {
            let Some(own) = &joint.over_preload else {
                continue;
            };
            let Some(&preload_n_m) = preloads.next() else {
                break;
            };
            let (law, count) = (own.law(preload_n_m), joint.laws.len());
            let matrix = |own: &[[f64; SPACE_COUNT]; SPACE_COUNT]| {
                Matrix::from_fn(count, count, |i, j| own[i][j])
            };
            joint.stiffness = matrix(&law.linear.stiffness);
            joint.damping = matrix(&law.linear.damping);
            joint.laws.copy_from_slice(&law.on[..count]);
        }
        assembly
    }

    /// The laws of the joints over the preload at these preloads (N·m).
    #[must_use]
    pub fn laws_at(&self, preloads_n_m: &[f64]) -> Vec<JointLaw<SPACE_COUNT>> {
        let pairs = self.over_preload().zip(preloads_n_m);
        pairs
            .map(|(own, &preload_n_m)| own.law(preload_n_m))
            .collect()
    }
}

/// The linear part as a system of first order, and what acts on it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct System {
    /// Number of coordinates.
    pub(super) size: usize,
    /// Number of loads.
    pub(super) loads: usize,
    /// K_q = Ω² + Sᵀ K_j S
    pub(super) stiffness: Matrix,
    /// C_q = C + Sᵀ C_j S
    pub(super) damping: Matrix,
    /// Bᵀ, m × n.
    pub(super) load_rows: Matrix,
    /// Rows of S for the DOFs that have laws beside the linear one, d × n.
    pub(super) rows: Matrix,
    /// The laws on these DOFs.
    pub(super) laws: LawsAt,
    /// Which of them have a law whose load depends on how fast it came there.
    pub(super) timed: Vec<usize>,
    /// The joints over the preload among them.
    pub(super) following: Vec<Following>,
    /// S Sᵀ of these DOFs, 1/kg: accelerations by loads.
    pub(super) mobility: Matrix,
    /// Ω², and rows and linear stiffness of each joint, which give the energy faster than K_q.
    squares: Vec<f64>,
    springs: Vec<[Matrix; 2]>,
}

impl System {
    pub(super) fn of(assembly: &Assembly) -> Self {
        let size = assembly.frequencies_rad_per_s.len();
        let squares = |i: usize| assembly.frequencies_rad_per_s[i].powi(2);
        let squares: Vec<f64> = (0..size).map(squares).collect();
        let mut stiffness =
            Matrix::from_fn(size, size, |i, j| if i == j { squares[i] } else { 0.0 });
        let springs = assembly.joints.iter();
        let springs = springs.map(|joint| [joint.relative.clone(), joint.stiffness.clone()]);
        let mut damping = assembly.damping_per_s.clone();
        let mut rows: Vec<&[f64]> = Vec::new();
        let mut laws: Vec<DofLaws> = Vec::new();
        let mut following = Vec::new();
        for joint in &assembly.joints {
            // SᵀKS
            let around = |matrix: &Matrix| {
                let left = joint.relative.transposed().product(matrix);
                left.product(&joint.relative)
            };
            stiffness = stiffness.plus(1.0, &around(&joint.stiffness));
            damping = damping.plus(1.0, &around(&joint.damping));
            if let Some(law) = &joint.over_preload {
                let count = joint.laws.len();
                following.push(Following {
                    law: law.clone(),
                    linear: Linear {
                        stiffness: in_space(&joint.stiffness),
                        damping: in_space(&joint.damping),
                    },
                    first: laws.len(),
                    count,
                });
            }
            for (dof, own) in joint.with_laws() {
                rows.push(joint.relative.row(dof));
                laws.push(*own);
            }
        }
        let rows = Matrix::from_fn(rows.len(), size, |i, j| rows[i][j]);
        Self {
            size,
            loads: assembly.loads.columns(),
            stiffness,
            damping,
            load_rows: assembly.loads.transposed(),
            mobility: rows.product(&rows.transposed()),
            rows,
            timed: (0..laws.len()).filter(|&i| is_timed(&laws[i])).collect(),
            laws: LawsAt::propagated(laws, following.len()),
            following,
            squares,
            springs: springs.collect(),
        }
    }

    /// G with Gᵀ G = K_q: Ω, and under it Lᵀ S of each joint with K_j = L Lᵀ. `None` where a joint's stiffness is not positive.
    pub(super) fn stiffness_factor(&self) -> Option<Matrix> {
        let count: usize = self.springs.iter().map(|[rows, _]| rows.rows()).sum();
        let mut factor = Matrix::zeros(self.size + count, self.size);
        for (i, square) in self.squares.iter().enumerate() {
            factor[(i, i)] = square.sqrt();
        }
        let mut top = self.size;
        for [rows, stiffness] in &self.springs {
            let lower = stiffness.cholesky()?;
            factor.set_block([top, 0], &lower.transposed().product(rows));
            top += rows.rows();
        }
        Some(factor)
    }

    /// Number of DOFs that have forces of laws, d.
    pub(super) fn forces(&self) -> usize {
        self.laws.on.len()
    }

    /// (q̇, q̈) at (q, q̇) where nothing acts but the linear part.
    pub(super) fn rates(&self, state: &[f64], rates: &mut [f64]) {
        let (q, velocities) = state.split_at(self.size);
        let (first, second) = rates.split_at_mut(self.size);
        first.copy_from_slice(velocities);
        for (i, acceleration) in second.iter_mut().enumerate() {
            let load = dot(self.stiffness.row(i), q) + dot(self.damping.row(i), velocities);
            *acceleration = -load;
        }
    }

    /// Energy of structures and joints, J.
    pub(super) fn stored_energy(&self, state: &AssemblyState) -> f64 {
        let laws = self.laws.on.iter().zip(&state.memory).enumerate();
        let of_laws: f64 = laws
            .map(|(i, (laws, memory))| {
                let r = dot(self.rows.row(i), &state.motion[..self.size]);
                laws.stored_energy(memory, r)
            })
            .sum();
        self.linear_energy(&state.motion) + of_laws
    }

    /// ½ q̇ᵀq̇ + ½ qᵀ K_q q, J.
    pub(super) fn linear_energy(&self, state: &[f64]) -> f64 {
        let (q, rates) = state.split_at(self.size);
        let pairs = q.iter().zip(&self.squares);
        let strain: f64 = pairs.map(|(q, square)| square * q * q).sum();
        let of_joint = |[rows, stiffness]: &[Matrix; 2]| -> f64 {
            let mut r = [0.0; SPACE_COUNT];
            for (i, r) in r.iter_mut().enumerate().take(rows.rows()) {
                *r = dot(rows.row(i), q);
            }
            let r = &r[..rows.rows().min(SPACE_COUNT)];
            let of_row = |(i, own): (usize, &f64)| own * dot(stiffness.row(i), r);
            r.iter().enumerate().map(of_row).sum()
        };
        let joints: f64 = self.springs.iter().map(of_joint).sum();
        0.5 * (dot(rates, rates) + strain + joints)
    }
}

/// All laws but LuGre's know places alone.
fn is_timed(laws: &DofLaws) -> bool {
    let name = <LuGre as Law<f64>>::DECLARATION.name;
    laws.present().any(|law| law.name == name)
}

/// A matrix of a joint as that of a joint in space, with zeros for what it has not.
fn in_space(matrix: &Matrix) -> [[f64; SPACE_COUNT]; SPACE_COUNT] {
    let has = |i: usize| i < matrix.rows();
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            if has(i) && has(j) {
                matrix[(i, j)]
            } else {
                0.0
            }
        })
    })
}
