//! Why no joint can be identified from functions that were read.

use bolted_joint_space::SpaceError;
use bolted_joint_virtual_point::VirtualPointError;
use thiserror::Error;

impl SpatialError {
    /// Of the virtual point of a, 0, or of b, 1.
    pub(crate) fn of_side(side: usize, source: VirtualPointError) -> Self {
        Self::VirtualPoint {
            side: ["a", "b"][side],
            source,
        }
    }
}

/// Why no joint can be identified.
#[derive(Debug, Error)]
pub enum SpatialError {
    /// The virtual point of a substructure.
    #[error("{side}: {source}")]
    VirtualPoint {
        /// `a` or `b`.
        side: &'static str,
        /// What is wrong with it.
        source: VirtualPointError,
    },
    /// The joint's matrices.
    #[error(transparent)]
    Space(#[from] SpaceError),
    /// Too few numbers for the unknowns.
    #[error(
        "found {found} functions of the assembly at {lines} lines, {} numbers, expected more than the {unknowns} unknowns of the joint; \
         measure more, or take a model with fewer unknowns (joint.model)",
        2 * found * lines
    )]
    TooFewFunctions {
        /// Functions of the assembly.
        found: usize,
        /// Lines.
        lines: usize,
        /// Unknowns of the joint.
        unknowns: usize,
    },
    /// Noise of the substructures is too large nearly everywhere.
    #[error(
        "of {lines} lines, {kept} are left at which noise of the substructures moves the assembly's functions by less than {percent} %; \
         measure a and b with less noise, or state less (noise.a, noise.b)"
    )]
    TooMuchNoise {
        /// Lines of the study.
        lines: usize,
        /// Those that could be used.
        kept: usize,
        /// What noise may move, in percent of the functions.
        percent: f64,
    },
    /// No start leads anywhere.
    #[error(
        "no start of the search gives finite functions of the assembly; check the units of the files and the interface's length"
    )]
    NoStart,
    /// The information matrix cannot be inverted.
    #[error(
        "the functions of the assembly do not tell the unknowns of the joint apart; measure with sensors on both sides, or take a model \
         with fewer unknowns (joint.model)"
    )]
    NotDetermined,
}
