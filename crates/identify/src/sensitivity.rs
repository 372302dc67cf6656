//! How much each receptance of the assembly depends on each parameter of the joint (Tol figures 4.6, 4.26, 5.14).

use std::f64::consts::TAU;

use num_complex::Complex64;

use bolted_joint_frf::structure::{ComplexMatrix, SingularAssembly};

use super::layout::Layout;
use super::lines::Lines;
use super::model::{JointMatrices, JointModel};

/// H^C_ss at one line and the factors of its derivative, dH^C_ss = −P dK* Q; for any number of bolts.
pub(super) struct Linearised {
    pub(super) assembly: ComplexMatrix,
    left: ComplexMatrix,
    right: ComplexMatrix,
}

impl Linearised {
    /// Of `lines` at one line with this joint.
    pub(super) fn new(
        lines: &Lines,
        line: usize,
        joint: &JointMatrices,
    ) -> Result<Self, SingularAssembly> {
        let stiffness = joint.complex_stiffness(lines.frequency_hz[line]);
        let b = lines.b_at(line);
        let free = &*lines.a.at(line) + &b.joint;
        let unit = ComplexMatrix::identity(free.nrows(), free.ncols());
        // P = H_sk (I + K*H)⁻¹,  Q = (I + H K*)⁻¹ H_ks,  H = H_jj + H_kk
        let left = (&unit + &stiffness * &free)
            .transpose()
            .lu()
            .solve(&b.points_joint.transpose())
            .ok_or(SingularAssembly)?
            .transpose();
        let right = (&unit + &free * &stiffness)
            .lu()
            .solve(&b.joint_points)
            .ok_or(SingularAssembly)?;
        Ok(Self {
            assembly: &b.points - &left * stiffness * &b.joint_points,
            left,
            right,
        })
    }

    /// ∂H^C/∂K*_ij at entry `place` of H^C_ss, for a symmetric K*.
    pub(super) fn by_stiffness(&self, place: (usize, usize), (i, j): (usize, usize)) -> Complex64 {
        let (row, column) = place;
        let mut derivative = self.left[(row, i)] * self.right[(j, column)];
        if i != j {
            derivative += self.left[(row, j)] * self.right[(i, column)];
        }
        -derivative
    }
}

/// Derivatives of one receptance of the assembly by one entry of the joint's matrices, at every line.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// Which bolt, from 0; 0 for all bolts that are alike.
    pub bolt: usize,
    /// Row and column in the bolt's matrices.
    pub entry: (usize, usize),
    /// Row and column of the receptance in H^C_ss.
    pub receptance: (usize, usize),
    /// ∂H^C/∂k at each line; by the damping it is jω times this.
    pub by_stiffness: Vec<Complex64>,
    /// H^C at each line.
    pub assembly: Vec<Complex64>,
    /// Frequency of each line, Hz.
    pub frequency_hz: Vec<f64>,
}

impl Sensitivity {
    /// ∂H^C/∂c at each line.
    #[must_use]
    pub fn by_damping(&self) -> Vec<Complex64> {
        let lines = self.frequency_hz.iter().zip(&self.by_stiffness);
        lines
            .map(|(hz, value)| Complex64::new(0.0, TAU * hz) * value)
            .collect()
    }

    /// |∂H^C/∂k| · `scale` / |H^C| at each line: by which fraction the receptance changes when k changes by the fraction
    /// one of `scale`, to first order.
    #[must_use]
    pub fn relative(&self, scale: f64) -> Vec<f64> {
        let lines = self.by_stiffness.iter().zip(&self.assembly);
        lines
            .map(|(derivative, value)| derivative.norm() * scale / value.norm())
            .collect()
    }
}

/// The sensitivity of each measured receptance of `lines` to each entry of `model`, for each bolt of `joint`.
///
/// # Errors
/// [`SingularAssembly`] at an undamped resonance.
pub fn sensitivities(
    lines: &Lines,
    model: JointModel,
    joint: &JointMatrices,
) -> Result<Vec<Sensitivity>, SingularAssembly> {
    let layout = Layout::of_different(model, joint.stiffness.nrows() / model.dofs());
    to_unknowns(lines, &layout, joint)
}

/// The same to each unknown entry of a layout; that of bolts that are alike acts at all of them.
pub(super) fn to_unknowns(
    lines: &Lines,
    layout: &Layout,
    whole: &JointMatrices,
) -> Result<Vec<Sensitivity>, SingularAssembly> {
    let linearised = (0..lines.frequency_hz.len())
        .map(|line| Linearised::new(lines, line, whole))
        .collect::<Result<Vec<_>, _>>()?;
    let entries = layout.model().entries();
    let mut found = Vec::new();
    for (index, place) in layout.places().into_iter().enumerate() {
        for receptance in lines.independent() {
            let derivative = |line: &Linearised| -> Complex64 {
                let blocks = place.all();
                blocks
                    .map(|block| line.by_stiffness(receptance, block))
                    .sum()
            };
            found.push(Sensitivity {
                bolt: index / entries.len(),
                entry: entries[index % entries.len()],
                receptance,
                by_stiffness: linearised.iter().map(derivative).collect(),
                assembly: linearised
                    .iter()
                    .map(|line| line.assembly[receptance])
                    .collect(),
                frequency_hz: lines.frequency_hz.clone(),
            });
        }
    }
    Ok(found)
}
