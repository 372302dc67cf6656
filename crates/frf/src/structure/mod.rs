//! Substructures: where their receptances come from, and how a joint couples two of them.

mod beam;
mod coupling;
mod modal;
mod rotation;
mod spatial;

pub use beam::{Beam, BeamError, BeamModes, BeamPoint, Boundary, Damping, Motion};
pub use coupling::{Assembly, ComplexMatrix, CouplingError, Partition, couple, transmission};
pub use modal::{ModalError, ModalModel};
pub use rotation::{Difference, FiniteDifference, Order};
pub use spatial::{Modes, SpatialError, SpatialModel};
