//! Substructures: where their receptances come from, and how a joint couples two of them.

mod banded;
mod beam;
mod coupling;
mod error;
mod matrices;
mod modal;
mod rotation;
mod section;
mod space_beam;
mod spatial;

pub use beam::{Beam, BeamModes, BeamPoint, Boundary, Damping, ModalBeam, Motion, Theory};
pub use coupling::{Assembly, ComplexMatrix, Partition, SingularAssembly, couple, transmission};
pub use error::StructureError;
pub use matrices::NamedMatrices;
pub use modal::{ModalModel, Mode, large_damping_ratio};
pub use rotation::{Difference, FiniteDifference, Order};
pub use section::Section;
pub use space_beam::{SpaceBeam, SpacePoint};
pub use spatial::{Modes, SpatialModel};
