//! Functions as a table: one column of frequencies, and one or two columns for each function.
//!
//! The header row carries what a universal file keeps in its records: between which degrees of freedom a column lies, what it
//! holds and in which unit.

mod column;
mod decibel;
mod header;
mod number;
mod parts_row;
mod phase;
mod read;
mod row;
mod rows;

pub use read::{read_csv, read_csv_from};
