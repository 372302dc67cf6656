//! What the estimator works on: receptances of the substructures and of the assembly, line by line.

use num_complex::Complex64;

use crate::frf::Dof;
use crate::structure::{ComplexMatrix, CouplingError, Partition, transmission};

use super::model::JointMatrices;

/// Receptances at the lines of one frequency axis.
#[derive(Clone, Debug)]
pub struct Lines {
    /// Frequency of each line, Hz.
    pub frequency_hz: Vec<f64>,
    /// H_jj of A at each line.
    pub a_joint: Vec<ComplexMatrix>,
    /// H_kk, H_ks, H_sk, H_ss of B at each line.
    pub b: Vec<Partition>,
    /// H^C_ss at each line.
    pub assembly: Vec<ComplexMatrix>,
    /// Points of B at which the assembly was measured: rows and columns of H^C_ss.
    pub points: Vec<Dof>,
    /// Entries (row, column) of H^C_ss that were measured; the others follow from them by reciprocity.
    pub measured: Vec<(usize, usize)>,
}

impl Lines {
    /// Every `stride`th line.
    pub(super) fn thinned(&self, stride: usize) -> Self {
        fn every<T: Clone>(items: &[T], stride: usize) -> Vec<T> {
            items.iter().step_by(stride).cloned().collect()
        }
        Self {
            frequency_hz: every(&self.frequency_hz, stride),
            a_joint: every(&self.a_joint, stride),
            b: every(&self.b, stride),
            assembly: every(&self.assembly, stride),
            points: self.points.clone(),
            measured: self.measured.clone(),
        }
    }

    /// H^C_ss at each line, as coupling with this joint gives it.
    ///
    /// # Errors
    /// [`CouplingError::Singular`] at an undamped resonance.
    pub fn regenerated(&self, joint: &JointMatrices) -> Result<Vec<ComplexMatrix>, CouplingError> {
        (0..self.frequency_hz.len())
            .map(|line| {
                let stiffness = joint.complex_stiffness(self.frequency_hz[line]);
                let b = &self.b[line];
                let z_inverse = transmission(&self.a_joint[line], &b.joint, &stiffness)?;
                // H^C_ss = H_ss − H_sk Z⁻¹ H_ks   (Tol 3.17)
                Ok(&b.points - &b.points_joint * z_inverse * &b.joint_points)
            })
            .collect()
    }

    /// H^C_ss at one line with the two factors of its derivative, dH^C_ss = −P dK* Q.
    pub(super) fn linearised(&self, line: usize, joint: &JointMatrices) -> Option<Linearised> {
        let stiffness = joint.complex_stiffness(self.frequency_hz[line]);
        let b = &self.b[line];
        let free = &self.a_joint[line] + &b.joint;
        let size = stiffness.nrows();
        let unit = ComplexMatrix::identity(size, size);
        // P = H_sk Z⁻¹ K*⁻¹ = H_sk (I + K*H)⁻¹,  Q = K*⁻¹ Z⁻¹ H_ks = (I + H K*)⁻¹ H_ks,  H = H_jj + H_kk:
        // dH^C_ss = H_sk Z⁻¹ d(K*⁻¹) Z⁻¹ H_ks with d(K*⁻¹) = −K*⁻¹ dK* K*⁻¹, free of inverses of K*.
        let left = (&unit + &stiffness * &free)
            .transpose()
            .lu()
            .solve(&b.points_joint.transpose())?
            .transpose();
        let right = (&unit + &free * &stiffness).lu().solve(&b.joint_points)?;
        let assembly = &b.points - &left * stiffness * &b.joint_points;
        Some(Linearised {
            assembly,
            left,
            right,
        })
    }
}

/// H^C_ss of a joint at one line and its derivative −P dK* Q.
pub(super) struct Linearised {
    pub(super) assembly: ComplexMatrix,
    left: ComplexMatrix,
    right: ComplexMatrix,
}

impl Linearised {
    /// Derivative of entry `place` of H^C_ss with respect to the symmetric entry `(i, j)` of K*.
    pub(super) fn sensitivity(&self, place: (usize, usize), (i, j): (usize, usize)) -> Complex64 {
        let (row, column) = place;
        let mut derivative = self.left[(row, i)] * self.right[(j, column)];
        if i != j {
            derivative += self.left[(row, j)] * self.right[(i, column)];
        }
        -derivative
    }
}
