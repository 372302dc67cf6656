//! What the estimator works on: receptances of the substructures and of the assembly, line by line.

use nalgebra::DMatrix;
use num_complex::Complex64;

use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::{ComplexMatrix, Partition, SingularAssembly, transmission};

use super::model::JointMatrices;
use super::parallel;
use super::receptances::Receptances;
use super::roughness::{Roughness, ShownNoise};

/// Receptances at the lines of one frequency axis.
#[derive(Clone, Debug)]
pub struct Lines {
    /// Frequency of each line, Hz.
    pub frequency_hz: Vec<f64>,
    /// H_jj of A.
    pub a: Receptances,
    /// H_kk, H_ks, H_sk, H_ss of B: the joint's DOFs, then the points.
    pub b: Receptances,
    /// Both apart, each at the joint's DOFs and its own points, where `b` is both as one: the assembly was measured on A, too.
    pub apart: Option<[Receptances; 2]>,
    /// H^C_ss at each line.
    pub assembly: Vec<ComplexMatrix>,
    /// Points at which the assembly was measured, those of B and then those of A: rows and columns of H^C_ss.
    pub points: Vec<Dof>,
    /// Entries (row, column) of H^C_ss that were measured; the others follow from them by reciprocity.
    pub measured: Vec<(usize, usize)>,
    /// Variance of each of `measured` at each line as a fraction of |H|², where it is known line by line.
    pub relative_variance: Option<Vec<Vec<f64>>>,
    /// Scatter of repeated measurements of the assembly, of which `assembly` is the mean.
    pub repeats: Option<Repeats>,
    /// What each of `measured` shows of its noise.
    pub shown: ShownNoise,
}

/// Repeated measurements of the same functions.
#[derive(Clone, Debug)]
pub struct Repeats {
    /// Measurements of each function.
    pub count: u32,
    /// Σ|y − mean|² over them at each line.
    pub scatter: Vec<DMatrix<f64>>,
}

impl Lines {
    /// The measured entries that are not the exact copy of their transpose, as reciprocity fills them in.
    #[must_use]
    pub fn independent(&self) -> Vec<(usize, usize)> {
        let is_symmetric = |p, q| {
            self.assembly
                .iter()
                .all(|matrix| matrix[(p, q)] == matrix[(q, p)])
        };
        independent(&self.measured, is_symmetric)
    }

    /// Noise of each of `measured`, as it shows by itself.
    pub(super) fn roughness(&self) -> &[Roughness] {
        self.shown.functions(|| self.find_roughness())
    }

    fn find_roughness(&self) -> Vec<Roughness> {
        let all: Vec<usize> = (0..self.measured.len()).collect();
        parallel::map(&all, |&index| {
            let place = self.measured[index];
            let values: Vec<Complex64> = self.assembly.iter().map(|matrix| matrix[place]).collect();
            let known = self.relative_variance.as_ref();
            let known = known.and_then(|known| known.get(index).map(Vec::as_slice));
            Roughness::of(&self.frequency_hz, &values, known)
        })
    }

    /// Floor of the noise of a measured entry, as it shows by itself: in the entry's unit; zero if it was not measured.
    pub(super) fn floor(&self, place: (usize, usize)) -> f64 {
        let index = self.measured.iter().position(|other| *other == place);
        index.map_or(0.0, |index| {
            self.shown.floors(|| self.find_roughness())[index]
        })
    }

    /// Every so many lines, so that at most `most` are left.
    pub(super) fn at_most(&self, most: usize) -> Self {
        let stride = self.frequency_hz.len().div_ceil(most.max(1)).max(1);
        let lines: Vec<usize> = (0..self.frequency_hz.len()).step_by(stride).collect();
        self.at_lines(&lines)
    }

    /// These lines. The noise is as all lines show it.
    pub(super) fn at_lines(&self, lines: &[usize]) -> Self {
        let known = self.relative_variance.as_ref();
        Self {
            frequency_hz: chosen(&self.frequency_hz, lines),
            a: self.a.at_lines(lines),
            b: self.b.at_lines(lines),
            apart: (self.apart.as_ref())
                .map(|apart| apart.each_ref().map(|own| own.at_lines(lines))),
            assembly: chosen(&self.assembly, lines),
            points: self.points.clone(),
            measured: self.measured.clone(),
            relative_variance: known
                .map(|known| known.iter().map(|known| chosen(known, lines)).collect()),
            repeats: self.repeats.as_ref().map(|repeats| Repeats {
                count: repeats.count,
                scatter: chosen(&repeats.scatter, lines),
            }),
            shown: self.shown.of_fewer_lines(|| self.find_roughness()),
        }
    }

    /// Receptances of A and of B, each at the joint's DOFs and then its own points.
    pub(super) fn structures(&self) -> [&Receptances; 2] {
        self.apart
            .as_ref()
            .map_or([&self.a, &self.b], |apart| apart.each_ref())
    }

    /// DOFs of the joint, those of all bolts; 0 without lines.
    #[must_use]
    pub fn joint_dofs(&self) -> usize {
        self.a.size()
    }

    /// H_kk, H_ks, H_sk, H_ss of B at a line.
    #[must_use]
    pub fn b_at(&self, line: usize) -> Partition {
        Partition::of(&self.b.at(line), self.joint_dofs())
    }

    /// H^C_ss at each line, as coupling with this joint gives it.
    ///
    /// # Errors
    /// [`SingularAssembly`] at an undamped resonance.
    pub fn regenerated(
        &self,
        joint: &JointMatrices,
    ) -> Result<Vec<ComplexMatrix>, SingularAssembly> {
        (0..self.frequency_hz.len())
            .map(|line| {
                let stiffness = joint.complex_stiffness(self.frequency_hz[line]);
                let b = self.b_at(line);
                let z_inverse = transmission(&self.a.at(line), &b.joint, &stiffness)?;
                // H^C_ss = H_ss − H_sk Z⁻¹ H_ks   (Tol 3.17)
                Ok(&b.points - &b.points_joint * z_inverse * &b.joint_points)
            })
            .collect()
    }
}

/// Those of these numbers.
pub(super) fn chosen<T: Clone>(values: &[T], indices: &[usize]) -> Vec<T> {
    indices.iter().map(|&index| values[index].clone()).collect()
}

/// Those of the `measured` entries that are not, bit by bit, their transpose: an analyser that fills the matrix by
/// reciprocity writes such copies, which are no measurements.
pub(super) fn independent(
    measured: &[(usize, usize)],
    is_symmetric: impl Fn(usize, usize) -> bool,
) -> Vec<(usize, usize)> {
    let is_copy = |&(row, column): &(usize, usize)| {
        row > column && measured.contains(&(column, row)) && is_symmetric(row, column)
    };
    let mut independent = measured.to_vec();
    independent.retain(|place| !is_copy(place));
    independent
}
