//! `[start]`: the matrices of a presumed joint, of the shape that the joint model has.

use nalgebra::DMatrix;

use super::super::super::model::{JointMatrices, JointModel};
use super::super::tables::StartTable;
use bolted_joint_study::{StudyError, StudyText};

pub(crate) fn start(
    study: &StudyText,
    table: &StartTable,
    model: JointModel,
) -> Result<JointMatrices, StudyError> {
    Ok(JointMatrices {
        stiffness: matrix(study, "start.stiffness", &table.stiffness, model)?,
        damping: matrix(study, "start.damping", &table.damping, model)?,
    })
}

fn matrix(
    study: &StudyText,
    key: &str,
    rows: &[Vec<f64>],
    model: JointModel,
) -> Result<DMatrix<f64>, StudyError> {
    let dofs = model.dofs();
    let lengths: Vec<String> = rows.iter().map(|row| row.len().to_string()).collect();
    study.ensure(
        rows.len() == dofs && rows.iter().all(|row| row.len() == dofs),
        key,
        format_args!("rows of [{}] entries", lengths.join(", ")),
        format_args!("{dofs} by {dofs}, for joint model \"{model}\""),
    )?;
    let matrix = DMatrix::from_fn(dofs, dofs, |i, j| rows[i][j]);
    for &value in &matrix {
        study.ensure(value.is_finite(), key, value, "finite numbers")?;
    }
    for &value in &matrix.diagonal() {
        let found = format!("{value} on the diagonal");
        study.ensure(value >= 0.0, key, found, "a number that is not negative")?;
    }
    if dofs == 2 {
        let [upper, lower] = [matrix[(0, 1)], matrix[(1, 0)]];
        let found = format!("{upper} and {lower} off the diagonal");
        study.ensure(upper == lower, key, found, "a symmetric matrix")?;
        study.ensure(
            model != JointModel::Diagonal || upper == 0.0,
            key,
            format_args!("{upper} off the diagonal"),
            "zero there: joint model \"diagonal\" has no coupling",
        )?;
    }
    Ok(matrix)
}
