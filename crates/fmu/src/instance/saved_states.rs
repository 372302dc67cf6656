//! Saving all that an instance remembers, and going on from it.

use std::sync::Arc;

use super::{
    Instance,
    variables::{CALCULATED, CALCULATED_PARAMETERS},
};
use crate::{fmu_state::Snapshot, interface::memory, refusal::Refusal};

impl Instance {
    /// Everything that this instance has to remember.
    pub(crate) fn snapshot(&self) -> Snapshot {
        // what is calculated is no part of the state: it follows from the rest, and may not even be finite
        let values = std::array::from_fn(|index| {
            let is_calculated = match self.roles.get(index) {
                Some(&roles) => {
                    roles.intersects(CALCULATED) || roles.intersects(CALCULATED_PARAMETERS)
                }
                None => index == memory::PRELOAD_RATE,
            };
            if is_calculated {
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
        if *snapshot.identity != *self.identity {
            return Err(Refusal::OtherFmu {
                found: snapshot.identity.to_string(),
                expected: self.identity.to_string(),
            });
        }
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
        Snapshot::deserialize(bytes, &self.identity)
    }
}
