//! Structures whose matrices another program has made: reduced models, as finite-element programs write them.

use std::io::BufReader;
use std::path::Path;

use bolted_joint_files::{inputs, text_file::TextFileError};

use super::{SpatialModel, StructureError};
use crate::{Dof, mat, npz};

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
        let reader = BufReader::new(file);
        let is_matlab = path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("mat"));
        match is_matlab {
            true => mat::matrices_from(reader, path),
            false => npz::matrices_from(reader, path),
        }
    }
}
