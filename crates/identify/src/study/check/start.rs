//! `[start]`: the matrices of a presumed joint, of the shape that the joint model has.

use nalgebra::DMatrix;

use super::super::super::error::IdentifyError;
use super::super::super::model::{JointMatrices, JointModel};
use super::super::tables::StartTable;
use super::Checker;

impl Checker<'_> {
    pub(in super::super) fn start(
        &self,
        table: &StartTable,
        model: JointModel,
    ) -> Result<JointMatrices, IdentifyError> {
        Ok(JointMatrices {
            stiffness: self.matrix("start.stiffness", &table.stiffness, model)?,
            damping: self.matrix("start.damping", &table.damping, model)?,
        })
    }

    fn matrix(
        &self,
        key: &str,
        rows: &[Vec<f64>],
        model: JointModel,
    ) -> Result<DMatrix<f64>, IdentifyError> {
        let dofs = model.dofs();
        if rows.len() != dofs || rows.iter().any(|row| row.len() != dofs) {
            let lengths: Vec<String> = rows.iter().map(|row| row.len().to_string()).collect();
            return self.refuse(
                key,
                format!("rows of [{}] entries", lengths.join(", ")),
                format!("{dofs} by {dofs}, for joint model \"{model}\""),
            );
        }
        let matrix = DMatrix::from_fn(dofs, dofs, |i, j| rows[i][j]);
        if let Some(value) = matrix.iter().find(|value| !value.is_finite()) {
            return self.refuse(key, value.to_string(), "finite numbers");
        }
        if let Some(value) = matrix.diagonal().iter().find(|value| **value < 0.0) {
            return self.refuse(
                key,
                format!("{value} on the diagonal"),
                "a number that is not negative",
            );
        }
        if dofs == 2 && matrix[(0, 1)] != matrix[(1, 0)] {
            return self.refuse(
                key,
                format!("{} and {} off the diagonal", matrix[(0, 1)], matrix[(1, 0)]),
                "a symmetric matrix",
            );
        }
        if model == JointModel::Diagonal && matrix[(0, 1)] != 0.0 {
            return self.refuse(
                key,
                format!("{} off the diagonal", matrix[(0, 1)]),
                "zero there: joint model \"diagonal\" has no coupling",
            );
        }
        Ok(matrix)
    }
}
