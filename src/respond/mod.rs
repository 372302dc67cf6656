//! How structures answer: the receptances that a test would measure, with the noise that it would have.

mod pollution;

pub use pollution::{Generator, Pollution, PollutionError};
