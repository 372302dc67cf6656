//! Saving all that an instance remembers, and going on from it.

use std::sync::Arc;

use super::{
    Instance,
    variables::{CALCULATED, CALCULATED_PARAMETERS},
};
use crate::{
    fmu_state::{Snapshot, StateError},
    interface::{Roles, is_beside, is_committed},
    refusal::Refusal,
};

impl Instance {
    /// Everything that this instance has to remember.
    pub(crate) fn snapshot(&self) -> Snapshot {
        // what is calculated is no part of the state: it follows from the rest, and may not even be finite; all that
        // stands beside the variables is remembered
        // nor is what a joint remembers before it has moved, which follows from the start values
        let begins = self.begins();
        let mut values = self.values.clone();
        // what an assembly goes on from is remembered; its states may not have been told
        let is_underway = values.underway().numbers().is_some();
        values.underway_mut().forget();
        for index in self.values.indices() {
            let is_kept = match self.roles.get(index) {
                _ if is_beside(index) => !begins,
                Some(roles) if roles.intersects(CALCULATED.with(CALCULATED_PARAMETERS)) => {
                    is_committed(index) && !begins
                }
                Some(roles) if roles.intersects(Roles::CARRIED) => !is_underway,
                _ => true,
            };
            if !is_kept {
                values[index] = 0.0;
            }
        }
        if begins {
            values.remembered_mut().for_each(|number| *number = 0.0);
        }
        Snapshot {
            identity: Arc::clone(&self.identity),
            mode: self.mode,
            stop_s: self.stop_s,
            pace: self.pace,
            values,
            inputs: self.inputs.clone(),
        }
    }

    /// Goes on from a snapshot of this or another instance of the same FMU.
    pub(crate) fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Refusal> {
        StateError::unless_same(&snapshot.identity, &self.identity)?;
        self.mode = snapshot.mode;
        self.stop_s = snapshot.stop_s;
        self.pace = snapshot.pace;
        self.values.clone_from(&snapshot.values);
        self.inputs.clone_from(&snapshot.inputs);
        self.model.restored(&self.values);
        self.parameters_changed = true;
        self.outputs_stale = true;
        Ok(())
    }

    /// The snapshot that these bytes were written from.
    pub(crate) fn deserialize(&self, bytes: &[u8]) -> Result<Snapshot, Refusal> {
        Ok(Snapshot::deserialize(bytes, &self.identity)?)
    }
}

#[cfg(test)]
mod tests {
    use super::Instance;
    use crate::{
        interface::{InterfaceType, REFERENCE_COUNT, VALUE_COUNT, Values},
        mode::Mode,
        start_file::StartFile,
        version::Abi,
    };

    const START: &str = "bolted-joint-start/1\nmodel element\ndofs 1\ntoken {memory}\njoint.k_yy 4e6\njoint.c_yy 8\n\
                         joint.k3_y 0\njoint.k5_y 0\njoint.k7_y 0\njoint.c2_y 0\njoint.c4_y 0\n";

    fn instance() -> Instance {
        let file = StartFile::parse("start.txt", START);
        file.ok()
            .and_then(|file| {
                Instance::new(file, "{memory}", Abi::Fmi3, InterfaceType::CoSimulation).ok()
            })
            .unwrap_or_else(|| unreachable!("the start file is right"))
    }

    /// What stands beside the variables.
    fn beside(values: &Values) -> Vec<f64> {
        (REFERENCE_COUNT..VALUE_COUNT)
            .map(|index| values[index])
            .collect()
    }

    #[test]
    fn all_that_stands_beside_the_variables_is_remembered() {
        let mut instance = instance();
        let fresh = instance.snapshot();
        instance.mode = Mode::Step;
        // whatever it is, and however many numbers it takes
        for index in REFERENCE_COUNT..VALUE_COUNT {
            instance.values[index] = 1.5 + index as f64;
        }
        let remembered = instance.values.clone();
        let saved = instance.snapshot();
        assert_eq!(beside(&saved.values), beside(&remembered));
        let loaded = instance.deserialize(&saved.serialize());
        assert_eq!(loaded.as_ref(), Ok(&saved));
        instance.mode = Mode::Terminated;
        instance.reset();
        assert_eq!(instance.snapshot(), fresh);
        assert_eq!(loaded.and_then(|state| instance.restore(&state)), Ok(()));
        assert_eq!(instance.snapshot(), saved);
        assert_eq!(beside(&instance.values), beside(&remembered));
        // before the simulation has begun it follows from the start values
        instance.mode = Mode::Initialization;
        assert!(
            beside(&instance.snapshot().values)
                .iter()
                .all(|&number| number == 0.0)
        );
    }
}
