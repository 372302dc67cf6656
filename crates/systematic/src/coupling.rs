//! Receptances of the assembly at one line, and how they follow from changes of joint and structures.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::experiment::{ComplexMatrix, JointShape};

/// Dynamic stiffness of the joint between the DOFs of A and those of B, 2n × 2n.
#[derive(Clone, Debug)]
pub(crate) struct DynamicStiffness {
    pub(crate) matrix: ComplexMatrix,
    /// K, for what the loss factor does.
    stiffness: DMatrix<f64>,
}

/// What a joint is at one moment of the search.
#[derive(Clone, Debug)]
pub(crate) struct JointValues<'v> {
    /// Stiffness of each unknown entry, then its damping.
    pub(crate) unknowns: &'v [f64],
    /// η
    pub(crate) loss_factor: f64,
    /// Mass at DOFs of A (below n) and B, kg.
    pub(crate) masses: &'v [(usize, f64)],
}

impl DynamicStiffness {
    /// D(ω) = [K* −K*; −K* K*] − ω² diag(m_A, m_B), K* = K (1 + jη) + jωC
    pub(crate) fn of(shape: &JointShape, joint: &JointValues<'_>, omega: f64) -> Self {
        let (n, count) = (shape.dofs, shape.entries.len());
        let (k, c) = joint.unknowns.split_at(count);
        let stiffness = filled(shape, k);
        let damping = filled(shape, c);
        let dynamic = DMatrix::from_fn(n, n, |i, j| {
            Complex64::new(1.0, joint.loss_factor) * stiffness[(i, j)]
                + Complex64::new(0.0, omega * damping[(i, j)])
        });
        let mut matrix = across(&dynamic);
        for &(dof, mass_kg) in joint.masses {
            matrix[(dof, dof)] -= omega * omega * mass_kg;
        }
        Self { matrix, stiffness }
    }
}

fn filled(shape: &JointShape, values: &[f64]) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(shape.dofs, shape.dofs);
    for (places, &value) in shape.entries.iter().zip(values) {
        for &(row, column) in places {
            matrix[(row, column)] = value;
            matrix[(column, row)] = value;
        }
    }
    matrix
}

/// [M −M; −M M]: what acts on the motion across the joint.
fn across(matrix: &ComplexMatrix) -> ComplexMatrix {
    let n = matrix.nrows();
    ComplexMatrix::from_fn(2 * n, 2 * n, |i, j| {
        let value = matrix[(i % n, j % n)];
        if (i < n) == (j < n) { value } else { -value }
    })
}

/// The assembly at one line.
#[derive(Clone, Debug)]
pub(crate) struct Coupled {
    /// H^C_ss
    pub(crate) receptance: ComplexMatrix,
    /// Q = (I + Y D)⁻¹ G, motion at the joint by loads at the points, 2n × p.
    q: ComplexMatrix,
    /// What a change of H_A does: dH^C = Z_Aᵀ dH_A Z_A.
    through_a: ComplexMatrix,
    /// What a change of H_B does, joint and points.
    through_b: ComplexMatrix,
    joint: DynamicStiffness,
}

impl Coupled {
    /// Y = diag(H_A, H_B,jj), G = [0; H_B,jp], X = D Q: H^C = H_B,pp − Gᵀ X; K* is never inverted. `None` where I + Y D is
    /// singular.
    pub(crate) fn of(
        a: &ComplexMatrix,
        b: &ComplexMatrix,
        joint: DynamicStiffness,
    ) -> Option<Self> {
        let n = a.nrows();
        let points = b.nrows() - n;
        let mut free = ComplexMatrix::zeros(2 * n, 2 * n);
        free.view_mut((0, 0), (n, n)).copy_from(a);
        free.view_mut((n, n), (n, n))
            .copy_from(&b.view((0, 0), (n, n)));
        let mut transfer = ComplexMatrix::zeros(2 * n, points);
        transfer
            .view_mut((n, 0), (n, points))
            .copy_from(&b.view((0, n), (n, points)));
        let mut system = &free * &joint.matrix;
        for i in 0..2 * n {
            system[(i, i)] += 1.0;
        }
        let q = system.lu().solve(&transfer)?;
        let x = &joint.matrix * &q;
        let receptance = b.view((n, n), (points, points)) - transfer.transpose() * &x;
        if !receptance
            .iter()
            .all(|value| value.re.is_finite() && value.im.is_finite())
        {
            return None;
        }
        let mut through_b = ComplexMatrix::zeros(n + points, points);
        for point in 0..points {
            for dof in 0..n {
                through_b[(dof, point)] = -x[(n + dof, point)];
            }
            through_b[(n + point, point)] = Complex64::from(1.0);
        }
        Some(Self {
            receptance,
            q,
            through_a: x.rows(0, n).into_owned(),
            through_b,
            joint,
        })
    }

    /// What a change of the joint's dynamic stiffness at (i, j) and (j, i) does, of K* alone: −Qᵀ [E −E; −E E] Q at an entry.
    pub(crate) fn by_stiffness(
        &self,
        places: &[(usize, usize)],
        (row, column): (usize, usize),
    ) -> Complex64 {
        let n = self.joint.stiffness.nrows();
        // motion across the joint
        let across = |dof: usize, point: usize| self.q[(dof, point)] - self.q[(n + dof, point)];
        let one = |&(i, j): &(usize, usize)| {
            let first = across(i, row) * across(j, column);
            if i == j {
                first
            } else {
                first + across(j, row) * across(i, column)
            }
        };
        -places.iter().map(one).sum::<Complex64>()
    }

    /// What a loss factor does: −j Qᵀ [K −K; −K K] Q.
    pub(crate) fn by_loss_factor(&self) -> ComplexMatrix {
        let stiffness = across(&self.joint.stiffness.map(Complex64::from));
        -(self.q.transpose() * stiffness * &self.q) * Complex64::i()
    }

    /// What a mass at a joint's DOF (of A below n) does: ω² q qᵀ.
    pub(crate) fn by_mass(&self, dof: usize, omega: f64) -> ComplexMatrix {
        let q = self.q.row(dof);
        q.transpose() * q * Complex64::from(omega * omega)
    }

    /// What follows a change of A's receptances at the joint, of B's at joint and points.
    pub(crate) fn by_structure(&self, is_a: bool, change: &ComplexMatrix) -> ComplexMatrix {
        let through = self.through(is_a);
        through.transpose() * change * through
    }

    /// Z: n × p for A, (n + p) × p for B.
    pub(crate) fn through(&self, is_a: bool) -> &ComplexMatrix {
        if is_a {
            &self.through_a
        } else {
            &self.through_b
        }
    }
}
