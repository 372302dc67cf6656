//! The assembly as one model.

use std::path::PathBuf;

use bolted_joint_dynamics::assembly::{Assembly, AssemblyJoint, LawOverPreload, Matrix};
use bolted_joint_dynamics::{Beyond, JointLaw, with_dofs};
use bolted_joint_joint::{About, JointFile, LawError, OverPreload};
use nalgebra::DMatrix;

use crate::error::AssemblyError;
use crate::modal_form::ModalForm;
use crate::place::{Channel, Place};
use crate::response::Response;

/// A structure with its name.
#[derive(Clone, Debug)]
pub struct NamedStructure {
    /// Its name.
    pub name: String,
    /// What it is.
    pub form: ModalForm,
}

/// A joint between two structures.
#[derive(Clone, Debug)]
pub struct PlacedJoint {
    /// Its name.
    pub name: String,
    /// Its file.
    pub path: PathBuf,
    /// What the file says, at the preload that is asked for.
    pub file: JointFile,
    /// The whole file, of a joint over the preload of which no preload is asked for: `file` has it at its nominal one.
    pub over_preload: Option<JointFile>,
    /// Where each of its degrees of freedom is on sides a and b, in the joint's order.
    pub places: [Vec<Place>; 2],
}

/// Structures, joints between them, and what goes in and comes out.
#[derive(Clone, Debug)]
pub struct AssemblyModel {
    /// The assembly file.
    pub path: PathBuf,
    /// Name of the assembly.
    pub name: String,
    /// Who stands behind it, and what others may do with it.
    pub about: Option<About>,
    /// The structures, by name.
    pub structures: Vec<NamedStructure>,
    /// The joints.
    pub joints: Vec<PlacedJoint>,
    /// Loads, by name.
    pub inputs: Vec<Channel>,
    /// Motions, by name.
    pub outputs: Vec<Channel>,
    /// What `respond` computes, where the file says so.
    pub response: Option<Response>,
    /// What the user should know of how it was read.
    pub warnings: Vec<String>,
    /// What is as it may well be meant: that nothing holds the whole, that a structure is connected to none.
    pub notes: Vec<String>,
}

impl PlacedJoint {
    /// K and C of small motion about the same displacement (m, rad) of every degree of freedom, to which the joint came in one
    /// go.
    ///
    /// # Errors
    /// [`AssemblyError::Law`] where the joint gives no law.
    pub fn of_small_motion_about(
        &self,
        displacement: f64,
    ) -> Result<(DMatrix<f64>, DMatrix<f64>), AssemblyError> {
        with_dofs!(self.file.joint.dofs.size(), D => {
            let linear = self.law_of::<D>()?.linearised_about(&[displacement; D]).linear;
            let matrix = |own: [[f64; D]; D]| DMatrix::from_fn(D, D, |i, j| own[i][j]);
            Ok((matrix(linear.stiffness), matrix(linear.damping)))
        })
    }

    /// The file as it is to follow the preload, or as it is at the one that is asked for.
    #[must_use]
    pub fn whole(&self) -> &JointFile {
        self.over_preload.as_ref().unwrap_or(&self.file)
    }

    /// The table over the preload, where none is asked for.
    #[must_use]
    pub fn table(&self) -> Option<&OverPreload> {
        self.over_preload.as_ref()?.joint.over_preload.as_ref()
    }

    /// The law that follows the preload, where none is asked for; `None` of other joints.
    ///
    /// # Errors
    /// [`AssemblyError::Law`] where more of it depends on the preload than can follow one that moves.
    pub fn law_over_preload(
        &self,
        beyond: Beyond,
    ) -> Result<Option<LawOverPreload>, AssemblyError> {
        let Some(whole) = &self.over_preload else {
            return Ok(None);
        };
        let law = with_dofs!(whole.joint.dofs.size(), D => {
            let law = whole.joint.law_over_preload::<D>(beyond);
            law.and_then(|law| law.widened().map_err(LawError::Table))
        });
        law.map(Some).map_err(|source| self.refused(source))
    }

    fn law_of<const D: usize>(&self) -> Result<JointLaw<D>, AssemblyError> {
        let law = self.file.joint.law::<D>();
        law.map_err(|source| self.refused(source))
    }

