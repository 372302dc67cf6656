//! The joint file, `*.joint.json`: what identification and prediction write, and what the export turns into an FMU.
//!
//! All quantities are in SI units. [`JointFile::read`] refuses what it does not understand and says where;
//! [`Passivity`] tells whether the joint can feed energy into a simulation, which reading does not judge.
#![forbid(unsafe_code)]

mod about;
mod at_preload;
mod bracket;
mod dofs;
mod error;
mod friction;
mod higher;
mod law;
mod passivity;
mod problem;
mod read;
mod record;
#[cfg(test)]
mod schema;
mod status;
mod units;
mod validate;
mod write;

pub use about::About;
pub use dofs::{DofName, DofSet};
pub use error::{JointFileError, TextPlace};
pub use friction::Friction;
pub use higher::HigherTerms;
pub use law::LawError;
pub use law::displacements;
pub use passivity::{MatrixPassivity, Passivity};
pub use problem::JointProblem;
pub use record::{
    BandOriginRecord, BandRecord, BandsRecord, Bodies, Body, BootstrapRecord, BudgetRecord,
    Correlation, Drawn, Format, FreeEstimate, FromModesRecord, FunctionResidual, GroupRecord,
    InputFile, Intervals, Joint, JointFile, NoiseRecord, OutlierRecord, OverPreload, Provenance,
    Residual, StandardDeviation, Uncertainty, UncertaintyAtPreload, UncertaintyOverPreload,
    Validity,
};
pub use status::Status;
pub use units::{description, superscript, unit, unit_for_people, with_symbols};
pub use validate::is_one_line;
