//! From a joint file, or from an assembly of structures and joints, to an FMU (FMI 3.0 or 2.0, Co-Simulation and Model Exchange)
//! that any FMI tool can load.
//!
//! Nothing is compiled: the FMU's library is the same for every joint and is carried inside this crate. [`fmu_bytes`] and
//! [`assembly_fmu`] write the model description, what the library reads, the documentation, and the archive around them.
#![forbid(unsafe_code)]

mod archive;
mod assembly;
mod assets;
mod declared;
mod description;
mod documentation;
mod error;
mod fmi2;
mod fmi_version;
mod fmu;
mod identifier;
mod interface;
mod nominal;
mod package;
mod parameters;
mod platforms;
mod provenance;
mod reference_run;
mod start_file;
mod step;
mod system;
mod terminals;
mod token;
mod xml;

pub use assembly::{AssemblyOptions, ExportedAssembly, assembly_fmu};
pub use bolted_joint_files::{DateError, Timestamp};
pub use declared::declared;
pub use documentation::joint_curves;
pub use error::ExportError;
pub use fmi_version::FmiVersion;
pub use fmu::{ExportOptions, Exported, fmu_bytes};
pub use interface::Interface;
pub use package::{Entry, Packed};
pub use parameters::start_value;
pub use platforms::{EMBEDDED_PLATFORM, Library, LibrarySource, embedded_library};
pub use provenance::provenance;
pub use start_file::{
    AssemblyStartFile, ListedVariable, StartFile, dofs_text, laws_line, parameter_lines,
    table_lines,
};
pub use step::{StepChoice, StepSize, StepWish};
pub use system::{Dialect, DrawnJoint, ExportedSystem, SystemOptions, assembly_system};
