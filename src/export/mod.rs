//! From a joint file to an FMU (FMI 3.0, Co-Simulation and Model Exchange) that any FMI tool can load.
//!
//! Nothing is compiled: the FMU's library is the same for every joint and is carried inside this crate. [`fmu_bytes`]
//! writes the model description, the start values that the library reads, the documentation, and the archive around them.

mod archive;
mod declared;
mod description;
mod documentation;
mod error;
mod fmu;
mod interface;
mod parameters;
mod platforms;
mod start_file;
mod step;
mod timestamp;
mod token;

pub(crate) use declared::declared;
pub use error::ExportError;
pub use fmu::{Entry, ExportOptions, Exported, fmu_bytes};
pub use interface::Interface;
pub(crate) use parameters::start_value;
pub(crate) use platforms::EMBEDDED_PLATFORM;
pub use platforms::{Library, LibrarySource};
pub(crate) use start_file::{StartFile, parameter_lines};
pub use step::{StepChoice, StepSize};
pub use timestamp::Timestamp;
