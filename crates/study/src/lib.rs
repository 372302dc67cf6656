//! Studies: the TOML files that say what is to be identified, predicted or computed. One reader, one set of checks and one error
//! serve every method, so that a mistake is told in the same words wherever it is made.
//!
//! [`StudyText::read`] takes a file, [`StudyText::method`] tells which reader it is for, [`StudyText::tables`] gives that reader
//! its tables. What the tables say is checked by [`StudyText::ensure`] and its kin, which name the file and the key.
//!
//! ```
//! use std::path::Path;
//! use bolted_joint_study::{Method, StudyText};
//!
//! let study = StudyText::new("method = \"respond\"\n[time]\nduration = -1", Path::new("study.toml"));
//! assert_eq!(study.method()?, Method::Respond);
//! let refused = study.positive("time.duration", -1.0, "a duration in s").unwrap_err();
//! assert_eq!(refused.to_string(), "study.toml: `time.duration`: found -1, expected a duration in s");
//! # Ok::<(), bolted_joint_study::StudyError>(())
//! ```
#![forbid(unsafe_code)]

mod check;
mod deviation;
mod error;
mod kind;
mod lines;
mod method;
mod named;
mod noise;
mod origin;
mod paths;
mod plausible;
pub mod schema;
mod stated;
mod tables;
mod text;
mod units;

pub use deviation::Deviation;
pub use error::StudyError;
pub use kind::TextKind;
pub use lines::LineChoice;
pub use method::Method;
pub use named::{NamedFile, PATH_KEYS};
pub use noise::overstated_noise;
pub use origin::{input_file, name_in, provenance};
pub use paths::Paths;
pub use plausible::BeamNumber;
pub use stated::{Stated, StatedDeviation};
pub use tables::{FrequencyTable, OneOrMore, UncertaintyTable, one_or_more_tables};
pub use text::StudyText;
pub use units::UnitsTable;
