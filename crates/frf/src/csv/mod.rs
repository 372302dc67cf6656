//! Functions as a table: one column of frequencies, and two columns for each function.
//!
//! The header row carries what a universal file keeps in its records: between which degrees of freedom a column lies, what it
//! holds and in which unit.

mod header;
mod number;
mod read;

pub use number::Decimal;
pub use read::{read_csv, read_csv_from};
