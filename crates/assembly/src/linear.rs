//! The linear assembly: its receptances and its modes.

use std::f64::consts::TAU;

use bolted_joint_dynamics::assembly::Assembly;
use nalgebra::{DMatrix, SymmetricEigen};
use num_complex::Complex64;

use crate::error::AssemblyError;
use crate::model::AssemblyModel;

/// A mode of the linear assembly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AssemblyMode {
    /// |λ|/2π, Hz.
    pub frequency_hz: f64,
    /// −Re λ/|λ|; below zero where the mode grows.
    pub damping_ratio: f64,
}

/// What rounding makes of an eigenvalue's real part, in units of the largest one's last digit times the size.
const OF_ROUNDING: f64 = 4.0;
/// Damping of a free motion, as a part of the largest that there is, below which it is none.
const UNDAMPED: f64 = 1e-12;

/// K and C of all joints, on the diagonal of blocks, and their relative motions.
#[derive(Clone, Debug)]
pub(crate) struct Joints {
    pub(crate) stiffness: DMatrix<f64>,
    pub(crate) damping: DMatrix<f64>,
    pub(crate) relative: DMatrix<f64>,
}

impl AssemblyModel {
    /// Receptances of the linear assembly, joints of small motion about rest: outputs × inputs at each frequency, m/N and so on.
    ///
    /// # Errors
    /// [`AssemblyError::Resonance`] at an undamped resonance, [`AssemblyError::Law`] where a joint gives no law.
    pub fn receptances(
        &self,
        frequency_hz: &[f64],
    ) -> Result<Vec<DMatrix<Complex64>>, AssemblyError> {
        let joints = self.joints_of_small_motion()?;
        let (inputs, outputs) = (self.input_rows().transpose(), self.output_rows());
        let lines = frequency_hz.iter().map(|&frequency_hz| {
            let found = self.receptance(TAU * frequency_hz, &joints, &inputs, &outputs);
            let is_finite = |found: &DMatrix<Complex64>| found.iter().all(|h| h.is_finite());
            found
                .filter(is_finite)
                .ok_or(AssemblyError::Resonance { frequency_hz })
        });
        lines.collect()
    }

    /// H = L G B − L G Sᵀ D (I + S G Sᵀ D)⁻¹ S G B with G of the structures alone and D = K + jωC: D may be singular or zero.
    fn receptance(
        &self,
        omega: f64,
        joints: &Joints,
        inputs: &DMatrix<f64>,
        outputs: &DMatrix<f64>,
    ) -> Option<DMatrix<Complex64>> {
        let complex = |matrix: &DMatrix<f64>| matrix.map(Complex64::from);
        let relative = complex(&joints.relative);
        let outputs = complex(outputs);
        let by_inputs = self.motion(omega, &complex(inputs))?;
        if relative.nrows() == 0 {
            // without joints each structure moves alone
            return Some(outputs * by_inputs);
        }
        let by_joints = self.motion(omega, &relative.transpose())?;
        let dynamic = DMatrix::from_fn(
            joints.stiffness.nrows(),
            joints.stiffness.ncols(),
            |i, j| Complex64::new(joints.stiffness[(i, j)], omega * joints.damping[(i, j)]),
        );
        let own = &relative * &by_joints;
        let size = own.nrows();
        if size == 0 {
            return Some(outputs * by_inputs);
        }
        let closed = DMatrix::identity(size, size) + own * &dynamic;
        let loads = dynamic * closed.lu().solve(&(&relative * &by_inputs))?;
        Some(&outputs * by_inputs - &outputs * by_joints * loads)
    }

    fn motion(&self, omega: f64, loads: &DMatrix<Complex64>) -> Option<DMatrix<Complex64>> {
        self.motion_released(omega, 0.0, loads)
    }

    /// (Ω² + jω(C − c) − ω²)⁻¹ of each structure times its part of loads on all coordinates, c of all masses alike (1/s).
    pub(crate) fn motion_released(
        &self,
        omega: f64,
        released_per_s: f64,
        loads: &DMatrix<Complex64>,
    ) -> Option<DMatrix<Complex64>> {
        let mut motion = DMatrix::zeros(loads.nrows(), loads.ncols());
        let mut first = 0;
        for structure in &self.structures {
            let count = structure.form.size();
            let own = loads.rows(first, count).into_owned();
            motion
                .rows_mut(first, count)
                .copy_from(&structure.form.motion(omega, released_per_s, &own)?);
            first += count;
        }
        Some(motion)
    }

