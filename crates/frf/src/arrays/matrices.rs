//! A file of arrays, made into a structure: its matrices of mass, damping and stiffness, and the names of its coordinates.

use std::path::Path;

use nalgebra::DMatrix;

use super::members::Members;
use super::{Array as _, ArrayFile, Element};
use crate::structure::{NamedMatrices, SpatialModel, StructureError};
use crate::{Dof, TableProblem};

pub(super) const MASS: &[&str] = &["M", "mass"];
const DAMPING: &[&str] = &["C", "damping"];
pub(super) const STIFFNESS: &[&str] = &["K", "stiffness"];
const POINTS: &[&str] = &["points", "point", "coordinates"];
/// More coordinates than a reduced model has.
const MOST_COORDINATES: usize = 5000;
/// How far a matrix may be from its transpose, in parts of its largest entry.
const ASYMMETRY: f64 = 1e-8;

/// Reads the matrices of a file of arrays, if it could be opened.
pub(crate) fn matrices<F: ArrayFile>(
    opened: Result<F, TableProblem>,
    path: &Path,
) -> Result<NamedMatrices, StructureError> {
    let problem = |problem: TableProblem| StructureError::Arrays {
        path: path.to_owned(),
        problem: Box::new(problem),
    };
    let mut file = opened.map_err(problem)?;
    let (points, [mass, damping, stiffness]) = matrices_of(&mut file).map_err(problem)?;
    Ok(NamedMatrices {
        points,
        spatial: SpatialModel::new(mass, damping, stiffness)?,
    })
}

type Found = (Vec<Option<Dof>>, [DMatrix<f64>; 3]);

fn matrices_of<F: ArrayFile>(file: &mut F) -> Result<Found, TableProblem> {
    let mut members = Members(file);
    let mass_name = members.required_of_matrices(MASS, "M, the mass matrix")?;
    let stiffness_name = members.required_of_matrices(STIFFNESS, "K, the stiffness matrix")?;
    let named = members.required_of_matrices(
        POINTS,
        "points, a name such as \"2:+Y\" for each coordinate, \"\" for those without",
    )?;
    let points = members.points(&named)?;
    let size = points.len();
    if !(1..=MOST_COORDINATES).contains(&size) {
        return Err(TableProblem::at(
            format_args!("array {named}"),
            format_args!("{size} coordinates"),
            format_args!("1 to {MOST_COORDINATES}; reduce the model (Craig–Bampton, modes) first"),
        ));
    }
    let mass = symmetric(&mut members, &mass_name, size)?;
    let stiffness = symmetric(&mut members, &stiffness_name, size)?;
    let damping = match members.find(DAMPING)? {
        None => {
            refuse_another(&mut members, [&mass_name, &stiffness_name], size)?;
            DMatrix::zeros(size, size)
        }
        Some(name) => symmetric(&mut members, &name, size)?,
    };
    Ok((points, [mass, damping, stiffness]))
}

/// Refuses a file without C that has a matrix of its size under another name: that would be left out without a word.
fn refuse_another<F: ArrayFile>(
    members: &mut Members<'_, F>,
    known: [&String; 2],
    size: usize,
) -> Result<(), TableProblem> {
    for name in members.0.names().to_vec() {
        // what cannot be read is no matrix
        let is_matrix = |array: F::Array<'_>| size > 1 && array.shape() == [size, size];
        if !known.contains(&&name) && members.0.array(&name).is_ok_and(is_matrix) {
            return Err(TableProblem::at(
                format_args!("array {name}"),
                format_args!("a matrix of {size} × {size}, and no array C"),
                "C for damping, and nothing else of that size: rename it, or leave it out",
            ));
        }
    }
    Ok(())
}

/// A real symmetric matrix of this size.
fn symmetric<F: ArrayFile>(
    members: &mut Members<'_, F>,
    name: &str,
    size: usize,
) -> Result<DMatrix<f64>, TableProblem> {
    let place = format!("array {name}");
    let array = members.numbers(name)?;
    if array.shape() != [size, size] {
        return Err(TableProblem::at(
            place,
            format_args!("shape {:?}", array.shape()),
            format_args!("{size} × {size}, as many as there are points"),
        ));
    }
    let mut numbers = Vec::with_capacity(size * size);
    array.each(|element| {
        if let Element::Number(number) = element {
            if number.im != 0.0 || !number.re.is_finite() {
                let expected = "real, finite numbers in SI units";
                return Err(TableProblem::at(&place, number, expected));
            }
            numbers.push(number.re);
        }
        Ok(())
    })?;
    // symmetric, so that the order of its axes is of no account
    let matrix = DMatrix::from_vec(size, size, numbers);
    let largest = matrix.amax();
    for i in 0..size {
        for j in 0..i {
            let (one, other) = (matrix[(i, j)], matrix[(j, i)]);
            if (one - other).abs() > ASYMMETRY * largest {
                return Err(TableProblem::at(
                    &place,
                    format_args!(
                        "{one} and {other} in the entries ({i}, {j}) and ({j}, {i}), counted from 0"
                    ),
                    "a symmetric matrix; gyroscopic and follower terms are not taken",
                ));
            }
        }
    }
    Ok((&matrix + matrix.transpose()) * 0.5)
}
