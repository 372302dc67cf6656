//! Joints of a chain as a study gives them: sought, known from a joint file, or taken to be something while a test is planned.

use std::path::Path;

use bolted_joint_joint::JointFile;
use bolted_joint_space::{Dof as Motion, Motions};
use bolted_joint_study::StudyError;
use nalgebra::Matrix6;

use super::response::Scatter;
use crate::links::{Link, Numbers};
use crate::study::{FARTHEST_M, Reader};
use crate::tables::{ExpectedTable, JointTable, MatricesTable};

/// Coupling of a known joint between the motions of a study and others, in parts of what it holds, that is none.
const UNCOUPLED: f64 = 1e-6;

/// Length of a joint that is known and has no rotations: it scales nothing.
const ANY_LENGTH_M: f64 = 1.0;

/// K and C of a joint file, and how far they scatter.
pub(super) struct Known {
    pub(super) matrices: [Matrix6<f64>; 2],
    pub(super) scatter: Option<Scatter>,
}

impl Reader<'_> {
    /// A joint, sought or known.
    pub(super) fn link(
        &self,
        key: &str,
        table: &JointTable,
    ) -> Result<(Link, Option<Scatter>), StudyError> {
        let mut scatter = None;
        let length = table.length.map(|length| {
            let key = format_args!("{key}.length");
            let expected = "about the size of the interface in m, such as 0.03";
            let length = self.study.positive(key, length, expected)?;
            self.study.ensure(
                length <= FARTHEST_M,
                key,
                length,
                format_args!("{expected}, at most {FARTHEST_M} m (is it in millimetres?)"),
            )?;
            Ok::<f64, StudyError>(length)
        });
        let length_m = length.transpose()?;
        let numbers = match (&table.known, table.model) {
            (Some(path), None) => {
                let known = self.joint_file(&format!("{key}.known"), path)?;
                scatter = known.scatter;
                Numbers::Known(Box::new(known.matrices))
            }
            (None, Some(model)) => Numbers::Unknown(self.model(key, model, table)?),
            (known, _) => {
                let found = if known.is_some() {
                    "known beside model"
                } else {
                    "neither model nor known"
                };
                return self.study.refuse(
                    key,
                    found,
                    "model of a joint that is sought, or known = \"NAME.joint.json\"",
                );
            }
        };
        let length_m = match (&numbers, length_m) {
            (_, Some(length_m)) => length_m,
            // √(rotations/translations)
            (Numbers::Known(matrices), None) => {
                let [stiffness, _] = matrices.as_ref();
                let trace = |from: usize| (from..from + 3).map(|i| stiffness[(i, i)]).sum::<f64>();
                let length_m = (trace(3) / trace(0)).sqrt();
                if length_m.is_finite() && length_m > 0.0 {
                    length_m
                } else {
                    ANY_LENGTH_M
                }
            }
            (Numbers::Unknown(_), None) => self.study.needed(
                format_args!("{key}.length"),
                None,
                "about the size of the interface in m, such as 0.03",
            )?,
        };
        let link = Link {
            key: key.to_owned(),
            length_m,
            motions: self.motions,
            is_placed: numbers.are_placed(self.motions),
            numbers,
        };
        Ok((link, scatter))
    }

    /// What a joint that is sought is taken to be.
    pub(super) fn expected(
        &self,
        key: &str,
        table: &JointTable,
    ) -> Result<Option<Known>, StudyError> {
        let key = format!("{key}.expected");
        Ok(match &table.expected {
            None => None,
            Some(ExpectedTable::File(path)) => Some(self.joint_file(&key, path)?),
            Some(ExpectedTable::Matrices(own)) => {
                let MatricesTable { stiffness, damping } = own;
                let matrices = [
                    self.stated(&format!("{key}.stiffness"), stiffness)?,
                    self.stated(&format!("{key}.damping"), damping)?,
                ];
                Some(Known {
                    matrices: self.between_motions(&key, matrices)?,
                    scatter: None,
                })
            }
        })
    }

    /// A matrix with a row and a column for each motion of the study, or for all six.
    fn stated(&self, key: &str, rows: &[Vec<f64>]) -> Result<Matrix6<f64>, StudyError> {
        let own = match rows.len() {
            6 => Motions::ALL,
            _ => self.motions,
        };
        let count = own.count();
        self.study.ensure(
            rows.len() == count && rows.iter().all(|row| row.len() == count),
            key,
            format_args!("{} rows", rows.len()),
            format_args!("{count} rows of {count} numbers each, for the motions {own}"),
        )?;
        let mut matrix = Matrix6::zeros();
        for (row, i) in rows.iter().zip(own.rows()) {
            for (number, j) in row.iter().zip(own.rows()) {
                matrix[(i, j)] = *number;
            }
        }
        Ok(matrix)
    }

    /// K and C of a joint file, in six motions.
    pub(super) fn joint_file(&self, key: &str, path: &Path) -> Result<Known, StudyError> {
        let file = JointFile::read(&self.study.resolved(path)).map_err(StudyError::of_file)?;
        let file = file
            .at_preload(None)
            .map_err(|source| StudyError::model(self.study.path(), Some(key), source))?;
        let dofs = file.joint.dofs;
        self.study.ensure(
            dofs.is_in_space() || self.are_of_a_beam_along_x(),
            key,
            format_args!("a joint with {dofs}"),
            "one in space, with some of x, y, z, rx, ry, rz; one in a plane is for motions = [\"y\", \"rz\"]",
        )?;
        // the slope of a beam along x is its rotation about z
        let name = |name| match name {
            "theta" => Motion::Rz.symbol(),
            name => name,
        };
        let names: Vec<&str> = dofs.names().into_iter().map(name).collect();
        let place = |dof: Motion| names.iter().position(|name| *name == dof.symbol());
        let of = |rows: &[Vec<f64>]| {
            Matrix6::from_fn(|i, j| {
                let at = place(Motion::ALL[i]).zip(place(Motion::ALL[j]));
                at.map_or(0.0, |(row, column)| rows[row][column])
            })
        };
        Ok(Known {
            matrices: self
                .between_motions(key, [of(&file.joint.stiffness), of(&file.joint.damping)])?,
            scatter: file
                .uncertainty
                .as_ref()
                .and_then(|own| Scatter::of(own, &names)),
        })
    }

    /// Whether the interfaces move as the end of a beam along x that bends along y, and no further but along it.
    fn are_of_a_beam_along_x(&self) -> bool {
        let has = |dof| self.motions.has(dof);
        let has_others = [Motion::Z, Motion::Rx, Motion::Ry].into_iter().any(has);
        has(Motion::Y) && has(Motion::Rz) && !has_others
    }

    /// What of a known joint's K and C is between the motions of the study, where it couples these to no others.
    fn between_motions(
        &self,
        key: &str,
        matrices: [Matrix6<f64>; 2],
    ) -> Result<[Matrix6<f64>; 2], StudyError> {
        for matrix in &matrices {
            let coupling = self.motions.coupling_to_others(matrix);
            self.study.ensure(
                coupling <= UNCOUPLED,
                key,
                format_args!(
                    "a joint that couples {} to other motions, by {:.2} % of what it holds",
                    self.motions,
                    100.0 * coupling
                ),
                "one with the plane as a mirror plane, or a study with all motions that it couples",
            )?;
        }
        Ok(matrices.map(|matrix| self.motions.part(&matrix)))
    }
}
