//! Where the FMUs' resources are while the fuzzer runs.

use std::{env, path::PathBuf, process};

/// A folder for this process alone.
pub(crate) fn own() -> PathBuf {
    env::temp_dir().join(format!("bolted-joint fuzz {}", process::id()))
}

/// Writes the resources of the FMUs that the calls are made on.
#[allow(dead_code, reason = "one of the targets writes its own")]
pub(crate) fn prepare() {
    crate::calls::write_resources(&own());
}
