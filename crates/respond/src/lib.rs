//! How structures answer: the receptances that a test would measure, with the noise that it would have, and the responses of
//! laps whose joint is not linear, in frequency and in time.
#![forbid(unsafe_code)]

mod answer;
mod assembly;
mod error;
mod figure;
mod histories;
mod hysteresis;
mod measured;
mod page;
mod periodic;
mod pollution;
mod run;
mod study;
mod table;

pub use assembly::AssemblyAnswer;
pub use error::RespondError;
pub use hysteresis::{HysteresisLoop, LoopPoint};
pub use measured::{to_csv, with_noise};
pub use page::ResponsePage;
pub use pollution::{Generator, Pollution};
pub use study::{LoadPlace, RespondStudy, Span, Start, StudyLap, Test, Times};
pub use table::{Column, ResponseTable, Role, Series};
