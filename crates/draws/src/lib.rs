//! Draws of a bootstrap or a Monte Carlo simulation that are made in parts, on several machines or after one another.
//!
//! Each draw has a number, and a stream of random numbers of its own. So a part of the draws is the same wherever it is
//! made, and all parts together are what one machine makes. [`Share`] says which draws are made, [`DrawsFile`] is what a
//! part leaves behind, and [`merged`] puts the parts together, if they belong together.
#![forbid(unsafe_code)]

mod draw;
mod error;
mod file;
mod merge;
mod origin;

pub use draw::{Draw, Share};
pub use error::{DrawsError, Numbers};
pub use file::{DrawsFile, FORMAT};
pub use merge::{Merged, merged};
pub use origin::Origin;
