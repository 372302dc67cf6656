//! What an assembly is to the integration: structures in coordinates with unit mass, and the joints between them.
//!
//! With q the coordinates, u the loads and r = S q the relative motions of the joints (side a less side b):
//!
//! q̈ + C q̇ + Ω² q = B u − Sᵀ (K_j r + C_j ṙ + f(r, ṙ, memory))

use super::matrix::{Matrix, dot};
use crate::{law::DofLaws, number::Dual};

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
}

impl Assembly {
    /// The laws beside the linear ones, on each DOF that has any, joint by joint.
    pub fn laws(&self) -> impl Iterator<Item = &DofLaws> {
        let all = self.joints.iter().flat_map(|joint| &joint.laws);
        all.filter(|laws| !laws.are_none())
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
    pub(super) laws: Vec<DofLaws>,
    /// S Sᵀ of these DOFs, 1/kg: accelerations by loads.
    mobility: Matrix,
}

impl System {
    pub(super) fn of(assembly: &Assembly) -> Self {
        let size = assembly.frequencies_rad_per_s.len();
        let squares = |i: usize| assembly.frequencies_rad_per_s[i].powi(2);
        let mut stiffness =
            Matrix::from_fn(size, size, |i, j| if i == j { squares(i) } else { 0.0 });
        let mut damping = assembly.damping_per_s.clone();
        let mut rows: Vec<&[f64]> = Vec::new();
        let mut laws = Vec::new();
        for joint in &assembly.joints {
            // SᵀKS
            let around = |matrix: &Matrix| {
                let left = joint.relative.transposed().product(matrix);
                left.product(&joint.relative)
            };
            stiffness = stiffness.plus(1.0, &around(&joint.stiffness));
            damping = damping.plus(1.0, &around(&joint.damping));
            for (dof, own) in joint.laws.iter().enumerate() {
                if !own.are_none() {
                    rows.push(joint.relative.row(dof));
                    laws.push(*own);
                }
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
            laws,
        }
    }

    /// Relative displacements of the DOFs with laws, and then their rates, at coordinates and their rates.
    pub(super) fn relative(&self, state: &[f64], relative: &mut [f64]) {
        let (q, rates) = state.split_at(self.size);
        let (r, velocity) = relative.split_at_mut(self.laws.len());
        for i in 0..self.laws.len() {
            r[i] = dot(self.rows.row(i), q);
            velocity[i] = dot(self.rows.row(i), rates);
        }
    }

    /// ½ q̇ᵀq̇ + ½ qᵀ K_q q, J.
    pub(super) fn linear_energy(&self, state: &[f64]) -> f64 {
        let (q, rates) = state.split_at(self.size);
        let strain: f64 = q
            .iter()
            .enumerate()
            .map(|(i, q)| q * dot(self.stiffness.row(i), q_of(state, self.size)))
            .sum();
        0.5 * (dot(rates, rates) + strain)
    }

    /// The highest frequency (rad/s) that these tangent stiffnesses of the laws alone give the DOFs that have them: an upper
    /// bound of √λmax(S M⁻¹Sᵀ K_t).
    pub(super) fn tangent_frequency(&self, tangents: &[f64]) -> f64 {
        let count = self.laws.len();
        // √K_t (S Sᵀ) √K_t is symmetric and similar to it; its rows' sums bound its eigenvalues
        let row = |i: usize| -> f64 {
            (0..count)
                .map(|j| self.mobility[(i, j)].abs() * (tangents[i] * tangents[j]).abs().sqrt())
                .sum()
        };
        (0..count).map(row).fold(0.0, f64::max).sqrt()
    }

    /// ∂f/∂r of one law at a trial motion.
    pub(super) fn tangent(
        laws: &DofLaws,
        memory: &crate::law::DofMemory,
        r: f64,
        velocity: f64,
    ) -> f64 {
        let laws = DofLaws::new(laws.parameters().map(Dual::<1>::from));
        let load = laws.load(memory, Dual::along(r, 0), Dual::from(velocity));
        load.change[0]
    }
}

fn q_of(state: &[f64], size: usize) -> &[f64] {
    &state[..size]
}
