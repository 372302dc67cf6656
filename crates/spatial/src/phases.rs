//! Whether the functions of the virtual points are those of structures that take up energy, before any joint is sought: phases that
//! are counted the other way turn dampers into sources, and the joint would have to make up for it.

use bolted_joint_frf::{Asked, feeds_energy, turns_backwards};
use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::error::SpatialError;
use crate::problem::Problem;
use crate::side::Side;
use crate::study::SpatialStudy;

impl SpatialStudy {
    /// What is wrong with the functions of the virtual points of a, of b, and of the assembly at a's and at b's, each a sentence.
    ///
    /// # Errors
    /// [`SpatialError::Interface`] for functions that cannot be used.
    pub fn phases(&self) -> Result<Vec<String>, SpatialError> {
        let problem = &self.problem;
        let mut told = Vec::new();
        let [rows, columns] = problem.skips();
        for ((name, side), first) in ["a", "b"]
            .into_iter()
            .zip(&problem.sides)
            .zip([[0; 2], [rows, columns]])
        {
            let own = side.lines.iter().cloned();
            told.extend(complaint(name, side, own)?);
            if let Some(lines) = of_assembly(problem, side, first) {
                told.extend(complaint(
                    &format!("assembly, at {name}"),
                    side,
                    lines.into_iter(),
                )?);
            }
        }
        Ok(told)
    }
}

/// The assembly's functions of a side's channels and impacts; `None` unless all of them were measured.
fn of_assembly(
    problem: &Problem,
    side: &Side,
    [row, column]: [usize; 2],
) -> Option<Vec<DMatrix<Complex64>>> {
    let (p, q) = (side.responses.len(), side.references.len());
    let mut lines = vec![DMatrix::zeros(p, q); problem.frequency_hz.len()];
    let mut count = 0;
    for one in &problem.observed {
        let at = (one.at[0].checked_sub(row), one.at[1].checked_sub(column));
        if let (Some(i), Some(j)) = at
            && i < p
            && j < q
        {
            count += 1;
            for (line, value) in lines.iter_mut().zip(&one.values) {
                line[(i, j)] = *value;
            }
        }
    }
    (count == p * q).then_some(lines)
}

/// That most of the motions answer their own loads as if the structure gave energy. All lines are asked: coarse ones would hide the
/// phase of a single motion behind its noise, and it is most of them together that decide.
fn complaint(
    name: &str,
    side: &Side,
    lines: impl Iterator<Item = DMatrix<Complex64>>,
) -> Result<Option<String>, SpatialError> {
    let reduction = side.reduction()?;
    let reduced: Vec<_> = lines.map(|line| reduction.reduced(&line)).collect();
    let motions = reduction.own.count();
    let functions: Vec<Vec<Complex64>> = (0..motions)
        .map(|motion| reduced.iter().map(|line| line[(motion, motion)]).collect())
        .collect();
    let active: Vec<_> = functions
        .iter()
        .filter(|own| feeds_energy(own, Asked::Every))
        .collect();
    if 2 * active.len() <= motions {
        return Ok(None);
    }
    let turned = active
        .iter()
        .filter(|own| turns_backwards(own, Asked::Every))
        .count();
    let why = match 2 * turned > active.len() {
        true => "phases are counted the other way (e^−jωt)",
        false => "the sign of all channels or of all impacts is turned",
    };
    Ok(Some(format!(
        "{name}: {} of {motions} motions of the virtual point answer their own loads as if the structure fed energy into them instead of \
         taking it up: {why}",
        active.len()
    )))
}
