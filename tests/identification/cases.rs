//! The thesis's beams, coupled through known joints.

use bolted_joint::frf::{Frf, FrfSet};
use bolted_joint::identify::{JointMatrices, Lines, Receptances};
use bolted_joint::structure::{Beam, Boundary, ComplexMatrix, Partition, couple};
use nalgebra::{DMatrix, dmatrix};
use num_complex::Complex64;

use crate::beams::{beam, joints, names, pairs, translations};

/// Largest error of an entry, relative to √(m_ii m_jj) of its matrix.
pub(crate) fn error(found: &JointMatrices, exact: &JointMatrices) -> f64 {
    let of = |found: &DMatrix<f64>, exact: &DMatrix<f64>| {
        let error = (found - exact)
            .map_with_location(|i, j, error| error.abs() / (exact[(i, i)] * exact[(j, j)]).sqrt());
        error.max()
    };
    of(&found.stiffness, &exact.stiffness).max(of(&found.damping, &exact.damping))
}

/// Joint model 2 of section 4.2.2: 1e5 N/m, 5 N·s/m, 1e3 N·m/rad, 0.05 N·m·s/rad.
pub(crate) fn joint_4_2_2() -> JointMatrices {
    JointMatrices {
        stiffness: dmatrix![1e5, 0.0; 0.0, 1e3],
        damping: dmatrix![5.0, 0.0; 0.0, 0.05],
    }
}

/// Both substructures at each line: A's tip is its joint, B's first end is its joint.
pub(crate) struct Pair {
    pub(crate) frequency_hz: Vec<f64>,
    pub(crate) a: Vec<Partition>,
    pub(crate) b: Vec<Partition>,
}

/// The beams of section 4.2.2 with points on A and B (positions in m, translations).
pub(crate) fn beams_4_2_2(frequency_hz: Vec<f64>, on_a: &[f64], on_b: &[f64]) -> Pair {
    let parts = |beam: Beam, joint_m: f64, points: &[f64]| -> Vec<Partition> {
        let dofs = [joints(&[joint_m]), translations(points)].concat();
        let receptances = beam.receptances(&dofs, &frequency_hz).unwrap();
        receptances.iter().map(|h| Partition::of(h, 2)).collect()
    };
    let a = parts(beam(0.3, Boundary::FixedFree, 0.01), 0.3, on_a);
    let b = parts(beam(0.225, Boundary::FreeFree, 0.01), 0.0, on_b);
    Pair { frequency_hz, a, b }
}

impl Pair {
    /// Lines with the assembly's receptances at the points of B, multiplied by 1 + noise.
    pub(crate) fn lines(&self, joint: &JointMatrices, relative_noise: f64, seed: u64) -> Lines {
        let assembly: Vec<ComplexMatrix> = (0..self.frequency_hz.len())
            .map(|line| {
                let stiffness = joint.complex_stiffness(self.frequency_hz[line]);
                couple(&self.a[line], &self.b[line], &stiffness).unwrap().ss
            })
            .collect();
        let count = self.b[0].points.nrows();
        let (points, places) = (names(count), pairs(count));
        let functions = places.iter().map(|&(row, column)| {
            let values = assembly.iter().map(|h| h[(row, column)]).collect();
            Frf::new(
                points[row],
                points[column],
                self.frequency_hz.clone(),
                values,
            )
            .unwrap()
        });
        let clean = FrfSet::new(functions.collect()).unwrap();
        let noisy = bolted_joint::frf::polluted(&clean, relative_noise, seed).unwrap();
        let assembly = (0..self.frequency_hz.len())
            .map(|line| {
                ComplexMatrix::from_fn(count, count, |row, column| -> Complex64 {
                    noisy.receptance(points[row], points[column]).unwrap()[line]
                })
            })
            .collect();
        Lines {
            frequency_hz: self.frequency_hz.clone(),
            a: Receptances::Exact(self.a.iter().map(|part| part.joint.clone()).collect()),
            b: Receptances::Exact(self.b.iter().map(whole).collect()),
            assembly,
            points,
            measured: places,
            relative_variance: None,
            repeats: None,
            shown: Default::default(),
            apart: None,
        }
    }
}

/// Two beams that overlap, with a bolt at each place of the overlap (m from B's first end), measured at points of B. A's
/// coordinate runs from the clamp to the tip at 0.3 m; B begins 0.1 m before it.
pub(crate) fn bolted(
    at_bolts_m: &[f64],
    points_m: &[f64],
    joint: &JointMatrices,
    frequency_hz: Vec<f64>,
) -> Lines {
    let on_a: Vec<f64> = at_bolts_m.iter().map(|x| 0.2 + x).collect();
    let on_b = [joints(at_bolts_m), translations(points_m)].concat();
    let of = |boundary, points: &[_]| {
        let beam = beam(0.3, boundary, 0.01);
        beam.receptances(points, &frequency_hz).unwrap()
    };
    let a = of(Boundary::FixedFree, &joints(&on_a));
    let b = of(Boundary::FreeFree, &on_b);
    let dofs = 2 * at_bolts_m.len();
    let coupled = frequency_hz
        .iter()
        .zip(a.iter().zip(&b))
        .map(|(&hz, (a, b))| {
            let (a, b) = (Partition::of(a, dofs), Partition::of(b, dofs));
            couple(&a, &b, &joint.complex_stiffness(hz)).unwrap().ss
        });
    let count = points_m.len();
    Lines {
        assembly: coupled.collect(),
        a: Receptances::Exact(a),
        b: Receptances::Exact(b),
        frequency_hz,
        points: names(count),
        measured: pairs(count),
        relative_variance: None,
        repeats: None,
        shown: Default::default(),
        apart: None,
    }
}

/// One of the bolts.
pub(crate) fn bolt(factor: f64) -> JointMatrices {
    JointMatrices {
        stiffness: dmatrix![1e5, 2e3; 2e3, 1e3] * factor,
        damping: dmatrix![5.0, 0.1; 0.1, 0.05] * factor,
    }
}

/// Lines from 1 Hz on.
pub(crate) fn axis(to_hz: f64, step_hz: f64) -> Vec<f64> {
    let count = (to_hz / step_hz).round() as usize;
    (1..=count).map(|line| line as f64 * step_hz).collect()
}

/// The parts in one matrix, the joint first.
fn whole(parts: &Partition) -> ComplexMatrix {
    let (joint, points) = (parts.joint.nrows(), parts.points.nrows());
    ComplexMatrix::from_fn(joint + points, joint + points, |i, j| {
        match (i < joint, j < joint) {
            (true, true) => parts.joint[(i, j)],
            (true, false) => parts.joint_points[(i, j - joint)],
            (false, true) => parts.points_joint[(i - joint, j)],
            (false, false) => parts.points[(i - joint, j - joint)],
        }
    })
}
