//! Universal files, data set 58: the format in which every modal analysis system can export its functions.
//!
//! Read are ASCII data sets 58 of function type 4 (frequency response function), with data set 164 for the units.
//! Whatever else the file holds is skipped and counted.

mod fields;
mod header;
mod lines;
mod meaning;
mod numbers;
mod problem;
mod read;
mod scale;
mod unit_label;
mod units;
mod values;
mod write;

pub use problem::UffProblem;
pub use read::{SkippedFunction, UffOptions, UffReading, read_uff58, read_uff58_from};
pub use units::{UnitFactorError, UnitSystem};
pub use write::{write_uff58, write_uff58_to};
