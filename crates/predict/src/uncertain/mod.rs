//! Values that are not known well: a value and its standard deviation, and what follows from them by Monte Carlo.
//!
//! [`Uncertain`] is what a study says of a value, [`Distribution`] how it is drawn, [`Inputs`] all of them together with
//! what ties them to each other, [`MonteCarlo`] the draws, and [`Outcome`] what came of them: means, standard deviations,
//! intervals of 95 %, correlations, and how much of each result's scatter each input accounts for.

mod distribution;
mod inputs;
mod moments;
mod monte_carlo;
mod outcome;
mod value;

pub use distribution::{Distribution, Spread};
pub use inputs::{Drawn, InputPlace, Inputs};
pub use monte_carlo::{MonteCarlo, MonteCarloError, Refusal};
pub use outcome::{Estimate, Outcome};
pub use value::Uncertain;
