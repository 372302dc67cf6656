//! What steps of the lengths need that came last: preparing a length takes far longer than a step.

use bolted_joint_dynamics::assembly::{Assembly, AssemblySteps, TOLERANCE};

use crate::{models::Step, refusal::Refusal};

/// So many lengths are kept: that of the steps, and a few of what is left over where they end or where events are.
const KEPT: usize = 4;

/// Lengths that are prepared, the latest one last.
#[derive(Debug, Default)]
pub(super) struct Lengths(Vec<AssemblySteps>);

impl Lengths {
    /// What this step needs.
    pub(super) fn of(
        &mut self,
        assembly: &Assembly,
        step: Step,
    ) -> Result<&mut AssemblySteps, Refusal> {
        let length_s = step.interval_s;
        let mut known = self.0.iter();
        match known.position(|own| own.length_s().to_bits() == length_s.to_bits()) {
            Some(place) if place + 1 == self.0.len() => {}
            Some(place) => {
                let own = self.0.remove(place);
                self.0.push(own);
            }
            None => {
                let own = AssemblySteps::new(assembly, length_s, TOLERANCE);
                let own = own.ok_or(Refusal::GrowsWithinStep {
                    interval_s: length_s,
                    time_s: step.time_s,
                })?;
                if self.0.len() == KEPT {
                    self.0.remove(0);
                }
                self.0.push(own);
            }
        }
        self.0.last_mut().ok_or(Refusal::Internal)
    }
}
