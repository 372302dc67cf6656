//! Whether the functions tell two joints that are sought apart.

use bolted_joint_space::ToldApart;
use nalgebra::DMatrix;

use crate::assembled::Assembled;
use crate::error::SpatialError;
use crate::normal::Deviations;
use crate::problem::{Problem, Unknowns};

/// Two neighbours that are sought.
#[derive(Clone, Debug)]
pub struct Apart {
    /// The tables of both in the study.
    pub joints: [String; 2],
    /// What their derivatives say.
    pub told: ToldApart,
}

/// Every pair of joints that are sought, with a set-up that is exact.
pub(crate) fn apart(
    problem: &Problem,
    unknowns: &Unknowns,
    deviations: &Deviations,
) -> Result<Vec<Apart>, SpatialError> {
    let sought = problem.links.sought();
    if sought.len() < 2 {
        return Ok(Vec::new());
    }
    let triangle = triangle(problem, unknowns, deviations)?;
    let columns = |n: usize| triangle.columns(sought[n].first, 2 * sought[n].model.count());
    let mut all = Vec::new();
    for first in 0..sought.len() {
        for second in first + 1..sought.len() {
            all.push(Apart {
                joints: [first, second].map(|n| sought[n].link.key.clone()),
                told: ToldApart::of(&columns(first).into_owned(), &columns(second).into_owned())?,
            });
        }
    }
    Ok(all)
}

/// R of the QR decomposition of all derivatives, line by line: JᵀJ would lose half of the digits, and they are all needed.
fn triangle(
    problem: &Problem,
    unknowns: &Unknowns,
    deviations: &Deviations,
) -> Result<DMatrix<f64>, SpatialError> {
    let assembled = Assembled::new(problem, unknowns)?;
    let count = problem.joint_count();
    let rows = problem.observed.len();
    let mut triangle = DMatrix::<f64>::zeros(0, count);
    for line in 0..problem.frequency_hz.len() {
        let found = assembled.line(line)?;
        let derivatives = assembled.derivatives(line, &found)?;
        let before = triangle.nrows();
        let stacked = DMatrix::from_fn(before + 2 * rows, count, |i, column| {
            if i < before {
                return triangle[(i, column)];
            }
            let row = (i - before) / 2;
            let value = derivatives[(row, column)] / deviations[row];
            std::f64::consts::SQRT_2
                * if (i - before) % 2 == 0 {
                    value.re
                } else {
                    value.im
                }
        });
        // columns of very different sizes: the QR decomposition does not mind
        triangle = stacked.qr().r();
    }
    Ok(triangle)
}
