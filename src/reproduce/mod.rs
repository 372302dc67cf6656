//! The case studies of Tol's thesis computed anew, published and obtained values side by side.

mod draws;
mod error;
mod lumped;
mod outcome;
mod published;

pub use draws::Draws;
pub use error::ReproduceError;
pub use outcome::{Reproduction, Row, Spread};
pub use published::{PublishedTable, UnknownTable};

/// Computes a published table anew.
///
/// # Errors
/// [`ReproduceError`] if the numbers of `draws` make no sense.
pub fn reproduce(table: PublishedTable, draws: &Draws) -> Result<Reproduction, ReproduceError> {
    match table {
        PublishedTable::Table4_2 => lumped::table_4_2(draws),
    }
}