    fn refused(&self, source: LawError) -> AssemblyError {
        AssemblyError::Law {
            path: self.path.display().to_string(),
            source: Box::new(source),
        }
    }
}

impl AssemblyModel {
    /// Number of coordinates of all structures.
    #[must_use]
    pub fn size(&self) -> usize {
        self.structures
            .iter()
            .map(|structure| structure.form.size())
            .sum()
    }

    /// Shapes at places, one row each, over the coordinates of all structures.
    pub(crate) fn rows<'p>(&self, places: impl IntoIterator<Item = &'p Place>) -> DMatrix<f64> {
        let places: Vec<&Place> = places.into_iter().collect();
        let mut rows = DMatrix::zeros(places.len(), self.size());
        for (i, place) in places.iter().enumerate() {
            let before = self.structures.iter().take(place.structure);
            let first: usize = before.map(|structure| structure.form.size()).sum();
            let form = self
                .structures
                .get(place.structure)
                .map(|structure| &structure.form);
            if let Some(row) = form.and_then(|form| form.row(place.dof)) {
                rows.view_mut((i, first), (1, row.len())).copy_from(&row);
            }
        }
        rows
    }

    /// Rows of the loads over the coordinates: Bᵀ.
    #[must_use]
    pub fn input_rows(&self) -> DMatrix<f64> {
        self.rows(self.inputs.iter().map(|channel| &channel.place))
    }

    /// Rows of the motions over the coordinates.
    #[must_use]
    pub fn output_rows(&self) -> DMatrix<f64> {
        self.rows(self.outputs.iter().map(|channel| &channel.place))
    }

    /// Rows of the relative motion of a joint: x_a − x_b.
    pub(crate) fn relative_rows(&self, joint: &PlacedJoint) -> DMatrix<f64> {
        let [a, b] = joint.places.each_ref().map(|places| self.rows(places));
        a - b
    }

    /// The equations that are integrated, with joints that follow the preload where no preload is asked for: they are about
    /// their nominal one.
    ///
    /// # Errors
    /// [`AssemblyError::Law`] where a joint gives no law.
    pub fn equations_over_preload(&self, beyond: Beyond) -> Result<Assembly, AssemblyError> {
        let mut assembly = self.equations()?;
        for (own, joint) in assembly.joints.iter_mut().zip(&self.joints) {
            own.over_preload = joint.law_over_preload(beyond)?.map(Box::new);
        }
        Ok(assembly)
    }

    /// The equations that are integrated where every preload stays what it is.
    ///
    /// # Errors
    /// [`AssemblyError::Law`] where a joint gives no law.
    pub fn equations(&self) -> Result<Assembly, AssemblyError> {
        let size = self.size();
        let mut frequencies = Vec::with_capacity(size);
        let mut damping = Matrix::zeros(size, size);
        for NamedStructure { form, .. } in &self.structures {
            let first = frequencies.len();
            let own = &form.damping_per_s;
            let block = Matrix::from_fn(form.size(), form.size(), |i, j| own[(i, j)]);
            damping.set_block([first, first], &block);
            frequencies.extend(form.frequency_rad_per_s.iter());
        }
        let joints = self.joints.iter().map(|joint| self.joint(joint));
        Ok(Assembly {
            frequencies_rad_per_s: frequencies,
            damping_per_s: damping,
            loads: transposed(&self.input_rows()),
            joints: joints.collect::<Result<_, _>>()?,
        })
    }

    fn joint(&self, joint: &PlacedJoint) -> Result<AssemblyJoint, AssemblyError> {
        let relative = self.relative_rows(joint);
        let relative = Matrix::from_fn(relative.nrows(), relative.ncols(), |i, j| relative[(i, j)]);
        with_dofs!(joint.file.joint.dofs.size(), D => {
            let law = joint.law_of::<D>()?;
            Ok(AssemblyJoint {
                relative,
                stiffness: Matrix::from_fn(D, D, |i, j| law.linear.stiffness[i][j]),
                damping: Matrix::from_fn(D, D, |i, j| law.linear.damping[i][j]),
                laws: law.on.to_vec(),
                over_preload: None,
            })
        })
    }
}

fn transposed(rows: &DMatrix<f64>) -> Matrix {
    Matrix::from_fn(rows.ncols(), rows.nrows(), |i, j| rows[(j, i)])
}
