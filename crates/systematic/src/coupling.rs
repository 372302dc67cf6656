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
    /// Mass at DOFs of A (below n) and B, kg, or moment of inertia, kg·m².
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
    pub(crate) q: ComplexMatrix,
    /// What a change of H_A does, joint and points: dH^C = Z_Aᵀ dH_A Z_A.
    through_a: ComplexMatrix,
    /// The same of H_B.
    through_b: ComplexMatrix,
    joint: DynamicStiffness,
}

impl Coupled {
    /// At the points of B and then of A: Y = diag(H_A,jj, H_B,jj), G = [0 H_A,jp; H_B,jp 0], X = D Q:
    /// H^C = diag(H_B,pp, H_A,pp) − Gᵀ X; K* is never inverted. `None` where I + Y D is singular.
    pub(crate) fn of(
        a: &ComplexMatrix,
        b: &ComplexMatrix,
        joint: DynamicStiffness,
    ) -> Option<Self> {
        let n = joint.stiffness.nrows();
        let (of_b, of_a) = (b.nrows() - n, a.nrows() - n);
        let points = of_b + of_a;
        // where a structure's joint and points begin
        let places = [(a, 0, of_b, of_a), (b, n, 0, of_b)];
        let mut free = ComplexMatrix::zeros(2 * n, 2 * n);
        let mut transfer = ComplexMatrix::zeros(2 * n, points);
        let mut apart = ComplexMatrix::zeros(points, points);
        for (own, dof, point, count) in places {
            let put = |to: &mut ComplexMatrix, at, from, size| {
                to.view_mut(at, size).copy_from(&own.view(from, size));
            };
            put(&mut free, (dof, dof), (0, 0), (n, n));
            put(&mut transfer, (dof, point), (0, n), (n, count));
            put(&mut apart, (point, point), (n, n), (count, count));
        }
        let mut system = &free * &joint.matrix;
        for i in 0..2 * n {
            system[(i, i)] += 1.0;
        }
        let q = system.lu().solve(&transfer)?;
        let x = &joint.matrix * &q;
        let receptance = apart - transfer.transpose() * &x;
        if !receptance
            .iter()
            .all(|value| value.re.is_finite() && value.im.is_finite())
        {
            return None;
        }
        let [through_a, through_b] = places.map(|(_, dof, point, count)| {
            let mut through = ComplexMatrix::zeros(n + count, points);
            through.rows_mut(0, n).copy_from(&-x.rows(dof, n));
            for own in 0..count {
                through[(n + own, point + own)] = Complex64::from(1.0);
            }
            through
        });
        Some(Self {
            receptance,
            q,
            through_a,
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

    /// What follows a change of a structure's receptances at joint and points.
    pub(crate) fn by_structure(&self, is_a: bool, change: &ComplexMatrix) -> ComplexMatrix {
        let through = self.through(is_a);
        through.transpose() * change * through
    }

    /// Z: joint and points of the structure × points of both.
    pub(crate) fn through(&self, is_a: bool) -> &ComplexMatrix {
        if is_a {
            &self.through_a
        } else {
            &self.through_b
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two masses on springs, m₁ on a spring to the ground, m₂ on one, and the point on a third mass behind m₂.
    const OMEGA: f64 = 7.0;

    fn joint(k: f64, eta: f64, mass_kg: f64) -> DynamicStiffness {
        let shape = JointShape {
            dofs: 1,
            dofs_of_a_bolt: 1,
            entries: vec![vec![(0, 0)]],
        };
        let masses = [(1, mass_kg)];
        let joint = JointValues {
            unknowns: &[k, 2.0],
            loss_factor: eta,
            masses: &masses,
        };
        DynamicStiffness::of(&shape, &joint, OMEGA)
    }

    /// Both structures seen at their masses at the joint and, in this order, at the third mass and at the first.
    #[test]
    fn points_on_both_sides_are_those_of_one_matrix() {
        let (a, b) = structures();
        // the mass of A at the joint is a point, too
        let a = ComplexMatrix::from_element(2, 2, a[(0, 0)]);
        let coupled = Coupled::of(&a, &b, joint(700.0, 0.1, 0.3)).unwrap();
        let whole = whole_matrix(700.0, 0.1, 0.3).try_inverse().unwrap();
        let places = [2, 0];
        for (i, p) in places.into_iter().enumerate() {
            for (j, q) in places.into_iter().enumerate() {
                let (found, expected) = (coupled.receptance[(i, j)], whole[(p, q)]);
                assert!((found - expected).norm() < 1e-12 * expected.norm());
            }
        }
        // a change of either structure moves all of them
        for (is_a, size) in [(true, 2), (false, 2)] {
            let change = ComplexMatrix::from_fn(size, size, |i, j| {
                Complex64::new(1e-8 * (1 + i * j) as f64, 2e-8 * (i + j) as f64)
            });
            let moved = |sign: f64| {
                let part = &change * Complex64::from(sign);
                let (a, b) = if is_a {
                    (&a + part, b.clone())
                } else {
                    (a.clone(), &b + part)
                };
                Coupled::of(&a, &b, joint(700.0, 0.1, 0.3))
                    .unwrap()
                    .receptance
            };
            let by = (moved(1.0) - moved(-1.0)) / Complex64::from(2.0);
            let found = coupled.by_structure(is_a, &change);
            assert!((found - &by).norm() < 1e-6 * by.norm(), "{is_a}");
        }
    }

    fn structures() -> (ComplexMatrix, ComplexMatrix) {
        let square = OMEGA * OMEGA;
        let a = Complex64::new(900.0 - 3.0 * square, 4.0).inv();
        let stiffness = ComplexMatrix::from_row_slice(
            2,
            2,
            &[
                Complex64::new(500.0 - 2.0 * square, 3.0),
                Complex64::new(-500.0, -3.0),
                Complex64::new(-500.0, -3.0),
                Complex64::new(500.0 - 5.0 * square, 3.0),
            ],
        );
        (
            ComplexMatrix::from_element(1, 1, a),
            stiffness.try_inverse().unwrap(),
        )
    }

    /// The same by one matrix of all three masses.
    fn whole(k: f64, eta: f64, mass_kg: f64) -> Complex64 {
        whole_matrix(k, eta, mass_kg).try_inverse().unwrap()[(2, 2)]
    }

    fn whole_matrix(k: f64, eta: f64, mass_kg: f64) -> ComplexMatrix {
        let square = OMEGA * OMEGA;
        let joint = Complex64::new(k, k * eta + 2.0 * OMEGA);
        let zero = Complex64::from(0.0);
        let spring = Complex64::new(500.0, 3.0);
        ComplexMatrix::from_row_slice(
            3,
            3,
            &[
                Complex64::new(900.0 - 3.0 * square, 4.0) + joint,
                -joint,
                zero,
                -joint,
                spring - (2.0 + mass_kg) * square + joint,
                -spring,
                zero,
                -spring,
                spring - 5.0 * square,
            ],
        )
    }

    #[test]
    fn the_assembly_and_its_derivatives_are_those_of_one_matrix() {
        let (a, b) = structures();
        let (k, eta, mass_kg) = (700.0, 0.1, 0.3);
        let coupled = Coupled::of(&a, &b, joint(k, eta, mass_kg)).unwrap();
        let close = |found: Complex64, expected: Complex64, to: f64| {
            assert!(
                (found - expected).norm() < to * expected.norm(),
                "{found}, not {expected}"
            );
        };
        close(coupled.receptance[(0, 0)], whole(k, eta, mass_kg), 1e-12);
        let by = |above: Complex64, below: Complex64, width: f64| (above - below) / width;
        let by_stiffness = coupled.by_stiffness(&[(0, 0)], (0, 0)) * Complex64::new(1.0, eta);
        close(
            by_stiffness,
            by(
                whole(k + 0.1, eta, mass_kg),
                whole(k - 0.1, eta, mass_kg),
                0.2,
            ),
            1e-6,
        );
        let by_eta = by(
            whole(k, eta + 1e-4, mass_kg),
            whole(k, eta - 1e-4, mass_kg),
            2e-4,
        );
        close(coupled.by_loss_factor()[(0, 0)], by_eta, 1e-6);
        let by_mass = by(
            whole(k, eta, mass_kg + 1e-4),
            whole(k, eta, mass_kg - 1e-4),
            2e-4,
        );
        close(coupled.by_mass(1, OMEGA)[(0, 0)], by_mass, 1e-6);
        // a change of either structure
        for is_a in [true, false] {
            let size = if is_a { 1 } else { 2 };
            let change = ComplexMatrix::from_fn(size, size, |i, j| {
                Complex64::new(1e-8, 2e-8 * (i + j) as f64)
            });
            let moved = |sign: f64| {
                let part = &change * Complex64::from(sign);
                let (a, b) = if is_a {
                    (&a + part, b.clone())
                } else {
                    (a.clone(), &b + part)
                };
                Coupled::of(&a, &b, joint(k, eta, mass_kg))
                    .unwrap()
                    .receptance[(0, 0)]
            };
            close(
                coupled.by_structure(is_a, &change)[(0, 0)],
                by(moved(1.0), moved(-1.0), 2.0),
                1e-6,
            );
        }
    }
}
