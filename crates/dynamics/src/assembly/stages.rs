//! The stages of a step: how the joints move at Lobatto's nodes, by the state at the beginning, the loads, and the joints' forces
//! at all nodes.
//!
//! With the forces f(θ) = Σ w_p θᵖ/p! through their values fⱼ at the nodes, and R = (S, 0; 0, S):
//!
//! (r, ṙ)ᵢ = R e^{θᵢhA} y + Σ_p θᵢᵖ R (θᵢh) φ_{p+1}(θᵢhA) X w_p
//!
//! These are equations for the forces alone, few as they are: collocation, with the linear part exact.

use super::{
    columns::Columns,
    lobatto::{NODES, THETA, legendre_coefficients, powers},
    matrix::Matrix,
    propagator::{Blocks, POWERS},
    system::System,
};

/// Nodes after the first one.
pub(super) const LATER: usize = NODES - 1;

/// What the nodes of one length of step take.
#[derive(Clone, Debug)]
pub(super) struct Stages {
    /// (r, ṙ) at each node after the first, by the state at the beginning: 4 · 2d × 2n.
    pub(super) by_state: Matrix,
    /// … by the loads' powers of time, 4 · 2d × m.
    pub(super) by_loads: [Matrix; POWERS],
    /// … by the forces at all nodes, 2d × 5d for each.
    pub(super) by_forces: [Columns; LATER],
    /// Moduli of what Legendre's polynomials of the forces make of (r, ṙ) at the end, 2d × d each.
    pub(super) of_legendre: [Matrix; NODES],
}

impl Stages {
    /// By what becomes of a state over the time of each node after the first, and what `rows` (2d × 2n) see of it.
    pub(super) fn of(system: &System, rows: &Matrix, to_nodes: [&Blocks; LATER]) -> Self {
        let (m, d) = (system.loads, system.forces());
        let seen = |of: &dyn Fn(&Blocks, usize) -> Matrix, power: usize| {
            // θᵖ is the p-th power of the node's own time times that of the whole
            let each = to_nodes.iter().zip(&THETA[1..]).map(|(blocks, theta)| {
                rows.product(&of(blocks, power))
                    .times(theta.powi(power as i32))
            });
            Matrix::stacked(each)
        };
        let of_loads = |blocks: &Blocks, power: usize| blocks.of_power(power, 0..m).transposed();
        let of_forces =
            |blocks: &Blocks, power: usize| blocks.of_power(power, m..m + d).transposed();
        let by_powers: [Matrix; POWERS] = std::array::from_fn(|power| seen(&of_forces, power));
        let along = |powers: [f64; POWERS], rows: usize| {
            let zeros = Matrix::zeros(rows, d);
            let pairs = by_powers.iter().zip(powers);
            pairs.fold(zeros, |sum, (block, power)| {
                let top = block.rows() - rows;
                sum.plus(power, &block.block([top, 0], rows, d))
            })
        };
        let mut by_forces = Matrix::zeros(LATER * 2 * d, NODES * d);
        for node in 0..NODES {
            let own = powers(legendre_coefficients(unit(node)));
            by_forces.set_block([0, node * d], &along(own, LATER * 2 * d));
        }
        Self {
            by_state: Matrix::stacked(to_nodes.iter().map(|blocks| blocks.state.seen_by(rows))),
            by_loads: std::array::from_fn(|power| seen(&of_loads, power)),
            by_forces: std::array::from_fn(|node| {
                Columns::of(&by_forces.block([node * 2 * d, 0], 2 * d, NODES * d))
            }),
            of_legendre: std::array::from_fn(|k| along(powers(unit(k)), 2 * d).moduli()),
        }
    }
}

fn unit(place: usize) -> [f64; NODES] {
    std::array::from_fn(|i| if i == place { 1.0 } else { 0.0 })
}
