//! Structures whose matrices another program has made: reduced models, as finite-element programs write them.

use std::io::{BufRead as _, BufReader};
use std::path::Path;

use bolted_joint_files::{inputs, text_file::TextFileError};

use super::{SpatialModel, StructureError};
use crate::table_problem::TableProblem;
use crate::{Dof, mat, npz};

/// How files begin.
const ARCHIVE: &[u8] = b"PK";
const MATRIX_MARKET: &[u8] = b"%%MatrixMarket";
const EXPECTED: &str = "a NumPy archive (.npz) or a MATLAB file (.mat) with the arrays M, K, points and, unless undamped, C: from \
                        matrices in files of their own numpy.savez(\"NAME.npz\", M=…, K=…, C=…, points=[…]) makes one";

/// Matrices of mass, damping and stiffness with names of their coordinates.
#[derive(Clone, Debug)]
pub struct NamedMatrices {
    /// The coordinates: displacements and rotations at points, or coordinates without a name, such as those of modes.
    pub points: Vec<Option<Dof>>,
    /// The matrices, in SI units.
    pub spatial: SpatialModel,
}

impl NamedMatrices {
    /// Reads a NumPy archive (`.npz`) or a MATLAB file (`.mat`) with the arrays `M`, `K`, `points` and, unless it is undamped,
    /// `C`. A reduction of Craig and Bampton is such a model.
    ///
    /// # Errors
    /// [`StructureError::File`] if the file cannot be read, [`StructureError::Arrays`] with the array, what was found and what was
    /// expected if it cannot be used.
    pub fn read(path: &Path) -> Result<Self, StructureError> {
        let file = inputs::open(path).map_err(|source| TextFileError::Unreadable {
            path: path.to_owned(),
            source,
        })?;
        let mut reader = BufReader::new(file);
        let is_matlab = path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("mat"));
        let beginning = reader.fill_buf().unwrap_or_default();
        if !is_matlab && !beginning.starts_with(ARCHIVE) {
            let found = match beginning.starts_with(MATRIX_MARKET) {
                true => "a Matrix Market file, which holds one matrix without names",
                false => "a file that is no archive of arrays",
            };
            return Err(StructureError::Arrays {
                path: path.to_owned(),
                problem: Box::new(TableProblem::whole(found, EXPECTED)),
            });
        }
        match is_matlab {
            true => mat::matrices_from(reader, path),
            false => npz::matrices_from(reader, path),
        }
    }
}
