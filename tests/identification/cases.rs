//! The thesis's beams, coupled through known joints.

use bolted_joint::frf::{Frf, FrfSet};
use bolted_joint::identify::{JointMatrices, Lines, Receptances};
use bolted_joint::structure::{
    Beam, BeamPoint, Boundary, ComplexMatrix, Damping, Motion, Partition, couple,
};
use nalgebra::dmatrix;
use num_complex::Complex64;

/// Tol section 4.2.2: A 0.3 m fixed-free, B 0.225 m free-free, ζ = 0.01 in every mode.
pub(crate) fn beam_4_2_2(length_m: f64, boundary: Boundary) -> Beam {
    Beam {
        length_m,
        width_m: 0.025,
        height_m: 0.006,
        youngs_modulus_pa: 67e9,
        density_kg_per_m3: 2700.0,
        boundary,
        damping: Damping::Ratios(vec![0.01]),
    }
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
        let joint = [Motion::Translation, Motion::Rotation].map(|motion| BeamPoint {
            position_m: joint_m,
            motion,
        });
        let translations = points.iter().map(|&position_m| BeamPoint {
            position_m,
            motion: Motion::Translation,
        });
        let dofs: Vec<BeamPoint> = joint.into_iter().chain(translations).collect();
        let receptances = beam.receptances(&dofs, &frequency_hz).unwrap();
        receptances.iter().map(|h| Partition::of(h, 2)).collect()
    };
    let a = parts(beam_4_2_2(0.3, Boundary::FixedFree), 0.3, on_a);
    let b = parts(beam_4_2_2(0.225, Boundary::FreeFree), 0.0, on_b);
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
        let dof = |point: usize| format!("{}:+Y", point + 1).parse().unwrap();
        let places: Vec<(usize, usize)> = (0..count)
            .flat_map(|row| (0..count).map(move |column| (row, column)))
            .collect();
        let functions = places.iter().map(|&(row, column)| {
            let values = assembly.iter().map(|h| h[(row, column)]).collect();
            Frf::new(dof(row), dof(column), self.frequency_hz.clone(), values).unwrap()
        });
        let clean = FrfSet::new(functions.collect()).unwrap();
        let noisy = bolted_joint::frf::polluted(&clean, relative_noise, seed).unwrap();
        let assembly = (0..self.frequency_hz.len())
            .map(|line| {
                ComplexMatrix::from_fn(count, count, |row, column| -> Complex64 {
                    noisy.receptance(dof(row), dof(column)).unwrap()[line]
                })
            })
            .collect();
        Lines {
            frequency_hz: self.frequency_hz.clone(),
            a: Receptances::Exact(self.a.iter().map(|part| part.joint.clone()).collect()),
            b: Receptances::Exact(self.b.iter().map(whole).collect()),
            assembly,
            points: (0..count).map(dof).collect(),
            measured: places,
            relative_variance: None,
            repeats: None,
        }
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
