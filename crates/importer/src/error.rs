//! What can go wrong between an importer and an FMU.

use std::path::PathBuf;

use thiserror::Error;

use crate::message::{Message, Status};

/// Why an FMU did not do what it was asked for.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ImportError {
    /// The system does not load the library.
    #[error("{}: cannot be loaded: {source}", path.display())]
    Unloadable {
        /// The library.
        path: PathBuf,
        /// What the system says.
        source: libloading::Error,
    },
    /// A function of the standard is not in the library.
    #[error("{}: found no function {function}, expected every function of the standard: {source}", path.display())]
    Missing {
        /// The library.
        path: PathBuf,
        /// Its C name.
        function: &'static str,
        /// What the system says.
        source: libloading::Error,
    },
    /// A text cannot be handed to C.
    #[error("{argument}: found {found:?}, expected UTF-8 text without a zero byte")]
    Text {
        /// Which text.
        argument: &'static str,
        /// What it was.
        found: String,
    },
    /// Numbers of references and of values differ.
    #[error("{function}: found {values} values for {references} variables, expected one each")]
    Count {
        /// The C function.
        function: &'static str,
        /// Number of value references.
        references: usize,
        /// Number of values.
        values: usize,
    },
    /// A state was saved from an instance of another library.
    #[error("{function}: found a state of another library, expected one of this")]
    ForeignState {
        /// The C function.
        function: &'static str,
    },
    /// A pointer that the function should have returned is null.
    #[error("{function} returned null{}", told(messages))]
    Null {
        /// The C function.
        function: &'static str,
        /// What the FMU logged during the call.
        messages: Vec<Message>,
    },
    /// The FMU refused a call, or failed in it.
    #[error("{function} returned {status}{}", told(messages))]
    Refused {
        /// The C function.
        function: &'static str,
        /// What it returned.
        status: Status,
        /// What the FMU logged during the call.
        messages: Vec<Message>,
    },
}

/// The messages of a call, as the end of a sentence.
fn told(messages: &[Message]) -> String {
    if messages.is_empty() {
        return " and logged nothing".to_owned();
    }
    let texts: Vec<String> = messages.iter().map(ToString::to_string).collect();
    format!("; {}", texts.join("; "))
}
