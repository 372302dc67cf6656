//! How structures answer: the receptances that a test would measure, with the noise that it would have.

mod measured;
mod pollution;

pub use measured::{to_csv, with_noise};
pub use pollution::{Generator, Pollution, PollutionError};
