//! Two substructures and the massless joint between them make an assembly (Tol section 3.2).

use nalgebra::DMatrix;
use num_complex::Complex64;
use thiserror::Error;

/// A matrix of receptances or complex stiffnesses at one frequency.
pub type ComplexMatrix = DMatrix<Complex64>;

/// I + K*(H_jj + H_kk) is singular: the undamped assembly resonates exactly at this line.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("the assembly resonates without damping at this line; add damping or leave the line out")]
pub struct SingularAssembly;

/// Receptances of one substructure at one frequency, split into joint DOFs and the other points.
#[derive(Clone, Debug, PartialEq)]
pub struct Partition {
    /// H_jj of A or H_kk of B: joint × joint.
    pub joint: ComplexMatrix,
    /// H_jr or H_ks: joint × points.
    pub joint_points: ComplexMatrix,
    /// H_rj or H_sk: points × joint.
    pub points_joint: ComplexMatrix,
    /// H_rr or H_ss: points × points.
    pub points: ComplexMatrix,
}

/// Receptances of the assembly at one frequency; `r` are points of A, `s` points of B.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    /// H^C_rr.
    pub rr: ComplexMatrix,
    /// H^C_rs.
    pub rs: ComplexMatrix,
    /// H^C_sr.
    pub sr: ComplexMatrix,
    /// H^C_ss.
    pub ss: ComplexMatrix,
}

impl Partition {
    /// Splits a receptance matrix whose first `joint_dofs` rows and columns are the joint's.
    #[must_use]
    pub fn of(receptance: &ComplexMatrix, joint_dofs: usize) -> Self {
        let points = receptance.nrows() - joint_dofs;
        let block = |start: (usize, usize), shape: (usize, usize)| {
            receptance.view(start, shape).into_owned()
        };
        Self {
            joint: block((0, 0), (joint_dofs, joint_dofs)),
            joint_points: block((0, joint_dofs), (joint_dofs, points)),
            points_joint: block((joint_dofs, 0), (points, joint_dofs)),
            points: block((joint_dofs, joint_dofs), (points, points)),
        }
    }
}

/// Z⁻¹ with Z = H_jj + H_kk + K*⁻¹: the load that the joint passes on for a unit gap between the free substructures.
///
/// Computed as (I + K*(H_jj + H_kk))⁻¹ K*, which needs no inverse of the joint: K* may be singular or zero.
///
/// # Errors
/// [`SingularAssembly`] at an undamped resonance of the assembly.
pub fn transmission(
    a: &ComplexMatrix,
    b: &ComplexMatrix,
    joint: &ComplexMatrix,
) -> Result<ComplexMatrix, SingularAssembly> {
    let size = joint.nrows();
    let loop_gain = ComplexMatrix::identity(size, size) + joint * (a + b);
    loop_gain.lu().solve(joint).ok_or(SingularAssembly)
}

/// Receptances of the assembly of A and B through a joint of complex stiffness K* = K + jωC.
///
/// # Errors
/// [`SingularAssembly`] at an undamped resonance of the assembly.
pub fn couple(
    a: &Partition,
    b: &Partition,
    joint: &ComplexMatrix,
) -> Result<Assembly, SingularAssembly> {
    let z_inverse = transmission(&a.joint, &b.joint, joint)?;
    Ok(Assembly {
        // H^C_rr = H_rr − H_rj Z⁻¹ H_jr   (Tol 3.12)
        rr: &a.points - &a.points_joint * &z_inverse * &a.joint_points,
        // H^C_rs = H_rj Z⁻¹ H_ks   (Tol 3.13)
        rs: &a.points_joint * &z_inverse * &b.joint_points,
        // H^C_sr = H_sk Z⁻¹ H_jr   (Tol 3.16)
        sr: &b.points_joint * &z_inverse * &a.joint_points,
        // H^C_ss = H_ss − H_sk Z⁻¹ H_ks   (Tol 3.17)
        ss: &b.points - &b.points_joint * &z_inverse * &b.joint_points,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::SpatialModel;
    use nalgebra::{DVector, dmatrix, dvector};

    fn model(mass: DVector<f64>, damping: DMatrix<f64>, stiffness: DMatrix<f64>) -> SpatialModel {
        SpatialModel::new(DMatrix::from_diagonal(&mass), damping, stiffness).unwrap()
    }

    #[test]
    fn the_coupled_chain_is_the_chain_assembled_directly() {
        // Tol Table 4.1; A is ground–m1–m2, B is m3–m4–ground, joint 2000 N/m and 3 N·s/m between m2 and m3.
        // Order of DOFs: the joint's first.
        let a = model(
            dvector![3.0, 5.0],
            dmatrix![4.0, -4.0; -4.0, 7.0],
            dmatrix![3500.0, -3500.0; -3500.0, 6000.0],
        );
        let b = model(
            dvector![4.0, 2.0],
            dmatrix![2.0, -2.0; -2.0, 3.0],
            dmatrix![2000.0, -2000.0; -2000.0, 4500.0],
        );
        let whole = model(
            dvector![5.0, 3.0, 4.0, 2.0],
            dmatrix![7.0, -4.0, 0.0, 0.0; -4.0, 7.0, -3.0, 0.0; 0.0, -3.0, 5.0, -2.0; 0.0, 0.0, -2.0, 3.0],
            dmatrix![6000.0, -3500.0, 0.0, 0.0; -3500.0, 5500.0, -2000.0, 0.0; 0.0, -2000.0, 4000.0, -2000.0; 0.0, 0.0, -2000.0, 4500.0],
        );
        for frequency_hz in [0.5, 2.6, 4.7, 7.77, 8.4, 20.0] {
            let omega = std::f64::consts::TAU * frequency_hz;
            let joint = ComplexMatrix::from_element(1, 1, Complex64::new(2000.0, 3.0 * omega));
            let assembly = couple(
                &Partition::of(&a.receptance(frequency_hz).unwrap(), 1),
                &Partition::of(&b.receptance(frequency_hz).unwrap(), 1),
                &joint,
            )
            .unwrap();
            let direct = whole.receptance(frequency_hz).unwrap();
            for (found, place) in [
                (&assembly.rr, (0, 0)),
                (&assembly.rs, (0, 3)),
                (&assembly.sr, (3, 0)),
                (&assembly.ss, (3, 3)),
            ] {
                let error = (found[(0, 0)] - direct[place]).norm() / direct[place].norm();
                assert!(error < 1e-11, "{frequency_hz} Hz {place:?}: {error}");
            }
        }
    }

    #[test]
    fn a_joint_without_stiffness_leaves_the_substructures_alone() {
        let unit = ComplexMatrix::from_element(2, 2, Complex64::new(1e-6, -1e-8));
        let part = Partition::of(&unit, 1);
        let assembly = couple(&part, &part, &ComplexMatrix::zeros(1, 1)).unwrap();
        assert_eq!(assembly.ss, part.points);
        assert_eq!(assembly.rs, ComplexMatrix::zeros(1, 1));
    }
}
