//! `export`: a joint file becomes an FMU.

use std::path::Path;

use crate::export::{ExportOptions, Exported, Interface, Timestamp, fmu_bytes};

use super::ExportArguments;
use super::error::CliError;
use super::output::{print, write_file};
