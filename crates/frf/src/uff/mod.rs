//! Universal files, data sets 58 and 55: the format in which every modal analysis system can export its functions.
//!
//! Read are data sets 58, ASCII and binary, of function types 4 (frequency response function) and 6 (ordinary coherence), with
//! data set 164 for the units; and mode shapes, data set 55. Whatever else the file holds is skipped and counted.

mod ahead;
mod binary;
mod data_type;
mod dataset_name;
mod datasets;
mod degree_of_freedom;
mod fields;
mod function_type;
mod header;
mod lines;
mod meaning;
mod numbers;
mod problem;
mod read;
mod scale;
mod shapes;
mod units;
mod values;
mod write;

pub use binary::ByteOrder;
pub use problem::UffProblem;
pub(crate) use read::read_uff58_of;
pub use read::{read_uff58, read_uff58_from};
pub use shapes::begins_with_shapes;
pub(crate) use shapes::{ShapeFile, Vibration, read_shapes};
pub(crate) use units::{KGF, LBF};
pub use units::{UnitFactorError, UnitSystem};
pub use write::{write_uff58, write_uff58_to, write_uff58b, write_uff58b_to};
