//! Functions as named arrays: a frequency axis, a matrix of functions and the names of its rows and columns.
//!
//! Several kinds of files hold such arrays. Each has a folder of its own, which says how its arrays are found and how their elements
//! are read; what the arrays mean is the same for all and is read here.

mod axes;
mod functions;
mod matrices;
mod matrix;
mod members;
mod misspelt;

use num_complex::Complex64;

use crate::{FileFormat, TableProblem};

pub(crate) use functions::functions;
pub(crate) use matrices::matrices;

/// What the elements of an array are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Real,
    Complex,
    Text,
}

/// One element of an array.
pub(crate) enum Element {
    Number(Complex64),
    Text(String),
}

/// A file of named arrays.
pub(crate) trait ArrayFile {
    /// What is said of the functions that come from it.
    const FORMAT: FileFormat;
    /// How functions are saved so that they can be read.
    const SAVE: &str;
    /// How matrices of a structure are.
    const SAVE_MATRICES: &str;
    /// What else helps where an array is not found.
    const HINT: &str = "";
    /// How elements of another type are made into those that can be read.
    const CONVERT: &str;
    /// An array whose elements are still to be read.
    type Array<'file>: Array
    where
        Self: 'file;

    /// Names of the arrays.
    fn names(&self) -> &[String];

    /// The array of this name, which is one of [`names`](Self::names).
    fn array(&mut self, name: &str) -> Result<Self::Array<'_>, TableProblem>;
}

/// An array whose elements are still to be read.
pub(crate) trait Array {
    fn kind(&self) -> Kind;

    /// Its lengths.
    fn shape(&self) -> &[usize];

    /// Whether the first index runs fastest, and not the last.
    fn fortran_order(&self) -> bool;

    /// Hands every element, in the order of the file, to `take`.
    fn each(
        self,
        take: impl FnMut(Element) -> Result<(), TableProblem>,
    ) -> Result<(), TableProblem>;
}
