//! Where loads act and where motions are seen: `b/12:+Y`.

use bolted_joint_dynamics::{self as dynamics, DOFS, DofKind, SPACE};
use bolted_joint_frf::{Direction, Dof};

/// A degree of freedom of one of the structures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Place of the structure among those of the assembly.
    pub structure: usize,
    /// Its degree of freedom.
    pub dof: Dof,
}

/// A load or a motion that has a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Its name.
    pub name: String,
    /// Where it is.
    pub place: Place,
}

impl Channel {
    /// Translation or rotation.
    #[must_use]
    pub fn kind(&self) -> DofKind {
        match self.place.dof.direction().is_rotation() {
            true => DofKind::Rotation,
            false => DofKind::Translation,
        }
    }

    /// The letters of its quantities: those in a plane along y and about z, those in space otherwise.
    #[must_use]
    pub fn letters(&self) -> &'static dynamics::Dof {
        let row = match self.place.dof.direction() {
            Direction::Y | Direction::Scalar => 0,
            Direction::RZ => 1,
            Direction::X => SPACE,
            Direction::Z => SPACE + 2,
            Direction::RX => SPACE + 3,
            Direction::RY => SPACE + 4,
        };
        &DOFS[row]
    }
}
