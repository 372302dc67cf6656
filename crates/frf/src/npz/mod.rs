//! Functions as NumPy arrays: an archive of a frequency axis, a matrix of functions and the names of its rows and columns.

mod array;
mod axes;
mod matrix;
mod members;
mod read;

pub use read::{read_npz, read_npz_from};
