//! From a joint file to an FMU (FMI 3.0 or 2.0, Co-Simulation and Model Exchange) that any FMI tool can load.
//!
//! Nothing is compiled: the FMU's library is the same for every joint and is carried inside this crate. [`fmu_bytes`]
//! writes the model description, the start values that the library reads, the documentation, and the archive around them.
#![forbid(unsafe_code)]

mod archive;
mod assets;
mod declared;
mod description;
mod documentation;
mod error;
mod fmi2;
mod fmi_version;
mod fmu;
mod interface;
mod parameters;
mod platforms;
mod provenance;
mod reference_run;
mod start_file;
mod step;
mod terminals;
mod token;
mod xml;

pub use bolted_joint_files::{DateError, Timestamp};
pub use declared::declared;
pub use documentation::joint_curves;
pub use error::ExportError;
pub use fmi_version::FmiVersion;
pub use fmu::{Entry, ExportOptions, Exported, fmu_bytes};
pub use interface::Interface;
pub use parameters::start_value;
pub use platforms::{EMBEDDED_LIBRARY, EMBEDDED_PLATFORM, Library, LibrarySource};
pub use provenance::provenance;
pub use start_file::{StartFile, dofs_text, laws_line, parameter_lines, table_lines};
pub use step::{StepChoice, StepSize};
