//! Saving all that an instance remembers, and going on from it.

use std::sync::Arc;

use super::{
    Instance,
    variables::{CALCULATED, CALCULATED_PARAMETERS},
};
use crate::{
    fmu_state::{Snapshot, StateError},
    interface::{Roles, is_committed},
    refusal::Refusal,
};

impl Instance {
    /// Everything that this instance has to remember.
    pub(crate) fn snapshot(&self) -> Snapshot {
        // what is calculated is no part of the state: it follows from the rest, and may not even be finite; all that
        // stands beside the variables is remembered
        let values = std::array::from_fn(|index| {
            let roles = self.roles.get(index).copied().unwrap_or(Roles::NONE);
            if roles.intersects(CALCULATED.with(CALCULATED_PARAMETERS)) && !is_committed(index) {
                0.0
            } else {
                self.values[index]
            }
        });
        Snapshot {
            identity: Arc::clone(&self.identity),
            mode: self.mode,
            stop_s: self.stop_s,
            pace: self.pace,
            values,
            inputs: self.inputs,
        }
    }

    /// Goes on from a snapshot of this or another instance of the same FMU.
    pub(crate) fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Refusal> {
        StateError::unless_same(&snapshot.identity, &self.identity)?;
        self.mode = snapshot.mode;
        self.stop_s = snapshot.stop_s;
        self.pace = snapshot.pace;
        self.values = snapshot.values;
        self.inputs = snapshot.inputs;
        self.parameters_changed = true;
        self.outputs_stale = true;
        Ok(())
    }

    /// The snapshot that these bytes were written from.
    pub(crate) fn deserialize(&self, bytes: &[u8]) -> Result<Snapshot, Refusal> {
        Ok(Snapshot::deserialize(bytes, &self.identity)?)
    }
}
