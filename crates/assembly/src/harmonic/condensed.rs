//! The assembly as its nonlinear joints feel it: what is linear is condensed to their relative motions.
//!
//! With G = (Ω² + jνC − ν² − jν 2ζω)⁻¹ of the structures, D = K + jνC of all joints and r = S q:
//!
//! r = H_ru u − H_rr f,  H_rr = (I + G_rr D)⁻¹ G_rr,  H_ru = (I + G_rr D)⁻¹ G_ru
//!
//! so that Z r + f = p with Z = H_rr⁻¹ and p = Z H_ru u, on the DOFs that have laws alone. 2ζω takes damping from all masses alike
//! (nonlinear modes, M. Krack, Comput. Struct. 154 (2015) 59); it is zero of forced motion.

use bolted_joint_dynamics::law::{DofLaws, Law, LuGre};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::error::AssemblyError;
use crate::linear::Joints;
use crate::model::AssemblyModel;

/// What does not depend on the frequency.
#[derive(Clone, Debug)]
pub(super) struct Condensed<'m> {
    model: &'m AssemblyModel,
    /// K and C of the linear laws.
    joints: Joints,
    /// All relative motions, S.
    relative: DMatrix<Complex64>,
    /// Places of the DOFs that have laws beside the linear one among all relative motions, and these laws.
    pub(super) laws: Vec<(usize, DofLaws)>,
    inputs: DMatrix<Complex64>,
    outputs: DMatrix<Complex64>,
}

/// The assembly at one frequency.
#[derive(Clone, Debug)]
pub(super) struct Dynamic {
    /// Z on the DOFs that have laws.
    pub(super) stiffness: DMatrix<Complex64>,
    /// p.
    pub(super) load: DVector<Complex64>,
    /// Motion of the outputs by the loads u alone, and by the laws' forces f.
    outputs_by_load: DVector<Complex64>,
    outputs_by_forces: DMatrix<Complex64>,
}

impl Dynamic {
    /// What the laws' forces do to an output.
    pub(super) fn by_forces(&self, output: usize) -> DMatrix<Complex64> {
        self.outputs_by_forces.rows(output, 1).into_owned()
    }

    /// Motion of the outputs at the laws' forces.
    pub(super) fn outputs(&self, forces: &DVector<Complex64>) -> DVector<Complex64> {
        &self.outputs_by_load + &self.outputs_by_forces * forces
    }
}

/// Where the assembly is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct At {
    /// ν, rad/s.
    pub(super) frequency_rad_per_s: f64,
    /// 2ζω, 1/s.
    pub(super) released_per_s: f64,
}

impl<'m> Condensed<'m> {
    pub(super) fn of(model: &'m AssemblyModel) -> Result<Self, AssemblyError> {
        let equations = model.equations()?;
        let mut laws = Vec::new();
        let mut first = 0;
        for (joint, placed) in equations.joints.iter().zip(&model.joints) {
            let mut present = joint.laws.iter().flat_map(DofLaws::present);
            let rate_dependent = <LuGre as Law<f64>>::DECLARATION.name;
            if let Some(law) = present.find(|law| law.name == rate_dependent) {
                return Err(AssemblyError::Rate {
                    name: placed.name.clone(),
                    law: law.name.to_owned(),
                });
            }
            laws.extend(joint.with_laws().map(|(dof, laws)| (first + dof, *laws)));
            first += joint.laws.len();
        }
        let joints = model.linear_joints(&equations);
        Ok(Self {
            model,
            relative: joints.relative.map(Complex64::from),
            joints,
            laws,
            inputs: model.input_rows().transpose().map(Complex64::from),
            outputs: model.output_rows().map(Complex64::from),
        })
    }

    /// Number of loads.
    pub(super) fn loads(&self) -> usize {
        self.inputs.ncols()
    }

    /// The assembly at a frequency under these loads; `None` where it has no finite motion.
    pub(super) fn at(&self, at: At, loads: &DVector<Complex64>) -> Option<Dynamic> {
        let nu = at.frequency_rad_per_s;
        let relative = &self.relative;
        let motion =
            |loads: &DMatrix<Complex64>| self.model.motion_released(nu, at.released_per_s, loads);
        let by_joints = motion(&relative.transpose())?;
        let loads = DMatrix::from_columns(&[&self.inputs * loads]);
        let by_load = match loads.iter().all(|own| *own == Complex64::ZERO) {
            true => loads,
            false => motion(&loads)?,
        };
        let size = relative.nrows();
        let dynamic = DMatrix::from_fn(size, size, |i, j| {
            Complex64::new(
                self.joints.stiffness[(i, j)],
                nu * self.joints.damping[(i, j)],
            )
        });
        let own = relative * &by_joints;
        let closed = (DMatrix::identity(size, size) + &own * &dynamic).lu();
        // relative motions of all joints by u and by f on the DOFs that have laws
        let places: Vec<usize> = self.laws.iter().map(|&(place, _)| place).collect();
        let forces = DMatrix::from_fn(size, places.len(), |i, j| {
            Complex64::from(f64::from(u8::from(places[j] == i)))
        });
        let r_by_load = closed.solve(&(relative * &by_load))?;
        let r_by_forces = -closed.solve(&(&own * &forces))?;
        let receptance = DMatrix::from_fn(places.len(), places.len(), |i, j| {
            -r_by_forces[(places[i], j)]
        });
        let stiffness = receptance.try_inverse()?;
        let free = DVector::from_fn(places.len(), |i, _| r_by_load[(places[i], 0)]);
        let onto = &self.outputs * &by_joints;
        let outputs_by_load = &self.outputs * by_load - &onto * (&dynamic * r_by_load);
        Some(Dynamic {
            load: &stiffness * free,
            stiffness,
            outputs_by_load: outputs_by_load.column(0).into_owned(),
            outputs_by_forces: -&onto * (&dynamic * r_by_forces + forces),
        })
    }
}
