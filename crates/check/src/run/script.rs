//! What the child process is to do with the library, and what it reports: both as JSON.

use std::fmt;
use std::path::PathBuf;

use bolted_joint_importer::FmiVersion;
use serde::{Deserialize, Serialize};

/// Everything that the child process needs to know.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Script {
    pub(super) library: PathBuf,
    #[serde(with = "Version")]
    pub(super) version: FmiVersion,
    pub(super) token: String,
    pub(super) resources: PathBuf,
    pub(super) actions: Vec<Action>,
}

/// How [`FmiVersion`] is written as JSON.
#[derive(Serialize, Deserialize)]
#[serde(remote = "FmiVersion")]
enum Version {
    Two,
    Three,
}

/// One thing to do with an instance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) enum Action {
    /// A new instance, initialised at t = 0 with these values; the one before is terminated and freed.
    Start {
        references: Vec<u32>,
        values: Vec<f64>,
    },
    Set {
        references: Vec<u32>,
        values: Vec<f64>,
    },
    Step {
        time_s: f64,
        interval_s: f64,
        /// Whether an earlier state may be restored afterwards.
        tentative: bool,
    },
    /// Reports one value for each reference.
    Get { references: Vec<u32> },
    /// Reports the directional derivatives of the unknowns.
    Derive {
        unknowns: Vec<u32>,
        knowns: Vec<u32>,
        seed: Vec<f64>,
    },
    /// Saves the state.
    Save,
    /// Goes back to the saved state.
    Restore,
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start { .. } => f.write_str("instantiation and initialisation"),
            Self::Set { .. } => f.write_str("setting inputs"),
            Self::Step {
                time_s, interval_s, ..
            } => write!(f, "the step at t = {time_s:?} s over {interval_s:?} s"),
            Self::Get { .. } => f.write_str("reading outputs"),
            Self::Derive { .. } => f.write_str("taking directional derivatives"),
            Self::Save => f.write_str("saving the state"),
            Self::Restore => f.write_str("restoring the state"),
        }
    }
}

/// One line of the child's journal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) enum Entry {
    /// The library is being loaded.
    Loading,
    /// The action with this index begins.
    Began(usize),
    /// The FMU logged this.
    Logged(String),
    /// What an action reports; `None` stands for what is not finite.
    Values(Vec<Option<f64>>),
    /// The FMU refused; nothing follows.
    Refused(String),
    /// All was done, and everything is freed.
    Finished,
}