    /// Modes of the linear assembly, joints of small motion about rest, ascending; motions of a free assembly have 0 Hz.
    ///
    /// # Errors
    /// [`AssemblyError::Law`] where a joint gives no law.
    pub fn modes(&self) -> Result<Vec<AssemblyMode>, AssemblyError> {
        let joints = self.joints_of_small_motion()?;
        let size = self.size();
        let around =
            |matrix: &DMatrix<f64>| joints.relative.transpose() * matrix * &joints.relative;
        let (mut stiffness, mut damping) = (around(&joints.stiffness), around(&joints.damping));
        let mut first = 0;
        for structure in &self.structures {
            let form = &structure.form;
            for i in 0..form.size() {
                stiffness[(first + i, first + i)] += form.frequency_rad_per_s[i].powi(2);
                for j in 0..form.size() {
                    damping[(first + i, first + j)] += form.damping_per_s[(i, j)];
                }
            }
            first += form.size();
        }
        // in (ω_ref q, q̇), so that rates and displacements are alike
        let scale = (0..size)
            .map(|i| stiffness[(i, i)].abs().sqrt())
            .fold(1.0, f64::max);
        let mut system = DMatrix::zeros(2 * size, 2 * size);
        for i in 0..size {
            system[(i, size + i)] = scale;
            for j in 0..size {
                system[(size + i, j)] = -stiffness[(i, j)] / scale;
                system[(size + i, size + j)] = -damping[(i, j)];
            }
        }
        // each free motion has zero twice, or once if it is damped; rounding makes of the two a pair around zero
        let free = self.unstrained_motions()?;
        let is_damped = |own: &&f64| **own > UNDAMPED * damping.amax();
        let damped = match free.ncols() {
            0 => 0,
            _ => {
                let among_them = SymmetricEigen::new(free.transpose() * &damping * &free);
                among_them.eigenvalues.iter().filter(is_damped).count()
            }
        };
        let zeros = 2 * free.ncols() - damped;
        let mut values: Vec<Complex64> = system.complex_eigenvalues().iter().copied().collect();
        values.sort_by(|one, other| one.norm().total_cmp(&other.norm()));
        let moves_freely = AssemblyMode {
            frequency_hz: 0.0,
            damping_ratio: 0.0,
        };
        let digit = OF_ROUNDING * size as f64 * f64::EPSILON * scale;
        let mut modes: Vec<AssemblyMode> = values
            .iter()
            .skip(zeros)
            // one of each pair, and every one that does not oscillate
            .filter(|value| value.im >= 0.0)
            .map(|value| AssemblyMode {
                frequency_hz: value.norm() / TAU,
                damping_ratio: match value.re.abs() <= digit {
                    true => 0.0,
                    false => -value.re / value.norm(),
                },
            })
            .chain(std::iter::repeat_n(moves_freely, free.ncols()))
            .collect();
        modes.sort_by(|one, other| one.frequency_hz.total_cmp(&other.frequency_hz));
        Ok(modes)
    }

    /// The linear laws of all joints alone.
    pub(crate) fn linear_joints(&self, equations: &Assembly) -> Joints {
        let total = equations.joints.iter().map(|joint| joint.laws.len()).sum();
        let mut all = Joints {
            stiffness: DMatrix::zeros(total, total),
            damping: DMatrix::zeros(total, total),
            relative: DMatrix::zeros(total, self.size()),
        };
        let mut first = 0;
        for (own, joint) in equations.joints.iter().zip(&self.joints) {
            let count = own.laws.len();
            let relative = self.relative_rows(joint);
            all.relative.rows_mut(first, count).copy_from(&relative);
            for i in 0..count {
                for j in 0..count {
                    all.stiffness[(first + i, first + j)] = own.stiffness[(i, j)];
                    all.damping[(first + i, first + j)] = own.damping[(i, j)];
                }
            }
            first += count;
        }
        all
    }

    fn joints_of_small_motion(&self) -> Result<Joints, AssemblyError> {
        let counts = self
            .joints
            .iter()
            .map(|joint| joint.file.joint.dofs.count());
        let total = counts.sum();
        let mut all = Joints {
            stiffness: DMatrix::zeros(total, total),
            damping: DMatrix::zeros(total, total),
            relative: DMatrix::zeros(total, self.size()),
        };
        let mut first = 0;
        for joint in &self.joints {
            let relative = self.relative_rows(joint);
            let count = relative.nrows();
            all.relative.rows_mut(first, count).copy_from(&relative);
            let (stiffness, damping) = joint.of_small_motion_about(0.0)?;
            for (whole, own) in [(&mut all.stiffness, stiffness), (&mut all.damping, damping)] {
                whole
                    .view_mut((first, first), (count, count))
                    .copy_from(&own);
            }
            first += count;
        }
        Ok(all)
    }
}
