//! Parts in a chain with joints between them, known and sought: spindle, holder and tool.
//!
//! [`ChainStudy`] is what a study says of them. It plans a test ([`ChainStudy::plan`]), gives what the assembly answers
//! ([`ChainStudy::answers`]), and identifies several joints at once ([`ChainStudy::identify`]). A single joint that is sought is
//! identified between two sides, with the known joints coupled into them ([`crate::SpatialStudy`]).

mod apart;
mod beam;
mod estimate;
mod joints;
mod once;
pub(crate) mod part;
pub(crate) mod plan;
mod reader;
mod reduced;
mod response;
mod study;

pub use apart::Apart;
pub use estimate::{ChainIdentification, FoundJoint};
#[cfg(test)]
pub(crate) use part::joined;
pub use plan::{Addition, Aim, Plan, Planned, Reason};
pub use response::{Answer, Answers};
pub use study::{ChainStudy, joints_sought};
