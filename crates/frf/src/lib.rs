//! Frequency response functions: what was measured, between which degrees of freedom, in which units.
#![forbid(unsafe_code)]

mod arrays;
mod beside;
mod coherence;
mod counted;
mod csv;
mod dof;
mod error;
mod function;
mod gathered;
mod mat;
mod noise;
mod npz;
mod options;
mod passivity;
mod quantity;
mod read;
mod reading;
mod resonance;
mod selection;
mod set;
mod shown;
mod skipped;
mod statement;
pub mod structure;
mod summary;
mod table_problem;
mod uff;
mod unit_label;

pub use coherence::{Coherence, absolute_variances, relative_variance};
pub use csv::{read_csv, read_csv_from};
pub use dof::{Direction, Dof, DofError, Sign};
pub use error::FrfError;
pub use function::Frf;
pub use mat::{read_mat, read_mat_from};
pub use noise::polluted;
pub use npz::{read_npz, read_npz_from, to_npz};
pub use options::ReadOptions;
pub use passivity::{Asked, beyond_noise, feeds_energy, turns_backwards, without_phase};
pub use quantity::{Quantity, receptance_unit};
pub use read::{Container, read_frfs, read_frfs_watched};
pub use reading::FrfReading;
pub use resonance::{Resonance, resonances};
pub use selection::Selection;
pub use set::{FrfSet, Receptance};
pub use shown::shown;
pub use skipped::{SkippedDatasets, SkippedFunction};
pub use summary::{FileFormat, FileSummary, StatedBy, UnitStatement};
pub use table_problem::TableProblem;
pub use uff::{
    ByteOrder, UffProblem, UnitFactorError, UnitSystem, begins_with_shapes, read_uff58,
    read_uff58_from, write_uff58, write_uff58_to, write_uff58b, write_uff58b_to,
};
